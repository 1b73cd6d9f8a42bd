"""Random directions as NumPy and JAX are timed on."""

from __future__ import annotations

from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np

from ....encodings.vec import Vec3
from ...ground.machine.cores import cores
from .normal_sets import NormalSet, from_arrays

CORES = cores()


@dataclass(frozen=True)
class Input:
    """One set of random directions and view positions, as rows for NumPy and as shards of planes for JAX."""

    n: np.ndarray
    view: np.ndarray
    shards: list[tuple[Vec3, Vec3]]

    def normal_set(self) -> NormalSet:
        """The same directions as the quality table takes them."""
        return from_arrays("", "", self.n, self.view, np.ones(len(self.n), bool))


def make_input(count: int, seed: int = 0) -> Input:
    """`count` directions, uniform on the sphere, and positions in front of the eye; float32 of shape (count, 3)."""
    rng = np.random.default_rng(seed)
    n = rng.normal(size=(count, 3)).astype(np.float32)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    view = rng.uniform((-1, -1, -2), (1, 1, -1), (count, 3)).astype(np.float32)
    parts = [
        tuple(Vec3(*(jnp.asarray(np.ascontiguousarray(a[part, i])) for i in range(3))) for a in (n, view))
        for part in np.array_split(np.arange(count), CORES)
    ]
    return Input(n, view, parts)  # type: ignore[arg-type]
