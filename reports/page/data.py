"""A run's rows inside a page: one packed block of columns for each table."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from typing import Any

from ..sheets import Column, Row, column_called, undefined
from ..tables import storable, title_of
from .packing import packed

# What a browser's numbers hold without a loss.
LARGEST_EXACT = 2**53
FLOAT, WHOLE, TEXT = "float", "whole", "text"
# Floats of tables of more rows are kept with so many digits: all of them make most of the page.
MANY_ROWS, DIGITS = 2_000, 5


def block(rows: Sequence[Row], columns: Iterable[Column]) -> str:
    """Return all rows of a table as base64 of packed JSON. From it, data.js reproduces the table's CSV file to the
    byte or, with more than MANY_ROWS rows, to DIGITS digits.

    Args:
        rows: rows with the same columns.
        columns: the known columns.
    """
    known = tuple(columns)
    names = list(rows[0]) if rows else []
    digits = DIGITS if len(rows) > MANY_ROWS else None
    column_blocks = [
        {**_about(column_called(name, known) or undefined(name), name), **_values(name, rows, digits)} for name in names
    ]
    content = {"count": len(rows), **({"digits": digits} if digits else {}), "columns": column_blocks}
    return packed(json.dumps(content, allow_nan=False, separators=(",", ":")))


def _about(column: Column, name: str) -> dict[str, Any]:
    """Return the facts about a column, without empty values."""
    facts = {"says": column.definition, "better": column.better, "role": column.role.value, "unit": column.unit}
    facts |= {"hidden": not column.shown}
    return {"name": name, "title": title_of(name), **{key: value for key, value in facts.items() if value}}


def _values(name: str, rows: Sequence[Row], digits: int | None) -> dict[str, Any]:
    """Return a column's values: numbers unchanged, others as texts of a CSV file, each stored once, with indices."""
    values = [row.get(name) for row in rows]
    known = [value for value in values if value is not None]
    if known and all(type(value) is float for value in known):
        return {"kind": FLOAT, "values": [_number(value, digits) for value in values]}
    if known and all(type(value) is int and abs(value) < LARGEST_EXACT for value in known):
        return {"kind": WHOLE, "values": values}
    words: dict[str, int] = {}
    places = [None if _is_nothing(value) else words.setdefault(str(storable(value)), len(words)) for value in values]
    return {"kind": TEXT, "words": list(words), "values": places}


def _is_nothing(value: Any) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def _number(value: float | None, digits: int | None) -> float | str | None:
    """Return a float for JSON: infinity as text, NaN as None, others with all digits unless `digits` is given."""
    if value is None or _is_nothing(value):
        return None
    if not math.isfinite(value):
        return str(value)
    return value if digits is None else float(f"{value:.{digits}g}")
