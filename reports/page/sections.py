"""The sections of a page: their questions, contents and methods, without any HTML."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from ..charts.drawings import Drawing
from ..sheets import Column, Row, Section, Sheet, column_called, undefined
from .data import block

# The conditions that stand next to an answer.
SAID = ("normals", "scene", "aim")


@dataclass(frozen=True)
class TableSection:
    """The section of a page about a table.

    Attributes:
        key: anchor of the section, and the name of the run's table.
        about: the page's text about the table, which does not depend on the results.
        columns: columns of its rows.
        also: columns that only its summary has.
        rows: all rows.
        summary: the sheets to read first.
        drawings: its charts.
        asked: whether the run requested the table.
        films: its animations, each a sentence and a data URI.
    """

    key: str
    about: Section
    columns: Sequence[Column]
    also: Sequence[Column]
    rows: Sequence[Row]
    summary: Sequence[Sheet]
    drawings: Sequence[Drawing]
    asked: bool
    films: Sequence[tuple[str, str]] = ()

    def column(self, name: str) -> Column:
        """Return the column for a name in rows or sheets; an unknown column has no definition."""
        known = column_called(name, (*self.columns, *self.also))
        return replace(known, name=name) if known else undefined(name)

    @property
    def sheets(self) -> Iterator[Sheet]:
        """The sheets to read first, without empty sheets; all rows of a sheet have the same columns."""
        return (replace(sheet, rows=whole(sheet.rows)) for sheet in self.summary if sheet.rows)

    @property
    def data(self) -> str:
        """All rows of the table, packed as text for data.js."""
        return block(whole(self.rows), self.columns)

    def measured(self) -> list[tuple[str, str]]:
        """Return pairs of a name and its values, as text, for the columns SAID: the conditions of the measurement.
        Columns without values are left out."""
        conditions = [(name, dict.fromkeys(str(row[name]) for row in self.rows if row.get(name))) for name in SAID]
        return [(name, ", ".join(values)) for name, values in conditions if values]


def answered_first(sections: Sequence[TableSection]) -> list[TableSection]:
    """Return the sections; in each, sheets with the storage and normals of the page's answers come first."""
    answers = [sheet.keys for section in sections if section.about.leads for sheet in section.summary]

    def is_other(sheet: Sheet) -> tuple[bool, ...]:
        return tuple(sheet.keys.get(key) not in [keys.get(key) for keys in answers] for key in ("storage", "normals"))

    return [replace(section, summary=sorted(section.summary, key=is_other)) for section in sections]


def whole(rows: Sequence[Row]) -> list[Row]:
    """Return rows that all have the same columns, in order of first appearance; missing values become None."""
    columns = dict.fromkeys(column for row in rows for column in row)
    return [{column: row.get(column) for column in columns} for row in rows]
