"""Figures that are counted or computed rather than sampled."""

from __future__ import annotations

import math
from functools import cache

import jax
import jax.numpy as jnp
import numpy as np

from normalbench.encodings.catalogue import DEPTH_ENCODINGS, LIGHT_BUFFERS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.normals.optimised_rings import points_needed
from normalbench.encodings.vec import Vec3
from normalbench.gbuffer.layouts.presets import LAYOUTS

from .measures import InACube, Quality, codec_of

SIDE = 256
DIRECTIONS = 6 * SIDE**2


# Codes that are used


@cache
def cells_crossed() -> int:
    """Return how many of the 2^24 cells around three 8-bit numbers in [-1, 1] the unit sphere crosses."""
    # By symmetry the cells with all numbers positive stand for eight.
    low = np.arange(128) * 2 / 255
    near = low[:, None, None] ** 2 + low[:, None] ** 2 + low**2
    far = (low[:, None, None] + 2 / 255) ** 2 + (low[:, None] + 2 / 255) ** 2 + (low + 2 / 255) ** 2
    return 8 * int(np.count_nonzero((near <= 1) & (far >= 1)))


def share_of_cells() -> float:
    """Return the percentage of cells that the unit sphere crosses."""
    return 100 * cells_crossed() / 2**24


def _cube_map() -> np.ndarray:
    """Return the directions to the texel centres of a cube map, float32 of shape (DIRECTIONS, 3)."""
    u, v = np.meshgrid(*[(np.arange(SIDE) + 0.5) / SIDE * 2 - 1] * 2)
    faces = [
        np.roll(np.stack([np.full_like(u, side), u, v], -1), axis, axis=-1) for axis in range(3) for side in (1.0, -1.0)
    ]
    n = np.concatenate([face.reshape(-1, 3) for face in faces])
    return (n / np.linalg.norm(n, axis=1, keepdims=True)).astype(np.float32)


@cache
def _told_apart_count(codec: Codec) -> int:
    n = Vec3(*(jnp.asarray(np.ascontiguousarray(plane)) for plane in _cube_map().T))
    view = Vec3(jnp.zeros_like(n.x), jnp.zeros_like(n.x), jnp.full_like(n.x, -1.0))
    stored = np.stack([np.asarray(number) for number in codec.stored(n, view)], axis=1)
    return len(np.unique(np.round(stored * 255), axis=0))


def told_apart(encoding: str) -> float:
    """Return how many directions of a 256 x 256 x 6 cube map have a code of their own in RGB8."""
    return float(_told_apart_count(codec_of(encoding, "rgba8")))


def share_told_apart(encoding: str) -> float:
    """Return the percentage of directions that have a code of their own."""
    return 100 * told_apart(encoding) / DIRECTIONS


def share_of_texels(encoding: str) -> float:
    """Return the number of the directions' codes as a percentage of all texels of RGB8."""
    return 100 * told_apart(encoding) / 2**24


# Points on the sphere


def optimised_points(degrees: float) -> float:
    """Return the minimum number of points on optimised rings with every direction within this angle of a point."""
    return min(float(points_needed(math.radians(degrees), rings).sum()) for rings in range(8, 200))


def uniform_points(degrees: float) -> float:
    """Return the number of points on equally many rings, each with as many points as the longest ring needs."""
    counts = {rings: points_needed(math.radians(degrees), rings) for rings in range(8, 200)}
    rings = min(counts, key=lambda count: counts[count].sum())
    return rings * float(counts[rings].max())


def bits_above_the_optimum() -> float:
    """Return 2 log2 of the supremum of octahedral 8:8 over the smallest possible maximum of equally many codes."""
    values = [Quality("octahedral", "rg8_snorm", column).figure() for column in ("angle_sup_deg", "limit_max_deg")]
    worst, least = (value or math.nan for value in values)
    return 2 * math.log2(worst / least)


# Angles by which codes differ


def _mean_error(encoding: str, storage: str) -> float:
    return Quality(encoding, storage, "angle_mean_deg").figure() or math.nan


def tetrahedral_over_octahedral() -> float:
    """Return the mean error of tetrahedral 10:10:2 over that of octahedral 11:11."""
    return _mean_error("tetrahedral", "rgb8_10_10_2") / _mean_error("octahedral", "rgb8_11_11")


