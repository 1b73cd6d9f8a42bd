"""How long a run takes on many workers: a simulation with recorded times of steps.

    python -m normalbench.bench.run.workers.simulate RECORD.json
    python -m normalbench.bench.run.workers.simulate --record RUN RECORD.json

RUN is a results folder that workers measured. `--record` takes its step times, and measures on two worker processes of
this machine what a task, a row and a byte cost.
"""

from __future__ import annotations

import heapq
import json
import random
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ....reports.tables import written
from ...ground.output.errors import UsageError
from ...keep.journal import journal
from ...measures.metrics.growth import exponent
from .chunks import chunk_size
from .places import TIMES

WORKERS = (1, 4, 10, 100, 1000)
# Workers of a machine, of which one measures at a time where a clock is read.
ON_A_MACHINE = 8
# Tasks and bytes that are sent to measure what they cost; a row as long as most.
TASKS, BYTES, ROW = 1000, 1 << 24, {"row": "0" * 1500}


@dataclass(frozen=True)
class Costs:
    """What is not measuring, in seconds.

    Attributes:
        start: from a worker's start to its first task.
        task: of the command, for a task: sending it and taking its answer.
        row: of the command, to keep a step's rows on the disk.
        byte: of the command, to send or take a byte.
    """

    start: float
    task: float
    row: float
    byte: float


@dataclass(frozen=True)
class Load:
    """Steps of a table.

    Attributes:
        seconds: recorded times of steps, from which those of the load are drawn.
        steps: how many steps there are.
        prepare: seconds in which a worker makes the steps of an order.
        sent, taken: bytes to a worker for each order, and back for each step.
        orders: into how many orders the steps are divided: a worker reads the files of its own.
        is_timed: whether a clock is read.
    """

    seconds: Sequence[float]
    steps: int
    prepare: float = 0.0
    sent: float = 0.0
    taken: float = 0.0
    orders: int = 1
    is_timed: bool = False


@dataclass(frozen=True)
class Simulated:
    """A load on some workers: how long it takes, and for how much of it the command is busy."""

    seconds: float
    command: float


