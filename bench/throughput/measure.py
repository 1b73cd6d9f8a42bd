"""How fast the project measures, against NumPy, C and reading the input once, all in one run on one machine.

    python -m normalbench.bench.throughput [--count N] [--encoding NAMES]

prints JSON: million normals a second and their ratios, for encode + quantise (UNORM8) + decode + error. Statistics are
"moments" (squared error and its maximum, the least that can be asked) and "row" (the whole row of the quality table,
percentiles included, as `normalbench quality` measures it). C's row is the angle's mean, RMS, maximum and histogram;
it is null, and `no_c` says why, where there is no C of the encoding or no compiler. C and the project take turns, and
the best of each counts.
"""

from __future__ import annotations

import argparse
import itertools
import json
import subprocess
import sys
import time
from collections.abc import Callable, Sequence

import jax
import jax.numpy as jnp

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.codec import Codec
from ...encodings.storages.storage import STORAGES
from ...encodings.vec import Vec3
from ..machine.cores import on_all_cores
from ..metrics.meter import Meter
from ..metrics.moments import FAST_BLOCK, LANES, squared_errors
from ..normals.directions import CORES, Input, make_input
from ..options.counts import MAX_TIMED_COUNT
from ..output.errors import UsageError, pick
from ..results.machine import machine
from . import c_baseline
from . import numpy_baseline as baseline

BLOCK = 2**14
LONG_ENOUGH = 1.0
STATISTICS = ("moments", "row")


def rate(work: Callable[[], object], count: int) -> float:
    """Million normals a second: the best of three repeats or more, for LONG_ENOUGH seconds, after one to warm up."""
    return rates([work], count)[0]


def rates(works: Sequence[Callable[[], object]], count: int) -> list[float]:
    """As `rate`, of works that take turns, so that whatever else the machine does slows all of them."""
    for work in works:
        work()
    times: list[list[float]] = [[] for _ in works]
    while len(times[0]) < 3 or sum(map(sum, times)) < LONG_ENOUGH * len(works):
        for work, taken in zip(works, times, strict=True):
            begin = time.perf_counter()
            work()
            taken.append(time.perf_counter() - begin)
    return [count / min(taken) / 1e6 for taken in times]


def reading(data: Input) -> Callable[[], object]:
    """Work that reads every plane of normals once and does next to nothing with it."""

    def total(n: Vec3):
        def step(carry, block: Vec3):
            return carry + block.x + block.y + block.z, None

        blocks = jax.tree.map(lambda a: a.reshape(-1, FAST_BLOCK), n)
        return jax.lax.scan(step, jnp.zeros(FAST_BLOCK, jnp.float32), blocks)[0].reshape(-1, LANES).sum()

    call = jax.jit(total)
    return lambda: _by_shards(lambda n, _: float(call(n)), data)


def _by_shards(function, data: Input) -> list:
    """What a function makes of each shard's planes, side by side."""
    return list(on_all_cores(lambda shard: function(*shard), data.shards))


def _numpy_blocked(round_trip, statistics, data: Input) -> list:
    parts = (slice(start, start + BLOCK) for start in range(0, len(data.n), BLOCK))
    quantise = baseline.quantise_unorm
    return [statistics(data.n[part], round_trip(data.n[part], data.view[part], quantise)) for part in parts]


def _by_project(codec: Codec, statistics: str, data: Input) -> Callable[[], object]:
    if statistics == "row":
        meter, normals = Meter(jax.jit(lambda b: codec.round_trip(b.n, b.view))), data.normal_set()
        return lambda: meter.measure(normals.loads(), len(data.n))
    errors = squared_errors(codec)
    return lambda: _by_shards(errors, data)


def _with_c(project: Callable[[], object], name: str, statistics: str, data: Input) -> tuple[float, dict[str, object]]:
    """The project's rate, and C's columns."""
    count, no_c = len(data.n), c_baseline.missing(name)
    if no_c:
        return rate(project, count), {"c": None, "times_c": None, "no_c": no_c}
    try:
        in_c = c_baseline.work(name, statistics, data.n, data.view)
    except (OSError, subprocess.SubprocessError) as error:
        return rate(project, count), {"c": None, "times_c": None, "no_c": f"cc cannot compile {name}: {error}"}
    ours, theirs = rates([project, in_c], count)
    return ours, {"c": round(theirs, 1), "times_c": round(ours / theirs, 3), "no_c": None}


def compare(name: str, statistics: str, data: Input, read: float) -> dict[str, object]:
    """One line: an encoding through UNORM8 by NumPy, NumPy in blocks, C and the project."""
    count, by_numpy = len(data.n), baseline.BASELINES[name]
    work = _by_project(Codec(ENCODINGS[name], STORAGES["rgba8"]), statistics, data)
    project, c_columns = _with_c(work, name, statistics, data)
    summary = baseline.whole_row if statistics == "row" else baseline.squared_error_and_maximum
    numpy = rate(lambda: summary(data.n, by_numpy(data.n, data.view, baseline.quantise_unorm)), count)
    blocked = rate(lambda: _numpy_blocked(by_numpy, summary, data), count)
    return {
        "encoding": name,
        "statistics": statistics,
        "numpy": round(numpy, 2),
        "numpy_blocked": round(blocked, 2),
        "project": round(project, 1),
        "times_numpy": round(project / numpy, 1),
        "times_numpy_blocked": round(project / blocked, 1),
        "share_of_reading": round(project / read, 3),
        **c_columns,
    }


def main(arguments: list[str] | None = None) -> int:
    """Run it all and print JSON."""
    parser = argparse.ArgumentParser(
        prog="python -m normalbench.bench.throughput", description="Throughput of the quality measurement"
    )
    parser.add_argument("--count", type=int, default=2**22, help="normals, rounded down to whole blocks")
    parser.add_argument("--encoding", default="all", help="encodings, comma-separated, or all")
    options = parser.parse_args(arguments)
    whole = FAST_BLOCK * CORES
    try:
        names = pick("encoding", options.encoding, {name: name for name in ENCODINGS if name in baseline.BASELINES})
        if not whole <= options.count <= MAX_TIMED_COUNT:
            raise UsageError(f"--count {options.count}: a count is {whole} to {MAX_TIMED_COUNT} (2^28)")
    except UsageError as error:
        print(f"throughput: {error}", file=sys.stderr)
        return error.exit_code
    data = make_input(options.count // whole * whole)
    read = rate(reading(data), len(data.n))
    rows = []
    for statistics, name in itertools.product(STATISTICS, names):
        print(f"throughput: {name}, {statistics}", file=sys.stderr)
        rows.append(compare(name, statistics, data, read))
    unit = "million normals a second"
    report = {"machine": machine(), "count": len(data.n), "unit": unit, "reading": round(read, 1), "rows": rows}
    print(json.dumps(report, indent=1))
    return 0
