"""The formats that rows are written in."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path
from types import MappingProxyType

from ...ground.output.errors import UsageError


class Format(StrEnum):
    table = "table"
    json = "json"
    csv = "csv"
    markdown = "markdown"


ENDINGS: Mapping[str, Format] = MappingProxyType({".csv": Format.csv, ".json": Format.json, ".md": Format.markdown})
# What a table's command writes besides its rows, by the ending of its file.
OTHERS: Mapping[str, str] = MappingProxyType(
    {".html": "--report", ".htm": "--report"} | dict.fromkeys((".png", ".svg", ".pdf"), "--plot")
)
# What people may expect, and would be given a text.
NOT_WRITTEN = (".parquet", ".xlsx")


def format_of(format: Format | None, output: Path | None) -> Format:
    """How rows are written: as asked, or as the file's name says.

    Raises:
        UsageError: a file whose name promises a page, a chart, or a format that is not written.
    """
    if not format and output and (other := OTHERS.get(output.suffix.lower())):
        raise UsageError(f"-o writes only rows; for {output.name} use {other} {output}, if the command has that option")
    if output and output.suffix.lower() in NOT_WRITTEN:
        raise UsageError(f"-o cannot write {output.suffix} files; use {output.with_suffix('.csv').name} or .json")
    return format or (ENDINGS.get(output.suffix.lower()) if output else None) or Format.table
