"""Rows and keys as they are read back from JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence

from ..tables.table import Row


def plain(rows: Sequence[Row]) -> list[Row]:
    """Return rows as JSON reads them back: NumPy's numbers become Python's."""
    return json.loads(json.dumps(rows, default=lambda number: number.item()))


def key_text(table: str, key: Row) -> str:
    """Return the text that identifies a step of a table."""
    return json.dumps([table, key], sort_keys=True, default=lambda number: number.item())
