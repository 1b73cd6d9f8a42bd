"""Orientations of an encoding's axes in a scene, and the accuracy of a mean over them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

# Degrees from a yaw to the next. An octant is cut by the golden ratio, so that even four yaws are spread over what a
# code with fourfold symmetry and mirrors tells apart; there the golden angle goes on by 2.5 degrees alone.
STEP_DEG = 45 * (3 + (5**0.5 - 1) / 2)
# By up to so many degrees each yaw is off its step: more than a grid of 8 bits has between its codes. Whole steps of an
# angle can be nearly whole steps of a grid: 137.508 degrees are 1563.007 of the 10-bit steps of a warped cube.
JITTER_DEG = 1.0
# By the axis of the world, y up, that an encoding's z axis lies along: from the world's axes to the encoding's.
POLES: Mapping[str, Float[np.ndarray, "3 3"]] = MappingProxyType(
    {axis: np.roll(np.eye(3), shift, axis=1) for axis, shift in (("x", 1), ("y", 2), ("z", 0))}
)


def yaws(first: int, count: int, seed: int) -> Float[np.ndarray, "count 3 3"]:
    """Return rotation matrices about the world's y axis, in steps of STEP_DEG, each with a random offset: elements
    `first` to `first + count - 1` of the seed's series."""
    random = np.random.default_rng([seed, 0])
    start, jitter = random.uniform(0, 360), random.uniform(0, JITTER_DEG, first + count)
    angles = np.radians(start + STEP_DEG * np.arange(first, first + count) + jitter[first:])
    turns = np.tile(np.eye(3), (count, 1, 1))
    turns[:, 0, 0] = turns[:, 2, 2] = np.cos(angles)
    turns[:, 0, 2] = np.sin(angles)
    turns[:, 2, 0] = -turns[:, 0, 2]
    return turns


def rotations(first: int, count: int, seed: int) -> Float[np.ndarray, "count 3 3"]:
    """Return independent uniform rotation matrices: elements `first` to `first + count - 1` of the seed's series."""
    from scipy.spatial.transform import Rotation

    return Rotation.random(first + count, np.random.default_rng([seed, 1])).as_matrix()[first:]


def jackknife(figure: Callable[[np.ndarray], float], samples: Sequence[int]) -> float:
    """Return the jackknife standard error of a figure computed from samples: one sample at a time is left out.

    Source: B. Efron and C. Stein, The jackknife estimate of variance, 1981.

    Args:
        figure: computes the figure from the samples with the given indices.
        samples: the indices of all samples, two or more.
    """
    # se^2 = (n - 1) / n sum (x_i - mean x)^2, x_i without sample i
    indices = np.asarray(samples)
    left = np.array([figure(np.delete(indices, i)) for i in range(len(indices))])
    return float(np.sqrt((len(indices) - 1) / len(indices) * np.sum((left - left.mean()) ** 2)))
