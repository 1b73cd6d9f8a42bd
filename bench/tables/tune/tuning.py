"""Fits an encoding's parameters, its numbers' bits and its look-up to normals.

Descents by the gradient of the expected error find where a search by measured errors starts from: the rounding that is
measured is the storage's own. Both are done on one half of a set; the other half is for whoever wants to know what was
gained.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.codec import LEAST_BITS, Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.rules import across
from ....encodings.storages.storage import Storage
from ....encodings.vec import Vec3, dot, maximum, minimum
from ...measures.metrics.meter import angle_between, readable
from .expected_errors import Normals, moved_squares, smooth_objective

# Normals that are descended on, and that a measured error is of, at most.
DESCENDED, MEASURED = 2**15, 2**20
# Where descents start from, besides the published values; steps of the search after them, in shares of the range.
STARTS, STEPS = 6, tuple(2.0**-k for k in range(4, 15))
# Digits of what is found: a name or a macro says all of it.
DIGITS = 6
# How many normals a texel's centre may count as, of a look-up that is fitted; infinitely many leave it alone.
PRIORS = (0.25, 1.0, 4.0, 16.0, math.inf)

Values = dict[str, float]


@dataclass(frozen=True)
class Tuned:
    """A codec, the values of its parameters, and its error on the normals that it was fitted to."""

    codec: Codec
    values: Values
    error: float


class Scale:
    """Values of parameters as numbers from 0 to 1: by their logarithm where they are never below 0."""

    def __init__(self, encoding: Encoding):
        self.names = [p.name for p in encoding.parameters]
        self._is_log = np.array([p.least > 0 for p in encoding.parameters], bool)
        self._ends = self._log_values(np.array([(p.least, p.most) for p in encoding.parameters]).reshape(-1, 2).T)

    def _log_values(self, values: np.ndarray) -> np.ndarray:
        return np.where(self._is_log, np.log(np.where(self._is_log, values, 1.0)), values)

    def shares(self, values: Mapping[str, float]) -> np.ndarray:
        """Numbers from 0 to 1 for values."""
        low, high = self._ends
        return (self._log_values(np.array([values[name] for name in self.names])) - low) / (high - low)

    def values(self, shares: np.ndarray) -> Values:
        """And back, of so many digits as a name says."""
        low, high = self._ends
        bent = low + np.clip(shares, 0.0, 1.0) * (high - low)
        straight = np.where(self._is_log, np.exp(np.where(self._is_log, bent, 0.0)), bent)
        return {name: float(f"{value:.{DIGITS}g}") for name, value in zip(self.names, straight, strict=True)}

    def slopes(self, values: np.ndarray, slopes: np.ndarray) -> np.ndarray:
        """A gradient by shares from one by values."""
        low, high = self._ends
        return slopes * np.where(self._is_log, values, 1.0) * (high - low)


def descend(codec: Codec, normals: Normals, goal: str) -> Values:
    """The values with the least expected error that descents from several places find."""
    from scipy.optimize import minimize

    scale = Scale(codec.encoding)
    with jax.enable_x64(True):
        objective = smooth_objective(codec, goal, *normals.some(DESCENDED).planes(np.float64))

        def logarithm(shares: np.ndarray) -> tuple[float, np.ndarray]:
            values = np.array(list(scale.values(shares).values()))
            error, slope = (np.asarray(a) for a in objective(values))
            return math.log(error), scale.slopes(values, slope) / error

        random = np.random.default_rng(0)
        published = scale.shares(codec.encoding.published)
        starts = [published, *random.uniform(0.0, 1.0, (STARTS, len(published)))]
        bounds = [(0.0, 1.0)] * len(published)
        found = [minimize(logarithm, start, jac=True, method="L-BFGS-B", bounds=bounds) for start in starts]
    return scale.values(min(found, key=lambda result: result.fun).x)


class Measure:
    """The error of a codec, its storage's rounding and all, on normals: the smaller the better.

    The values of parameters are given to what is compiled once.
    """

    def __init__(self, codec: Codec, normals: Normals, goal: str):
        self._codec, self._goal = codec, goal
        self._planes = normals.some(MEASURED).planes()
        self._call = jax.jit(self._traced_error)

    def _traced_error(self, values: Mapping[str, Any], n: Vec3, view: Vec3):
        encoding = self._codec.encoding
        encode, decode = (partial(function, **values) for function in (encoding.encode, encoding.decode))
        codec = replace(self._codec, encoding=replace(encoding, encode=encode, decode=decode))
        decoded, _ = readable(n, codec.round_trip(n, view))
        difference = n - decoded
        angle = angle_between(n, decoded)
        errors = {"psnr": dot(difference, difference), "rms": angle * angle, "mean": angle, "max": angle}
        return (jnp.max if self._goal == "max" else jnp.mean)(errors[self._goal])

    def __call__(self, values: Mapping[str, float]) -> float:
        found = float(self._call({name: jnp.float32(value) for name, value in values.items()}, *self._planes))
        return found if math.isfinite(found) else math.inf


def search(codec: Codec, normals: Normals, goal: str, starts: list[Values]) -> Tuned:
    """From the best of some values on, each is changed by ever smaller steps as long as the measured error falls."""
    measure, scale = Measure(codec, normals, goal), Scale(codec.encoding)
    least, values = min(((measure(start), start) for start in starts), key=lambda found: found[0])
    for step, axis in itertools.product(STEPS, range(len(scale.names))):
        for sign in (1, -1):
            while True:
                tried = scale.values(scale.shares(values) + sign * step * np.eye(len(scale.names))[axis])
                error = measure(tried)
                if error >= least:
                    break
                least, values = error, tried
    return Tuned(codec, values, least)


def wanted_bits(codec: Codec, values: Values, normals: Normals) -> dict[int, float]:
    """For each free component how many bits it should have, of those that they have together.

    Errors are the sum of a square A_i 4^-b_i for each, least under a sum of bits where all of these are the same:
    b_i = B / k + log4(A_i / geometric mean of A).
    """
    free = free_components(codec)
    with jax.enable_x64(True):
        n, view = normals.some(DESCENDED).planes(np.float64)
        code = codec.encoding.encode(n, view, **values)
        held = type(code)(*(minimum(maximum(c, -1.0), 1.0) for c in code))
        moved = moved_squares(codec, values, held, view)
        means = [float(jnp.nanmean(jnp.where(jnp.isfinite(moved[i]), moved[i], jnp.nan))) for i in free]
    logs = np.log(np.maximum(means, 1e-30)) / math.log(4)
    shared = sum(codec.storage.bits[i] for i in free) / len(free)
    return {i: shared + float(log) for i, log in zip(free, logs - logs.mean(), strict=True)}


def free_components(codec: Codec) -> list[int]:
    """The components whose bits may go to another: two or more numbers in fixed point, not of few values; or none."""
    encoding = codec.encoding
    free = [i for i in range(encoding.components) if not encoding.levels_of(i)]
    is_fixed = codec.storage.kind != "float" and not codec.storage.is_full
    return free if is_fixed and len(free) > 1 and not encoding.look_up and not encoding.searches else []


def spreads(codec: Codec, wanted: Mapping[int, float]) -> Iterator[Storage]:
    """Storages of as many bits as the codec has, each free component's within 1 of what is wanted, but its own."""
    own = codec.storage.bits[: codec.encoding.components]
    around = [(math.floor(wanted[i]), math.ceil(wanted[i])) if i in wanted else (b, b) for i, b in enumerate(own)]
    for bits in dict.fromkeys(itertools.product(*around)):
        if sum(bits) == sum(own) and bits != own and min(bits[i] for i in wanted) >= LEAST_BITS:
            storage = across(codec.storage.kind, bits)
            if replace(codec, storage=storage).fits:
                yield storage


