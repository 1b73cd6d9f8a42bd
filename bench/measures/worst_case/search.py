"""The largest angular error of a codec, in float64, and the normal with this error.

Within the cell of a code, the angle to the decoded direction grows towards the border, so the worst normals are at
corners of cells, approached from inside. If a code is a point in a plane (two numbers besides signs and indices),
the corners of all cells are tried if there are at most 2^24 of them; otherwise the search climbs over cells from many
starts. If codes are points on the sphere instead, cells have their corners where three codes are equidistant: on the
face normals of the codes' convex hull. For all codecs, the search also tries directions spread over the domain, the
great circles where codes are folded, and rings around the axes. From the worst of all these directions, a climb in
ever smaller steps continues across everything that cuts the cells: seams, the domain's rim, and the sphere itself if
a code has three numbers.

The result is the error of an actual normal, so it is never above the supremum; `moved_deg` is the increase in the
last round of climbing, which starts from the best place alone with steps of every size.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache, partial, reduce
from operator import add

import numpy as np

from ....encodings.codecs.codec import Codec
from ...ground.machine.cores import on_all_cores
from . import cells
from .climb import WAYS, Ground, Starts, highest
from .exact_codec import BLOCK, ExactCodec, degrees

# Directions looked at, and the worst of them kept: where the corners of cells are not known, or only some; where they
# are known; and for an encoder that searches, which takes longer for each direction.
WIDE, NARROW, QUICK = (2**23, 2**12), (2**20, 2**11), (2**19, 2**8)
FIRST_SIZES = (0.25, 0.02)  # of the first step of each round, in the error
CLIMBING = "climbing"
# A start this near the result, relatively, is what found it.
SAME = 1e-6


@dataclass(frozen=True)
class Worst:
    """A codec's largest error.

    Attributes:
        angle_deg: the supremum, as found by the search.
        normal: the unit normal with this error.
        found_by: a method of `cells`, or "climbing".
        moved_deg: the increase of the angle in the last round of climbing.
    """

    angle_deg: float
    normal: tuple[float, float, float]
    found_by: str
    moved_deg: float


@cache
def worst_case(codec: Codec, is_half: bool = False) -> Worst:
    """Return the largest error found over the sphere, or z >= 0 if `is_half`, with eye rays straight ahead."""
    exact = ExactCodec(codec, is_half)
    way = cells.way_to_corners(exact)
    is_known = way in (cells.ALL_CORNERS, cells.NEAREST)
    samples, count = QUICK if codec.encoding.searches else NARROW if is_known else WIDE
    # Compiling and the hull of the codes do not hold Python's lock, so a second thread finds the corners meanwhile.
    with ThreadPoolExecutor(1) as pool:
        corners = pool.submit(_worst_corners, exact, way, count) if way else None
        blocks = itertools.chain(((block,) for block in spread(samples, is_half)), _special_starts(is_half))
        starts = _worst_of(exact, blocks, count)
    ours = corners.result() if corners else None
    starts = starts + ours if ours else starts
    ground = Ground(exact.chords, exact.around, _lengths, degrees, exact.block // WAYS)
    last, moved = highest(ground, starts, count, FIRST_SIZES)
    angle = degrees(last.chords[0])
    is_ours = ours and degrees(ours.chords[0]) >= angle * (1 - SAME)
    return Worst(angle, exact.unit(last.places[:, 0]), way if is_ours else CLIMBING, moved)


def _lengths(chords: np.ndarray) -> np.ndarray:
    return np.sqrt(np.maximum(chords, 0.0))


def _worst_corners(exact: ExactCodec, way: str, count: int) -> Starts:
    """Return at most `count` of the worst normals at corners of cells."""
    normals = cells.corners(exact, way)
    return Starts(exact.chords(normals), normals).best(count)


def _worst_of(exact: ExactCodec, blocks: Iterable[Sequence[Callable[[], np.ndarray]]], count: int) -> Starts:
    """Return at most `count` of the worst normals that functions return.

    Args:
        blocks: lists of functions, each of which returns normals of shape (3, any); a list fills one block."""

    def peaks(block: Sequence[Callable[[], np.ndarray]]) -> Starts:
        parts = [part() for part in block]
        ends = np.cumsum([part.shape[1] for part in parts])
        chords = np.split(exact.chords(np.concatenate(parts, axis=1)), ends[:-1])
        return reduce(add, map(_peak_starts, chords, parts))

    best = Starts(np.empty(0), np.empty((3, 0)))
    for starts in on_all_cores(peaks, blocks):
        best = (best + starts).best(count)
    return best


def _peak_starts(chords: np.ndarray, normals: np.ndarray) -> Starts:
    """Return some of the worst normals, taken from all parts of the array."""
    largest, index = cells.column_peaks(chords, cells.KEPT)
    return Starts(largest, normals[:, index])


def spread(count: int, is_half: bool) -> Iterator:
    """Yield functions that each return BLOCK directions, at least `count` in all: spread evenly over the sphere, or
    over z >= 0 if `is_half`, by a two-dimensional additive sequence."""

    def block(start: int) -> np.ndarray:
        index = np.arange(start, start + BLOCK) + 0.5
        z, turn = (np.modf(index * step)[0] for step in (0.7548776662466927, 0.5698402909980532))
        return _sphere_points(z if is_half else 2.0 * z - 1.0, 2.0 * np.pi * turn)

    return (partial(block, start) for start in range(0, count, BLOCK))


def _sphere_points(z: np.ndarray, angle: np.ndarray) -> np.ndarray:
    r = np.sqrt(1.0 - z * z)
    return np.stack([np.cos(angle) * r, np.sin(angle) * r, z])


def _special_starts(is_half: bool) -> Iterator:
    """Yield lists of functions that return normals where codes are folded, cut or singular: great circles
    perpendicular to axes and diagonals, and circles on both sides of them; the rim of a hemisphere, densely; and
    rings around the axes. Within 1e-4 of a pole, some encodings suffer from cancellation even in float64 and are not
    the exact map."""
    circle = _sphere_points(np.zeros(BLOCK // 4), np.arange(BLOCK // 4) * (8 * np.pi / BLOCK))
    diagonals = [(1, s, 0) for s in (1, -1)] + [(1, 0, s) for s in (1, -1)] + [(0, 1, s) for s in (1, -1)]
    offsets = [circle + np.array([[0.0], [0.0], [offset]]) for offset in (0.0, 1e-9, -1e-9)]
    circles = [
        partial(_moved_to_axis, across, near) for across in [*np.eye(3), *np.array(diagonals)] for near in offsets
    ]
    yield from (circles[start : start + 4] for start in range(0, len(circles), 4))
    height = np.cos(np.repeat(np.geomspace(1e-4, 1.0, 256), 64))
    ring = _sphere_points(height, np.arange(len(height)) * (np.pi / 32))
    yield from ([partial(_moved_to_axis, axis, ring), partial(_moved_to_axis, -axis, ring)] for axis in np.eye(3))
    for start in range(16 if is_half else 0):
        angle = (np.arange(BLOCK) + start / 16) * (2 * np.pi / BLOCK)
        yield [partial(_sphere_points, np.zeros(BLOCK), angle)]


def _moved_to_axis(axis: np.ndarray, around_z: np.ndarray) -> np.ndarray:
    """Return unit normals around +z, rotated so that they are around the given axis."""
    axis = axis / np.linalg.norm(axis)
    least = np.eye(3)[np.argmin(np.abs(axis))]
    x = np.cross(least, axis)
    x /= np.linalg.norm(x)
    turned = np.stack([x, np.cross(axis, x), axis], axis=1) @ around_z
    return turned / np.linalg.norm(turned, axis=0)
