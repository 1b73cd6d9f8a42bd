"""The options that every command has."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class Format(StrEnum):
    table = "table"
    json = "json"
    csv = "csv"
    markdown = "markdown"


FormatOption = Annotated[Format, typer.Option("--format", help="How to write the rows.")]
OutputOption = Annotated[
    Path | None,
    typer.Option("-o", "--output", help="Write the rows to this file; a command that was stopped then goes on."),
]
