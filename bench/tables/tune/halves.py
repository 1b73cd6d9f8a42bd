"""A set of normals split into two halves: one for fitting, and one that is held out for measuring."""

from __future__ import annotations

from dataclasses import dataclass, replace

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.vec import Vec3
from ...ground.output.errors import UsageError
from ...subjects.normals.normal_sets import NormalSet, from_arrays

# A set is kept in memory, half of it in float64 for a while.
MAX_COUNT = 2**24
# The least of a half that says anything.
LEAST = 128
# Pixels a side of the squares that an image is halved by.
TILE = 16


@dataclass(frozen=True)
class Normals:
    """Unit normals and view-space positions, float32 of shape (count, 3)."""

    n: np.ndarray
    view: np.ndarray

    def __len__(self) -> int:
        return len(self.n)

    def some(self, most: int) -> Normals:
        """Return at most `most` of the normals, at even intervals in the set."""
        step = -(-len(self) // most)
        return Normals(self.n[::step], self.view[::step])

    def planes(self) -> tuple[Vec3, Vec3]:
        """Return the normals and the positions as planes, each a Vec3."""
        return tuple(Vec3(*(jnp.asarray(c) for c in a.T)) for a in (self.n, self.view))  # type: ignore[return-value]


@dataclass(frozen=True)
class Halves:
    """The normals for fitting, and the held-out normals as a set."""

    fitting: Normals
    held_out: NormalSet


def halves_of(chosen: NormalSet, seed: int, by_tiles: bool) -> Halves:
    """Return a set's covered normals, split into two random halves.

    Args:
        by_tiles: whether to split an image by square tiles instead of pixels. Needed for a lookup table, which could
            memorise single normals and reproduce them for their similar neighbours. Two parameters cannot do so; for
            them, neither half should miss rare normals.

    Raises:
        UsageError: too many or too few normals, or all normals to fit are the same.
    """
    if chosen.count > MAX_COUNT:
        raise UsageError(
            f"{chosen.name}: {chosen.count} normals are too many; tune holds at most {MAX_COUNT} in memory"
        )
    loaded = [load() for load in chosen.loads()]
    n, view, covered = jax.tree.map(lambda *parts: np.concatenate(parts)[: chosen.count], *loaded)
    n, view = (np.stack([np.asarray(c) for c in planes], axis=1) for planes in (n, view))
    group = _tile_numbers(chosen) if by_tiles else np.arange(chosen.count)
    random = np.random.default_rng(seed)
    is_fitting = (random.permutation(group.max() + 1) % 2 == 0)[group]
    fitting, others = (np.flatnonzero(covered & side) for side in (is_fitting, ~is_fitting))
    if min(len(fitting), len(others)) < LEAST:
        raise UsageError(
            f"{chosen.name}: {int(covered.sum())} normals are too few; two halves need at least {LEAST} each"
        )
    if np.ptp(n[fitting], axis=0).max() == 0:
        raise UsageError(f"{chosen.name}: all normals to fit are the same; use a set with several directions")
    held = from_arrays(chosen.name, chosen.title, n[others], view[others], np.ones(len(others), bool))
    return Halves(Normals(n[fitting], view[fitting]), replace(held, code_space=chosen.code_space))


def _tile_numbers(chosen: NormalSet) -> np.ndarray:
    """Return the tile number of each pixel; in a set without an image or with a small one, every normal is a tile."""
    index = np.arange(chosen.count)
    if not chosen.shape or min(chosen.shape) < 4 * TILE:
        return index
    width = chosen.shape[1]
    return (index // width // TILE) * -(-width // TILE) + index % width // TILE
