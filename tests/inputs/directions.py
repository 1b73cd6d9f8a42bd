"""The inputs of the parity harness: a test names an encoding and a tolerance, and the directions are chosen here."""

import itertools
from functools import cache

import numpy as np


def _kept(array: np.ndarray) -> np.ndarray:
    """Make the array read-only, because all tests share it, and return it."""
    array.flags.writeable = False
    return array


@cache
def hard_directions() -> np.ndarray:
    """Return axes, diagonals with both zeros, poles and fold seams, with their neighbours; float32 (count, 3)."""
    steps = [0.0, -0.0, *(s * k for k in (2.0**-24, 2.0**-23, 3e-7, 1e-5, 3e-4) for s in (1, -1))]
    near_axes = [np.insert([a, b], i, s) for i, s, a, b in itertools.product(range(3), (1.0, -1.0), steps, steps)]
    diagonals = [d for d in itertools.product((-1.0, 0.0, -0.0, 1.0), repeat=3) if any(d)]
    # The octahedron's fold is z = 0; the seams on its lower half are x = 0 and y = 0; the angle wraps at y = 0, x < 0.
    angles = np.linspace(0, 2 * np.pi, 33)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    folds = [np.insert(c, i, z) for c in circle for i in range(3) for z in steps]
    v = np.concatenate([near_axes, diagonals, folds])
    return _kept((v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32))


@cache
def random_directions(count: int, seed: int = 0) -> np.ndarray:
    """Return directions uniform on the sphere, float32 (count, 3)."""
    v = np.random.default_rng(seed).normal(size=(count, 3))
    return _kept((v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32))


@cache
def view_positions(count: int, seed: int = 1) -> np.ndarray:
    """Return positions in front of the eye, the first straight up, down and ahead; float32 (count, 3)."""
    v = np.random.default_rng(seed).uniform((-2, -2, -3), (2, 2, -0.1), (count, 3))
    special = [(0, 1, 0), (0, -1, 0), (0, 0, -1), (0, 2, -1e-20), (1, 0, 0)]
    v[: len(special)] = special
    return _kept(v.astype(np.float32))


NOT_DIRECTIONS = np.array(
    [
        (0, 0, 0),
        (-0.0, 0, -0.0),
        (np.nan, 0, 1),
        (0, np.nan, np.nan),
        (np.inf, 0, 0),
        (0, -np.inf, 1),
        (1e-30, 0, 0),
        (3e38, 3e38, 0),
    ],
    np.float32,
)