def fitted(codec: Codec, normals: Normals, goal: str, names: list[str], with_bits: bool) -> Tuned:
    """The values of the parameters `names`, and where `with_bits` the spread of bits, with the least measured error.

    What is not better than what was published stays as it is.
    """
    chosen = tuple(p for p in codec.encoding.parameters if p.name in names)
    codec = replace(codec, encoding=replace(codec.encoding, parameters=chosen))
    published = codec.encoding.published
    found = _tuned_with_storage(codec, normals, goal, [published])
    if not with_bits or not free_components(codec):
        return found
    storages = spreads(codec, wanted_bits(codec, found.values, normals))
    others = (
        _tuned_with_storage(replace(codec, storage=s), normals, goal, [found.values, published]) for s in storages
    )
    return min([found, *others], key=lambda tuned: tuned.error)


def _tuned_with_storage(codec: Codec, normals: Normals, goal: str, starts: list[Values]) -> Tuned:
    if codec.encoding.parameters:
        starts = [*starts, descend(codec, normals, goal)]
    return search(codec, normals, goal, starts)


def fitted_table(codec: Codec, normals: Normals, goal: str) -> np.ndarray:
    """The look-up with the least squared error on normals.

    How much a texel's centre counts beside the few normals that it may have is decided between two halves of them.
    """
    look_up, levels = codec.encoding.look_up, codec.storage.count(0)
    assert look_up
    halves = [Normals(normals.n[i::2], normals.view[i::2]) for i in (0, 1)]

    def table(given: Normals, prior: float) -> np.ndarray:
        counted = given.n if math.isfinite(prior) else given.n[:0]
        return look_up.fit(counted.astype(np.float64), levels, prior)

    def error(prior: float) -> float:
        encoding = codec.encoding.with_table(table(halves[0], prior), "")
        return Measure(replace(codec, encoding=encoding), halves[1], goal)({})

    return table(normals, min(PRIORS, key=error))
