"""The `run` command: measures many tables, and writes the results and a page to a folder. A stopped run resumes."""

from __future__ import annotations

import itertools
import sys
import time
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, nullcontext
from dataclasses import fields, replace
from functools import partial
from pathlib import Path
from typing import Any

from ..ground.choose import choose
from ..ground.machine.memory import give_back_what_a_table_needed, have_few_heaps, keep_what_is_imported, require_memory
from ..ground.options.option import fields_of
from ..ground.options.source_options import in_names, names_files
from ..ground.options.words import Names
from ..ground.output.errors import MissingError, UsageError, leave_out, noting_what_is_left_out, tell, told
from ..ground.output.progress import PAGE, progress, progress_of_all, spoken
from ..ground.output.writing import say
from ..ground.user_files import SETTINGS
from ..keep.commit import commit_of
from ..keep.plain import plain
from ..keep.runs import Row, Run, facts_of, opened, read_run, unfinished
from ..keep.table_files import write_tables
from ..run.durations import expected, seconds_of
from ..run.measuring import Asked, Place, asked_together, measured, with_parts
from ..run.second import Second, is_worth_it, second_process
from ..run.workers.places import place
from ..show.showing import say_lines, say_skipped, say_verdict
from ..tables.registry import TABLES
from ..tables.table import Measured, Table
from . import beside
from .table_command import in_folder

RESULTS = Path("results")
REPORT = "report.html"


def chosen_tables(names: Names, options: Mapping[str, Any]) -> list[Table]:
    """Return the tables with these names; for "all", the tables that are measured by default with the given options.
    Raises UsageError if a name is unknown."""
    if names == ("all",):
        return [table for table in TABLES.values() if table.is_in_all(options)]
    return list(dict.fromkeys(choose("table", names, TABLES)))


def given(request: Any) -> dict[str, Any]:
    """Return the options that a request sets, by name, without `tables`."""
    values = {field.name: getattr(request, field.name) for field in fields(request) if field.name != "tables"}
    return {name: value for name, value in values.items() if value is not None}


def options_of(table: Table, options: Mapping[str, Any]) -> list[Any]:
    """Return a table's sets of options in a run: its usual sets, in which the given values replace the usual
    values."""
    known = fields_of(table.options)
    own = {name: value for name, value in options.items() if name in known and known[name].option.in_run}
    # A layout is measured as it is where nothing is said to put into it.
    is_as_it_is = own.get("layout") and not {"encoding", "storage", "rounding"} & set(own)
    unusual = {"encoding"} if is_as_it_is else set()
    chosen = ({name: value for name, value in usual.items() if name not in unusual} for usual in table.usual)
    replaced = {key: value for name in own for key, value in table.usual_where_said.get(name, {}).items()}
    return [table.options(**_read_so(usual | replaced | own)) for usual in chosen]


def _read_so(values: dict[str, Any]) -> dict[str, Any]:
    """Return options unchanged if they name files; otherwise without the options for reading files."""
    return values if names_files(values) else {name: option for name, option in values.items() if name not in SETTINGS}


def asked_of(request: Any, folder: Path) -> list[Asked]:
    """Return the request for each table, and report on standard error the tables that this machine cannot measure.

    Raises:
        UsageError: a table is unknown, or an option is invalid.
        MissingError: this machine can measure none of the tables.
    """
    asks: list[Asked] = []
    reasons: dict[str, list[str]] = {}
    chosen = chosen_tables(request.tables, given(request))
    _check_taken(chosen, given(request))
    for table in chosen:
        try:
            asks.append(_asked(table, given(request), folder))
        except MissingError as error:
            reasons.setdefault(str(error), []).append(table.name)
        except UsageError as error:
            raise UsageError(f"{table.name}: {error}") from error
    if not asks:
        raise MissingError("; ".join(reasons))
    for reason, names in reasons.items():
        leave_out(f"{', '.join(names)}: {reason}")
    return asks


def _check_taken(chosen: Iterable[Table], options: Mapping[str, Any]) -> None:
    """Raise UsageError for an option that no chosen table takes, or for an option for reading files if no file is
    named."""
    in_names(options)
    for name in options:
        takers = [table for table in TABLES.values() if _takes(table, name)]
        if not set(takers) & set(chosen):
            option, those = name.replace("_", "-"), ", ".join(table.name for table in takers)
            raise UsageError(f"--{option} applies only to {those}; measure one of them with --tables")


