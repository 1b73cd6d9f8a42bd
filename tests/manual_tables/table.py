"""A measured table of the manual: its lines from measured rows, its text from kept lines, and the differences between
two measurements."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

ROOT, KEPT = Path(__file__).parents[2], Path(__file__).with_name("kept")
Row, Line = dict[str, Any], list[Any]


@dataclass(frozen=True)
class Column:
    """A column of the page.

    Attributes:
        title: the heading; empty for a figure that is kept and compared but not shown.
        name: the column of the measured rows.
        of: values of other columns, which choose a row among those of a line; the last of several matches counts.
        form: format of a value.
        empty: text for a missing value.
        abs, rel: maximum difference between a new measurement and the shown figure, absolute or relative.
        is_key: whether it names the line.
        is_counted: whether a compiler counts it, so that the next version may give another count.
        is_compared: whether it is measured again.
    """

    title: str
    name: str
    of: Mapping[str, Any] = field(default_factory=dict)
    form: Callable[[Any], str] = str
    empty: str = ""
    abs: float = 0
    rel: float = 0
    is_key: bool = False
    is_counted: bool = False
    is_compared: bool = True

    def value(self, rows: Sequence[Row]) -> Any:
        chosen = [row for row in rows if all(row.get(name) == value for name, value in self.of.items())]
        return chosen[-1].get(self.name) if chosen else None

    def text(self, value: Any) -> str:
        return self.empty if value is None else self.form(value)

    def agrees(self, kept: Any, measured: Any) -> bool:
        """Whether a figure is close to the shown figure; for any other value, whether it is the same."""
        if not (is_figure([kept]) and is_figure([measured])):
            return kept == measured
        (shown,) = re.findall(r"-?[\d.]+(?:e-?\d+)?", self.text(kept))
        return self.is_near(float(shown), measured)

    def is_near(self, shown: float, measured: float) -> bool:
        return shown == pytest.approx(measured, rel=self.rel, abs=self.abs)


def is_figure(values: Sequence[Any]) -> bool:
    """Whether all values are numbers."""
    return all(isinstance(value, int | float) for value in values)


def key(title: str, name: str, form: Callable[[Any], str] = "`{}`".format) -> Column:
    return Column(title, name, form=form, is_key=True)


@dataclass(frozen=True)
class Measured:
    """The lines of a table, and the versions of the compilers that counted for it."""

    lines: list[Line]
    drivers: list[str]


def markdown(table: Table, kept: Measured) -> str:
    """Return a table in Markdown, padded to keep its source readable."""
    lines = [line for line in kept.lines if line[0] not in table.unshown]
    columns = [
        _padded(
            [column.title.format(*kept.drivers), *map(column.text, values)],
            is_figure([value for value in values if value is not None]),
        )
        for column, values in zip(table.columns, zip(*lines, strict=True), strict=True)
        if column.title
    ]
    return "\n".join("|" + "|".join(cells) + "|" for cells in zip(*columns, strict=True))


def _padded(texts: list[str], is_right: bool) -> list[str]:
    """Return the cells of a column, the heading first and a rule below it."""
    width = max(map(len, texts))
    cells = [f" {text:>{width}} " if is_right else f" {text:<{width}} " for text in texts[1:]]
    return [f" {texts[0]:<{width}} ", "-" * (width + 1) + "-:"[is_right], *cells]


def page_with(marker: str) -> tuple[Path, str]:
    """Return the only page of the manual that has a marker, and its text."""
    texts = {path: path.read_text() for path in (ROOT / "README.md", *(ROOT / "docs").rglob("*.md"))}
    ((path, text),) = [(path, text) for path, text in texts.items() if f"\n<!-- {marker} -->\n" in text]
    return path, text


@dataclass(frozen=True)
class Table:
    """A table of the manual.

    Attributes:
        marker: the comment above it.
        rows: commands of normalbench that print its rows, or a function that measures them.
        columns: columns of its lines, which are kept.
        needs: fixtures that the measurement needs.
        takes: whether a row belongs to the table.
        gather: converts the measured rows to the rows of lines.
        lines: the lines in their order, each by its keys, such as `linear packed16,linear r16f`; empty for all rows
            in their own order.
        unshown: names of lines that are kept and compared but not shown.
        again: commands that measure it again in less time than `rows`.
        holds: asserts the page's conclusions from the lines.
        text: writes the table.
        end: text after the table on the page.
    """

    marker: str
    rows: tuple[str, ...] | Callable[[], list[Row]]
    columns: tuple[Column, ...]
    needs: tuple[str, ...] = ()
    takes: Callable[[Row], bool] = lambda _: True
    gather: Callable[[list[Row]], list[Row]] = list
    lines: str = ""
    unshown: tuple[str, ...] = ()
    again: tuple[str, ...] = ()
    holds: Callable[[list[Line]], None] = lambda _: None
    text: Callable[[Table, Measured], str] = markdown
    end: str = "\n\n"

    @property
    def path(self) -> Path:
        return KEPT / f"{re.sub(r'[ :]+', '-', self.marker)}.json"

    def read(self) -> Measured:
        return Measured(**json.loads(self.path.read_text()))

    def keep(self, measured: Measured) -> None:
        lines = ",\n".join(json.dumps(line, ensure_ascii=False) for line in measured.lines)
        self.path.write_text(f'{{"drivers": {json.dumps(measured.drivers)}, "lines": [\n{lines}\n]}}\n')

    def parts(self, page: str) -> tuple[str, str, str]:
        """Return a page before the table, the table, and the page after it."""
        before, mark, rest = page.partition(f"<!-- {self.marker} -->\n")
        text, end, after = rest.partition(self.end)
        return before + mark, text, end + after

    def measured(self, rows: list[Row]) -> Measured:
        """Return the lines of measured rows."""
        drivers = {row["driver"].partition(" (")[0] for row in rows if row.get("driver")}
        groups: dict[str, list[Row]] = {}
        for row in filter(self.takes, self.gather(rows)):
            groups.setdefault(self.name([row[column.name] for column in self.columns if column.is_key]), []).append(row)
        chosen = [groups[name] for name in self.lines.split(",")] if self.lines else groups.values()
        return Measured([[column.value(group) for column in self.columns] for group in chosen], sorted(drivers))

    def name(self, line: Line) -> str:
        """Return a line's name: its first values, which are its keys."""
        return " ".join(str(value) for value, column in zip(line, self.columns, strict=False) if column.is_key)

    def differences(self, kept: Measured, measured: Measured) -> list[str]:
        """Return a line per kept figure that the new measurement does not confirm; skip other compilers' counts."""
        names = [[*map(self.name, lines)] for lines in (kept.lines, measured.lines)]
        if names[0] != names[1]:
            return [f"the lines are {names[1]}, and were {names[0]}"]
        columns = [c for c in self.columns if c.is_compared and not (c.is_counted and kept.drivers != measured.drivers)]
        return [
            f"{self.name(line)}: {column.title or column.name}: {line[index]} was kept, {other[index]} is measured"
            for line, other in zip(kept.lines, measured.lines, strict=True)
            for column in columns
            if not column.agrees(line[index := self.columns.index(column)], other[index])
        ]
