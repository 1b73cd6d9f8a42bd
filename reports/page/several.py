"""A page of several runs: what differs, and every figure side by side."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .. import tables
from ..sheets import Sheet
from .page import base, data_block, shown_sheet, template

SCRIPTS = ("tables.js", "several.js")


@dataclass(frozen=True)
class Figures:
    """A table's figures side by side.

    Attributes:
        table, title: which table, and its heading.
        runs: their names.
        columns: by column and row the figure of each run.
        better: by column which way is better.
    """

    table: str
    title: str
    runs: Sequence[str]
    columns: Mapping[str, Mapping[str, Sequence[Any]]]
    better: Mapping[str, str]

    @property
    def first(self) -> str:
        """The column that is shown to begin with: the one in which most differs, between runs or else between rows."""

        def differing(column: str) -> tuple[int, int]:
            rows = self.columns[column].values()
            return sum(map(_differ, rows)), min(2, len({str(row) for row in rows}))

        return max(self.columns, key=differing)

    @property
    def rows(self) -> list[tuple[str, list[str], bool]]:
        """Of that column each row's name, its figures as text, and whether they differ."""
        lines = self.columns[self.first].items()
        return [(name, [tables.text_of(v) for v in values], _differ(values)) for name, values in lines]

    @property
    def data(self) -> str:
        """All columns as several.js reads them."""
        return data_block({"columns": {name: _pairs(rows) for name, rows in self.columns.items()}})


def _differ(values: Sequence[Any]) -> bool:
    """Whether the runs that have a figure differ in it."""
    return len({str(value) for value in values if value is not None}) > 1


def _pairs(rows: Mapping[str, Sequence[Any]]) -> list[tuple[str, list[Any]]]:
    return [(name, list(map(_plain, values))) for name, values in rows.items()]


def _plain(value: Any) -> Any:
    """A figure as JSON can hold it: infinity as the text that tables show."""
    return value if not isinstance(value, float) or math.isfinite(value) else tables.text_of(value)


def html(names: Sequence[str], sheets: Sequence[Sheet], figures: Sequence[Figures]) -> str:
    """The page.

    Args:
        names: of the runs.
        sheets: what differs first.
        figures: of each table.
    """
    shown = [shown_sheet(sheet) for sheet in sheets]
    return template("several.html.j2").render(
        names=names,
        sheets=shown,
        figures=figures,
        **base(SCRIPTS),
    )


def markdown(names: Sequence[str], sheets: Sequence[Sheet]) -> str:
    """What differs, for a pull request."""
    blocks = [f"## normalbench: {', '.join(map(tables.markdown_text, names))}\n"]
    for sheet in sheets:
        if not sheet.folded:
            rows = [{tables.markdown_text(k): _text(v) for k, v in row.items()} for row in sheet.rows]
            said = [f"{tables.markdown_sentence(line)}\n" for line in sheet.said]
            blocks += [f"**{tables.markdown_sentence(sheet.title)}**\n", *said, tables.to_markdown(rows)]
    return "\n".join(blocks)


def _text(value: Any) -> Any:
    return tables.markdown_text(value) if isinstance(value, str) else value
