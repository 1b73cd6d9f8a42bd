"""Several runs next to each other: what differs, on which machines, and how far the back ends agree on each."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ...reports.page.several import Figures
from ...reports.page.verdict import is_number
from ...reports.sheets import Sheet
from ..tables.registry import TABLES
from ..tables.table import Role, Row, Table
from .change_lines import in_short, what_matters
from .comparison import compared, named_rows, same
from .runs import Done

# How many differing figures a page holds.
MOST = 500
# Facts that a machine is known by come first; the others follow.
FIRST = ("processor", "GL", "GL version", "RADV", "jax", "python")


def sheets(runs: Mapping[str, Done]) -> Iterator[Sheet]:
    """The tables of a page of several runs, differences first."""
    first, *others = runs
    for other in others:
        changes = compared(runs[first], runs[other])
        title = f"From {first} to {other}, the worst first"
        rows = in_short(changes) or [{"table": "all", "change": "no figure differs"}]
        yield Sheet(title, rows, said=tuple(what_matters(runs[first], runs[other], changes)))
    different = list(_different_rows(runs))
    if different:
        more = f", the first {MOST} of {len(different)}" if len(different) > MOST else ""
        yield Sheet(f"Every figure that differs{more}", different[:MOST], folded=True)
    yield Sheet("The machines", _fact_rows(runs))
    each = ((table, name, done) for table in _tables(runs) for name, done in runs.items())
    if parity := [row for one in each for row in _parity_rows(*one)]:
        yield Sheet("JAX and GLSL, device by device: the largest difference", parity)


def _different_rows(runs: Mapping[str, Done]) -> Iterator[Row]:
    """A row for each figure that is not the same in every run."""
    for table in _tables(runs):
        for name, column, values in _values(runs, table):
            if any(not same(value, values[0]) for value in values[1:]):
                yield {"table": table.name, "row": name, "figure": column} | dict(zip(runs, values, strict=True))


def _tables(runs: Mapping[str, Done]) -> list[Table]:
    known = {name for done in runs.values() for name in done.tables}
    return [table for table in TABLES.values() if table.name in known]


def _values(runs: Mapping[str, Done], table: Table) -> Iterator[tuple[str, str, list[Any]]]:
    """Each row's name, a figure's column and its values by run; None where a run does not have it."""
    found = [named_rows(table, done.tables.get(table.name, [])) for done in runs.values()]
    for key in dict.fromkeys(key for rows in found for key in rows):
        columns = dict.fromkeys(column for rows in found for column in rows.get(key, ()))
        for column in columns:
            known = table.column(column)
            if known and known.role is Role.FIGURE and known.better:
                yield key[0], column, [rows.get(key, {}).get(column) for rows in found]


def figures(runs: Mapping[str, Done]) -> Iterator[Figures]:
    """Every figure of each table, a column for each run."""
    for table in _tables(runs):
        columns: dict[str, dict[str, list[Any]]] = {}
        for name, column, values in _values(runs, table):
            if any(isinstance(value, int | float) for value in values):
                columns.setdefault(column, {})[name] = values
        if columns:
            better = {name: column.better if (column := table.column(name)) else "" for name in columns}
            yield Figures(table.name, table.section.title, list(runs), columns, better)


def _fact_rows(runs: Mapping[str, Done]) -> list[Row]:
    """A row for each fact, those that differ first."""
    machines = [dict(done.facts.get("machine") or {}) for done in runs.values()]
    about = [{name: str(done.facts.get(name) or "") for name in ("time", "sources")} for done in runs.values()]
    machines = [one | other for one, other in zip(about, machines, strict=True)]
    names = dict.fromkeys((*FIRST, *(name for machine in machines for name in machine)))
    rows = [{"fact": name} | {run: m.get(name) for run, m in zip(runs, machines, strict=True)} for name in names]
    known = [row for row in rows if any(row[run] for run in runs)]
    return sorted(known, key=lambda row: len({str(row[run]) for run in runs}) == 1)


def _parity_rows(table: Table, name: str, done: Done) -> Iterator[Row]:
    """A row for each figure: how far the two back ends are apart at most on a run's device, and where."""
    pairs: dict[tuple[Any, ...], dict[str, Row]] = {}
    for row in done.tables.get(table.name, []) if table.parity else ():
        key = tuple(row.get(column) for column in ("encoding", "storage", "rounding", "normals"))
        pairs.setdefault(key, {})[str(row.get("backend"))] = row
    both = [(key, two["jax"], two["glsl"]) for key, two in pairs.items() if {"jax", "glsl"} <= set(two)]
    for column in table.parity:
        apart = [
            (abs(one[column] - other[column]), key, other)
            for key, one, other in both
            if _has_both_numbers(one, other, column)
        ]
        if apart:
            most, key, row = max(apart, key=lambda found: found[0])
            about = {"run": name, "device": row.get("device"), "figure": column, "rows": len(apart)}
            yield about | {"largest": most, "where": " ".join(str(word) for word in key if word != "nearest")}


def _has_both_numbers(one: Row, other: Row, column: str) -> bool:
    return all(is_number(row.get(column)) and math.isfinite(row[column]) for row in (one, other))


def labels(folders: Sequence[str]) -> list[str]:
    """What runs are called: their folders' names, numbered where two are the same."""
    return [
        name if folders.count(name) == 1 else f"{name} ({folders[: at + 1].count(name)})"
        for at, name in enumerate(folders)
    ]
