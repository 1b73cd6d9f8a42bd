"""Figures over runs of many commits: the commit at which a figure became worse, and whether it has recovered since.

Two runs are judged as in `compare`. A time is judged by all runs on one machine before and after a step.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from statistics import median
from typing import Any

from ...reports.page.verdict import is_number
from ..tables.registry import TABLES
from ..tables.table import Column, Role, Row, Table
from .comparison import ASKED, in_turn, is_slower_or_faster, is_small, row_changes, severity_of, time_change
from .past_runs import Past
from .runs import Done
from .time_steps import time_steps

# What a row is called, and what it was asked for: rows of other numbers of normals are not set next to each other.
Called = tuple[str, tuple[Any, ...]]


@dataclass
class Series:
    """The history of one row over the runs.

    Attributes:
        table: the table of the row.
        called: the row's name.
        rows: each version of the row, with the index of the first run that has it.
        runs: the indices of the runs that have the row.
        gaps: a run that lacks the row although its request was the same, and the run that has the row again, or None.
        times: by machine and column, the runs and their times.
    """

    table: Table
    called: str
    rows: list[tuple[int, Row]] = field(default_factory=list)
    runs: list[int] = field(default_factory=list)
    gaps: list[tuple[int, int | None]] = field(default_factory=list)
    times: dict[tuple[str, str], list[tuple[int, float]]] = field(default_factory=dict)

    @cached_property
    def is_timed(self) -> bool:
        """Whether the table has times."""
        return bool(self.table.of_role(Role.TIME))

    @cached_property
    def reasons(self) -> set[str]:
        """The names of the columns that give reasons why figures are missing."""
        return {column.name for column in self.table.of_role(Role.REASON)}

    @property
    def judged(self) -> list[str]:
        """The names of the columns of figures, times and speeds for which either less or more is better."""
        names = dict.fromkeys(name for _, row in self.rows for name in row)
        columns = ((name, self.table.column(name)) for name in names)
        return [
            name for name, column in columns if column and column.better and column.role in (Role.FIGURE, Role.TIME)
        ]

    def values(self, column: str) -> list[tuple[int, Any]]:
        """Return (run index, value) pairs of a column, one for each version of the row, with the first run that has
        it."""
        return [(run, row.get(column)) for run, row in self.rows]

    def over_all(self, column: str) -> list[tuple[int, Any]]:
        """Return (run index, value) pairs of a column, one for every run that has the row."""
        pairs, rest = [], list(self.rows)
        for run in self.runs:
            while len(rest) > 1 and rest[1][0] <= run:
                rest.pop(0)
            pairs.append((run, rest[0][1].get(column)))
        return pairs


@dataclass(frozen=True)
class Change:
    """A figure that changed from one run to the next.

    Attributes:
        line: the change as `compare` reports it.
        at: the first run with the change.
        mended: the first run in which the figure is no longer worse; None if it is still worse, or became better.
        series: the row that has the figure.
    """

    line: Row
    at: int
    mended: int | None
    series: Series


def series_of(runs: Sequence[Past]) -> list[Series]:
    """Return the history of each row over some runs, which are referred to by their index."""
    asked = [_asked_text(past) for past in runs]
    by_key: dict[tuple[str, tuple[Called, int]], Series] = {}
    read = Rows()
    for run_index, past in enumerate(runs):
        machine = json.dumps(past.done.facts.get("machine"), sort_keys=True)
        for table, rows in read.of(past):
            for key, row in rows.items():
                if not (series := by_key.get((table.name, key))):
                    series = by_key[table.name, key] = Series(table, key[0][0])
                elif series.runs[-1] != run_index - 1:
                    _close_gap(series, run_index, asked, run_index)
                _add(series, run_index, row, machine)
    for series in by_key.values():
        _close_gap(series, len(runs), asked, None)
    return list(by_key.values())


def _asked_text(past: Past) -> str:
    """Return the request of a run, as text; empty if the run may lack rows."""
    return json.dumps(past.done.facts.get("request"), sort_keys=True) if past.done.finished else ""


class Rows:
    """The rows of runs by their tables and keys. A table with the same lines as in the previous run is not read
    again."""

    def __init__(self):
        self._names: dict[int, Called] = {}
        self._last: dict[str, tuple[list[int], dict[tuple[Called, int], Row]]] = {}

    def of(self, past: Past) -> Iterator[tuple[Table, dict[tuple[Called, int], Row]]]:
        """Yield each table of a run with its rows, by name, conditions and an index among rows of the same name."""
        steps: dict[str, list[Row]] = {}
        for step in past.done.steps:
            steps.setdefault(step["table"], []).append(step)
        for name in filter(TABLES.__contains__, steps):
            lines = list(map(id, steps[name]))
            if self._last.get(name, ([],))[0] != lines:
                self._last[name] = lines, self._keyed(TABLES[name], replace(past.done, steps=steps[name]))
            yield TABLES[name], self._last[name][1]

    def _keyed(self, table: Table, done: Done) -> dict[tuple[Called, int], Row]:
        return in_turn(done.tables[table.name], lambda row: self._called(table, row))

    def _called(self, table: Table, row: Row) -> Called:
        if id(row) not in self._names:
            self._names[id(row)] = table.name_of(row), tuple(row.get(column) for column in ASKED)
        return self._names[id(row)]


def _close_gap(series: Series, run_index: int, asked: Sequence[str], regained: int | None) -> None:
    """Add a gap to a series if a run before `run_index` lacks the row although its request was the same as that of
    the last run with the row. `regained` is the run that has the row again, or None."""
    last = series.runs[-1]
    lacking = (run for run in range(last + 1, run_index) if asked[run] and asked[run] == asked[last])
    if (lost := next(lacking, None)) is not None:
        series.gaps.append((lost, regained))


def _add(series: Series, run_index: int, row: Row, machine: str) -> None:
    """Add the row of another run to a series; the same object as the previous row adds no new version."""
    series.runs.append(run_index)
    if not series.rows or series.rows[-1][1] is not row:
        series.rows.append((run_index, row))
    if series.is_timed:
        for name in _clocks(series.table, row):
            series.times.setdefault((machine, name), []).append((run_index, row[name]))


def _clocks(table: Table, row: Row) -> Iterator[str]:
    """Yield the names of a row's columns with a time or a speed above 0 for which either less or more is better."""
    for name, value in row.items():
        column = table.column(name) if is_value(value) and value > 0 else None
        if column and column.role is Role.TIME and column.better:
            yield name


