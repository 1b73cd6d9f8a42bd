"""Measured rows for a gate or a test, which names a table and its options."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import Any

from ...ground.choose import names_a_file, unknown_name
from ...ground.options.option import checked_options, fields_of
from ...ground.options.source_options import NAMED
from ...ground.options.words import Names, words_in
from ...ground.output.errors import UsageError, noting_what_is_left_out
from ...ground.spelling import spelled
from ...ground.user_files import INCLUDE, UserFile, file_of, files_in, names_an_encoder, with_files
from ...measures.metrics.totals import Worst
from ...run.measuring import Nothing, asked
from ...run.measuring import measured as find_measured
from ...tables.registry import TABLES
from ...tables.table import Role, Row, Step, Table
from .limits import Limit

# The table of a gate that names none.
USUAL = next(table.name for table in TABLES.values() if table.is_usual)


@dataclass(frozen=True)
class Found:
    """A row, and functions that find its worst normal and its instructions on demand.

    Attributes:
        find: a function that returns the normal with the largest error; None if unknown.
        asked: every option that the row was measured with; empty for rows of a run.
        list_it: a function that returns the instructions counted for the row, or None.
    """

    row: Row
    find: Callable[[], Worst | None]
    asked: Mapping[str, Any] = field(default_factory=dict)
    list_it: Callable[[], str | None] = lambda: None

    @property
    def listing(self) -> str:
        """The instructions counted for the row, as text; empty if no instructions were counted."""
        return self.list_it() or ""

    @cached_property
    def worst(self) -> Worst | None:
        """The normal with the largest error; None if unknown."""
        return self.find()


def table_named(name: Any) -> Table:
    """Return the table with a name, in any accepted spelling. Raises UsageError for an unknown name."""
    if not isinstance(name, str):
        raise UsageError(f"unknown table {name!r}; known: {', '.join(TABLES)}")
    known = spelled("table", name, TABLES)
    if known is None:
        raise unknown_name("table", [name], TABLES)
    return TABLES[known]


def measured(table: Table, values: Mapping[str, Any], usual: Mapping[str, Any] | None = None) -> list[Found]:
    """Return the rows of a table, measured with these options and with the usual values of the other options.

    Args:
        usual: values to use in place of a gate's usual values.

    Raises:
        UsageError: an option or a value is unknown.
        MissingError: this machine lacks something that the rows need.
    """
    given = {**checked_options(table.options, usual or {}), **checked_options(table.options, values)}
    options = table.options(**single(table, given))
    with noting_what_is_left_out() as left_out:
        ask = asked(table, options)
    # What is named and not there would pass unseen; of "all" some never fit.
    if left_out and ("all",) not in given.values():
        raise UsageError(f"a requested row cannot be measured: {left_out[0]}")
    done = find_measured(ask, Nothing())
    # By name: a finished row may be another object.
    step_of = {table.name_of(row): step for step, rows in zip(ask.steps, done.kept, strict=True) for row in rows}
    rows = named_rows(table, given, done.rows)
    return [_found(table, row, step_of[table.name_of(row)], asdict(options)) for row in rows]


def named_rows(table: Table, given: Mapping[str, Any], rows: Sequence[Row]) -> list[Row]:
    """Return the rows whose key columns have the values that options name, because a table may return other rows too.

    `cost` also measures the packing of a storage, and `depth` the whole range as well as a distance. If no row has
    all named values, return the rows in which the missing values are empty.
    """
    keys = {column.name for column in table.of_role(Role.KEY)}
    words = {name: words for name, value in given.items() if name in keys and (words := _words(value))}
    for name in list(words):
        # "all", a vendor's name or a file stands for values that rows spell otherwise.
        if not words[name] <= {_word(row.get(name)) for row in rows}:
            del words[name]
    whole = [row for row in rows if all(_word(row.get(name)) in words[name] for name in words)]
    return whole or [row for row in rows if all(_word(row.get(name)) in {*words[name], ""} for name in words)]


def _words(value: Any) -> set[str]:
    return {*map(_word, value)} if isinstance(value, tuple) else {_word(value)}


def _word(value: Any) -> str:
    """Return a value of a row or of an option as text, with numbers in one spelling; empty for None."""
    try:
        return f"{float(value):.17g}"
    except (TypeError, ValueError):
        return "" if value is None else str(value)


def located(table: Table, options: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return the options by name; names of files in `folder` become paths relative to the working directory. The
    value of an option for files becomes a tuple if the option takes several names, else text."""
    known = fields_of(table.options)
    placed: Mapping[str, Callable[[Path, str], str]] = {INCLUDE: _root_in}
    files = {name for name in options if name in known and known[name].option.files}
    located = {
        name: tuple(placed.get(name, path_in)(folder, str(word)) for word in words_in(options[name])) for name in files
    }
    return {**options, **{name: located[name] if known[name].has_names else "".join(located[name]) for name in files}}


def _root_in(folder: Path, word: str) -> str:
    """Return FOLDER or NAME=FOLDER, given relative to `folder`, with the path relative to the working directory."""
    name, mark, root = word.rpartition("=")
    return f"{name}{mark}{os.path.relpath(folder / root)}"


def path_in(folder: Path, word: str) -> str:
    """Return a word in which the paths of files, given relative to `folder`, are relative to the working directory.
    Absolute paths stay unchanged."""
    paths = (path for path in files_in(word, folder) if not Path(path).is_absolute())
    return with_files(word, {path: os.path.relpath(folder / path) for path in paths})


def _found(table: Table, row: Row, step: Step, options: Mapping[str, Any]) -> Found:
    return Found(row, partial(table.work.worst, step), options, partial(table.work.listing, step, row))


def single(table: Table, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options that a gate measures with: its own options, and for other options the values that give one
    row.

    A layout is measured as it is. A shader without a Python twin is measured in GLSL.
    """
    usual = {} if given.get("layout") is not None else dict(table.single)
    if "backend" in usual and any(_is_in_glsl_only(given.get(name) or ()) for name in NAMED):
        usual["backend"] = "glsl"
    return {**usual, **given}


def _is_in_glsl_only(names: Names) -> bool:
    """Whether one of the names is a user's file with an encoder but without a Python twin."""
    words = [word for word in map(str, names) if names_an_encoder(word)]
    return any(names_a_file(str(file_of(word))) and not names_a_file(str(UserFile(word).twin)) for word in words)


def with_their_options(table: Table, values: Mapping[str, Any], limits: Iterable[Limit]) -> dict[str, Any]:
    """Return the options, with True for each option without which a limited column is not measured: `flip`,
    `worst_case` or `codes`."""
    return dict(values) | {option: True for limit in limits if (option := limit.option_of(table))}
