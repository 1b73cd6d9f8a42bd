"""Gates: a team's thresholds for figures, read from a TOML file and checked against measurements."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ....encodings.codecs.files import file_toml
from ...ground.options.option import fields_of
from ...ground.options.words import Names, typed, words_in
from ...ground.output.errors import UsageError
from ...ground.user_files import files_in
from ...keep.runs import Done, read_run
from ...tables.table import UNEXPECTED, Role, Row, Table
from .baseline import Baseline, NoRowError, entry, write_baseline
from .limits import Limit, limits_on, split_limits
from .measured import USUAL, Found, located, measured, table_named, with_their_options

MAX_GATES = 1000
BASELINE = "matches_baseline"
WRITER = "normalbench check --write-baseline"
# Of the rows that `check` writes.
COLUMNS = ("gate", "table", "row", "column", "figure", "limit", "holds", "worst_normal", "changed", "lacks", "skipped")


@dataclass(frozen=True)
class Gate:
    """Rows of a table, and the limits that they must meet.

    Attributes:
        table: the table of the rows.
        options: the options to measure the table with; for rows of a run, the column values that select the rows.
        limits: the limits, at most one per column.
        place: the file and the gate's number, for messages.
        folder: the folder of the gates file, which file names in options are relative to.
        baseline: the file that every row is compared with, with or without limits; None for no baseline.
    """

    table: Table
    options: Mapping[str, Any]
    limits: tuple[Limit, ...]
    place: str
    folder: Path
    baseline: Path | None = None

    def located(self) -> dict[str, Any]:
        """Return the options by name; names of files in the folder become paths relative to the working directory.

        Raises:
            UsageError: a file is in the working directory but not in the folder of the gates file.
        """
        for name, words in self.files().items():
            for word in map(str, words):
                there = files_in(word, self.folder)
                # A name without an ending may be one of the catalogue's.
                lost = [path for path in files_in(word) if Path(path).suffix and path not in there]
                if lost:
                    reason = f"{lost[0]} is in the current folder, but paths are relative to the gates file"
                    raise UsageError(f"{name}: {reason}; write {os.path.relpath(lost[0], self.folder)}")
        return located(self.table, self.options, self.folder)

    def files(self) -> dict[str, Names]:
        """Return the options whose words may name files, by name; the words are spelled as in the gates file."""
        known = fields_of(self.table.options)
        may_be = (name for name in self.options if name in known and known[name].option.files)
        return {name: words_in(self.options[name]) for name in may_be}


def read_gates(path: Path) -> list[Gate]:
    """Return the gates of a TOML file: `[[gate]]` tables with options and limits on columns, such as "at most 0.95".

    Raises:
        UsageError: the file cannot be read or is not a gates file; the message is one line that names the place.
    """
    try:
        data = file_toml(path)
    except (OSError, ValueError) as error:
        raise UsageError(f"{path}: {error}") from error
    gates = data.get("gate")
    if other := sorted(set(data) - {"gate"}):
        raise UsageError(f"{path}: unknown key {other[0]!r}; a gates file has only [[gate]] tables")
    if not isinstance(gates, list) or not all(isinstance(gate, dict) for gate in gates):
        raise UsageError(f"{path}: no [[gate]] table")
    if not 1 <= len(gates) <= MAX_GATES:
        raise UsageError(f"{path}: {len(gates)} gates; a file may have 1 to {MAX_GATES}")
    return [_gate(f"{path}, gate {number}", values, path.parent) for number, values in enumerate(gates, 1)]


def _gate(place: str, values: dict[str, Any], folder: Path) -> Gate:
    named = values.pop(BASELINE, None)
    try:
        if named is not None and not (isinstance(named, str) and named):
            raise UsageError(f"{BASELINE} is {named!r}; it must be a file name")
        for name, value in values.items():
            if not isinstance(value, str | int | float):
                raise UsageError(f"{name} is {value!r}; it must be text or a number")
        table = table_named(values.pop("table", USUAL))
        raw_options, limits = split_limits(values, table, may_lack=named is not None)
        known = fields_of(table.options)
        options = {
            name: known[name].read(value, folder) if name in known else value for name, value in raw_options.items()
        }
        for limit in limits:
            limit.check(table)
    except UsageError as error:
        raise UsageError(f"{place}: {error}") from error
    return Gate(table, options, limits, place, folder, folder / named if named else None)


Measure = Callable[[Gate], list[Found]]


def measured_for(gate: Gate) -> list[Found]:
    """Measure a gate's rows, and return each row with its request.

    Raises:
        UsageError: a table, an option or a name is unknown; the message is one line that names the gate's place.
        MissingError: this machine lacks something that the rows need.
    """
    try:
        measurements = measured(gate.table, with_their_options(gate.table, gate.located(), gate.limits))
    except UsageError as error:
        raise UsageError(f"{gate.place}: {error}") from error
    # A baseline has paths as the file of gates has them, from wherever it is compared.
    return [replace(measurement, asked={**measurement.asked, **gate.files()}) for measurement in measurements]


def _rows_of_run(run: Path) -> Measure:
    done = read_run(run)
    if done.damage:
        raise UsageError(f"{done.damage}; measure it again")
    tables = done.tables

    def rows(gate: Gate) -> list[Found]:
        name = gate.table.name
        if name not in tables:
            raise UsageError(f"{gate.place}: {run} has no table {name!r}; it has {', '.join(tables)}")
        for option in gate.options:
            if not gate.table.column(option):
                keys = ", ".join(column.name for column in gate.table.of_role(Role.KEY))
                raise UsageError(f"{gate.place}: rows of {name} have no {option!r}; their keys are {keys}")
            if not any(_is(row.get(option), gate.options[option]) for row in tables[name]):
                there = ", ".join(dict.fromkeys(str(row.get(option)) for row in tables[name]))
                wanted = f"{option} {typed(gate.options[option])!r}"
                raise UsageError(f"{gate.place}: no row of {name} in {run} has {wanted}; values there: {there}")
        rows = [row for row in _finished(done, gate, run) if all(_is(row.get(n), v) for n, v in gate.options.items())]
        if not rows:
            asked = ", ".join(f"{option} {typed(value)!r}" for option, value in gate.options.items())
            raise UsageError(f"{gate.place}: no row in {run} combines {asked}")
        for limit in gate.limits:
            _check_was_measured(gate, limit, rows, run)
        return [Found(row, lambda: None) for row in rows]

    return rows


def _finished(done: Done, gate: Gate, run: Path) -> list[Row]:
    """Return a run's finished rows for a gate's table. Raises UsageError if they do not match this version."""
    name = gate.table.name
    try:
        return done.finished_rows(name)
    except UNEXPECTED as error:
        raise UsageError(
            f"{gate.place}: the rows of {name} in {run} do not match this version; {done.remedy(name)}"
        ) from error


def _check_was_measured(gate: Gate, limit: Limit, rows: list[Row], run: Path) -> None:
    """Raise UsageError if a run lacks a figure because it was measured without the option that the figure needs."""
    option = limit.option_of(gate.table)
    if option and all(row.get(limit.column) is None and not row.get("skipped") for row in rows):
        flag = fields_of(gate.table.options)[option].option.flag
        raise UsageError(f"{gate.place}: {run} has no {limit.column}; measure the run with {flag}")


def _is(value: Any, asked: Any) -> bool:
    """Whether a row's value is the requested value, or one of several requested values."""
    return value in asked if isinstance(asked, tuple) else value == asked


