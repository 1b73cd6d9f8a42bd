"""Environments computed from formulas, averaged over the area of each texel to avoid aliased edges."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .environment import towards

# Texels of the environments that are made, and samples in each along either side.
HEIGHT = 256
SAMPLES = 4

# From unit directions, (..., 3), to linear radiance, (..., 3).
Formula = Callable[[np.ndarray], np.ndarray]


def drawn(formula: Formula, height: int = HEIGHT) -> np.ndarray:
    """Return a formula's radiance, (height, 2 height, 3), float32, read-only: the mean of 4 x 4 points per texel."""
    radiance = np.concatenate([_row(formula, row, height) for row in range(height)])
    radiance.setflags(write=False)
    return radiance


def _row(formula: Formula, row: int, height: int) -> np.ndarray:
    t = ((row + (np.arange(SAMPLES)[:, None] + 0.5) / SAMPLES) * np.pi) / height
    p = (np.arange(2 * height * SAMPLES) + 0.5) / SAMPLES * np.pi / height - np.pi
    weight = np.sin(t)[..., None] / np.sin(t).mean()
    light = (formula(towards(t, p)) * weight).reshape(SAMPLES, 2 * height, SAMPLES, 3)
    return light.mean((0, 2), dtype=np.float64).astype(np.float32)[None]


def rises(value: np.ndarray, start: float, end: float) -> np.ndarray:
    """Return a smooth step of values: 0 up to `start`, 1 from `end` on."""
    share = np.clip((value - start) / (end - start), 0, 1)
    return share * share * (3 - 2 * share)


def mixed(first: np.ndarray, second: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Return the mix of two colours, (..., 3), by shares, (...): the first colour at 0, the second at 1."""
    return first + (second - first) * share[..., None]
