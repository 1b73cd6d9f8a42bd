"""The `show` command: prints the verdicts of a run's tables, or the summaries of named tables."""

from __future__ import annotations

from pathlib import Path

from ..ground.choose import choose
from ..ground.options.words import Names
from ..ground.output.errors import UsageError, tell
from ..keep.runs import read_to_show
from ..tables.registry import TABLES
from ..tables.table import UNEXPECTED
from .showing import say_verdict, show_summary


def show_command(folder: Path, tables: Names) -> None:
    """Print the verdict of each table of a run; if tables are named, print their summaries instead.

    Args:
        folder: the run's folder.
        tables: the names of tables; empty for the verdicts of all tables.

    Raises:
        UsageError: the folder has no run or no rows, the run has no such table, or the rows do not match this
            version.
    """
    done = read_to_show(folder, needs_rows=True)
    if not done.facts.get("finished", True):
        tell(f"{folder} is not finished, so verdicts cover only the rows so far; to finish it, repeat its command")
    here = {name: table for name, table in TABLES.items() if name in done.tables}
    say = show_summary if tables else say_verdict
    for table in choose("table of the run", tables or ("all",), here):
        try:
            say(table, done.finished_rows(table.name))
        except UNEXPECTED as error:
            remedy = done.remedy(table.name)
            raise UsageError(f"{folder}: the rows of {table.name} do not match this version; {remedy}") from error