def simulated(load: Load, workers: int, costs: Costs, seed: int = 0) -> Simulated:
    """Workers take chunks as they get free. The command serves one at a time."""
    rng, size_of = random.Random(seed), load.steps // load.orders
    times = rng.choices(load.seconds, k=load.steps)
    hands = max(workers // ON_A_MACHINE, 1) if load.is_timed else workers
    free = [(0.0, number) for number in range(hands)]
    knows: dict[int, int] = {}
    clock = busy = end = 0.0
    at = 0
    while at < load.steps:
        ready, number = heapq.heappop(free)
        order = at // size_of
        size = 1 if load.is_timed else chunk_size(load.steps - at, hands)
        size = min(size, (order + 1) * size_of - at) if order < load.orders - 1 else min(size, load.steps - at)
        is_new = knows.get(number) != order
        knows[number] = order
        served = costs.task + size * (costs.row + load.taken * costs.byte) + is_new * load.sent * costs.byte
        clock, busy = max(clock, ready) + served, busy + served
        done = clock + sum(times[at : at + size]) + is_new * load.prepare
        heapq.heappush(free, (done, number))
        at, end = at + size, max(end, done)
    return Simulated(end, busy)


def rows(name: str, loads: Sequence[Load], costs: Costs) -> list[dict[str, Any]]:
    """A row for each number of workers; the loads are measured one after the other.

    From the row before the time grows as workers^exponent: -1 where twice as many take half the time.
    """
    alone = sum(simulated(load, 1, costs).seconds for load in loads)
    made: list[dict[str, Any]] = []
    fewer: tuple[int, float] | None = None
    for workers in WORKERS:
        found = [simulated(load, workers, costs) for load in loads]
        took = costs.start + sum(one.seconds for one in found)
        row = {"work": name, "workers": workers, "minutes": round(took / 60, 1), "times faster": round(alone / took, 1)}
        made.append(row | {"workers busy %": round(100 * alone / took / workers)})
        made[-1]["command busy %"] = round(100 * sum(one.command for one in found) / took, 1)
        made[-1]["exponent"] = fewer and exponent((fewer[0], workers), (fewer[1], took))
        fewer = workers, took
    return made


def loads_of(record: Mapping[str, Any]) -> dict[str, list[Load]]:
    """The work of a record: by name the loads, one after the other."""
    times, sizes = record["seconds"], record["bytes"]
    everything = [
        Load(times[one["table"]], one["steps"], one["prepare"], 0.0, sizes[one["table"]], is_timed=one["timed"])
        for one in record["everything"]
    ]
    scenes = record["scenes"]
    render = Load(
        times["render"],
        scenes["count"] * scenes["rows"],
        scenes["prepare"],
        scenes["bytes"],
        sizes["render"],
        scenes["count"],
    )
    return {"all encodings, storages and sets": everything, f"render, {scenes['count']} scenes": [render]}


def table(record: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The rows of every work in a record."""
    costs = Costs(**record["costs"])
    return [row for name, loads in loads_of(record).items() for row in rows(name, loads, costs)]


def recorded(run: Path) -> dict[str, Any]:
    """What a run says of its steps: by table their seconds, and the mean bytes of their pictures. Raises UsageError."""
    try:
        steps = json.loads((run / TIMES).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise UsageError(f"{run / TIMES} cannot be read ({error}); name a run that was measured with --on") from error
    names = list(dict.fromkeys(step["table"] for step in steps))
    of = {name: [step for step in steps if step["table"] == name] for name in names}
    seconds = {name: [round(step["seconds"], 3) for step in part] for name, part in of.items()}
    sizes = {name: round(sum(step["bytes"] for step in part) / len(part)) for name, part in of.items()}
    return {"seconds": seconds, "bytes": sizes}


def measured_costs() -> Costs:
    """What a task, a row and a byte cost here, with two workers."""
    from .about import about
    from .crew import Crew
    from .local import LocalProcesses
    from .tasks import nothing

    own, began = about(), time.perf_counter()
    processes = LocalProcesses(2)
    crew = Crew(processes.address, own)
    try:
        while len(crew.admission) < 2:
            crew.lost()
            crew.arrival()
        start = time.perf_counter() - began
        task = _through(crew, TASKS, lambda address: crew.send(address, "", nothing)) / TASKS
        data = bytes(BYTES)
        byte = _through(crew, 8, lambda address: crew.send(address, "", nothing, data)) / (8 * BYTES)
    finally:
        crew.close()
        processes.close()
    return Costs(round(start, 2), round(task, 6), round(_row_cost(), 6), float(f"{byte:.2g}"))


def _through(crew: Any, count: int, send: Callable[[str], None]) -> float:
    """Seconds for so many tasks, each worker having one at a time."""
    began, sent, back = time.perf_counter(), 0, 0
    while back < count:
        for address in crew.idle()[: count - sent]:
            send(address)
            sent += 1
        back += crew.arrival() is not None
    return time.perf_counter() - began


def _row_cost() -> float:
    with tempfile.TemporaryDirectory() as folder, journal(Path(folder) / "rows") as kept:
        began = time.perf_counter()
        for _ in range(200):
            kept.add(ROW)
        return (time.perf_counter() - began) / 200


def main(words: list[str]) -> None:
    """Print the table of a record, or make a record."""
    if words[:1] == ["--record"]:
        run, path = map(Path, words[1:])
        before = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        made = before | recorded(run) | {"costs": asdict(measured_costs())}
        path.write_text(json.dumps(made) + "\n", encoding="utf-8")
        return
    print(written(table(json.loads(Path(words[0]).read_text(encoding="utf-8"))), "table"), end="")


if __name__ == "__main__":
    main(sys.argv[1:])
