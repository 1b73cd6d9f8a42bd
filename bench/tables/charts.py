"""Rows as charts can draw them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ...reports.page.codec_key import CodecKey
from ...reports.page.verdict import BACKENDS, is_number
from ..ground.output.errors import lacks_twin
from ..subjects.names import backends
from .table import Row

# A histogram's least angle: nothing of 32 bits and less is finer, and what is 0 has no logarithm.
LEAST_DEG = 1e-4
# What may tell rows of one codec apart, in the order of their names.
LINES = ("layout", "light_buffer", "light_targets", "pipeline", "shadow", "exposure")


def having(rows: Sequence[Row], *columns: str) -> list[Row]:
    """Return the rows with a finite figure in each of the columns."""
    return [row for row in rows if all(is_number(row.get(c)) and math.isfinite(row[c]) for c in columns)]


def lines_of(rows: Sequence[Row]) -> list[str]:
    """Return labels that distinguish a chart's rows: the codec, and other names that differ between the rows."""
    others = [name for name in LINES if len({str(row.get(name)) for row in rows}) > 1]
    return [" ".join([CodecKey.of(row).label, *(str(row.get(name)) for name in others)]) for row in rows]


def but_without_twins(rows: Sequence[Row]) -> list[Row]:
    """Return rows, except those without figures only for lack of a Python twin, which is reported next to them."""
    return [row for row in rows if not lacks_twin(row.get("skipped") or "")]


def one_backend(rows: Sequence[Row]) -> list[Row]:
    """Return the rows of one backend for each encoding of normals or depth: JAX's if it has any."""
    chosen: dict[Any, Any] = {}
    for backend in dict.fromkeys([*BACKENDS, *(str(row.get("backend")) for row in rows)]):
        for row in rows:
            if str(row.get("backend")) == backend:
                chosen.setdefault(_code_name(row), backend)
    return [row for row in rows if str(row.get("backend")) == chosen[_code_name(row)]]


def _code_name(row: Row) -> Any:
    return row.get("encoding") or row.get("depth")


def backends_of(rows: Sequence[Row]) -> str:
    """Return the backends of rows for a title, joined by "or", whatever the order of the rows."""
    names = dict.fromkeys(str(row.get("backend")) for row in rows)
    return " or ".join(sorted(names, key=_place))


def _place(backend: str) -> int:
    """Return the place of a backend among all backends; the last place for another name."""
    known = backends.BACKENDS
    return known.index(backend) if backend in known else len(known)


def bins(text: Any) -> list[tuple[float, float, int]]:
    """Return a row's histogram: lower and upper edge in degrees and count of each bin; empty if it is not one."""
    try:
        pairs = [(float(edge), int(count)) for edge, count in (word.split(":") for word in str(text).split())]
    except ValueError:
        return []
    # A bin is an eighth of its octave wide; the first begins at 0.
    return [(edge, edge + 2.0 ** math.floor(math.log2(edge)) / 8 if edge > 0 else 0.0, n) for edge, n in pairs]
