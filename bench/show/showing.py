"""Output of a measured table: for people on the terminal, as text for programs, and messages about skipped rows."""

from __future__ import annotations

import shutil
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from ...reports import tables
from ..ground.output.errors import UsageError, lacks_twin, tell
from ..ground.output.writing import say, whole_file
from ..keep.row_files import check_rows
from ..tables.charts import but_without_twins
from ..tables.table import Measured, Role, Row, Sheet, Table

FOR_PEOPLE = ("table", "markdown")
# How wide a table in a file may be.
FILE_WIDTH = 200
# How wide sentences are at most.
SENTENCE_WIDTH = 100


def show(table: Table, done: Measured, format: str, output: Path | None) -> None:
    """Write the rows of a table to a file or, if `output` is None, to standard output. Raises UsageError if the file
    cannot be written."""
    if output is None:
        width = shutil.get_terminal_size((120, 40)).columns
        say(written(table, done, format, width))
        return
    check_rows(output)
    with whole_file(output, is_checked=True) as partial:
        partial.write_text(written(table, done, format, FILE_WIDTH, spares=False), encoding="utf-8", newline="\n")


def written(table: Table, done: Measured, format: str, width: int, spares: bool = True) -> str:
    """Return the rows of a table as text in a format.

    Args:
        width: the number of characters in a line, for formats that people read.
        spares: whether columns may be left out to fit the width."""
    if format == "json":
        return tables.written(_with_lists(table, done.rows), format)
    if format not in FOR_PEOPLE:
        return tables.written(_flat(table, done.rows), format)
    return "\n".join(_sheet(sheet, format, width, spares) for sheet in sheets(table, done))


def _flat(table: Table, rows: Sequence[Row]) -> list[Row]:
    """Return the rows without their histogram columns."""
    hidden = {column.name for column in table.columns if column.is_histogram}
    return [{name: value for name, value in row.items() if name not in hidden} for row in rows]


def _with_lists(table: Table, rows: Sequence[Row]) -> list[Row]:
    """Return the rows with each histogram as a list of (lower edge, count), one item per bin."""
    names = [column.name for column in table.columns if column.is_histogram]
    return [row | {name: bins(row[name]) for name in names if row.get(name) is not None} for row in rows]


def bins(text: str) -> list[tuple[float, int]]:
    """Return (lower edge, count) for each bin of a histogram in text form, such as `0:12 0.5:3`."""
    pairs = (word.split(":") for word in text.split())
    return [(float(edge), int(count)) for edge, count in pairs]


def sheets(table: Table, done: Measured) -> Iterator[Sheet]:
    """Yield the sheets in which people read a table's rows; the first sheet starts with the verdict."""
    yield from with_verdict(table, done.rows, _own_sheets(table, done))


def _own_sheets(table: Table, done: Measured) -> Iterator[Sheet]:
    if table.work.shown:
        yield from table.work.shown(done)
        return
    groups: dict[object, list[Row]] = {}
    for row in table.without_hidden(but_without_twins(done.rows)):
        groups.setdefault(row[table.by] if table.by else None, []).append(row)
    for rows in groups.values():
        yield Sheet("", rows, table.drops(rows))


def _sheet(sheet: Sheet, format: str, width: int, spares: bool) -> str:
    title = _said(sheet, width) + (f"{sheet.title}\n\n" if sheet.title else "")
    rows = tables.written(sheet.rows, format, width, sheet.drops if spares else ()) if sheet.rows else ""
    # In Markdown a line right below a table is one of its rows.
    above, mark = ("\n", "- ") if format == "markdown" and sheet.notes else ("", "")
    return title + rows + above + "".join(f"{mark}{note}\n" for note in sheet.notes)


