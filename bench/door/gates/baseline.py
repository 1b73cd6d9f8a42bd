"""Baselines: files with the rows of earlier measurements, for comparison with later rows. They are written only on
request."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ....encodings.codecs.files import file_json
from ....reports.tables import to_json
from ...ground.options.option import fields_of
from ...ground.output.errors import UsageError
from ...ground.output.writing import whole_file
from ...keep.comparison import difference, same
from ...tables.registry import TABLES
from ...tables.table import Role, Row, Table
from .listings import differences as listing_differences
from .listings import lines_of

Entry = dict[str, Any]
# How a row was measured, which is not a figure of it.
HOW = ("device", "rounded_by", "clock")


def entry(table: Table, asked: Mapping[str, Any], row: Row, listing: str = "") -> Entry:
    """Return a row and its request as a dict for JSON: "table", "key", "row" and, if given, "listing".

    Names in the key are spelled as in the row, and numbers as in the request. Times, and columns that only programs
    read, are left out.

    Args:
        listing: the instructions behind the row's counts; empty if no instructions were counted.
    """
    known = fields_of(table.options)
    key = {name: row.get(name, value) if known[name].kind is str else value for name, value in asked.items()}
    # Several rows of one request differ in their keys.
    key |= {column.name: row.get(column.name) for column in table.of_role(Role.KEY)}
    key |= {name: row.get(name) for name in table.compilers}
    (plain,) = json.loads(to_json([{name: value for name, value in row.items() if _is_kept(table, name)}]))
    return {"table": table.name, "key": key, "row": plain} | ({"listing": lines_of(listing)} if listing else {})


def _is_kept(table: Table, name: str) -> bool:
    column = table.column(name)
    return column is None or column.role not in (Role.TIME, Role.RAW)


def read_baseline(path: Path) -> dict[str, Entry]:
    """Return the entries of a baseline, by table and key as text. Raises UsageError if the file is not a baseline."""
    try:
        entries = file_json(path)
        if not isinstance(entries, list):
            raise ValueError("it is not a list of entries")
    except (OSError, ValueError) as error:
        raise UsageError(f"{path} is not a baseline: {error}") from error
    from ...keep.schema import check_entry

    for number, record in enumerate(entries, 1):
        check_entry(record, f"{path}, entry {number}")
    return {_text(known_entry): known_entry for known_entry in entries}


def _text(row_entry: Entry) -> str:
    return json.dumps([row_entry["table"], row_entry["key"]], sort_keys=True)


def write_baseline(path: Path, dumped: Sequence[str]) -> None:
    """Write rows, given as texts from `Baseline.dumped`, to a baseline. Each row replaces the entry with the same
    key; other entries are kept.

    Raises:
        UsageError: the file is not a baseline or cannot be written, or two rows with the same key differ.
    """
    kept = Baseline(path, True)
    for record in (new_entry for text in dumped for new_entry in json.loads(text)):
        kept.record(record)
    entries = (read_baseline(path) if path.exists() else {}) | kept.recorded
    with whole_file(path) as partial:
        lines = (json.dumps(entries[text]) for text in sorted(entries))
        partial.write_text("[\n" + ",\n".join(lines) + "\n]\n", encoding="utf-8", newline="\n")


class NoRowError(AssertionError):
    """A baseline lacks a row.

    Attributes:
        said: the name of the row.
    """

    def __init__(self, message: str, row_name: str = ""):
        super().__init__(message)
        self.said = row_name


@dataclass
class Baseline:
    """A baseline file, and the rows recorded for it, which `write_baseline` writes.

    Attributes:
        writes: whether rows are recorded.
        writer: the option that turns recording on.
    """

    path: Path
    writes: bool
    writer: str = "--normalbench-write-baseline"
    recorded: dict[str, Entry] = field(default_factory=dict)
    _read: dict[str, Entry] | None = None

    def record(self, row_entry: Entry) -> None:
        """Record an entry for writing. Raises UsageError if a recorded entry has the same key but different
        figures."""
        before = self.recorded.setdefault(_text(row_entry), row_entry)
        if list(changes(before["row"], row_entry["row"], {})):
            raise UsageError(f"two rows of the baseline have the same name: {_name(row_entry)}; rename one")

    def differences(self, row_entry: Entry, tolerances: Mapping[str, float]) -> list[str]:
        """Return the differences between a row and its entry, one line per column; empty if they agree.

        If a column differs, changed instructions and a different device add a line each.

        Raises:
            NoRowError: the file has no such row.
            UsageError: the file is not a baseline.
        """
        if self._read is None:
            self._read = read_baseline(self.path) if self.path.exists() else {}
        before = self._read.get(_text(row_entry))
        if before is None:
            row_name = f"{_name(row_entry)}{self._other_compilers(row_entry)}"
            raise NoRowError(f"{self.path} has no row {row_name}; write it with {self.writer}", row_name)
        lines = list(changes(before["row"], row_entry["row"], tolerances))
        if lines and before.get("listing") and row_entry.get("listing"):
            changed = list(listing_differences(before["listing"], row_entry["listing"]))
            lines.append("\n  ".join(["instructions, with changed lines marked + and -:", *changed]))
        devices = [row.get("device") for row in (before["row"], row_entry["row"])]
        if lines and devices[0] != devices[1]:
            lines.append(f"measured on {devices[1]}; the baseline was measured on {devices[0]}")
        return lines

    def _other_compilers(self, row_entry: Entry) -> str:
        """Return text such as " for A, only for B", which names this row's compiler and the compilers of similar rows
        in the file; empty if the file has no similar row."""
        table = TABLES.get(row_entry["table"])
        names = table.compilers if table else ()
        alike = [e["key"] for e in (self._read or {}).values() if _less(e, names) == _less(row_entry, names)]
        if not names or not alike:
            return ""
        differ = [name for name in names if any(key.get(name) != row_entry["key"].get(name) for key in alike)]
        mine, *others = (", ".join(str(key.get(name)) for name in differ) for key in (row_entry["key"], *alike))
        return f" for {mine}, only for {' and for '.join(dict.fromkeys(others))}"

    def dumped(self) -> str:
        """Return the recorded entries as a JSON list in text form; an empty text if no entry is recorded."""
        return json.dumps(list(self.recorded.values())) if self.recorded else ""


def _less(row_entry: Entry, names: Sequence[str]) -> str:
    """Return an entry's table and key as text, without the parts of the key that `names` lists."""
    return _text({**row_entry, "key": {name: value for name, value in row_entry["key"].items() if name not in names}})


