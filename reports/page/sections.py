"""A page's sections: what each asks, shows and was measured by. Nothing here knows HTML."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ..charts.drawings import Drawing

Row = dict[str, Any]


@dataclass(frozen=True)
class Sheet:
    """A table to show.

    Attributes:
        title: its caption.
        rows: all with the same columns.
        folded: whether it is shown only when asked for.
        said: paragraphs above it, the first of which is the answer.
        aside: paragraphs that say what is not part of the answer, and are shown only when asked for.
        keys: what the title says of every row, by column.
    """

    title: str
    rows: Sequence[Row]
    folded: bool = False
    said: tuple[str, ...] = ()
    aside: tuple[str, ...] = ()
    keys: Row = field(default_factory=dict)


@dataclass(frozen=True)
class Section:
    """A table's part of a page.

    Attributes:
        key: its anchor, and the table of the run.
        title, short, intro, method: its heading, its name in the navigation, what it asks and how it is measured.
        parts: a column whose values are tables of their own; empty for none.
        extras: what the template shows beside the tables.
        rows: every row.
        summary: what people look at first.
        conditions: columns that say under what conditions rows were measured.
        not_shown: columns that only a program reads.
        says: what a column means.
        better: which way a column is better, "more" or "less"; empty where it has none.
        drawings: its charts.
        asked: whether the run was asked for it.
        films: its animations, each a sentence and a data URI.
        leads: whether it is the page's first screen.
    """

    key: str
    title: str
    short: str
    intro: str
    method: str
    parts: str
    extras: tuple[str, ...]
    rows: Sequence[Row]
    summary: Sequence[Sheet]
    conditions: tuple[str, ...]
    not_shown: tuple[str, ...]
    says: Callable[[str], str]
    better: Callable[[str], str]
    drawings: Sequence[Drawing]
    asked: bool
    leads: bool = False
    films: Sequence[tuple[str, str]] = ()

    def sheets(self, domains: Mapping[str, str]) -> Iterator[Sheet]:
        """Its tables: those that people look at first, then every row."""
        for sheet in self.summary:
            if sheet.rows:
                yield replace(sheet, rows=whole(sheet.rows))
        rows = whole(self.rows)
        for value in dict.fromkeys(row.get(self.parts) for row in rows) if self.parts else (None,):
            part = [row for row in rows if not self.parts or row.get(self.parts) == value]
            if part:
                name = f"{self.key}, {value}" if self.parts else self.key
                yield Sheet(f"Every row of {name}", with_domain(domains, self._worth_showing(part)), folded=True)

    def _worth_showing(self, rows: Sequence[Row]) -> list[Row]:
        """Less the columns that are empty in every row, and those that only a program reads."""
        kept = [c for c in rows[0] if c not in self.not_shown and any(row[c] is not None for row in rows)]
        return [{column: row[column] for column in kept} for row in rows]

    def measured(self) -> list[tuple[str, str]]:
        """The conditions: what each column says in these rows."""
        said = []
        for column in self.conditions:
            values = list(dict.fromkeys(str(row[column]) for row in self.rows if row.get(column) is not None))
            if values:
                said.append((column.replace("_", " "), ", ".join(values[:8]) + (" ..." if len(values) > 8 else "")))
        return said


def answered_first(sections: Sequence[Section]) -> list[Section]:
    """The sections, each with those sheets first that are of a storage, and a set of normals, that the page's answer is
    of."""
    answers = [sheet.keys for section in sections if section.leads for sheet in section.summary]

    def is_other(sheet: Sheet) -> tuple[bool, ...]:
        return tuple(sheet.keys.get(key) not in [keys.get(key) for keys in answers] for key in ("storage", "normals"))

    return [replace(section, summary=sorted(section.summary, key=is_other)) for section in sections]


def whole(rows: Sequence[Row]) -> list[Row]:
    """Rows that all have the same columns, in the order in which these come up."""
    columns = dict.fromkeys(column for row in rows for column in row)
    return [{column: row.get(column) for column in columns} for row in rows]


def with_domain(domains: Mapping[str, str], rows: Sequence[Row]) -> list[Row]:
    """What an encoding is made for next to its name, where there are encodings of normals."""
    if not any(row.get("encoding") in domains for row in rows):
        return list(rows)
    return [
        {"encoding": row["encoding"], "domain": domains.get(row["encoding"])} | row if "encoding" in row else dict(row)
        for row in rows
    ]
