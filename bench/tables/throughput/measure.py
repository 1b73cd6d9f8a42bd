"""How fast the project measures, against NumPy, C and reading the input once, all in one run on one machine.

C's row is the angle's mean, RMS, maximum and histogram.
"""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import jax

from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.storage import STORAGES
from ...ground.machine.cores import on_all_cores
from ...ground.native.library import compiler
from ...measures.metrics.meter import in_groups
from ...measures.metrics.moments import FAST_BLOCK, squared_errors
from ...measures.native.meter import NativeMeter
from ...shaders.code.twin import NoTwinError
from ...subjects.normals.directions import CORES, Input, make_input
from ..quality import measure as quality
from . import c_baseline
from . import numpy_baseline as baseline
from .table import TABLE

# Every rate is of a multiple of so many normals: whole blocks on every core.
WHOLE = FAST_BLOCK * CORES
STORAGE = "rgba8"
BLOCK = 2**14
LONG_ENOUGH = 1.0
# Seconds between turns: OpenMP's threads wait awake for a few milliseconds, and would take a core from the next one.
PAUSE = 0.01
# To read the input an encoding of C's is compiled with it.
ANY_IN_C = next(iter(c_baseline.ENCODINGS))

Row = dict[str, Any]
Task = Callable[[], object]


@dataclass(frozen=True)
class Case:
    """One row: an encoding through UNORM of 8 bits; `count` is a multiple of WHOLE."""

    encoding: Encoding
    statistics: str
    count: int

    @property
    def name(self) -> str:
        return f"{self.encoding.name} {self.statistics} {self.count}"


def least_times(works: Sequence[Task]) -> list[float]:
    """Seconds of works that take turns: the least of three turns or more, for LONG_ENOUGH seconds each, after one to
    warm up."""
    for work in works:
        work()
    times: list[list[float]] = [[] for _ in works]
    while len(times[0]) < 3 or sum(map(sum, times)) < LONG_ENOUGH * len(works):
        for work, taken in zip(works, times, strict=True):
            time.sleep(PAUSE)
            begin = time.perf_counter()
            work()
            taken.append(time.perf_counter() - begin)
    return [min(taken) for taken in times]


def rates(works: Sequence[Task], count: int) -> list[float]:
    """Million normals a second of works on so many, by their least times."""
    return [count / taken / 1e6 for taken in least_times(works)]


@lru_cache(maxsize=1)
def _input(count: int) -> Input:
    return make_input(count)


@lru_cache(maxsize=1)
def _reading_rate(count: int) -> float | None:
    """By C, which is the fastest; None where it cannot be compiled."""
    in_c, _ = _by_c(ANY_IN_C, "reading", _input(count))
    return rates(in_c, count)[0] if in_c else None


def _by_shards(function: Callable[..., object], data: Input) -> list[object]:
    """What a function makes of each shard's planes, side by side."""
    return list(on_all_cores(lambda shard: function(*shard), data.shards))


def _project(case: Case, data: Input) -> Task:
    row = quality.Case(Codec(case.encoding, STORAGES[STORAGE]), data.normal_set(), "jax")
    if case.statistics == "row":
        return lambda: quality.measure(row)
    meter = quality.meter_of(row.codec, row.is_compiled)
    if isinstance(meter, NativeMeter):
        groups = [*in_groups(row.normal_set.loads(), row.at_once)]
        return lambda: [*on_all_cores(meter.moments, groups)]
    errors = squared_errors(row.codec)
    return lambda: _by_shards(errors, data)


def _by_c(name: str, statistics: str, data: Input) -> tuple[list[Task], str | None]:
    """C's work, and why there is none."""
    if missing := c_baseline.missing(name):
        return [], missing
    try:
        return [c_baseline.work(name, statistics, data.n, data.view)], None
    except (OSError, subprocess.SubprocessError) as error:
        return [], f"cc cannot compile {name}: {error}"


def _by_numpy(case: Case, data: Input) -> list[Task]:
    """NumPy's work over whole arrays, and over blocks; none where the encoding is not written in NumPy."""
    round_trip = baseline.BASELINES.get(case.encoding.name)
    if round_trip is None:
        return []
    summary = baseline.whole_row if case.statistics == "row" else baseline.squared_error_and_maximum

    def over(size: int) -> list[object]:
        parts = (slice(start, start + size) for start in range(0, len(data.n), size))
        quantise = baseline.quantise_unorm
        return [summary(data.n[p], round_trip(data.n[p], data.view[p], quantise)) for p in parts]

    return [lambda: over(len(data.n)), lambda: over(BLOCK)]


def measure(case: Case) -> Row:
    """One row of the table; one without figures, and why, for an encoding that is written in GLSL alone."""
    row = TABLE.empty() | {"encoding": case.encoding.name, "statistics": case.statistics, "count": case.count}
    row |= {"device": f"{jax.devices()[0].device_kind}, {CORES} cores"}
    data = _input(case.count)
    try:
        in_c, no_c = _by_c(case.encoding.name, case.statistics, data)
        rate, *theirs = rates([_project(case, data), *in_c], case.count)
    except NoTwinError as error:
        return row | {"skipped": str(error)}
    reading, by_numpy = _reading_rate(case.count), [rates([work], case.count)[0] for work in _by_numpy(case, data)]
    found: Row = {"rate": rate, "reading": reading, "no_c": no_c}
    found["share_of_reading"] = rate / reading if reading else None
    others = dict(zip(("c", "numpy", "numpy_blocked"), [*(theirs or [None]), *by_numpy], strict=False))
    ratios = {f"times_{name}": rate / other for name, other in others.items() if other}
    return row | found | others | ratios | {"compiler": compiler() if in_c else None}
