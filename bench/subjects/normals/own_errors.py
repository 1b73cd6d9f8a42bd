"""Errors in normals that are due to how their file stores them.

The error of a rounding is estimated from the normals themselves. They are rounded again, to steps about four times as
wide; a quarter of the resulting angle is the estimated error of the file's own rounding. Normals that are on every
grid, such as normals along an axis, are exact in both roundings.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import jax.numpy as jnp
import numpy as np

from ....encodings.catalogue import ENCODINGS
from ....encodings.vec import Vec2, Vec3
from ....gbuffer.scenes.files.mesh_file import Rounding

# How much wider the steps are that a rounding is estimated by.
COARSER = 4
# Normals looked at.
MOST = 2**16
# A source that is off by less, in degrees, is as good as exact to codes of up to 24 bits: octahedral has 0.019 there.
FINE = 0.01
# The share of a source's own error below which a code adds next to nothing: errors add up as squares do, by 6 %.
WASTED = 1 / 3
# Bits of an octahedral map that can be told from the normals alone, the fewest first; fewer different normals than the
# second number may lie on such a grid by chance, and others lie this close to it in steps.
BITS, DIFFERENT, NEAR = range(5, 13), 64, 0.1


def own_error_deg(n: np.ndarray, roundings: Sequence[Rounding]) -> float | None:
    """Return the mean angular error in degrees that roundings caused in unit normals of shape (count, 3); None
    without roundings or normals.

    Args:
        roundings: the roundings of the normals, in the order in which they were applied.
    """
    some = _some(n)
    if not roundings or not len(some):
        return None
    return math.degrees(math.sqrt(sum(_mean_angle(some, rounding) ** 2 for rounding in roundings)))


def _some(n: np.ndarray) -> np.ndarray:
    return n[:: max(1, -(-len(n) // MOST))].astype(np.float64)


def all_roundings(n: np.ndarray, roundings: Sequence[Rounding]) -> tuple[Rounding, ...]:
    """Return the roundings that a file declares and, if unit normals of shape (count, 3) show that they were packed
    by an octahedral map, the rounding of that map."""
    if any(rounding.is_octahedral for rounding in roundings):
        return tuple(roundings)
    return (*octahedral_grid(_some(n), roundings), *roundings)


def octahedral_grid(n: np.ndarray, roundings: Sequence[Rounding] = ()) -> list[Rounding]:
    """Return a list with the grid of the octahedral map that packed the normals, as in Draco; empty if none is found.

    On the octahedron |x| + |y| + |z| = 1 the two components of the map's code are two of x, y and z, and the third
    makes the sum 1. All three are therefore multiples of a step.
    """
    on = n / np.sum(np.abs(n), axis=1, keepdims=True)
    if len(np.unique(np.round(on, 6), axis=0)) < DIFFERENT:
        return []
    grids = [Rounding(2 ** (bits - 1) - 1, is_octahedral=True) for bits in BITS]
    # A grid as fine as what x, y and z were rounded to themselves has nothing off it.
    coarse = [grid for grid in grids if all(COARSER * grid.most <= other.most for other in roundings)]
    return [grid for grid in coarse if np.abs(on * grid.most - np.round(on * grid.most)).max() < NEAR][:1]


def _mean_angle(n: np.ndarray, rounding: Rounding) -> float:
    """Return an estimate of the mean angle, in radians, by which a rounding has rotated normals."""
    wide = max(rounding.most // COARSER, 1)
    again = _rounded_on_octahedron(n, wide) if rounding.is_octahedral else np.round(n * wide)
    apart = np.linalg.norm(again / np.linalg.norm(again, axis=1, keepdims=True) - n, axis=1)
    return float((2 * np.arcsin(np.minimum(apart / 2, 1))).mean()) * wide / rounding.most


def _rounded_on_octahedron(n: np.ndarray, most: float) -> np.ndarray:
    """Return directions of shape (count, 3) with both octahedral components rounded to steps of 1 / most."""
    octahedral, view = ENCODINGS["octahedral"], Vec3(*np.zeros((3, len(n)), np.float32))
    code = octahedral.encode(Vec3(*np.ascontiguousarray(n.T, np.float32)), view)
    decoded = octahedral.decode(Vec2(*(jnp.round(number * most) / most for number in code)), view)
    return np.stack([np.asarray(number) for number in decoded], axis=1)


def own_error_note(what: str, own: float) -> str:
    """Return a remark that `what` are off by `own` degrees, and which mean errors would waste bits on them."""
    finer = f"encodings with a mean error below {own * WASTED:.1g} degrees waste bits on them"
    return f"{what} are off by about {own:.2g} degrees themselves: {finer}"


def bits_text(roundings: Iterable[Rounding]) -> str:
    """Return the bits of roundings as text, such as `8 bits and 10 bits of an octahedral map`."""
    kinds = {(rounding.is_octahedral, int(2 * rounding.most).bit_length()) for rounding in roundings}
    return " and ".join(f"{bits} bits{' of an octahedral map' * packed}" for packed, bits in sorted(kinds))
