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
    """Return the rows that have a finite number in each of these columns."""
    return [row for row in rows if all(is_number(row.get(c)) and math.isfinite(row[c]) for c in columns)]


def lines_of(rows: Sequence[Row]) -> list[str]:
    """Return labels that distinguish a chart's rows: the codec, and other columns that differ between rows."""
    others = [name for name in LINES if len({str(row.get(name)) for row in rows}) > 1]
    return [" ".join([CodecKey.of(row).label, *(str(row.get(name)) for name in others)]) for row in rows]


def but_without_twins(rows: Sequence[Row]) -> list[Row]:
    """Return the rows, without rows that were skipped for lack of a Python twin; these are reported separately."""
    return [row for row in rows if not lacks_twin(row.get("skipped") or "")]


def one_backend(rows: Sequence[Row]) -> list[Row]:
    """Return the rows of one backend for each encoding of normals or depth: JAX if it has any rows."""
    chosen: dict[Any, Any] = {}
    for backend in dict.fromkeys([*BACKENDS, *(str(row.get("backend")) for row in rows)]):
        for row in rows:
            if str(row.get("backend")) == backend:
                chosen.setdefault(_code_name(row), backend)
    return [row for row in rows if str(row.get("backend")) == chosen[_code_name(row)]]


def _code_name(row: Row) -> Any:
    return row.get("encoding") or row.get("depth")


def backends_of(rows: Sequence[Row]) -> str:
    """Return the backends of rows for a title, joined by "or", independent of the order of the rows."""
    names = dict.fromkeys(str(row.get("backend")) for row in rows)
    return " or ".join(sorted(names, key=_place))


def _place(backend: str) -> int:
    """Return the position of a backend in the list of backends; after the last for an unknown name."""
    known = backends.BACKENDS
    return known.index(backend) if backend in known else len(known)


def bins(text: Any) -> list[tuple[float, float, int]]:
    """Return the bins of a row's histogram as (lower edge, upper edge, count), edges in degrees; empty if the text is
    not a histogram."""
    try:
        pairs = [(float(edge), int(count)) for edge, count in (word.split(":") for word in str(text).split())]
    except ValueError:
        return []
    # A bin is an eighth of its octave wide; the first begins at 0.
    return [(edge, edge + 2.0 ** math.floor(math.log2(edge)) / 8 if edge > 0 else 0.0, n) for edge, n in pairs]
