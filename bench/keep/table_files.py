"""The tables of a run as files for other programs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ...reports import tables
from ..ground.output.writing import whole_file
from ..tables.registry import TABLES
from .runs import Row


def write_tables(folder: Path, found: Mapping[str, list[Row]]) -> None:
    """The rows of tables, by name, as files for others. Raises UsageError."""
    for name, rows in found.items():
        _write_table(folder / name, TABLES[name].work.finish(rows))


def _write_table(path: Path, rows: list[Row]) -> None:
    for suffix, written in ((".json", tables.to_json), (".csv", tables.to_csv)):
        with whole_file(path.with_suffix(suffix)) as partial:
            partial.write_text(written(rows), encoding="utf-8")
    if tables.has_parquet():
        with whole_file(path.with_suffix(".parquet")) as partial:
            tables.write_parquet(rows, partial)