def _takes(table: Table, name: str) -> bool:
    """Whether a run passes an option on to a table."""
    known = fields_of(table.options)
    return name in known and known[name].option.in_run


def _asked(table: Table, options: Mapping[str, Any], folder: Path) -> Asked:
    """Return the request for one table, without duplicate steps. Raises UsageError, and MissingError if this machine
    lacks something that the table needs."""
    if missing := table.work.missing():
        raise MissingError(missing)
    return asked_together(table, options_of(table, options), in_folder(table, table.outputs(), folder))


def run_command(request: Any, output: Path | None, on: str | None = None, commit: str | None = None) -> int:
    """Measure tables, write them to a results folder and print their verdicts. A stopped run is resumed.

    Args:
        on: where the tables are measured; None for this process.
        commit: the name of the measured change; None for the working folder's commit.

    Returns:
        the exit status: 1 if a row fails.
    """
    require_memory()
    have_few_heaps()
    # It imports what it needs while this process does, and finds out what there is to measure.
    with spoken(), ExitStack() as ending:
        second = ending.enter_context(_second(request, on))
        from ..ground.machine.devices import require_jax

        require_jax()
        (asked,) = plain([{"tables": request.tables, **given(request)}])
        facts: Row = {"request": asked, **facts_of(sys.argv[1:])}
        facts |= {
            "time": time.strftime("%Y-%m-%dT%H:%M:%S%z"),
            "finished": False,
            "commit": commit_of(commit, Path.cwd()),
        }
        folder = output or unfinished(RESULTS, facts) or _new_folder()
        with noting_what_is_left_out() as left_out:
            asks = asked_of(request, folder)
        facts |= {"left_out": left_out}
        keep_what_is_imported()
        with place(on) as where, opened(folder, facts) as run:
            shown = _measured_and_shown(run, asks, where, second, ending)
    return int(shown.failed)


def _second(request: Any, on: str | None) -> AbstractContextManager[Second | None]:
    """Return a context manager for the second process, or for None if that process would have nothing to do."""
    chosen = chosen_tables(request.tables, given(request))
    names = [table.name for table in chosen if not table.section.leads]
    return second_process(partial(beside.prepare, tables=names)) if not on and is_worth_it(chosen) else nullcontext()


def _measured_and_shown(
    run: Run, asks: Sequence[Asked], where: Place, second: Second | None, ending: ExitStack
) -> Shown:
    total = sum(1 for ask in asks for _ in with_parts(ask.steps))
    if run.kept:
        tell(f"resuming {run.folder}: {_there(run, asks)} of {total} steps are done")
    others = _beside(asks) if second and len(asks) > 1 else []
    try:
        with progress_of_all(expected(asks, others)):
            # The second process ends while its rows are still kept, and before it is said how many are.
            with ending.pop_all():
                shown = _measure_all(run, asks, where, second, others)
            shown.written |= second.written if second else set()
            run.arrange((ask.table.name, step) for ask in asks for step in ask.steps)
            with progress(1, PAGE):
                _complete(run, shown)
    except (KeyboardInterrupt, SystemExit):
        tell(f"{run.kept} of {total} steps were saved; to resume, run the same command")
        raise
    return shown


def _there(run: Run, asks: Iterable[Asked]) -> int:
    return sum(run.find(ask.table.name, step) is not None for ask in asks for step in with_parts(ask.steps))


def _new_folder() -> Path:
    named = RESULTS / time.strftime("%Y%m%d-%H%M%S")
    others = (named.with_name(f"{named.name}-{number}") for number in itertools.count(2))
    return next(folder for folder in itertools.chain([named], others) if not folder.exists())


