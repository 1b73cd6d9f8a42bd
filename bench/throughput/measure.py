"""How fast the project measures, against NumPy and against reading the input once, all in one run on one machine.

    python -m normalbench.bench.throughput [--count N] [--encoding NAMES]

prints JSON: million normals a second and their ratios, for encode + quantise (UNORM8) + decode + error. Statistics are
"moments" (squared error and its maximum, the least that can be asked) and "row" (the whole row of the quality table,
percentiles included, as `normalbench quality` measures it).
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
import time
from collections.abc import Callable

import jax
import jax.numpy as jnp

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.codec import Codec
from ...encodings.storages.storage import STORAGES
from ...encodings.vec import Vec3
from ..machine.cores import on_all_cores
from ..metrics.meter import FAST_BLOCK, LANES, Meter, compiled, squared_errors
from ..normals.directions import CORES, Input, make_input
from ..options.counts import MAX_TIMED_COUNT
from ..output.errors import UsageError, pick
from ..results.machine import machine
from . import numpy_baseline as baseline

BLOCK = 2**14
LONG_ENOUGH = 1.0
STATISTICS = ("moments", "row")


def rate(work: Callable[[], object], count: int) -> float:
    """Million normals a second: the best of three repeats or more, for LONG_ENOUGH seconds, after one to warm up."""
    work()
    times: list[float] = []
    while len(times) < 3 or sum(times) < LONG_ENOUGH:
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return count / min(times) / 1e6


def reading(data: Input) -> Callable[[], object]:
    """Work that reads every plane of normals once and does next to nothing with it."""

    def total(n: Vec3):
        def step(carry, block: Vec3):
            return carry + block.x + block.y + block.z, None

        blocks = jax.tree.map(lambda a: a.reshape(-1, FAST_BLOCK), n)
        return jax.lax.scan(step, jnp.zeros(FAST_BLOCK, jnp.float32), blocks)[0].reshape(-1, LANES).sum()

    call = compiled(total)
    return lambda: _by_shards(lambda n, _: float(call(n)), data)


def _by_shards(function, data: Input) -> list:
    """What a function makes of each shard's planes, side by side."""
    return list(on_all_cores(lambda shard: function(*shard), data.shards))


def _numpy_blocked(round_trip, statistics, data: Input) -> list:
    parts = (slice(start, start + BLOCK) for start in range(0, len(data.n), BLOCK))
    quantise = baseline.quantise_unorm
    return [statistics(data.n[part], round_trip(data.n[part], data.view[part], quantise)) for part in parts]


def compare(name: str, statistics: str, data: Input, read: float) -> dict[str, object]:
    """One line: an encoding through UNORM8 by NumPy, NumPy in blocks, and the project."""
    count = len(data.n)
    codec = Codec(ENCODINGS[name], STORAGES["rgba8"])
    by_numpy = baseline.BASELINES[name]
    summary = baseline.whole_row if statistics == "row" else baseline.squared_error_and_maximum
    if statistics == "row":
        meter, normals = Meter(jax.jit(lambda b: codec.round_trip(b.n, b.view))), data.normal_set()
        project = rate(lambda: meter.measure(normals.loads(), count), count)
    else:
        errors = squared_errors(codec)
        project = rate(lambda: _by_shards(errors, data), count)
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