def mean_in_a_cube_over_uniform() -> float:
    """Return by how many percent the mean error of octahedral 8:8 is larger in a cube than on uniform directions."""
    return 100 * ((InACube("octahedral", "rg8").figure() or math.nan) / _mean_error("octahedral", "rg8") - 1)


def mean_saved_by_precision() -> float:
    """Return by how many percent precise rounding lowers the mean error of octahedral 8:8, on points of a cube."""
    precise, plain = (InACube(name, "rg8").figure() or math.nan for name in ("octahedral_precise", "octahedral"))
    return 100 * (1 - precise / plain)


def maximum_saved_by_precision() -> float:
    """Return by how many percent precise rounding lowers the supremum of octahedral 8:8."""
    names = ("octahedral_precise", "octahedral")
    precise, plain = (Quality(name, "rg8", "angle_sup_deg").figure() or math.nan for name in names)
    return 100 * (1 - precise / plain)


def supremum_in_radians() -> float:
    """Return the supremum of octahedral 16:16, in radians."""
    return math.radians(Quality("octahedral", "rg16", "angle_sup_deg").figure() or math.nan)


def bits(encoding: str, storage: str) -> float:
    """Return the bits of a codec."""
    return float(codec_of(encoding, storage).bits)


def truncated(axis: int) -> float:
    """Return a component of one normal through octahedral 8:8, truncated instead of rounded."""
    n = Vec3(*(jnp.asarray([value], jnp.float32) for value in (-0.5082557, 0.54751796, 0.6647558)))
    return float(codec_of("octahedral", "rg8", "truncate").round_trip(n, n)[axis][0])


# Layouts and light


def bytes_of_targets(layout: str) -> float:
    """Return the bytes per pixel of a layout's own targets."""
    return float(LAYOUTS[layout].bytes_per_pixel)


def most_light(light_buffer: str) -> float:
    """Return the maximum white light that a light buffer can store."""
    return LIGHT_BUFFERS[light_buffer].limit


# Depth


def depth_step(encoding: str, near: float, far: float, codes: int, at: float) -> float:
    """Return how far apart the depths of neighbouring codes are at a depth, in its unit, in float64.

    All depths nearer than the near plane have one code: for these, the result is the distance to that plane.
    """
    if at < near:
        return near
    with jax.enable_x64(True):
        chosen = DEPTH_ENCODINGS[encoding]
        numbers = chosen.encode(jnp.asarray([at], jnp.float64), near, far) + jnp.asarray([0.0, 1.0 / (codes - 1)])
        first, second = np.asarray(chosen.decode(numbers, near, far))
    return float(abs(second - first))


def share_of_codes(encoding: str, near: float, far: float, at: float) -> float:
    """Return the percentage of a fixed-point depth's codes between the near plane and a depth."""
    with jax.enable_x64(True):
        ends = DEPTH_ENCODINGS[encoding].encode(jnp.asarray([near, at, far], jnp.float64), near, far)
        first, middle, last = np.asarray(ends)
    return float(100 * abs(middle - first) / abs(last - first))


def depth_of_step(encoding: str, near: float, far: float, codes: int, step: float) -> float:
    """Return the depth beyond which the step is larger than `step`."""
    low, high = near, far
    for _ in range(60):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if depth_step(encoding, near, far, codes, middle) < step else (low, middle)
    return high


def largest_float_step(near: float, far: float) -> float:
    """Return the largest step of reversed z/w in 32-bit floats between the planes."""
    depths = np.geomspace(near, far, 10_001)
    with jax.enable_x64(True):
        chosen = DEPTH_ENCODINGS["reversed_window"]
        # Half a step either way is what rounding leaves.
        numbers = np.asarray(chosen.encode(jnp.asarray(depths), near, far)).astype(np.float32)
        near_by = np.nextafter(numbers, np.float32(1))
        decoded = [np.asarray(chosen.decode(jnp.asarray(n, jnp.float64), near, far)) for n in (numbers, near_by)]
    return float(np.abs(decoded[0] - decoded[1]).max())