def _name(row_entry: Entry) -> str:
    table = TABLES.get(row_entry["table"])
    return table.name_of(row_entry["row"]) if table else str(row_entry["table"])


def changes(before: Row, after: Row, tolerances: Mapping[str, float]) -> Iterator[str]:
    """Yield a line for each column, except those in HOW, that differs by more than its tolerance (0 unless given)."""
    for column in dict.fromkeys([*before, *after]):
        previous, other = before.get(column), after.get(column)
        if column not in HOW and not same(previous, other) and not _near(previous, other, tolerances.get(column, 0.0)):
            allowed = f", tolerance {tolerances[column]:g}" if column in tolerances else ""
            yield f"{column} is {other}, but {previous} in the baseline ({difference(previous, other)}{allowed})"


def _near(figure: Any, other: Any, tolerance: float) -> bool:
    return isinstance(figure, int | float) and isinstance(other, int | float) and abs(figure - other) <= tolerance


def checked_tolerances(tolerances: Mapping[str, Any], columns: Sequence[str]) -> dict[str, float]:
    """Return the tolerances as a dict. Raises UsageError for an unknown column or a value that is not a tolerance."""
    for column, value in tolerances.items():
        if column not in columns:
            raise UsageError(f"no column {column!r}; known: {', '.join(columns)}")
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < math.inf:
            raise UsageError(f"{column}: a tolerance must be a number of at least 0, not {value!r}")
    return dict(tolerances)
