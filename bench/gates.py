"""Gates: what figures a team's choices must keep, from a TOML file, measured and held against."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from . import quality
from .commands import Request
from .errors import UsageError
from .quality import require_device
from .render_commands import RenderRequest
from .rendering import Bench, ranked
from .runs import Row, read_run

LIMIT = re.compile(r"\s*(at least|at most)\s+([-+]?[\d.]+(?:e[-+]?\d+)?)\s*", re.I)
MAX_GATES = 1000
QUALITY = Request(encoding="octahedral", backend="jax")
RENDER = RenderRequest(encoding="octahedral")


@dataclass(frozen=True)
class Limit:
    """The least or the most that a column may be."""

    column: str
    side: str
    value: float

    def holds(self, figure: Any) -> bool:
        """Whether a figure keeps it; what is no number does not."""
        if not isinstance(figure, int | float) or math.isnan(figure):
            return False
        return figure >= self.value if self.side == "at least" else figure <= self.value

    def __str__(self) -> str:
        return f"{self.side} {self.value:g}"


@dataclass(frozen=True)
class Gate:
    """Rows of a table, and what they must keep.

    Attributes:
        table: "quality" or "render", which are measured; or any table of a run.
        options: what chooses the rows, columns' values, and for a measured table the command's options.
        limits: one for each column.
        place: file and number, for messages.
    """

    table: str
    options: Mapping[str, Any]
    limits: tuple[Limit, ...]
    place: str


def read_gates(path: Path) -> list[Gate]:
    """The gates of a TOML file: `[[gate]]` tables with options and, for columns, "at least 47.5" or "at most 0.95".

    Raises:
        UsageError: it cannot be read, or says something else; one line with the place.
    """
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError) as error:
        raise UsageError(f"{path}: cannot be read as gates: {error}") from error
    found = data.get("gate")
    if set(data) != {"gate"} or not isinstance(found, list) or not all(isinstance(gate, dict) for gate in found):
        raise UsageError(f"{path}: gates are [[gate]] tables, and nothing else is there")
    if not 1 <= len(found) <= MAX_GATES:
        raise UsageError(f"{path}: {len(found)} gates; from 1 to {MAX_GATES}")
    return [_gate(f"{path}, gate {number}", values) for number, values in enumerate(found, 1)]


def _gate(place: str, values: dict[str, Any]) -> Gate:
    options, limits = {}, []
    for name, value in values.items():
        match = LIMIT.fullmatch(value) if isinstance(value, str) else None
        if match:
            limits.append(Limit(name, match[1].lower(), _number(place, name, match[2])))
        elif isinstance(value, str | int | float) and not isinstance(value, bool):
            options[name] = value
        else:
            raise UsageError(f"{place}: {name} is {value!r}; a text or a number would do")
    if not limits:
        raise UsageError(f'{place}: it holds no column to anything; say psnr_db = "at least 47.5"')
    table = str(options.pop("table", "quality"))
    return Gate(table, options, tuple(limits), place)


def _number(place: str, name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise UsageError(f"{place}: {name}: {text} is no number") from error


Measure = Callable[[Gate], list[Row]]


def _request(gate: Gate, usual: Any) -> Any:
    """A command's request with a gate's options in place of what is usual. Raises UsageError for others."""
    known = {field.name: getattr(usual, field.name) for field in fields(usual)}
    unknown = [name for name in gate.options if name not in known]
    if unknown:
        raise UsageError(f"{gate.place}: unknown option {unknown[0]!r}; known: table, {', '.join(known)}")
    for name, value in gate.options.items():
        if isinstance(known[name], int) != isinstance(value, int) and not isinstance(known[name], float):
            raise UsageError(f"{gate.place}: {name} is {value!r}; like {known[name]!r} it must be")
    return type(usual)(**(known | dict(gate.options)))


def _measured_quality(gate: Gate) -> list[Row]:
    return [quality.measure(case) for case in _request(gate, QUALITY).cases()]


def _measured_render(gate: Gate) -> list[Row]:
    gl = require_device()
    bench = Bench(gl, 0, False)
    return ranked([bench.measure(case)[0] for case in _request(gate, RENDER).cases(gl)])


MEASURED: Mapping[str, Measure] = {"quality": _measured_quality, "render": _measured_render}


def _rows_of_run(run: Path) -> Measure:
    done = read_run(run)

    def rows(gate: Gate) -> list[Row]:
        if gate.table not in done.tables:
            raise UsageError(f"{gate.place}: {run} has no table {gate.table!r}; it has {', '.join(done.tables)}")
        found = [row for row in done.tables[gate.table] if all(_is(row.get(n), v) for n, v in gate.options.items())]
        if not found:
            raise UsageError(f"{gate.place}: {run} has no row with {dict(gate.options)!r}")
        return found

    return rows


def _is(value: Any, asked: Any) -> bool:
    """Whether a row's value is what was asked for: one of the names, where those are comma-separated."""
    return value in [word.strip() for word in asked.split(",")] if isinstance(asked, str) else value == asked


def checked(gates: list[Gate], run: Path | None, tick: Callable[[str], None]) -> Iterator[Row]:
    """A row for each limit on each row of each gate: the figure, the limit, whether it holds.

    Args:
        run: a results folder to take the figures from; None to measure them.

    Raises:
        UsageError: a table, option or column that there is not.
        MissingError: a table needs a GL device and there is none.
    """
    from_run = _rows_of_run(run) if run else None
    for gate in gates:
        measure = from_run or MEASURED.get(gate.table)
        if not measure:
            known = ", ".join(MEASURED)
            raise UsageError(f"{gate.place}: table {gate.table!r} is not measured here, only {known}; name a --run")
        try:
            rows = measure(gate)
        except UsageError as error:
            raise UsageError(str(error) if gate.place in str(error) else f"{gate.place}: {error}") from error
        yield from (_held(gate, row, limit) for row in rows for limit in gate.limits)
        tick(gate.place)


def _held(gate: Gate, row: Row, limit: Limit) -> Row:
    if limit.column not in row:
        raise UsageError(f"{gate.place}: {gate.table} has no column {limit.column!r}; it has {', '.join(row)}")
    figure = row[limit.column]
    said = {name: row[name] for name in IDENTITY if row.get(name) is not None}
    what = " ".join(str(value) for value in said.values())
    return {
        "gate": gate.place.rsplit(" ", 1)[-1],
        "table": gate.table,
        "row": what,
        "column": limit.column,
        "figure": figure,
        "limit": str(limit),
        "holds": "pass" if limit.holds(figure) else "FAIL",
        "skipped": row.get("skipped"),
    }


# What a row is called by.
IDENTITY = (
    *("encoding", "storage", "rounding", "normals", "backend", "pipeline", "layout", "scene", "experiment"),
    *("light_buffer", "light_targets", "channel", "order", "colour", "lights", "sum", "peak", "power", "depth"),
    *("rebuilt", "near", "far", "distance"),
)
