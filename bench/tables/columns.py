"""The meanings of the columns of tables, as a table."""

from __future__ import annotations

from ..ground.choose import choose
from ..ground.options.words import Names
from .registry import TABLES
from .table import Column, Row, Table


def columns(names: Names) -> list[Row]:
    """Return a row for each column of the tables with these names. Raises UsageError."""
    return [_column_row(table, column) for table in choose("table", names, TABLES) for column in table.columns]


def _column_row(table: Table, column: Column) -> Row:
    return {
        "table": table.name,
        "column": column.name,
        "role": str(column.role),
        "unit": column.unit or None,
        "better": column.better or None,
        "option": f"--{column.option.replace('_', '-')}" if column.option else None,
        "says": column.says,
    }
