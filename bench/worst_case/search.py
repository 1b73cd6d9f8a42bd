"""The largest angular error a codec can make, in float64, and the normal that makes it.

Within the cell of a code the angle to what it decodes to grows towards the border, so the worst normals lie at corners
of cells, approached from inside. Where a code is a point of a plane (two numbers besides signs and indices) the corners
of all cells are tried if there are 2^24 of them at most, else cells are climbed over from many starts. Codes that are
no planes but points on the sphere have their corners where three of them are equally near: across the faces of their
convex hull. Besides, everywhere: directions spread over the domain, the great circles where codes are folded, and rings
around the axes. From the worst of all these a climb in ever smaller steps goes on through whatever the cells are cut
by: seams, the domain's rim, and the sphere itself where a code has three numbers.

What is found is an error that a normal makes, so it is never above the supremum; `moved_deg` says by how much the last
round of climbing, which starts from the best alone with steps of every size, still raised it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache, partial, reduce
from operator import add

import numpy as np

from ...encodings.codecs.codec import Codec
from ..machine.cores import on_all_cores
from . import cells
from .exact_codec import BLOCK, WAYS, ExactCodec, degrees

# Starts that fill a block with what is tried around them, and steps of a round.
LANES, STEPS = BLOCK // WAYS, 80
# Directions looked at, and the worst of them kept: where nothing is known of the cells but what these find; and where
# corners are known, or an encoder that searches takes its time.
WIDE, NARROW = (2**23, 2 * LANES), (2**20, LANES)
KEPT = 2**8  # of a round, for the next
FIRST_SIZES = (0.25, 0.02)  # of a round's steps, in the error
GROW, SHRINK = 1.5, 0.55
LEAST = 1e-10  # of a step, in the error; then a climb is over
# Rounds from the best alone, until one moves it no more than that, relatively.
LAST_ROUNDS, SETTLED = 12, 1e-8
CLIMBING = "climbing"
# A start this near the result, relatively, is what found it.
SAME = 1e-6


@dataclass(frozen=True)
class Worst:
    """A codec's largest error.

    Attributes:
        angle_deg: the supremum as it was found.
        normal: the unit normal that makes it.
        found_by: one of `cells`' ways, or "climbing".
        moved_deg: how much the last round of climbing still raised it.
    """

    angle_deg: float
    normal: tuple[float, float, float]
    found_by: str
    moved_deg: float


@dataclass(frozen=True)
class Starts:
    """Normals, shape (3, count), and their squared chords, shape (count,)."""

    chords: np.ndarray
    normals: np.ndarray

    def best(self, count: int) -> Starts:
        """The worst of them, at most `count`."""
        return self[np.argsort(-self.chords, kind="stable")[:count]]

    def filled(self, count: int) -> Starts:
        """So many of them, each as often as it takes: climbs differ by where in the block they start."""
        return self[np.arange(count) % len(self.chords)]

    def __getitem__(self, which: slice | np.ndarray) -> Starts:
        return Starts(self.chords[which], self.normals[:, which])

    def __add__(self, other: Starts) -> Starts:
        return Starts(*(np.concatenate(pair, axis=-1) for pair in zip(_fields(self), _fields(other), strict=True)))


def _fields(starts: Starts) -> tuple[np.ndarray, np.ndarray]:
    return starts.chords, starts.normals


@cache
def worst_case(codec: Codec, is_half: bool = False) -> Worst:
    """The largest error over the sphere, or over z >= 0, with eye rays straight ahead."""
    exact = ExactCodec(codec, is_half)
    way, normals = cells.corners(exact)
    samples, count = NARROW if way in (cells.ALL_CORNERS, cells.NEAREST) or codec.encoding.searches else WIDE
    ours = Starts(exact.chords(normals), normals).best(count) if way else None
    starts = _worst_of(exact, itertools.chain(spread(samples, is_half), _special(is_half)), count)
    starts = starts + ours if ours else starts
    for size in FIRST_SIZES:
        starts = _climb(exact, starts.best(count).filled(count), size).best(KEPT)
    angle, moved, last = degrees(starts.chords[0]), math.inf, starts.best(1)
    for _ in range(LAST_ROUNDS):
        last = _climb(exact, last.filled(LANES), np.geomspace(1e-9, 1.0, LANES)).best(1)
        moved, angle = degrees(last.chords[0]) - angle, degrees(last.chords[0])
        if moved <= SETTLED * angle:
            break
    is_ours = ours and degrees(ours.chords[0]) >= angle * (1 - SAME)
    x, y, z = (float(c) for c in last.normals[:, 0])
    return Worst(angle, (x, y, z), way if is_ours else CLIMBING, moved)


def _worst_of(exact: ExactCodec, blocks: Iterable[Callable[[], np.ndarray]], count: int) -> Starts:
    """The worst of normals that come in blocks of shape (3, up to BLOCK), at most `count`."""

    def peaks(block: Callable[[], np.ndarray]) -> Starts:
        normals = block()
        chords, index = cells.column_peaks(exact.chords(normals), cells.KEPT)
        return Starts(chords, normals[:, index])

    best = Starts(np.empty(0), np.empty((3, 0)))
    for found in on_all_cores(peaks, blocks):
        best = (best + found).best(count)
    return best


def spread(count: int, is_half: bool) -> Iterator:
    """Directions of equal area over the domain, by golden ratios."""

    def block(start: int) -> np.ndarray:
        index = np.arange(start, start + BLOCK) + 0.5
        z, turn = (np.modf(index * step)[0] for step in (0.7548776662466927, 0.5698402909980532))
        return _on_sphere(z if is_half else 2.0 * z - 1.0, 2.0 * np.pi * turn)

    return (partial(block, start) for start in range(0, count, BLOCK))


def _on_sphere(z: np.ndarray, angle: np.ndarray) -> np.ndarray:
    r = np.sqrt(1.0 - z * z)
    return np.stack([np.cos(angle) * r, np.sin(angle) * r, z])


def _special(is_half: bool) -> Iterator:
    """Where codes are folded, cut or singular: great circles between axes and diagonals, both sides of them; the rim of
    a hemisphere, closely; and rings around the axes. Nearer than 1e-4 to a pole even float64 cancels in
    some encodings, which are then not the exact map."""
    circle = _on_sphere(np.zeros(BLOCK // 4), np.arange(BLOCK // 4) * (8 * np.pi / BLOCK))
    diagonals = [(1, s, 0) for s in (1, -1)] + [(1, 0, s) for s in (1, -1)] + [(0, 1, s) for s in (1, -1)]
    for across in [*np.eye(3), *np.array(diagonals)]:
        for offset in (0.0, 1e-9, -1e-9):
            yield partial(_about, across, circle + np.array([[0.0], [0.0], [offset]]))
    for axis in (*np.eye(3), *-np.eye(3)):
        height = np.cos(np.repeat(np.geomspace(1e-4, 1.0, 256), 64))
        yield partial(_about, axis, _on_sphere(height, np.arange(len(height)) * (np.pi / 32)))
    for start in range(16 if is_half else 0):
        angle = (np.arange(BLOCK) + start / 16) * (2 * np.pi / BLOCK)
        yield partial(_on_sphere, np.zeros(BLOCK), angle)


def _about(axis: np.ndarray, around_z: np.ndarray) -> np.ndarray:
    """Unit normals about +z turned to another axis."""
    axis = axis / np.linalg.norm(axis)
    least = np.eye(3)[np.argmin(np.abs(axis))]
    x = np.cross(least, axis)
    x /= np.linalg.norm(x)
    turned = np.stack([x, np.cross(axis, x), axis], axis=1) @ around_z
    return turned / np.linalg.norm(turned, axis=0)


def _climb(exact: ExactCodec, starts: Starts, first) -> Starts:
    """Normals, a multiple of LANES, each moved to the worst of WAYS around it; steps shrink where none is worse.

    `first` is the size of the first step in the error, for all or for each.
    """
    sizes = first * np.sqrt(np.maximum(starts.chords, 0.0))
    parts = (slice(begin, begin + LANES) for begin in range(0, len(sizes), LANES))
    return reduce(add, on_all_cores(lambda part: _climb_from(exact, starts[part], sizes[part]), parts))


def _climb_from(exact: ExactCodec, starts: Starts, sizes: np.ndarray) -> Starts:
    """LANES normals, moved by steps of these sizes to begin with."""
    chords, normals = starts.chords, starts.normals
    errors, lane = np.sqrt(np.maximum(chords, 0.0)), np.arange(LANES)
    for step in range(STEPS):
        around = exact.around(normals, sizes, step)
        found = exact.chords(around.reshape(3, BLOCK)).reshape(WAYS, LANES)
        way = found.argmax(axis=0)
        worst = found[way, lane]
        is_worse = worst > chords
        chords = np.where(is_worse, worst, chords)
        normals = np.where(is_worse, around[:, way, lane], normals)
        sizes = sizes * np.where(is_worse, GROW, SHRINK)
        if (sizes < LEAST * errors).all():
            break
    return Starts(chords, normals)
