"""The tables of a run as files for other programs."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ...reports import tables
from ..ground.output.writing import whole_file
from .runs import Done, Row


def write_tables(folder: Path, done: Done, names: Iterable[str]) -> None:
    """Write the named tables of a run to a folder, each as NAME.json and NAME.csv. Raises UsageError."""
    for name in names:
        _write_table(folder / name, done.finished_rows(name))


def _write_table(path: Path, rows: list[Row]) -> None:
    for suffix, written in ((".json", tables.to_json), (".csv", tables.to_csv)):
        with whole_file(path.with_suffix(suffix), is_checked=True) as partial:
            partial.write_text(written(rows), encoding="utf-8", newline="\n")