def changes_of(series: Sequence[Series]) -> list[Change]:
    """Return the figures that became worse, or better than ever before, in the histories of some rows."""
    tests = sum(len(times) - 1 for row_series in series for times in row_series.times.values())
    return [
        change
        for row_series in series
        for change in (*_figures(row_series), *_gone(row_series), *_times(row_series, tests))
    ]


def _figures(series: Series) -> Iterator[Change]:
    known: Row = {}
    for (_, row), (run, other) in pairwise(series.rows):
        # A figure that a run did not look for is that of the last run that did.
        known |= {name: value for name, value in row.items() if value is not None or name in series.reasons}
        for line in row_changes(series.table, {(series.called, 0): known}, {(series.called, 0): other}, False):
            name = line["column"]
            column = series.table.column(name) if row.get(name) is not None or other.get(name) is not None else None
            if line["verdict"] and column and _is_told(series, line, run, column):
                yield Change(line, run, _mended_at(series, line, run, column), series)


def _is_told(series: Series, line: Row, run_index: int, column: Column) -> bool:
    """Whether to report a change: the figure became worse, or better than ever before. A return to an earlier figure
    is not reported."""
    if line["verdict"] == "worse":
        return True
    earlier = [value for run, value in series.values(line["column"]) if run < run_index]
    return all(severity_of(column, value, line["after"], has_reason=True) < 0 for value in earlier)


def _mended_at(series: Series, line: Row, run_index: int, column: Column) -> int | None:
    """Return the first run after `run_index` in which a figure is no longer worse, or only slightly worse after being
    much worse; None if no run qualifies, or the figure became better."""
    for run, value in series.values(line["column"]):
        severity = severity_of(column, line["before"], value, has_reason=True)
        is_as_good = severity <= 0 or (not is_small(line) and is_small(line | {"severity": severity}))
        if run > run_index and line["verdict"] == "worse" and is_as_good:
            return run
    return None


def _gone(series: Series) -> Iterator[Change]:
    for lost, mended in series.gaps:
        row = [row for run, row in series.rows if run < lost][-1]
        for line in row_changes(series.table, {(series.called, 0): row}, {}, same_machine=False):
            yield Change(line, lost, mended, series)


def _times(series: Series, tests: int) -> Iterator[Change]:
    for (_, column), times in series.times.items():
        begins = time_steps([value for _, value in times], tests)
        ends = [0, *begins, len(times)]
        middles = [median(value for _, value in times[begin:end]) for begin, end in pairwise(ends)]
        for number, begin in enumerate(begins, 1):
            before, after = middles[number - 1 : number + 1]
            line = time_change(series.table, series.rows[0][1], series.called, column, before, after)
            later = (ends[i] for i in range(number + 1, len(middles)) if not _is_worse(line, middles[i]))
            mended = next(later, None) if line["verdict"] == "worse" else None
            if line["verdict"] == "worse" or all(_is_better(line, middle) for middle in middles[:number]):
                yield Change(line, times[begin][0], None if mended is None else times[mended][0], series)


def _is_worse(line: Row, later: float) -> bool:
    """Whether a later time is still worse than before a step."""
    before = line["before"]
    return is_slower_or_faster(before, later) and (later > before) == (line["after"] > before)


def _is_better(line: Row, earlier: float) -> bool:
    """Whether a time after a step is better than an earlier time."""
    after = line["after"]
    return is_slower_or_faster(earlier, after) and (after > earlier) == (after > line["before"])


def is_value(value: Any) -> bool:
    """Whether a value is a finite number, which a chart can show."""
    return is_number(value) and math.isfinite(value)
