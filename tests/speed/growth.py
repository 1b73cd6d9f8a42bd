"""The growth of the time of one kind of work with its size, all else being equal."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from types import MappingProxyType

from normalbench.bench.ground.machine.devices import require_device
from normalbench.bench.ground.options.counts import MAX_COUNT, MAX_LIGHTS, MAX_OBJECTS
from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.measures.worst_case.search import worst_case
from normalbench.bench.subjects.codecs.names import codecs_named
from normalbench.bench.subjects.normals.normal_sets import sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.sweep import measure as sweep
from normalbench.bench.tables.sweep.points import points
from normalbench.bench.tables.sweep.table import SweepOptions
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.rules import across
from normalbench.encodings.storages.storage import STORAGES

from .timing import Row, exponent, least_times

ENCODING, STORAGE = "octahedral", "rg8"
# Normals of each of several codecs.
NORMALS = 2**16
OBJECTS, LIGHTS = 100, 64


@dataclass(frozen=True)
class Kind:
    """A kind of work that is made larger.

    Attributes:
        timed: description of the work that is timed.
        seconds: seconds for a size.
        usual: default sizes, each about ten times the one before.
        least, most: smallest and largest size allowed.
    """

    timed: str
    seconds: Callable[[int], float]
    usual: tuple[int, ...]
    least: int
    most: int


def rows(over: str, sizes: Sequence[int]) -> list[Row]:
    """Return a row for each size of one of KINDS, the smallest first, with the exponent from the row before."""
    measured = [measure(over, size) for size in sorted({rounded(over, size) for size in sizes})]
    for smaller, larger in pairwise(measured):
        if smaller["seconds"] and larger["seconds"]:
            larger["exponent"] = exponent(*([row[name] for row in (smaller, larger)] for name in ("size", "seconds")))
    return measured


def measure(over: str, size: int) -> Row:
    """Return one row without its exponent, or with the reason why it has no time."""
    row: Row = {"over": over, "size": size, "timed": KINDS[over].timed, "seconds": None, "exponent": None}
    try:
        seconds = KINDS[over].seconds(size)
    except MissingError as error:
        return row | {"skipped": str(error)}
    return row | {"seconds": seconds, "microseconds_each": 1e6 * seconds / size}


def rounded(over: str, size: int) -> int:
    """Return the nearest possible size: the number of codes of two numbers with equal bits is a power of 4."""
    return 4 ** _bits(size) if over == "codes" else size


def _bits(codes: int) -> int:
    return round(math.log(codes, 4))


def _quality(codecs: list[Codec], count: int) -> float:
    cases = quality.cases(codecs, [sphere(count)], ["jax"])
    return least_times([lambda: [*quality.rows(cases, lambda _: None)]])[0]


def _normals(size: int) -> float:
    return _quality([Codec(ENCODINGS[ENCODING], STORAGES[STORAGE])], size)


def _codecs(size: int) -> float:
    """Return the seconds for codecs spread evenly over all codecs, because their costs differ; some may repeat."""
    every = [codec for codec in codecs_named(("all",), ("all",), ("nearest",)) if codec.fits]
    return _quality([every[index * len(every) // size] for index in range(size)], NORMALS)


def _codes(size: int) -> float:
    codec = Codec(ENCODINGS[ENCODING], across("unorm", (_bits(size),) * 2))
    # What was found before is kept; here it is found again.
    return least_times([lambda: worst_case.__wrapped__(codec)])[0]


def _frame(objects: int, lights: int) -> float:
    gl = require_device()
    asked = SweepOptions(pipeline="hybrid", light_targets="1", shadow="off", size="320x240", objects=str(objects))
    (point,) = points(replace(asked, lights=lights), gl)
    return sweep.measure(gl, point)["ms_frame"] / 1e3


FRAME = "a frame of the hybrid pipeline, 320x240, no shadow map"
KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        "normals": Kind("a row of the quality table", _normals, (10**6, 10**7, 10**8), 1, MAX_COUNT),
        "codecs": Kind(f"a quality table of {NORMALS} normals", _codecs, (4, 40, 400), 1, 10_000),
        "codes": Kind("the exact worst case of one codec", _codes, (4**7, 4**9, 4**11), 4**4, 4**12),
        "objects": Kind(FRAME, lambda size: _frame(size, LIGHTS), (20, 200, 2000), 1, MAX_OBJECTS),
        "lights": Kind(FRAME, lambda size: _frame(OBJECTS, size), (10, 100, 1000), 1, MAX_LIGHTS),
    }
)
