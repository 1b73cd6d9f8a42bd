"""Rows in a file, which may replace an existing file only if that contains rows of normalbench."""

from __future__ import annotations

import re
import shutil
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path
from typing import Any

from ...encodings.codecs.files import parsed_json
from ...reports import tables
from ..ground.output.replacing import MOST, is_empty, not_ours
from ..ground.output.writing import check_writable, say, whole_file
from ..tables.registry import TABLES

# How a line of a table for people is split into its columns.
BETWEEN = re.compile(r"\s*\|\s*|\s{2,}")
# How texts without the columns of a table begin: those of `doctor`, of earlier versions too, and `history`.
BEGINS = re.compile(
    rb"\d+ findings?\n|No problems found\.\n|nothing is likely wrong\n|\d+ runs?, from |(\| )?commit +(\| )?date "
)
# Which share of the names in a header must be columns: another version may have others.
KNOWN_SHARE = 0.75


def check_rows(path: Path | None, columns: Iterable[str] = ()) -> None:
    """Raise UsageError if rows cannot be written to a file, or the file contains anything but rows. None is accepted.

    Args:
        columns: additional columns that the file may have, if the rows belong to no table.
    """
    if path is None:
        return
    check_writable(path)
    data = path.read_bytes() if path.is_file() else b""
    known = [[column.name for column in (*table.columns, *table.also)] for table in TABLES.values()]
    if not (is_empty(data) or _is_table(data, [*known, list(columns)])):
        raise not_ours(path, "table")


def _is_table(data: bytes, known: Sequence[Sequence[str]]) -> bool:
    """Whether the content of a file is rows in any format, judged by the columns of known tables."""
    names = _columns_of(data)
    is_for_programs = any(names[:1] == columns[:1] and _are_columns(names, columns) for columns in known)
    begin = [_beginnings(columns) for columns in known]
    is_for_people = any(_are_columns(names, columns) for names in _lines_of(data) for columns in begin)
    return is_for_programs or is_for_people or bool(BEGINS.match(data)) or data.strip() == b"[]"


def _columns_of(data: bytes) -> list[str]:
    """Return the column names of a JSON or CSV file, in order; empty for damaged JSON."""
    try:
        if data.startswith(b"["):
            return list(parsed_json(data)[0])
    except (ValueError, TypeError, LookupError):
        return []
    return data.partition(b"\n")[0].decode(errors="replace").strip().split(",")


def _lines_of(data: bytes) -> list[list[str]]:
    """Return the cells of each line of a plain-text table, with underscores for spaces; empty if a line starts
    with "#", as notes in Markdown do."""
    lines = [] if re.search(rb"^#", data, re.M) else data[:MOST].decode(errors="replace").splitlines()
    return [[cell.replace(" ", "_") for cell in BETWEEN.split(line.strip()) if cell] for line in lines]


def _beginnings(columns: Iterable[str]) -> set[str]:
    """Return the beginnings of column names, in whole words, that the first line of a narrow header may show."""
    words = [column.split("_") for column in columns]
    return {"_".join(several[:count]) for several in words for count in range(1, len(several) + 1)}


def _are_columns(names: Sequence[str], columns: Collection[str]) -> bool:
    """Whether there are at least two names and nearly all of them are among these columns."""
    return len(names) > 1 and sum(name in columns for name in names) >= KNOWN_SHARE * len(names)


def write(
    rows: Sequence[dict[str, Any]],
    format: str,
    output: Path | None,
    expendable: Sequence[str] = (),
    by: str | None = None,
    lead: str = "",
    total: str = "",
) -> None:
    """Write rows to a file or to standard output; a table that does not fit the terminal omits `expendable` columns.

    In formats for people, rows are split into tables by column `by`, `lead` is the text above the table, and `total`
    is the line below it.
    """
    if output is None:
        width = shutil.get_terminal_size((120, 40)).columns
        say(tables.written(rows, format, width, expendable, by, lead, total))
        return
    check_rows(output, dict.fromkeys(column for row in rows for column in row))
    with whole_file(output, is_checked=True) as partial:
        partial.write_text(tables.written(rows, format, by=by, lead=lead, total=total), encoding="utf-8", newline="\n")
