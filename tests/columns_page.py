"""The manual's page of columns, written by `python -m tests.columns_page`."""

from __future__ import annotations

from pathlib import Path

from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.table import Column, Table

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "columns.md"
HEAD = """# Columns

What does a column of a table mean? Each table has a part below. `normalbench columns quality` prints the same.
"""
WAYS = {"more": "Higher is better.", "less": "Lower is better."}


def text() -> str:
    """Return the text of the whole page."""
    return "\n".join([HEAD, *map(_part, TABLES.values())])


def _part(table: Table) -> str:
    lines = "".join(map(_line, table.columns))
    return f"## {table.name}\n\n{table.help.partition(chr(10))[0]}\n\n| column | meaning |\n|---|---|\n{lines}"


def _line(column: Column) -> str:
    ends = [f"Unit: {column.unit}." if column.unit else "", WAYS.get(column.better, "")]
    ends.append(f"Needs `--{column.option.replace('_', '-')}`." if column.option else "")
    return f"| `{column.name}` | {' '.join(filter(None, (column.says, *ends)))} |\n"


if __name__ == "__main__":
    PAGE.write_text(text(), encoding="utf-8")
