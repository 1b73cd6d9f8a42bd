"""The histogram of angles, and the figures computed from it.

A bin is given by the upper bits of a float32, including ten bits of its mantissa. It is 2^-10 of an octave wide, so
that percentiles are accurate to 0.1%. Bins range from 2^-40 degrees to 180 and above, and their numbers fit in 16
bits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import jax.numpy as jnp
import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Array, ArrayLike, Bool, Float, Int, UInt

BIN_SHIFT = 13
FIRST_BIN = int(np.float32(2.0**-40).view(np.uint32)) >> BIN_SHIFT
BINS = (int(np.float32(256.0).view(np.uint32)) >> BIN_SHIFT) - FIRST_BIN
# The bin of normals that do not count.
UNCOVERED = BINS
# A row keeps eight bins of an octave: three bits of mantissa.
BINS_TOGETHER = 2**7


def bins_of(angle: Float[Array, "*shape"], covered: Bool[ArrayLike, "*shape"]) -> UInt[Array, "*shape"]:
    """Return the number of each angle's bin, uint16 of the same shape; UNCOVERED where a normal does not count.
    Angles are float32, in degrees."""
    key = (angle.view(jnp.uint32) >> BIN_SHIFT).astype(jnp.int32) - FIRST_BIN
    return jnp.where(covered, jnp.clip(key, 0, BINS - 1), UNCOVERED).astype(jnp.uint16)


def bin_of(angle_deg: float) -> int:
    """Return the number of the bin for an angle in degrees; the first or the last bin for angles beyond all bins."""
    return min(max((int(np.float32(angle_deg).view(np.uint32)) >> BIN_SHIFT) - FIRST_BIN, 0), BINS - 1)


def lower_edge(number: int) -> float:
    """Return the smallest angle of a bin, in degrees; 0 for the first bin."""
    return float(np.uint32(number + FIRST_BIN << BIN_SHIFT).view(np.float32)) if number else 0.0


def tally(bins: UInt[Array, "*shape"]) -> Int[Array, " bins"]:
    """Return the number of normals in each bin, int32 of shape (BINS + 1,); the last counts UNCOVERED. Integer counts
    do not depend on the order in which normals are counted."""
    return jnp.zeros(BINS + 1, jnp.int32).at[bins.ravel()].add(1, mode="promise_in_bounds")


def percentile(histogram: Int[np.ndarray, " bins"], largest: float, share: float) -> float:
    """Return the angle, in degrees, below which `share` (0 to 1) of the counts fall, interpolated within its bin. The
    result is at most `largest`, the largest angle, and 0 if `largest` is 0."""
    cumulative = np.cumsum(histogram[:BINS])
    rank = share * cumulative[-1]
    index = int(np.searchsorted(cumulative, rank))
    edges = ((np.arange(index, index + 2) + FIRST_BIN) << BIN_SHIFT).astype(np.uint32).view(np.float32)
    within = (rank - (cumulative[index] - histogram[index])) / histogram[index]
    return min(float(edges[0] + within * (edges[1] - edges[0])), largest) if largest else 0.0


def counts_by_angle(histogram: Int[np.ndarray, " bins"]) -> tuple[tuple[float, int], ...]:
    """Return (lower edge in degrees, number of angles) for each non-empty eighth of an octave, ascending; the first
    eighth begins at 0."""
    counts = histogram[:BINS].reshape(-1, BINS_TOGETHER).sum(axis=1)
    edges = ((np.arange(0, BINS, BINS_TOGETHER) + FIRST_BIN) << BIN_SHIFT).astype(np.uint32).view(np.float32)
    edges[0] = 0
    return tuple((float(edges[i]), int(counts[i])) for i in np.flatnonzero(counts))


def counts_below(histogram: Int[np.ndarray, " bins"]) -> tuple[tuple[float, int], ...]:
    """Return (power of two in degrees, number of angles below it) for each octave of the bins, ascending."""
    octave = 2 ** (23 - BIN_SHIFT)
    below = np.cumsum(histogram[:BINS])[octave - 1 :: octave]
    first = np.log2(np.uint32(FIRST_BIN << BIN_SHIFT).view(np.float32))
    return tuple((float(2.0 ** (first + k + 1)), int(count)) for k, count in enumerate(below))
