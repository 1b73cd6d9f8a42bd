"""Detection of codes that are truncated instead of rounded, for any packing.

The directions that share a code form a cell. If codes are rounded, the decoder returns the middle of the cell; if
they are truncated, it returns a corner. So all directions in a small patch of the sphere decode with the same shift,
half a cell long. Each patch is judged separately, because the shifts cancel over the whole sphere. The squared length
of the shift, relative to the covariance of the decoded directions, does not depend on the shape of the cells: it is 3
per truncated component. It is 0 for a decoder that adds the half step that the encoder truncates.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ....ground.directions import unit
from .probe import Probe, Trip

# How many patches there are, and directions in each; a patch's radius in usual errors, and in degrees at most.
PATCHES, INSIDE = 128, 256
IN_ERRORS, LARGEST_DEG = 12.0, 10.0
# Fewer patches say nothing.
FEWEST = 16
# Squared shifts of nearly all patches where codes are cut off: seams make some smaller.
CUT_OFF_LEAST, CUT_OFF_MOST = 2.2, 10.0
# The one of half of the patches above which a fifth of the error is a shift. The most that two numbers have which are
# scaled by a step too many or too few.
SHIFTED, MOST = 1.2, 24.0
# What is left of the error if two numbers are rounded instead, and how near to it a half is.
HALF, NEARLY = 0.5, 0.1

CUT_OFF = "codes are truncated instead of rounded: rounding would {}"
SHIFT = "codes are shifted, and without the shift errors would be {:.0f}% as large: is a scale or a rounding wrong?"


def cut_off(held: Trip, probe: Probe) -> Iterator[str]:
    """Yield one line if codes are truncated or otherwise shifted; nothing if the decoder returns the middle of each
    cell, or if too few patches can be compared.

    Args:
        held: directions that the encoding is made for, with their decoded directions.
    """
    radius = np.radians(min(IN_ERRORS * float(np.median(held.angles())), LARGEST_DEG))
    patches = _patches(held.n[-PATCHES:], probe, radius)
    kept = [shifts for shifts in patches if len(shifts) > INSIDE / 2]
    if len(kept) < FEWEST:
        return
    low, half, high = np.quantile([_squared_shift(shifts) for shifts in kept], (0.25, 0.5, 0.9))
    whole, without = np.sum([_errors(shifts) for shifts in kept], axis=0)
    left = without / whole
    if low > CUT_OFF_LEAST and high < CUT_OFF_MOST:
        is_half = abs(left - HALF) < NEARLY
        yield CUT_OFF.format("halve the error" if is_half else f"reduce the error to {100 * left:.0f}%")
    elif half > SHIFTED and high < MOST:
        yield SHIFT.format(100 * left)


def _patches(centres: np.ndarray, probe: Probe, radius: float) -> Iterator[np.ndarray]:
    """Yield the shifts in each patch of random directions around a centre: directions minus decoded directions in the
    tangent plane, of shape (count, 2). Shifts of `radius` or more are left out, because they cross a seam.

    Args:
        centres: a direction per patch, of shape (patches, 3).
        radius: half the width of a patch, in radians."""
    inside = np.random.default_rng(3).uniform(-radius, radius, size=(len(centres), INSIDE, 2))
    planes = _planes(centres)
    n = unit((centres[:, None] + np.einsum("pik,pkj->pij", inside, planes)).reshape(-1, 3)).astype(np.float32)
    off = (n - unit(probe.decode(np.clip(probe.encode(n), -1, 1)))).reshape(len(centres), INSIDE, 3)
    for shifts in np.einsum("pij,pkj->pik", off, planes):
        # What comes back elsewhere lies beyond a seam.
        yield shifts[np.linalg.norm(shifts, axis=1) < radius]


def _planes(n: np.ndarray) -> np.ndarray:
    """Return two perpendicular tangents for each direction, of shape (count, 2, 3)."""
    tangent = unit(np.cross(n, np.eye(3)[np.argmin(np.abs(n), axis=1)]))
    return np.stack([tangent, np.cross(n, tangent)], axis=1)


def _squared_shift(shifts: np.ndarray) -> float:
    """Return the squared length of a patch's mean shift, in units of the covariance of its shifts (Mahalanobis)."""
    shift = shifts.mean(axis=0)
    return float(shift @ np.linalg.pinv(np.cov(shifts.T)) @ shift)


def _errors(shifts: np.ndarray) -> tuple[float, float]:
    """Return the mean length of a patch's shifts, before and after subtracting the mean shift."""
    return _mean_length(shifts), _mean_length(shifts - shifts.mean(axis=0))


def _mean_length(vectors: np.ndarray) -> float:
    return float(np.linalg.norm(vectors, axis=1).mean())
