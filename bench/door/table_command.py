"""The command of a table: measures it, shows the rows and writes any other outputs that were requested."""

from __future__ import annotations

import platform
import shutil
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..ground.machine.memory import keep_what_is_freed
from ..ground.output.errors import MissingError, UsageError, tell
from ..ground.output.replacing import PAGE
from ..ground.output.sources import sources
from ..ground.output.writing import check_plot, check_writable, say, whole_file
from ..keep import answers
from ..keep.row_files import check_rows
from ..tables.table import Measured, Row, Table

if TYPE_CHECKING:
    from ..run.measuring import Asked, Beside, Place


def table_command(
    table: Table,
    options: Any,
    outputs: Any,
    format: str,
    output: Path | None,
    report: Path | None,
    on: str | None = None,
) -> int:
    """Measure a table and write it. With -o, a stopped command is resumed.

    A cached answer is printed again if the command writes nothing else.

    Args:
        on: where the table is measured; None for this process.

    Returns:
        the exit status: 1 if a row fails.

    Raises:
        UsageError, MissingError: see `measuring.asked`; MissingError also at the end, if a part could not be
            measured.
    """
    writes = any(isinstance(value, Path) for value in vars(outputs).values())
    is_alone = not (output or report or on or writes)
    key = answers.key_of_answer(table, options, format, repr(outputs)) if table.is_kept and is_alone else ""
    return answers.answered(key, lambda: _command(table, options, outputs, format, output, report, on))


def _command(
    table: Table, options: Any, outputs: Any, format: str, output: Path | None, report: Path | None, on: str | None
) -> int:
    # What is imported late here is what measures, which an answer that is kept does without.
    from ..run.measuring import asked, beside
    from ..run.workers.places import place

    keep_what_is_freed()
    check_rows(output)
    if report:
        check_writable(report, mark=PAGE)
    check_plot(getattr(outputs, "plot", None))
    scratch = tempfile.TemporaryDirectory(prefix="normalbench-") if report else nullcontext("")
    with scratch as folder, place(on) as where:
        ask = asked(table, options, in_folder(table, outputs, Path(folder)) if report else outputs)
        table.work.check(outputs, ask.steps)
        # Kept rows go once everything is written.
        with beside(output, _work(table) if output else {}) as kept:
            done = _measured(ask, kept, where)
            failed = _show(table, done, format, output)
            if report:
                _bring(table, outputs, Path(folder))
                _write_page(table, done, Path(folder), report)
    if lacking := table.lacking(done):
        raise MissingError("; ".join(lacking))
    return int(failed)


def in_folder(table: Table, outputs: Any, folder: Path) -> Any:
    """Return outputs with the files that a run keeps placed in its folder, except files that already have a path."""
    known = {field.name for field in fields(outputs)}
    places = {name: folder / place for name, place in table.files.items() if name in known}
    return replace(outputs, **{name: place for name, place in places.items() if getattr(outputs, name) is None})


def _work(table: Table) -> Row:
    """Return the facts that must match for kept rows to be reused: table name, digest of the sources and platform."""
    return {"table": table.name, "sources": sources(), "machine": platform.platform()}


def _measured(ask: Asked, kept: Beside | None, where: Place) -> Measured:
    from ..run.measuring import Nothing, measured, with_parts

    total = sum(1 for _ in with_parts(ask.steps))
    if kept:
        kept_count = sum(kept.find(ask.table.name, step) is not None for step in with_parts(ask.steps))
        if kept_count < len(kept):
            other = f"{kept.path} has {len(kept)} steps of a different {ask.table.name} command"
            raise UsageError(f"{other}; finish that command, delete the file, or name another file")
        tell(f"{kept_count} of {total} steps are already measured")
    try:
        return measured(ask, Nothing() if kept is None else kept, where)
    except (KeyboardInterrupt, SystemExit):
        _say_how_to_go_on(kept, total)
        raise


def _say_how_to_go_on(kept: Beside | None, total: int) -> None:
    if kept is not None:
        tell(f"{len(kept)} of {total} steps were saved; to resume, run the same command")
    else:
        tell("nothing was saved; use -o FILE to make the command resumable")


def _show(table: Table, done: Measured, format: str, output: Path | None) -> bool:
    """Write the rows, messages, pictures and charts. Return whether a row fails."""
    from ..show.showing import say_lines, say_skipped, show

    work = table.work
    say_skipped(table, done.rows, table.lacking(done))
    say_lines(table.warnings(done.rows))
    failed = say_lines(work.failures(done.rows))
    show(table, done, format, output)
    work.write(done, lambda _: None)
    if images := getattr(done.outputs, "images", None):
        tell(f"the pictures are in {images}")
    _plot(table, done)
    return failed


def _plot(table: Table, done: Measured) -> None:
    """Draw the table's charts into the file of --plot, if a file is given and the table has charts.

    Raises UsageError if there is nothing to draw although the machine lacks nothing that the table needs."""
    path, work = getattr(done.outputs, "plot", None), table.work
    if not path or not work.has_charts:
        return
    charts = list(work.plotted(done) if work.plotted else work.charts(done.rows))
    if charts:
        from ...reports.charts import draw

        with whole_file(path) as partial:
            draw.write(charts, (partial, path.suffix[1:].lower()))
        tell(f"the chart is in {path}")
    elif not table.lacking(done):
        raise UsageError(f"--plot: nothing to plot; {_why_nothing(table, done.rows)}")


def _why_nothing(table: Table, rows: Sequence[Row]) -> str:
    """Return the reason why rows have no chart: the first reason in a row or, without one, that figures are too
    few."""
    few = f"too few figures for a chart in {len(rows)} row{'s' * (len(rows) != 1)}; for example, run: {table.example}"
    return next((row["skipped"] for row in rows if row.get("skipped")), few)


def _bring(table: Table, outputs: Any, folder: Path) -> None:
    """Copy output files and folders that were written elsewhere into a run's folder, unless it has them already."""
    for name, inside in table.files.items():
        target = getattr(outputs, name, None)
        if target is not None and target.exists() and not (folder / inside).exists():
            copy = shutil.copytree if target.is_dir() else shutil.copy
            copy(target, folder / inside)


def _write_page(table: Table, done: Measured, folder: Path, target: Path) -> None:
    from ..keep.plain import plain
    from ..keep.runs import Done, facts_of
    from ..show.report import write_report

    rows = plain(list(done.rows))
    facts = facts_of(sys.argv[1:]) | {"time": time.strftime("%Y-%m-%dT%H:%M:%S%z"), "finished": True}
    facts |= {"request": {"tables": [table.name]}}
    steps = [{"table": table.name, "key": {}, "rows": rows}]
    shown = Done(facts, steps, whole={table.name: rows})
    say(f"\nPage: {write_report(folder, shown, target, name=target.stem)}\n")
