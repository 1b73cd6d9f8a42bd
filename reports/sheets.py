"""The presentation of rows: columns with their definitions, sheets to read, and a page's description of a table.

Imports nothing but the standard library, because every start of the program imports this module.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from fnmatch import fnmatchcase
from typing import Any

Row = dict[str, Any]


class Role(StrEnum):
    """The purpose of a column."""

    KEY = "key"  # names the row
    FIGURE = "figure"  # what was measured; gates and comparisons hold these
    TIME = "time"  # what a clock says, which two runs never agree on
    HOW = "how"  # under what conditions it was measured
    RAW = "raw"  # what only a program reads
    REASON = "reason"  # why there are no figures


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Attributes:
        name: its name in rows; `*` stands for a part that is known only when it is measured.
        says: its definition, in one sentence, for the page, the manual and `normalbench columns`.
        role: its purpose.
        unit: unit of its values; empty if they have none.
        better: "more" or "less"; empty if neither is better.
        drops: order in which a narrow terminal leaves columns out, from 1; among equal numbers the first column goes
            first. 0 for a column that is never left out.
        option: the option without which the column is not measured.
        shown: whether displayed tables include the column.
        is_histogram: whether its values are bins, `from:count`, separated by spaces; CSV leaves the column out.
        before: for a column that distinguishes rows, its value in all rows from versions that did not have it.
    """

    name: str
    says: str
    role: Role = Role.FIGURE
    unit: str = ""
    better: str = ""
    drops: int = 0
    option: str = ""
    shown: bool = True
    is_histogram: bool = False
    before: str | None = None

    @property
    def definition(self) -> str:
        """The column's definition, followed by its unit, if any."""
        return f"{self.says} Unit: {self.unit}." if self.unit else self.says

    def is_called(self, name: str) -> bool:
        """Whether a name in a row matches the column's name, which may be a pattern such as `ms_*`."""
        return fnmatchcase(name, self.name)


def column_called(name: str, columns: Iterable[Column]) -> Column | None:
    """Return the column with the longest name that matches a name in a row or a summary; None if none matches."""
    matches = [column for column in columns if column.is_called(name)]
    # `ms_frame` is itself and not one of `ms_*`.
    return max(matches, key=lambda column: len(column.name), default=None)


def undefined(name: str) -> Column:
    """Return a column without a definition, for a name that no table defines."""
    return Column(name, "")


class View(StrEnum):
    """The views of the page; the reader sees one at a time, and they are listed in this order."""

    CHOOSE = "choose"  # what to take
    COMPARE = "compare"  # two codecs' pictures
    SEE = "see"  # the laboratory
    CODECS = "codecs"  # what each code of normals does and costs
    LAYOUTS = "layouts"  # whole G-buffers
    MORE = "more"  # all other subjects
    DATA = "data"  # every row, and how it was measured


@dataclass(frozen=True)
class Section:
    """The section of the page about a table.

    Attributes:
        title: heading of the section.
        short: its name in the navigation.
        intro: the question that it answers.
        method: how the table is measured, in sentences.
        parts: a column; rows with different values in it are shown as separate tables.
        extras: contents that the page's template shows next to the tables.
        view: the view that shows it.
        leads: whether it is the page's answer.
        of_texels: whether its figures depend on the bytes of whole texels, and not only on the stored numbers.
    """

    title: str
    short: str
    intro: str
    method: str
    parts: str = ""
    extras: tuple[str, ...] = ()
    view: View = View.MORE
    leads: bool = False
    of_texels: bool = False


@dataclass(frozen=True)
class Sheet:
    """Rows to display, all with the same columns.

    Attributes:
        title: title of the rows; empty if they need none.
        rows: the rows.
        drops: columns that a narrow terminal leaves out, in this order.
        notes: lines below the rows, on a terminal and in Markdown.
        said: paragraphs above the rows; the first is the answer.
        aside: paragraphs after `said` that are not part of the answer; a page folds them.
        keys: the values that the title states for all rows, by column.
        is_ranked: whether a page marks the best figures.
    """

    title: str
    rows: Sequence[Row]
    drops: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    said: tuple[str, ...] = ()
    aside: tuple[str, ...] = ()
    keys: Mapping[str, Any] = field(default_factory=dict)
    is_ranked: bool = True