def _measure_all(
    run: Run, asks: Sequence[Asked], where: Place, second: Second | None, others: Sequence[Asked] = ()
) -> Shown:
    """Measure and show every table. Return the shown tables.

    Args:
        others: the tables that the second process measures.
    """
    # The answer first: this process measures nothing else while people wait for it.
    first, rest = ([ask for ask in asks if ask.table.section.leads is leads] for leads in (True, False))
    shown = Shown([*first, *rest])
    if second and others:
        own, firsts = ([beside.Asking.of(ask) for ask in asks] for asks in (others, first))
        second.measure(run, others, beside.measure, run.folder, own, firsts, frozenset(told))
    for ask in first:
        shown.add(ask, measured(ask, run, where))
    if second and others:
        _measure_others(run, [ask for ask in rest if ask not in others], others, shown, second)
    # All that the second process did not get to, because something killed it or there is none.
    for ask in rest:
        if ask.table.name not in shown.done:
            shown.add(ask, measured(ask, run, where))
    return shown


def _beside(asks: Iterable[Asked]) -> list[Asked]:
    """Return the tables for the second process to measure, chosen so that both processes take about equally long. The
    first process keeps the answer and all timed tables."""
    chosen: list[Asked] = []
    own = sum(seconds_of(ask) for ask in asks if ask.table.section.leads or _takes_times(ask))
    beside = 0.0
    movable = [ask for ask in asks if not ask.table.section.leads and not _takes_times(ask)]
    for ask in sorted(movable, key=seconds_of, reverse=True):
        if beside <= own:
            chosen.append(ask)
            beside += seconds_of(ask)
        else:
            own += seconds_of(ask)
    return [ask for ask in asks if ask in chosen]


def _measure_others(run: Run, asks: Iterable[Asked], others: Sequence[Asked], shown: Shown, second: Second) -> None:
    """Measure and show the tables `asks`; timed tables are last, when nothing else runs. Show the tables `others` as
    the second process finishes them."""
    # What takes times is measured when nothing else runs.
    for ask in sorted(asks, key=_takes_times):
        if _takes_times(ask):
            second.wait()
        shown.add(ask, measured(ask, run))
        _add_written(run, others, shown, second)
    second.wait()
    _add_written(run, others, shown, second)


def _add_written(run: Run, asks: Iterable[Asked], shown: Shown, second: Second) -> None:
    """Show the tables among `asks` that the second process has written and that are not yet shown."""
    for ask in asks:
        if ask.table.name in second.written - shown.written:
            shown.written.add(ask.table.name)
            shown.add(ask, measured(ask, run))


def _takes_times(ask: Asked) -> bool:
    """Whether a clock is read for any of a table's rows."""
    return any(ask.table.work.is_timed(step) for step in ask.steps)


class Shown:
    """Tables of a run, shown in the order in which they were requested, regardless of which is finished first.

    Attributes:
        failed: whether a row fails.
        done: the measurements, by table name.
        written: the tables whose files are written.
    """

    def __init__(self, asks: Sequence[Asked]):
        self.failed, self.asks = False, asks
        self.done: dict[str, Measured] = {}
        self.written: set[str] = set()
        self._left = deque(asks)

    def add(self, ask: Asked, done: Measured) -> None:
        """Record a table's measurement. Show each table once it and all tables before it are measured. Set `failed`
        if a row fails."""
        self.done[ask.table.name] = done
        give_back_what_a_table_needed()
        while self._left and self._left[0].table.name in self.done:
            table = self._left.popleft().table
            self.failed |= _show(table, self.done[table.name].rows)


def _show(table: Table, rows: Sequence[Row]) -> bool:
    """Report a table's skipped rows, warnings, failures and verdict. Return whether any row fails."""
    say_skipped(table, rows)
    say_lines(table.warnings(rows))
    failed = say_lines(table.work.failures(rows))
    say_verdict(table, rows)
    return failed


def _complete(run: Run, shown: Shown) -> None:
    """Write a run's tables, their remaining files, the code and the page with its charts. Mark the run as finished,
    and print the page's path."""
    from ..show.report import CHARTS, CHARTS_OF_A_RUN, write_report
    from .run_code import keep_code

    done = replace(read_run(run.folder), facts=run.facts | {"finished": True})
    write_tables(run.folder, done, done.tables)
    for ask in shown.asks:
        if ask.table.name not in shown.written:
            ask.table.work.write(shown.done[ask.table.name], lambda _: None)
    keep_code(run.folder, done)
    page = write_report(run.folder, done, run.folder / REPORT, CHARTS, most_charts=CHARTS_OF_A_RUN)
    run.finish()
    say(f"Page: {page}\nTo print a table: normalbench show {run.folder} {shown.asks[0].table.name}\n")
