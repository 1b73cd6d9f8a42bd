"""Rows as a gate or a test asks for them: a table, and its options by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from functools import cached_property, partial
from typing import Any

from ..languages.words import file_of, names_an_encoder, twin_of
from ..metrics.totals import Worst
from ..options.option import checked_options
from ..output.errors import UsageError, names_a_file, noting_what_is_left_out
from ..results.measuring import Nothing, asked, measured_steps
from ..tables.registry import TABLES
from ..tables.table import Row, Step, Table
from .limits import Limit


@dataclass(frozen=True)
class Found:
    """A row, and how to find the normal that came back farthest off, which takes a second look.

    Attributes:
        asked: every option that it was measured with; empty of a run's rows.
        list_it: gives the instructions that it was counted in, or None.
    """

    row: Row
    find: Callable[[], Worst | None]
    asked: Mapping[str, Any] = field(default_factory=dict)
    list_it: Callable[[], str | None] = lambda: None

    @property
    def listing(self) -> str:
        """The instructions that it was counted in; empty where there are none."""
        return self.list_it() or ""

    @cached_property
    def worst(self) -> Worst | None:
        """That normal; None where there is none."""
        return self.find()


def table_named(name: Any) -> Table:
    """A table by its name. Raises UsageError."""
    if not isinstance(name, str) or name not in TABLES:
        raise UsageError(f"unknown table {name!r}; known: {', '.join(TABLES)}")
    return TABLES[name]


def measured(table: Table, values: Mapping[str, Any], usual: Mapping[str, Any] | None = None) -> list[Found]:
    """The rows of a table with these options, and with what is usual where they say nothing.

    Args:
        usual: in place of what is usual for a gate.

    Raises:
        UsageError: an option or a value that there is not.
        MissingError: this machine lacks what they need.
    """
    given = {**checked_options(table.options, usual or {}), **checked_options(table.options, values)}
    options = table.options(**single(table, given))
    with noting_what_is_left_out() as left_out:
        ask = asked(table, options)
    # What is named and not there would pass unseen; of "all" some never fit.
    if left_out and not any(str(value) == "all" for value in given.values()):
        raise UsageError(f"a row that is asked for cannot be measured: {left_out[0]}")
    steps = measured_steps(ask, Nothing())
    # By name: a finished row may be another object.
    step_of = {table.name_of(row): step for step, rows in zip(ask.steps, steps, strict=True) for row in rows}
    rows = table.work.finish([row for rows in steps for row in rows])
    return [_found(table, row, step_of[table.name_of(row)], asdict(options)) for row in rows]


def _found(table: Table, row: Row, step: Step, options: Mapping[str, Any]) -> Found:
    return Found(row, partial(table.work.worst, step), options, partial(table.work.listing, step, row))


def single(table: Table, given: Mapping[str, Any]) -> dict[str, Any]:
    """What a gate measures: what it says, and one row's worth of the rest.

    A layout is measured as it is. A shader without a Python twin is measured by GLSL.
    """
    usual = {} if given.get("layout") is not None else dict(table.single)
    if "backend" in usual and _is_in_glsl_only(str(given.get("encoding", ""))):
        usual["backend"] = "glsl"
    return {**usual, **given}


def _is_in_glsl_only(names: str) -> bool:
    """Whether one of the names is a file with a user's encoder without a Python twin."""
    words = [word.strip() for word in names.split(",") if names_an_encoder(word.strip())]
    return any(names_a_file(str(file_of(word))) and not names_a_file(str(twin_of(word))) for word in words)


def with_their_options(table: Table, values: Mapping[str, Any], limits: Iterable[Limit]) -> dict[str, Any]:
    """The options, and those without which a limited column is not measured: `flip`, `worst_case`, `codes`."""
    return dict(values) | {option: True for limit in limits if (option := limit.option_of(table))}
