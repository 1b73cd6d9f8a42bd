"""A run's rows inside a page: of each table one packed block of columns."""

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


def block(rows: Sequence[Row], columns: Iterable[Column]) -> str:
    """Every row of a table, as base64 of packed JSON that data.js reads; it gives the table's CSV file to the byte.

    Args:
        rows: all with the same columns.
        columns: what is known of them.
    """
    known = tuple(columns)
    names = list(rows[0]) if rows else []
    made = [{**_about(column_called(name, known) or undefined(name), name), **_values(name, rows)} for name in names]
    return packed(json.dumps({"count": len(rows), "columns": made}, allow_nan=False, separators=(",", ":")))


def _about(column: Column, name: str) -> dict[str, Any]:
    """What is said of a column, less what is empty."""
    said = {"says": column.definition, "better": column.better, "role": column.role.value, "unit": column.unit}
    said |= {"hidden": not column.shown}
    return {"name": name, "title": title_of(name), **{key: value for key, value in said.items() if value}}


def _values(name: str, rows: Sequence[Row]) -> dict[str, Any]:
    """Its values: numbers as they are, and all else as the texts that a CSV file has, each once, and their places."""
    values = [row.get(name) for row in rows]
    known = [value for value in values if value is not None]
    if known and all(type(value) is float for value in known):
        return {"kind": FLOAT, "values": list(map(_number, values))}
    if known and all(type(value) is int and abs(value) < LARGEST_EXACT for value in known):
        return {"kind": WHOLE, "values": values}
    words: dict[str, int] = {}
    at = [None if _is_nothing(value) else words.setdefault(str(storable(value)), len(words)) for value in values]
    return {"kind": TEXT, "words": list(words), "values": at}


def _is_nothing(value: Any) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def _number(value: float | None) -> float | str | None:
    """A float as JSON can hold it."""
    if value is None or _is_nothing(value):
        return None
    return value if math.isfinite(value) else str(value)
