"""A search for the worst mix of an operation, from the worst mixes of a sample: a sample's largest error is no bound.

Patches are rotated as a whole, so that the angles between neighbours are unchanged, and their weights are varied. A
mix with a larger error is kept; steps grow after a success and shrink otherwise. The model computes the mixes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .patches import ALPHAS, FRACTION_BITS, Mixes, rounded
from .reference import angles_between, unit_rows

# Mixes that are climbed from, what is tried of each in a round, and rounds.
STARTS, TRIES, ROUNDS = 24, 16, 80
GROWS, SHRINKS = 1.6, 0.8
# Of a filter's place between texels, as a share of the step in degrees.
SHARE_OF_STEP = 0.1

# Mixes -> the error of each in degrees, -1 where the encoding cannot hold it.
Errors = Callable[[Mixes], np.ndarray]


def climbed(mixes: Mixes, errors: np.ndarray, of: Errors, seed: int) -> Mixes:
    """Return the worst mix that a random search finds, as `Mixes` with a single patch.

    Args:
        mixes: the sample; its patches are rotated if they may be anywhere on the sphere.
        errors: error of each mix in the sample.
        of: function that returns the errors of other mixes.
    """
    random = np.random.default_rng([seed, 3])
    best = chosen(mixes, np.argsort(errors)[::-1][:STARTS])
    known, steps = of(best), np.full(len(best.alphas), mixes.patches.angle_deg or 1.0)
    for _ in range(ROUNDS):
        tried = _moved(chosen(best, np.repeat(np.arange(len(known)), TRIES)), np.repeat(steps, TRIES), random)
        tried_errors = of(tried).reshape(-1, TRIES)
        indices = tried_errors.argmax(axis=1)
        largest = tried_errors.max(axis=1)
        is_better = largest > known
        places = np.arange(len(known)) * TRIES + indices
        best = _chosen_mixes(is_better, chosen(tried, places), best)
        known, steps = np.maximum(known, largest), steps * np.where(is_better, GROWS, SHRINKS)
    return chosen(best, np.array([known.argmax()]))


def chosen(mixes: Mixes, index: np.ndarray) -> Mixes:
    """Return the mixes with these indices."""
    patches = mixes.patches
    patches = replace(patches, count=len(index), normals=patches.normals[:, index], views=patches.views[index])
    return replace(mixes, patches=patches, **{name: getattr(mixes, name)[index] for name in OF_EACH})


OF_EACH = ("shares", "quarters", "counts", "alphas", "decals", "details")


def _moved(mixes: Mixes, steps: np.ndarray, random: np.random.Generator) -> Mixes:
    """Return mixes with randomly changed rotations and weights; `steps` are the changes in degrees, (patches,)."""
    count, patches = len(steps), mixes.patches
    turn = _random_rotations(steps * random.standard_normal(count) * patches.is_anywhere, random)
    moved = mixes.shares + SHARE_OF_STEP * steps[:, None] * random.standard_normal((count, 2))
    unit = 2**FRACTION_BITS
    alphas = np.clip(mixes.alphas + random.integers(-1, 2, count) / 10, ALPHAS[0], ALPHAS[-1])
    normals = rounded(np.einsum("pij,tpj->tpi", turn, patches.normals))
    decals = np.einsum("pij,pj->pi", turn, mixes.decals)
    return replace(
        mixes,
        patches=replace(patches, normals=normals),
        shares=np.clip(np.rint(moved * unit), 0, unit - 1) / unit,
        counts=np.clip(mixes.counts + random.integers(-1, 2, count), 1, mixes.samples - 1),
        alphas=alphas,
        decals=decals,
        details=_between(normals[0], decals, alphas),
    )


def _between(base: np.ndarray, detail: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """Return the normals at a share `alpha` of the arc from a base to a detail, (patches, 3)."""
    tilt = np.radians(angles_between(base, detail))[:, None]
    # slerp: (sin((1 - a) t) base + sin(a t) detail) / sin t
    a, whole = alpha[:, None], np.sin(tilt)
    mixed = np.sin((1 - a) * tilt) * base + np.sin(a * tilt) * detail
    return unit_rows(np.divide(mixed, whole, out=base.copy(), where=whole > 0))


def _random_rotations(degrees: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Return rotations by the given angles about random axes, matrices of shape (count, 3, 3)."""
    k = unit_rows(random.standard_normal((len(degrees), 3)))
    c, s = np.cos(np.radians(degrees))[:, None, None], np.sin(np.radians(degrees))[:, None, None]
    zero = np.zeros(len(k))
    # Rodrigues: R = cos I + sin [k]x + (1 - cos) k k'
    cross = np.array([(zero, -k[:, 2], k[:, 1]), (k[:, 2], zero, -k[:, 0]), (-k[:, 1], k[:, 0], zero)]).transpose(
        2, 0, 1
    )
    return c * np.eye(3) + s * cross + (1 - c) * k[:, :, None] * k[:, None, :]


def _chosen_mixes(first: np.ndarray, mixes: Mixes, other: Mixes) -> Mixes:
    """Return mixes taken from `mixes` where `first`, (patches,), is true, and from `other` elsewhere."""
    normals = np.where(first[:, None], mixes.patches.normals, other.patches.normals)
    patches = replace(mixes.patches, normals=normals)
    named = {name: (getattr(mixes, name), getattr(other, name)) for name in OF_EACH}
    arrays = {name: np.where(first.reshape(-1, *[1] * (a.ndim - 1)), a, b) for name, (a, b) in named.items()}
    return replace(mixes, patches=patches, **arrays)
