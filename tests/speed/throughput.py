"""The speed of the quality table's rows, compared with C, NumPy and reading the input once.

All of them encode, store in 8-bit UNORM, decode and measure the same normals, on all cores in one run. C's row is
the angle's mean, RMS, maximum and histogram. With -ffast-math, C may round differently.
"""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from dataclasses import dataclass

import jax
import numpy as np

from normalbench.bench.ground.machine.cores import cores
from normalbench.bench.ground.native.library import compiler
from normalbench.bench.shaders.code.twin import NoTwinError
from normalbench.bench.subjects.normals.normal_sets import from_arrays
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.codecs.encoding import Encoding
from normalbench.encodings.storages.storage import STORAGES

from . import c_baseline
from . import numpy_baseline as baseline
from .timing import Row, Task, rates

# Counts are rounded down to a multiple of so many normals: blocks for every core.
WHOLE = 2**15 * cores()
STORAGE = "rgba8"
# Normals that NumPy takes at once where its arrays are to stay in a core's cache.
BLOCK = 2**14
# To read the input an encoding of C's is compiled with it.
ANY_IN_C = next(iter(c_baseline.ENCODINGS))


@dataclass(frozen=True)
class Normals:
    """Directions and view positions, float32 of shape (count, 3)."""

    n: np.ndarray
    view: np.ndarray


def normals(count: int, seed: int = 0) -> Normals:
    """Return directions, uniform on the sphere, and positions in front of the eye."""
    rng = np.random.default_rng(seed)
    n = rng.normal(size=(count, 3)).astype(np.float32)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    return Normals(n, rng.uniform((-1, -1, -2), (1, 1, -1), (count, 3)).astype(np.float32))


def rows(encodings: Sequence[Encoding], counts: Sequence[int]) -> list[Row]:
    """Return a row for each encoding and count, with rates in million normals per second, and their ratios."""
    measured: list[Row] = []
    for count in dict.fromkeys(count // WHOLE * WHOLE for count in counts):
        data = normals(count)
        in_c, _ = by_c(ANY_IN_C, "reading", data)
        reading = rates(in_c, count)[0] if in_c else None
        measured += [measure(encoding, data, reading) for encoding in encodings]
    return measured


def measure(encoding: Encoding, data: Normals, reading: float | None) -> Row:
    """Return one row; for an encoding written only in GLSL, the row has a reason instead of rates.

    Args:
        reading: the rate at which C reads the normals; None if it cannot be compiled.
    """
    count = len(data.n)
    row: Row = {"encoding": encoding.name, "count": count, "device": f"{jax.devices()[0].device_kind}, {cores()} cores"}
    in_c, no_c = by_c(encoding.name, "row", data)
    try:
        rate, *theirs = rates([by_jax(encoding, data), *in_c], count)
    except NoTwinError as error:
        return row | {"skipped": str(error)}
    others = {"c": theirs[0] if theirs else None, "reading": reading}
    others |= dict.fromkeys(("numpy", "numpy_blocked")) | _by_numpy(encoding.name, data)
    ratios = {f"times_{name}": rate / other if other else None for name, other in others.items()}
    return row | {"rate": rate} | others | ratios | {"no_c": no_c, "compiler": compiler() if in_c else None}


def by_jax(encoding: Encoding, data: Normals) -> Task:
    """Return the work of the program's own row."""
    given = from_arrays("", "", data.n, data.view, np.ones(len(data.n), bool))
    case = quality.QualityCase(Codec(encoding, STORAGES[STORAGE]), given, "jax")
    return lambda: quality.measure(case)


def by_c(name: str, function: str, data: Normals) -> tuple[list[Task], str | None]:
    """Return the work of one of C's functions, or the reason why it is missing."""
    if missing := c_baseline.missing(name):
        return [], missing
    try:
        return [c_baseline.work(name, function, data.n, data.view)], None
    except (OSError, subprocess.SubprocessError) as error:
        return [], f"cc cannot compile {name}: {error}"


def _by_numpy(name: str, data: Normals) -> dict[str, float]:
    """Return NumPy's rates over whole arrays and over blocks; empty if the encoding is not written in NumPy."""
    round_trip = baseline.BASELINES.get(name)
    if round_trip is None:
        return {}

    def over(size: int) -> None:
        for start in range(0, len(data.n), size):
            n, view = (a[start : start + size] for a in (data.n, data.view))
            baseline.whole_row(n, round_trip(n, view, baseline.quantise_unorm))

    whole, blocked = (rates([lambda size=size: over(size)], len(data.n))[0] for size in (len(data.n), BLOCK))
    return {"numpy": whole, "numpy_blocked": blocked}
