"""Downsampling of an environment: each texel is the mean over its area."""

from __future__ import annotations

import numpy as np


def averaged(radiance: np.ndarray, height: int) -> np.ndarray:
    """Return an environment reduced to (height, 2 height, 3), float32, by area averages that conserve its light.

    Args:
        radiance: (rows, 2 rows, 3), where rows is at least `height`."""
    rows, columns = radiance.shape[:2]
    # The area of a band goes by the cosine of its polar angle.
    bands, wanted = (-np.cos(np.arange(count + 1) * np.pi / count) for count in (rows, height))
    smaller = np.empty((height, 2 * height, 3), np.float32)
    for channel in range(3):
        means = _means(radiance[..., channel].astype(np.float64), bands, wanted)
        smaller[..., channel] = _means(means.T, np.linspace(0, 1, columns + 1), np.linspace(0, 1, 2 * height + 1)).T
    return smaller


def _means(values: np.ndarray, edges: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Return the means between `wanted` edges, along the first axis, of values that are constant between `edges`."""
    sums = np.concatenate([np.zeros_like(values[:1]), np.cumsum(values * np.diff(edges)[:, None], axis=0)])
    index = np.clip(np.searchsorted(edges, wanted, side="right") - 1, 0, len(values) - 1)
    up_to = sums[index] + values[index] * (wanted - edges[index])[:, None]
    return np.diff(up_to, axis=0) / np.diff(wanted)[:, None]
