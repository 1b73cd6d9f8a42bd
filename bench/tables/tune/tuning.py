"""A search for the parameters and lookup table of an encoding that minimise the measured error over normals.

The error includes the rounding of the storage. The search uses one half of a set; the other half measures the gain.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.vec import Vec3, dot
from ...measures.metrics.meter import angle_between, readable
from .halves import Normals

# Normals that a measured error is of, at most.
MEASURED = 2**20
# Random values that are tried, and the best of them, which searches begin at; steps, in shares of the range.
RANDOM, STARTS, STEPS = 256, 8, tuple(2.0**-k for k in range(4, 15))
# Digits of what is found: a name or a macro says all of it.
DIGITS = 6
# How many normals a texel's centre may count as, of a look-up that is fitted; infinitely many leave it alone.
PRIORS = (0.25, 1.0, 4.0, 16.0, math.inf)

Values = dict[str, float]


class Scale:
    """Conversion between parameter values and numbers from 0 to 1, logarithmic for positive parameters."""

    def __init__(self, encoding: Encoding):
        self.names = [p.name for p in encoding.parameters]
        self._is_log = np.array([p.least > 0 for p in encoding.parameters], bool)
        self._ends = self._log_values(np.array([(p.least, p.most) for p in encoding.parameters]).reshape(-1, 2).T)

    def _log_values(self, values: np.ndarray) -> np.ndarray:
        return np.where(self._is_log, np.log(np.where(self._is_log, values, 1.0)), values)

    def shares(self, values: Mapping[str, float]) -> np.ndarray:
        """Return numbers from 0 to 1: the positions of parameter values within their ranges."""
        low, high = self._ends
        return (self._log_values(np.array([values[name] for name in self.names])) - low) / (high - low)

    def values(self, shares: np.ndarray) -> Values:
        """Return the parameter values at positions from 0 to 1, rounded to the digits that a name shows."""
        low, high = self._ends
        bent = low + np.clip(shares, 0.0, 1.0) * (high - low)
        straight = np.where(self._is_log, np.exp(np.where(self._is_log, bent, 0.0)), bent)
        return {name: float(f"{value:.{DIGITS}g}") for name, value in zip(self.names, straight, strict=True)}


class Measure:
    """The error of a codec over normals, including the rounding of the storage; lower is better.

    Parameter values are arguments of the program, so that it is compiled only once.
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
        error = float(self._call({name: jnp.float32(value) for name, value in values.items()}, *self._planes))
        return error if math.isfinite(error) else math.inf


def search(codec: Codec, normals: Normals, goal: str) -> Values:
    """Return the parameter values with the smallest measured error that searches find; they start from the published
    values and from the best of many random values.

    The published values are kept if no other values are better.
    """
    measure, scale = Measure(codec, normals, goal), Scale(codec.encoding)
    random = np.random.default_rng(0).uniform(0.0, 1.0, (RANDOM, len(scale.names)))
    starts = [codec.encoding.published, *sorted(map(scale.values, random), key=measure)[:STARTS]]
    return min((_searched(measure, scale, start) for start in starts), key=measure)


def _searched(measure: Measure, scale: Scale, values: Values) -> Values:
    """Return the values after a local search with ever smaller steps, each repeated while the error falls."""
    ways = [np.array(way) for way in itertools.product((-1, 0, 1), repeat=len(scale.names)) if any(way)]
    for step in STEPS:
        while True:
            tried = min((scale.values(scale.shares(values) + step * way) for way in ways), key=measure)
            if measure(tried) >= measure(values):
                break
            values = tried
    return values


def fitted(codec: Codec, normals: Normals, goal: str, names: list[str]) -> Values:
    """Return the values of the named parameters with the smallest measured error; empty without such parameters."""
    chosen = tuple(p for p in codec.encoding.parameters if p.name in names)
    return search(replace(codec, encoding=replace(codec.encoding, parameters=chosen)), normals, goal) if chosen else {}


def fitted_table(codec: Codec, normals: Normals, goal: str) -> np.ndarray:
    """Return the lookup table fitted to normals.

    A texel's centre is weighed against its normals, which may be few. The weight is chosen by fitting to one half of
    the normals and measuring the error on the other.
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