def _said(sheet: Sheet, width: int) -> str:
    """Return a sheet's paragraphs as text for a terminal or for Markdown, with a bullet before all but the first;
    empty if `sheet.said` is empty."""
    if not sheet.said:
        return ""
    first, *rest = (*sheet.said, *sheet.aside)
    wide = min(width, SENTENCE_WIDTH)
    bullets = (textwrap.fill(paragraph, wide, initial_indent="- ", subsequent_indent="  ") for paragraph in rest)
    return "\n".join([textwrap.fill(first, wide), *bullets]) + "\n\n"


def with_verdict(table: Table, rows: Sequence[Row], sheets: Iterable[Sheet]) -> Iterator[Sheet]:
    """Yield the sheets, with the table's verdict before the first sheet's own paragraphs."""
    verdict = tuple(table.work.verdict(rows))
    for number, sheet in enumerate(sheets):
        yield replace(sheet, said=(*verdict, *sheet.said)) if verdict and not number else sheet


def summary(table: Table, rows: Sequence[Row]) -> list[Sheet]:
    """Return the sheets of a table's summary that have rows; the first sheet starts with the verdict."""
    return list(with_verdict(table, rows, (sheet for sheet in table.work.summary(rows) if sheet.rows)))


def show_summary(table: Table, rows: Sequence[Row]) -> None:
    """Write a table's summary to standard output; if the table has no summary, write its rows."""
    width = shutil.get_terminal_size((120, 40)).columns
    shown = table.without_hidden(rows)
    for sheet in summary(table, rows) or ([Sheet(table.section.title, shown, table.drops(shown))] if shown else []):
        say(f"{_sheet(sheet, 'table', width, spares=True)}\n")


def say_verdict(table: Table, rows: Sequence[Row]) -> None:
    """Write NAME: SENTENCE to standard output for each sheet in a table's summary that has sentences; SENTENCE is the
    sheet's first."""
    width = min(shutil.get_terminal_size((120, 40)).columns, SENTENCE_WIDTH)
    for sheet in summary(table, rows):
        if sheet.said:
            say(textwrap.fill(f"{table.name}: {sheet.said[0]}", width, subsequent_indent="  ") + "\n")


def say_skipped(table: Table, rows: Sequence[Row], known: Iterable[str] = ()) -> None:
    """Write each reason for missing figures once to standard error, except reasons that contain a `known` phrase.

    Raises:
        UsageError: no row has figures, and the table does not accept incomplete rows.
    """
    reasons = dict.fromkeys(row["skipped"] for row in rows if row.get("skipped"))
    told = [reason for reason in reasons if not any(phrase in reason for phrase in known)]
    if told and not table.partial and all(row.get("skipped") for row in rows):
        raise UsageError(told[0])
    for reason in told:
        tell(f"{_kind_of_skip(table, rows, reason)}: {reason}")


def _but_its_backend(table: Table, row: Row) -> tuple[object, ...]:
    """Return the values of a row's key columns, except its backend."""
    return tuple(row.get(column.name) for column in table.of_role(Role.KEY) if column.name != "backend")


def _kind_of_skip(table: Table, rows: Sequence[Row], reason: str) -> str:
    """Return a description of the rows skipped for this reason. A missing twin does not count as a failure if another
    backend measures the encoding."""
    skipped = [row for row in rows if row.get("skipped") == reason]
    measured = {_but_its_backend(table, row) for row in rows if not row.get("skipped")}
    if lacks_twin(reason) and all(_but_its_backend(table, row) in measured for row in skipped):
        return "measured only by OpenGL"
    return (
        "rows with some figures missing" if any(_has_figures(table, row) for row in skipped) else "rows without figures"
    )


def _has_figures(table: Table, row: Row) -> bool:
    """Whether a row has any figures, in a table that accepts incomplete rows."""
    return table.partial and any(row.get(c.name) is not None for c in table.of_role(Role.FIGURE, Role.TIME))


def say_lines(lines: Iterable[str]) -> bool:
    """Write lines to standard error with repeated spaces removed, and return whether there are any lines."""
    sentences = [" ".join(line.split()) for line in lines]
    for line in sentences:
        tell(f"{line}")
    return bool(sentences)