def checked(
    gates: list[Gate], run: Path | None, tick: Callable[[str], None], baselines: Baselines | None = None
) -> Iterator[Row]:
    """Check each row of each gate against the gate's limits and its baseline. Yield a row per check: the figure, the
    limit, whether the row passes, the worst normal, and the differences from the baseline.

    Args:
        run: a results folder to take the figures from; None to measure them.
        baselines: the baselines that rows are compared with, or written to.

    Raises:
        UsageError: a table, an option or a column is unknown.
        MissingError: a table needs an OpenGL device and this machine has none.
    """
    measure = _rows_of_run(run) if run else measured_for
    baselines = baselines or Baselines(False)
    for gate in gates:
        measurements = measure(gate)
        yield from (
            _held(gate, measurement, limit)
            for measurement in measurements
            for limit in limits_on(measurement.row, gate.limits)
        )
        if gate.baseline:
            yield from (_compared(gate, measurement, baselines.of(gate.baseline)) for measurement in measurements)
        tick(gate.place)


class Baselines:
    """The baselines that gates name, each read once.

    Args:
        writes: whether rows are written to the baselines instead of being compared with them.
    """

    def __init__(self, writes: bool):
        self.writes = writes
        self._by_path: dict[Path, Baseline] = {}

    def of(self, path: Path) -> Baseline:
        """Return the baseline of a file, always the same object for one path."""
        return self._by_path.setdefault(path, Baseline(path, self.writes, WRITER))

    def write(self) -> Iterator[Path]:
        """Write the recorded rows to their baselines, and yield the paths of the files written. Do nothing if rows
        are only compared. Raises UsageError if a baseline cannot be written."""
        for path, baseline in self._by_path.items():
            if self.writes and (dumped := baseline.dumped()):
                write_baseline(path, [dumped])
                yield path


def _row(gate: Gate, tested: Found, **more: Any) -> Row:
    row: Row = {"gate": gate.place.rsplit(" ", 1)[-1], "table": gate.table.name, "row": gate.table.name_of(tested.row)}
    return dict.fromkeys(COLUMNS) | row | {"holds": "pass", "skipped": tested.row.get("skipped")} | more


def _held(gate: Gate, tested: Found, limit: Limit) -> Row:
    try:
        broken = limit.broken_by(gate.table, tested.row)
    except UsageError as error:
        raise UsageError(f"{gate.place}: {gate.table.name}: {error}") from error
    worst = str(tested.worst) if broken and tested.worst else None
    figure, holds = tested.row[limit.column], "FAIL" if broken else "pass"
    return _row(gate, tested, column=limit.column, figure=figure, limit=str(limit), holds=holds, worst_normal=worst)


def _compared(gate: Gate, tested: Found, baseline: Baseline) -> Row:
    """Return one row for the report: whether the baseline agrees, and if not, the differences. If baselines are
    written, record the tested row instead, and report that."""
    record = entry(gate.table, tested.asked, tested.row, tested.listing)
    if baseline.writes:
        baseline.record(record)
        return _row(gate, tested, limit=f"written into {baseline.path.name}")
    try:
        differences = baseline.differences(record, {})
    except NoRowError as error:
        return _row(gate, tested, limit=f"as in {baseline.path.name}", holds="FAIL", lacks=f"{error.said}")
    holds, changed = "FAIL" if differences else "pass", "\n".join(differences) or None
    return _row(gate, tested, limit=f"as in {baseline.path.name}", holds=holds, changed=changed)
