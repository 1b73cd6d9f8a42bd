"""What `run` does: many tables into a results folder with its page. A run that was stopped goes on."""

from __future__ import annotations

import itertools
import sys
import time
from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from ...reports import tables
from ..options.option import fields_of
from ..output.errors import MissingError, UsageError, leave_out, noting_what_is_left_out, pick, tell
from ..output.writing import say, whole_file
from ..results.measuring import Asked, Place, asked, measured
from ..results.runs import Row, Run, facts_of, opened, read_run, unfinished
from ..tables.registry import TABLES
from ..tables.table import Measured, Table
from ..workers.places import keep_times, place
from .showing import say_lines, say_skipped, show_summary
from .table_command import in_folder

RESULTS = Path("results")
PAGE = "report.html"


def chosen_tables(names: str) -> list[Table]:
    """The tables that comma-separated names stand for; of "all" those measured unasked. Raises UsageError."""
    known = {name: table for table in TABLES.values() for name in (table.name, *table.old_names)}
    if names.strip() == "all":
        return [table for table in TABLES.values() if table.in_all]
    return list(dict.fromkeys(pick("table", names, known)))


def given(request: Any) -> dict[str, Any]:
    """What of a request was said."""
    values = {field.name: getattr(request, field.name) for field in fields(request) if field.name != "tables"}
    return {name: value for name, value in values.items() if value is not None}


def options_of(table: Table, said: Mapping[str, Any]) -> list[Any]:
    """A table's options in a run: what is usual, and what was said in place of it."""
    known = fields_of(table.options)
    own = {name: value for name, value in said.items() if name in known and known[name].option.in_run}
    return [table.options(**dict(usual) | own) for usual in table.usual]


def asked_of(request: Any, folder: Path) -> list[Asked]:
    """What a request asks of each table; which of them this machine cannot measure is said on standard error.

    Raises:
        UsageError: an unknown table, or an option that cannot be.
        MissingError: this machine can measure none of them.
    """
    made: list[Asked] = []
    reasons: dict[str, list[str]] = {}
    chosen = chosen_tables(request.tables)
    _check_taken(chosen, given(request))
    for table in chosen:
        try:
            made.append(_asked(table, given(request), folder))
        except MissingError as error:
            reasons.setdefault(str(error), []).append(table.name)
        except UsageError as error:
            raise UsageError(f"{table.name}: {error}") from error
    if not made:
        raise MissingError("; ".join(reasons))
    for reason, names in reasons.items():
        leave_out(f"{', '.join(names)}: {reason}")
    return made


def _check_taken(chosen: Iterable[Table], said: Mapping[str, Any]) -> None:
    """Raises UsageError for an option that none of the tables takes."""
    for name in said:
        takers = [table for table in TABLES.values() if _takes(table, name)]
        if not set(takers) & set(chosen):
            option, those = name.replace("_", "-"), ", ".join(table.name for table in takers)
            raise UsageError(f"--{option} is an option of {those}; none of them is measured")


def _takes(table: Table, name: str) -> bool:
    """Whether a run passes an option on to a table."""
    known = fields_of(table.options)
    return name in known and known[name].option.in_run


def _asked(table: Table, said: Mapping[str, Any], folder: Path) -> Asked:
    """What is asked of one table, each step once."""
    if missing := table.work.missing():
        raise MissingError(missing)
    outputs = in_folder(table, table.outputs(), folder)
    asks = [asked(table, options, outputs) for options in options_of(table, said)]
    steps = {repr(step.key): step for ask in asks for step in ask.steps}
    return replace(asks[0], steps=list(steps.values()), others=[ask.options for ask in asks[1:]])


def run_command(request: Any, output: Path | None, on: str | None = None) -> int:
    """Measure tables into a results folder, their summaries to standard output. What was stopped goes on.

    Args:
        on: where they are measured; None for this process.

    Returns:
        the exit status: 1 where a row fails.
    """
    from ..machine.devices import require_jax

    require_jax()
    facts: Row = {"request": {"tables": request.tables, **given(request)}, **facts_of(sys.argv[1:])}
    facts |= {"time": time.strftime("%Y-%m-%dT%H:%M:%S%z"), "finished": False}
    folder = output or unfinished(RESULTS, facts) or _new_folder()
    with noting_what_is_left_out() as left_out:
        asks = asked_of(request, folder)
    facts |= {"left_out": left_out}
    total = sum(len(ask.steps) for ask in asks)
    with place(on) as where, opened(folder, facts) as run:
        if run.kept:
            tell(f"{folder} goes on: {_there(run, asks)} of {total} steps are there")
        try:
            failed = [_measure(run, ask, where) for ask in asks]
            done = [one for one, _ in failed]
            if on:
                run.arrange((ask.table.name, step) for ask in asks for step in ask.steps)
            keep_times(where, folder)
            _complete(run, asks, done)
        except (KeyboardInterrupt, SystemExit):
            tell(f"{run.kept} of {total} steps are kept; the same command goes on")
            raise
    return int(any(one for _, one in failed))


def _there(run: Run, asks: Iterable[Asked]) -> int:
    return sum(run.find(ask.table.name, step) is not None for ask in asks for step in ask.steps)


def _new_folder() -> Path:
    named = RESULTS / time.strftime("%Y%m%d-%H%M%S")
    others = (named.with_name(f"{named.name}-{number}") for number in itertools.count(2))
    return next(folder for folder in itertools.chain([named], others) if not folder.exists())


def _measure(run: Run, ask: Asked, where: Place) -> tuple[Measured, bool]:
    """One table: its rows kept, its summary shown; whether a row fails."""
    done = measured(ask, run, where)
    say_skipped(ask.table, done.rows)
    say_lines(ask.table.work.warnings(done.rows))
    failed = say_lines(ask.table.work.failures(done.rows))
    show_summary(ask.table, done.rows)
    return done, failed


def _complete(run: Run, asks: list[Asked], done: list[Measured]) -> None:
    """Tables for others, the pictures and the page; then the run is finished."""
    from .report import write_report

    for name, rows in read_run(run.folder).tables.items():
        table = TABLES.get(name)
        _write_table(run.folder / name, table.work.finish(rows) if table else rows)
    for ask, one in zip(asks, done, strict=True):
        ask.table.work.write(one, lambda _: None)
    say(f"\nEvery figure, the pictures and the machine they come from: {run.folder}\n")
    whole = replace(read_run(run.folder), facts=run.facts | {"finished": True})
    page = write_report(run.folder, whole, run.folder / PAGE)
    run.finish()
    say(f"All of it on one page: {page}\n")


def _write_table(path: Path, rows: list[Row]) -> None:
    for suffix, written in ((".json", tables.to_json), (".csv", tables.to_csv)):
        with whole_file(path.with_suffix(suffix)) as partial:
            partial.write_text(written(rows), encoding="utf-8")
    if tables.has_parquet():
        with whole_file(path.with_suffix(".parquet")) as partial:
            tables.write_parquet(rows, partial)
