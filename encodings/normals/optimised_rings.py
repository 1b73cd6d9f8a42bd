"""Optimised rings: the index, in two bytes, of one of 2^16 points on rings of latitude with a common covering radius.

Ring j of R is at the angle j pi / (R - 1) from +z. It has enough points for every direction between its borders,
halfway to its neighbours, to be within the radius of a point. The radius is as small as 2^16 points allow: 0.5624
degrees, for the best number of rings, 227.
"""

import math
from functools import cache
from pathlib import Path

import numpy as np

from ..codecs.encoding import Encoding
from ..elementary import CONSTANTS, atan2_pi, sincos_pi
from ..vec import Vec2, Vec3, dot, floor, index_of, jnp, minimum, number_of, select, sqrt

COUNT, BYTE = 2**16, 256
# Of about square cells: the distance of rings is that of points on them.
RINGS = round(math.sqrt(math.pi * COUNT / 4))


def points_needed(radius: float, count: int = RINGS) -> np.ndarray:
    """Return how many points each of `count` rings needs so that every direction between its borders is within
    `radius` (radians) of a point; float64 of shape (count,)."""
    theta = np.arange(1, count - 1) * np.pi / (count - 1)
    needed = np.ones(count)
    for border in (theta - 0.5 * np.pi / (count - 1), theta + 0.5 * np.pi / (count - 1)):
        # cos(radius) = cos(theta) cos(border) + sin(theta) sin(border) cos(pi / points)
        across = (math.cos(radius) - np.cos(theta) * np.cos(border)) / (np.sin(theta) * np.sin(border))
        with np.errstate(divide="ignore"):
            points = np.ceil(np.pi / np.arccos(np.clip(across, -1, 1)))
        needed[1:-1] = np.maximum(needed[1:-1], points)
    return needed


@cache
def covering_radius() -> float:
    """Return the largest angle between a direction and its point, in radians: the smallest possible with COUNT."""
    low, high = 0.0, math.pi
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if points_needed(middle).sum() <= COUNT else (middle, high)
    return high


@cache
def rings() -> np.ndarray:
    """Return the number of points in each ring and the number in all rings before it; float32 of shape (RINGS, 2)."""
    counts = points_needed(covering_radius())
    return np.stack([counts, np.cumsum(counts) - counts], axis=1).astype(np.float32)


def tables() -> dict[str, np.ndarray]:
    """Return the rings by sampler name, as a texture with one row: float32 of shape (1, RINGS, 2)."""
    return {"optimised_rings_table": rings()[None]}


def _ring(ring, dtype) -> tuple:
    """Return, for an array of ring indices, two arrays: the point count of each ring and of all rings before it."""
    return tuple(jnp.asarray(column, dtype)[ring.astype(jnp.int32)] for column in rings().T)


def _point(ring, share) -> Vec3:
    # theta = pi ring / (RINGS - 1), phi = 2 pi share
    turns = 2.0 * share
    sine, cosine = sincos_pi(select(turns > 1.0, turns - 2.0, turns))
    r, z = sincos_pi(ring * (1.0 / (RINGS - 1)))
    return Vec3(cosine * r, sine * r, z)


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal to the index of the nearest point in the two rings around the normal: the high and the low
    byte of the index, each as a number in [-1, 1]."""
    # ring = theta (RINGS - 1) / pi, share = phi / (2 pi)
    theta = atan2_pi(sqrt(n.x * n.x + n.y * n.y), n.z)
    turn = 0.5 * atan2_pi(n.y, n.x)
    above = minimum(floor(theta * (RINGS - 1.0)), RINGS - 2.0)
    best, least = jnp.zeros_like(n.x), jnp.full_like(n.x, 8.0)
    for step in (0.0, 1.0):
        points, before = _ring(above + step, n.x.dtype)
        k = floor(turn * points + 0.5)
        k = select(k < 0.0, k + points, k)
        k = select(k >= points, 0.0, k)
        miss = n - _point(above + step, k / points)
        is_nearer = dot(miss, miss) < least
        best, least = select(is_nearer, before + k, best), select(is_nearer, dot(miss, miss), least)
    high = floor(best * (1.0 / BYTE))
    return Vec2(number_of(high, BYTE), number_of(best - BYTE * high, BYTE))


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the unit normal at the point whose index the two bytes hold."""
    i = index_of(e.x, BYTE) * BYTE + index_of(e.y, BYTE)
    # the last ring that begins at i or before
    ring = jnp.searchsorted(jnp.asarray(rings()[:, 1]), i.astype(jnp.float32), side="right") - 1
    points, before = _ring(ring, i.dtype)
    return _point(ring.astype(i.dtype), (i - before) / points)


ENCODING = Encoding(
    name="optimised_rings",
    title="optimised rings",
    encode=encode,
    decode=decode,
    components=2,
    domain="sphere",
    citation="J. Smith, G. Petrova and S. Schaefer, Encoding Normal Vectors using Optimized Spherical Coordinates, "
    "Computers & Graphics 36(5), 2012",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 8),
    ulps_reason="of two points that are as near either may be taken; a turn makes a division's unit six; two sines",
    levels=(BYTE, BYTE),
    searches=True,
    constants={**CONSTANTS, "OPTIMISED_RINGS_BYTE": BYTE, "OPTIMISED_RINGS_COUNT": RINGS},
    tables=tables,
)
