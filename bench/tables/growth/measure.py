"""What is timed of each kind, at one size."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import jax

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.codec import Codec
from ....encodings.storages.storage import STORAGES, across
from ...ground.machine.devices import require_device
from ...ground.output.errors import MissingError
from ...measures.worst_case.search import worst_case
from ...subjects.codecs.names import codecs_named
from ...subjects.normals.normal_sets import sphere
from ..quality import measure as quality
from ..sweep import measure as sweep
from ..sweep.points import points
from ..sweep.table import SweepOptions
from ..throughput.measure import least_times
from .table import KINDS, TABLE

ENCODING, STORAGE = "octahedral", "rg8"
# Normals of each of several codecs.
NORMALS = 2**16
OBJECTS, LIGHTS = 100, 64

Row = dict[str, Any]


@dataclass(frozen=True)
class Case:
    """One row to measure: one of KINDS, at a size that `rounded` gives."""

    over: str
    size: int

    @property
    def name(self) -> str:
        return f"{self.size} {self.over}"


def rounded(over: str, size: int) -> int:
    """The nearest size that there is: two numbers of equal bits have a power of 4 codes."""
    return 4 ** _bits(size) if over == "codes" else size


def _bits(codes: int) -> int:
    return round(math.log(codes, 4))


def _quality(codecs: list[Codec], count: int) -> float:
    cases = quality.cases(codecs, [sphere(count)], ["jax"])
    return least_times([lambda: [*quality.rows(cases, lambda _: None)]])[0]


def _normals(size: int) -> float:
    return _quality([Codec(ENCODINGS[ENCODING], STORAGES[STORAGE])], size)


def _codecs(size: int) -> float:
    """Evenly from all that there are, since they differ in what they take; some come again where there are fewer."""
    every = [codec for codec in codecs_named("all", "all", "nearest") if codec.fits]
    return _quality([every[at * len(every) // size] for at in range(size)], NORMALS)


def _codes(size: int) -> float:
    codec = Codec(ENCODINGS[ENCODING], across("unorm", (_bits(size),) * 2))
    return least_times([lambda: worst_case.__wrapped__(codec)])[0]


def _frame(objects: int, lights: int) -> float:
    gl = require_device()
    asked = SweepOptions(pipeline="hybrid", light_targets="1", shadow="off", size="320x240", objects=str(objects))
    (point,) = points(replace(asked, lights=lights), gl)
    return sweep.measure(gl, point)["ms_frame"] / 1e3


SECONDS: Mapping[str, Callable[[int], float]] = MappingProxyType(
    {
        "normals": _normals,
        "codecs": _codecs,
        "codes": _codes,
        "objects": lambda size: _frame(size, LIGHTS),
        "lights": lambda size: _frame(OBJECTS, size),
    }
)


def measure(case: Case) -> Row:
    """One row without its exponent, or the reason why there is none."""
    kind = KINDS[case.over]
    row = TABLE.empty() | {"over": case.over, "size": case.size, "timed": kind.says}
    try:
        seconds = SECONDS[case.over](case.size)
    except MissingError as error:
        return row | {"skipped": str(error)}
    device = require_device().renderer if kind.draws else jax.devices()[0].device_kind
    return row | {"seconds": seconds, "microseconds_each": 1e6 * seconds / case.size, "device": device}
