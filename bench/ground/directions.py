"""Directions for tests of encoders: axes and their neighbours, diagonals, circles and random directions."""

from __future__ import annotations

import itertools

import numpy as np

RANDOM = 4096
# How many directions lie on a circle.
AROUND = 96


def directions() -> np.ndarray:
    """Return axes, their neighbours, diagonals and random directions: float32 of shape (count, 3). The zeros of the
    axes have both signs.

    The last RANDOM directions are the random ones.
    """
    near = (0.0, -0.0, 1e-7, -1e-7, 1e-3, -1e-3)
    sides = itertools.product(range(3), (1.0, -1.0), near, near)
    axes = [np.insert(np.array([a, b]), axis, side) for axis, side, a, b in sides]
    diagonals = [d for d in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(d)]
    random = np.random.default_rng(0).normal(size=(RANDOM, 3))
    return unit(np.concatenate([axes, diagonals, random])).astype(np.float32)


def circles() -> np.ndarray:
    """Return directions on the three circles where one coordinate is exactly 0: float32 of shape (count, 3)."""
    turn = np.arange(AROUND) * (2 * np.pi / AROUND)
    return np.concatenate(
        [np.insert(np.stack([np.cos(turn), np.sin(turn)], axis=1), axis, 0.0, axis=1) for axis in range(3)]
    ).astype(np.float32)


def unit(v: np.ndarray) -> np.ndarray:
    """Return rows scaled to length 1; rows of length 0 are unchanged."""
    length = np.linalg.norm(v.astype(np.float64), axis=1, keepdims=True)
    return v / np.where(length > 0, length, 1.0)
