"""A simulation of a run on many workers: the same rules for tasks, with recorded times of steps."""

from __future__ import annotations

import heapq
import json
import random
import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from normalbench.bench.ground.choose import choose
from normalbench.bench.keep.journal import journal
from normalbench.bench.run.measuring import HERE, asked
from normalbench.bench.run.workers.chunks import chunk_size
from normalbench.bench.run.workers.orders import PICTURES
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.table import Table

from .scheduled import scheduled
from .timing import Row, exponent

WORKERS = (1, 4, 10, 100, 1000)
# Tasks and bytes that are sent to measure what they cost; a row as long as most.
TASKS, BYTES, ROW = 1000, 1 << 24, {"row": "0" * 1500}


@dataclass(frozen=True)
class Costs:
    """Costs other than measuring, in seconds.

    Attributes:
        start: time from a worker's start to its first task.
        task: time of the command to send a task and take its answer.
        row: time of the command to save a step's rows to disk.
        byte: time of the command to send or take a byte.
    """

    start: float
    task: float
    row: float
    byte: float


@dataclass(frozen=True)
class Load:
    """Steps of a table.

    Attributes:
        seconds: recorded times of steps, from which the load's times are drawn.
        steps: number of steps.
        prepare: seconds that a worker takes to make the steps.
        sent, taken: bytes to each worker, and back for each step.
        is_timed: whether a clock is read: then the command measures the steps itself.
    """

    seconds: Sequence[float]
    steps: int
    prepare: float = 0.0
    sent: float = 0.0
    taken: float = 0.0
    is_timed: bool = False


@dataclass(frozen=True)
class Simulated:
    """A load on some workers: its duration, and how long the command is busy."""

    seconds: float
    command: float


def simulated(load: Load, workers: int, costs: Costs, seed: int = 0) -> Simulated:
    """Simulate workers that take chunks as they become free. The command serves one worker at a time."""
    rng, hands = random.Random(seed), 1 if load.is_timed else workers
    times = rng.choices(load.seconds, k=load.steps)
    free, knows = [(0.0, number) for number in range(hands)], set[int]()
    clock = busy = end = 0.0
    position = 0
    while position < load.steps:
        ready, number = heapq.heappop(free)
        size = 1 if load.is_timed else chunk_size(load.steps - position, hands)
        is_new = number not in knows
        knows.add(number)
        served = costs.task + size * (costs.row + load.taken * costs.byte) + is_new * load.sent * costs.byte
        clock, busy = max(clock, ready) + served, busy + served
        done = clock + sum(times[position : position + size]) + is_new * load.prepare
        heapq.heappush(free, (done, number))
        position, end = position + size, max(end, done)
    return Simulated(end, busy)


def rows(name: str, loads: Sequence[Load], costs: Costs) -> list[Row]:
    """Return a row for each number of workers; the loads are measured one after the other.

    The exponent compares a row with the row before: the time grows as workers^exponent, which is -1 if twice as many
    workers take half the time.
    """
    alone = sum(simulated(load, 1, costs).seconds for load in loads)
    figures: list[Row] = []
    fewer: tuple[int, float] | None = None
    for workers in WORKERS:
        runs = [simulated(load, workers, costs) for load in loads]
        took = costs.start + sum(run.seconds for run in runs)
        row = {"work": name, "workers": workers, "minutes": round(took / 60, 1), "times faster": round(alone / took, 1)}
        figures.append(row | {"workers busy %": round(100 * alone / took / workers)})
        figures[-1]["command busy %"] = round(100 * sum(run.command for run in runs) / took, 1)
        # Of as many digits as machines agree on.
        figures[-1]["exponent"] = fewer and round(exponent((fewer[0], workers), (fewer[1], took)) or 0.0, 6)
        fewer = workers, took
    return figures


def loads_of(record: Mapping[str, Any]) -> dict[str, list[Load]]:
    """Return the loads of each work in a record, by name; a work's loads are measured one after the other."""
    times, sizes = record["seconds"], record["bytes"]
    everything = [
        Load(times[work["table"]], work["steps"], work["prepare"], 0.0, sizes[work["table"]], is_timed=work["timed"])
        for work in record["everything"]
    ]
    return {"all encodings, storages and sets": everything}


def table(record: Mapping[str, Any]) -> list[Row]:
    """Return the rows of every work in a record."""
    costs = Costs(**record["costs"])
    return [row for name, loads in loads_of(record).items() for row in rows(name, loads, costs)]


def record(names: Iterable[str], path: Path) -> None:
    """Write step times of tables, and the costs of sending here, into a record; all other contents stay.

    Raises:
        UsageError: an unknown table.
    """
    before = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    measured = {"seconds": dict(before.get("seconds", {})), "bytes": dict(before.get("bytes", {}))}
    for table in choose("table", names, TABLES):
        measured["seconds"][table.name], measured["bytes"][table.name] = step_times(table)
    path.write_text(json.dumps(before | measured | {"costs": asdict(measured_costs())}) + "\n", encoding="utf-8")


def step_times(table: Table) -> tuple[list[float], int]:
    """Return the seconds of a table's default steps in this process, and the mean bytes of their images."""
    with tempfile.TemporaryDirectory() as folder:
        images = {PICTURES: Path(folder)} if PICTURES in table.files else {}
        ask = asked(table, table.options(), replace(table.outputs(), **images))
        times, began = list[float](), time.perf_counter()
        for _ in HERE.measure(ask, ask.steps, lambda _: None):
            times.append(round(time.perf_counter() - began, 3))
            began = time.perf_counter()
        sizes = [path.stat().st_size for path in Path(folder).rglob("*") if path.is_file()]
    return times, round(sum(sizes) / max(len(times), 1))


def measured_costs() -> Costs:
    """Measure the costs of a task, a row and a byte here, with two workers of a scheduler."""
    from distributed import Client

    from normalbench.bench.run.workers.worker import quiet

    quiet()
    began = time.perf_counter()
    with scheduled({}, {}) as there, Client(there.address, set_as_default=False) as client:
        client.wait_for_workers(2)
        start = time.perf_counter() - began
        # `len` takes no time: what remains is what sending a task takes.
        task = _through(client, TASKS, b"") / TASKS
        byte = _through(client, 8, bytes(BYTES)) / (8 * BYTES)
    return Costs(round(start, 2), round(task, 6), round(_row_cost(), 6), float(f"{byte:.2g}"))


def _through(client: Any, count: int, data: bytes) -> float:
    """Return the seconds for `count` tasks."""
    began = time.perf_counter()
    client.gather([client.submit(len, data, pure=False) for _ in range(count)])
    return time.perf_counter() - began


def _row_cost() -> float:
    with tempfile.TemporaryDirectory() as folder, journal(Path(folder) / "rows") as kept:
        began = time.perf_counter()
        for _ in range(200):
            kept.add(ROW)
        return (time.perf_counter() - began) / 200
