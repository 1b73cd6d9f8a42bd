"""The command of the history."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from ...ground.options.words import names
from ...tables.table import Group
from .formats import Format, format_of

Runs = Annotated[
    list[Path],
    typer.Argument(
        help="Results folders, or folders that contain results folders.", metavar="RUN...", show_default=False
    ),
]
SHOWN = "Selection"


class By(StrEnum):
    change = "change"
    commit = "commit"


ByOption = Annotated[
    By,
    typer.Option(
        "--by",
        help="change: commits at which figures got worse, or better than ever; commit: the figures at each commit.",
        rich_help_panel=SHOWN,
    ),
]
Tables = Annotated[str | None, typer.Option("--tables", help="Tables, comma-separated.", rich_help_panel=SHOWN)]
Encoding = Annotated[str | None, typer.Option("--encoding", help="Encodings, comma-separated.", rich_help_panel=SHOWN)]
Storage = Annotated[str | None, typer.Option("--storage", help="Storages, comma-separated.", rich_help_panel=SHOWN)]
Column = Annotated[
    str | None, typer.Option("--column", help="Columns with figures, comma-separated.", rich_help_panel=SHOWN)
]


def add_history(app: typer.Typer) -> None:
    """The command."""
    app.command("history", rich_help_panel=Group.KEEP, epilog="Example: normalbench history results")(history)


def history(
    runs: Runs,
    by: ByOption = By.change,
    tables: Tables = None,
    encoding: Encoding = None,
    storage: Storage = None,
    column: Column = None,
    format: Format | None = None,
    output: Path | None = None,
) -> int:
    """Find the commit at which a figure got worse, over many runs.

    Figures are judged as in compare. A timing counts only if many runs on one machine, before and after a commit,
    agree. A run records the commit of the folder that it was started in; see run --commit.
    """
    from ...keep.history_command import Wanted, history_command

    wanted = Wanted(*(None if text is None else names(text) for text in (tables, encoding, storage, column)))
    return history_command(runs, wanted, by, format_of(format, output), output)
