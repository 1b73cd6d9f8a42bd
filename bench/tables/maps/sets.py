"""Two built-in tangent-space normal maps: a smooth map and a map of noise."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from types import MappingProxyType

import numpy as np

from ...subjects.normals.normal_sets import NormalSet, from_arrays

SIZE = 256
# The root of the mean squared slope of both surfaces.
SLOPE = 0.35
# The smooth one: so many waves of up to so many periods across the map, the longer the higher.
WAVES, MOST_PERIODS = 24, 6
SEED = 0


def _bumps() -> np.ndarray:
    """Return the slopes along x and y of a sum of waves, of shape (SIZE, SIZE, 2); the map can be tiled."""
    random = np.random.default_rng(SEED)
    periods = random.integers(-MOST_PERIODS, MOST_PERIODS + 1, (WAVES, 2))
    periods = periods[np.any(periods != 0, axis=1)]
    phases = random.uniform(0, 2 * np.pi, len(periods))
    place = 2 * np.pi * np.arange(SIZE) / SIZE
    angles = periods[:, 0, None, None] * place + periods[:, 1, None, None] * place[:, None] + phases[:, None, None]
    # A height of cos(f x) / |f| has the slope -f/|f| sin(f x).
    along = periods / np.linalg.norm(periods, axis=1, keepdims=True)
    return np.einsum("kc,kyx->yxc", along, -np.sin(angles))


def _grain() -> np.ndarray:
    """Return normally distributed slopes, independent for every texel, of shape (SIZE, SIZE, 2)."""
    return np.random.default_rng(SEED).normal(size=(SIZE, SIZE, 2))


def _normal_map(name: str, title: str, slopes: np.ndarray) -> NormalSet:
    slopes = slopes * (SLOPE / np.sqrt(np.mean(slopes**2)))
    n = np.concatenate([-slopes, np.ones((SIZE, SIZE, 1))], axis=-1)
    n = (n / np.linalg.norm(n, axis=-1, keepdims=True)).astype(np.float32)
    view = np.broadcast_to(np.array([0, 0, -1], np.float32), n.shape)
    return from_arrays(name, title, n, view, np.ones(n.shape[:2], bool), n.shape[:2])


@cache
def bumps() -> NormalSet:
    """Return a smooth normal map made of waves."""
    return _normal_map("bumps", "a smooth normal map", _bumps())


@cache
def grain() -> NormalSet:
    """Return a normal map of noise, independent for every texel."""
    return _normal_map("grain", "a normal map of noise", _grain())


MAPS: Mapping[str, Callable[[], NormalSet]] = MappingProxyType({"bumps": bumps, "grain": grain})
