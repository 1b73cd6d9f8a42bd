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
    """Rows with a finite figure in each of the columns."""
    return [row for row in rows if all(is_number(row.get(c)) and math.isfinite(row[c]) for c in columns)]


def lines_of(rows: Sequence[Row]) -> list[str]:
    """What tells each row of a chart apart: its codec, and what else differs between the rows."""
    others = [name for name in LINES if len({str(row.get(name)) for row in rows}) > 1]
    return [" ".join([CodecKey.of(row).label, *(str(row.get(name)) for name in others)]) for row in rows]


def but_without_twins(rows: Sequence[Row]) -> list[Row]:
    """Rows but those that have no figures for want of a Python twin alone, which is said beside them."""
    return [row for row in rows if not lacks_twin(row.get("skipped") or "")]


def one_backend(rows: Sequence[Row]) -> list[Row]:
    """Of each encoding or depth code the rows of one back end: JAX's where it has some."""
    chosen: dict[Any, Any] = {}
    for backend in dict.fromkeys([*BACKENDS, *(str(row.get("backend")) for row in rows)]):
        for row in rows:
            if str(row.get("backend")) == backend:
                chosen.setdefault(_code_name(row), backend)
    return [row for row in rows if str(row.get("backend")) == chosen[_code_name(row)]]


def _code_name(row: Row) -> Any:
    return row.get("encoding") or row.get("depth")


def backends_of(rows: Sequence[Row]) -> str:
    """By which back ends rows are, as a title says it, whatever the order of the rows."""
    names = dict.fromkeys(str(row.get("backend")) for row in rows)
    return " or ".join(sorted(names, key=_place))


def _place(backend: str) -> int:
    """Its place among the back ends; the last for another name."""
    known = backends.BACKENDS
    return known.index(backend) if backend in known else len(known)


def bins(text: Any) -> list[tuple[float, float, int]]:
    """A row's histogram: lower and upper edge in degrees and the count of each bin; none where it is no histogram."""
    try:
        pairs = [(float(edge), int(count)) for edge, count in (word.split(":") for word in str(text).split())]
    except ValueError:
        return []
    # A bin is an eighth of its octave wide; the first begins at 0.
    return [(edge, edge + 2.0 ** math.floor(math.log2(edge)) / 8 if edge > 0 else 0.0, n) for edge, n in pairs]
