"""The corners of cells, which are where the worst normals of most codecs are.

A cell is the set of numbers that are stored as one code. Its corners are found by asking the storage where the
interval of each number begins and ends, which works for every rounding and every format. A point just inside a
corner is decoded, and its normal is a candidate. The result does not depend on the corners being exact, because the
error of the candidate itself is measured afterwards.
"""

from __future__ import annotations

import itertools
import math
from functools import partial

import numpy as np

from ...ground.machine.cores import on_all_cores
from .exact_codec import SLAB, ExactCodec

ALL_CORNERS, SOME_CORNERS, NEAREST, NONE = "all corners", "corners", "nearest codes", ""
# Cells whose corners are all tried; codes whose convex hull is computed; the sides of a plane that is climbed over.
MOST_CELLS, MOST_POINTS, MOST_NUMBERS = 2**24, 2**18, 2**16
# How far inside its cell a corner is tried, in the cell's width; and halvings that find its edge.
INSIDE, HALVINGS = 1e-9, 60
CLIMBERS, CLIMBS = 2**11, 150
COLUMNS, KEPT = 2**12, 2**8
# Parts of a hull, and how far from the middle of their faces corners are: times the side of a square that is as large
# as a corner's share of the sphere.
BANDS, REACH = 16, 2.0


def way_to_corners(exact: ExactCodec) -> str:
    """Return the method that finds the corners of a codec's cells: NEAREST, ALL_CORNERS, SOME_CORNERS, or NONE ("")
    if the cells are too many or not in a plane."""
    counts = [exact.codec.storage.count(i) for i in exact.free]
    if not counts and exact.codec.codes <= MOST_POINTS:
        return NEAREST
    if len(counts) != 2 or max(counts) > MOST_NUMBERS:
        return NONE
    return ALL_CORNERS if exact.codec.codes <= MOST_CELLS else SOME_CORNERS


def corners(exact: ExactCodec, way: str) -> np.ndarray:
    """Return normals at the worst corners of cells, (3, count), by a method from `way_to_corners` other than NONE."""
    if way == NEAREST:
        return _across_faces(exact)
    tables = sides(exact)
    cells = _all_cells(exact, tables) if way == ALL_CORNERS else _climb_cells(exact, tables)
    return _corners_of(exact, tables, cells)


def sides(exact: ExactCodec) -> list[np.ndarray]:
    """Return an array for each component. For a free component it has two values per number, just inside the two
    ends of the number's interval; for any other component it has the numbers themselves."""
    return [_sides(exact, i) if i in exact.free else exact.codec.numbers(i) for i in range(exact.size)]


def _sides(exact: ExactCodec, component: int) -> np.ndarray:
    numbers = exact.codec.numbers(component)
    middle = (numbers[:-1] + numbers[1:]) / 2
    low, high = numbers[:-1], numbers[1:]
    for _ in range(HALVINGS):
        tried = (low + high) / 2
        is_low = exact.stored(np.tile(tried, (exact.size, 1)))[component] < middle
        low, high = np.where(is_low, tried, low), np.where(is_low, high, tried)
    first, last = np.concatenate([[-1.0], high]), np.concatenate([low, [1.0]])
    margin = INSIDE * (last - first)
    return np.stack([first + margin, last - margin], axis=1).ravel()


def _all_cells(exact: ExactCodec, tables: list[np.ndarray]) -> np.ndarray:
    """Return the CLIMBERS cells with the worst corners, and for each the three other cells that share its corner, as
    indices of shape (components, count)."""
    u, v = exact.free
    rest = [range(1) if i in exact.free else range(len(table)) for i, table in enumerate(tables)]
    edges = tables[u][1:-1:2], tables[v][1:-1:2]
    numbers = exact.codec.numbers(u), exact.codec.numbers(v)

    def slab(place: tuple[tuple[int, ...], tuple[int, ...]]) -> tuple[np.ndarray, np.ndarray]:
        starts, others = place
        ends = [start + size for start, size in zip(starts, SLAB, strict=True)]
        around = [side[start : end + 1] for side, start, end in zip(numbers, starts, ends, strict=True)]
        across = [side[start:end] for side, start, end in zip(edges, starts, ends, strict=True)]
        corner_chords = exact.corners(across, around, np.array([t[i] for t, i in zip(tables, others, strict=True)]))
        chords, index = column_peaks(corner_chords.ravel(), KEPT)
        cells = np.repeat(np.array(others)[:, None], len(index), axis=1)
        cells[u], cells[v] = starts[0] + index // corner_chords.shape[1], starts[1] + index % corner_chords.shape[1]
        return chords, cells

    begins = (range(0, len(side), size) for side, size in zip(edges, SLAB, strict=True))
    worst, cells = np.empty(0), np.empty((exact.size, 0), np.int64)
    for chords, slab_cells in on_all_cores(
        slab, itertools.product(itertools.product(*begins), itertools.product(*rest))
    ):
        worst, cells = np.concatenate([worst, chords]), np.concatenate([cells, slab_cells], axis=1)
        kept = np.argsort(-worst, kind="stable")[:CLIMBERS]
        worst, cells = worst[kept], cells[:, kept]
    steps = np.zeros((exact.size, 4), np.int64)
    steps[u], steps[v] = (0, 0, 1, 1), (0, 1, 0, 1)
    return (cells[:, :, None] + steps[:, None, :]).reshape(exact.size, -1)


def column_peaks(values: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest value of each of COLUMNS interleaved columns, in descending order and at most `count` of
    them, and the indices of these values."""
    columns = np.pad(values, (0, -len(values) % COLUMNS), constant_values=-1.0).reshape(-1, COLUMNS)
    index = np.minimum(columns.argmax(axis=0) * COLUMNS + np.arange(COLUMNS), len(values) - 1)
    kept = index[np.argsort(-values[index], kind="stable")[:count]]
    return values[kept], kept


def _climb_cells(exact: ExactCodec, tables: list[np.ndarray]) -> np.ndarray:
    """Return CLIMBERS cells, as indices of shape (components, CLIMBERS): random cells, each compared CLIMBS times
    with four near or distant cells and replaced by the worst of these if that is worse."""
    random = np.random.default_rng(0)
    sizes = np.array([len(table) // (2 if i in exact.free else 1) for i, table in enumerate(tables)])[:, None]
    cells = random.integers(0, sizes, (exact.size, CLIMBERS))
    worst = np.full(CLIMBERS, -1.0)
    for _ in range(CLIMBS):
        reach = (sizes / 2.0) ** random.uniform(0.0, 1.0, (1, 4 * CLIMBERS))
        tried = np.tile(cells, 4) + np.rint(reach * random.normal(size=(exact.size, 4 * CLIMBERS))).astype(np.int64)
        tried = np.clip(np.where(sizes > 64, tried, np.tile(cells, 4)), 0, sizes - 1)
        errors = exact.chords(_corners_of(exact, tables, tried)).reshape(4, 4, CLIMBERS).max(axis=0)
        best = errors.argmax(axis=0), np.arange(CLIMBERS)
        is_worse = errors[best] > worst
        worst = np.where(is_worse, errors[best], worst)
        cells = np.where(is_worse, tried.reshape(exact.size, 4, CLIMBERS)[:, *best], cells)
    return cells


def _corners_of(exact: ExactCodec, tables: list[np.ndarray], cells: np.ndarray) -> np.ndarray:
    """Return the four corners of cells, (components, count), as normals, (3, 4 count), corner by corner."""
    u, v = exact.free
    around = []
    for corner in range(4):
        side = {u: corner & 1, v: corner >> 1}
        code = [t[2 * c + side[i]] if i in side else t[c] for i, (t, c) in enumerate(zip(tables, cells, strict=True))]
        around.append(np.stack(code))
    return exact.normals(np.concatenate(around, axis=1))


def _across_faces(exact: ExactCodec) -> np.ndarray:
    """Return the directions that are equidistant from three neighbouring codes, (3, count): the face normals of the
    codes' convex hull."""
    numbers = [exact.codec.numbers(i) for i in range(exact.size)]
    code = np.stack([c.ravel() for c in np.meshgrid(*numbers, indexing="ij")])
    return across_faces(_distinct(exact.normals(code).round(12)))


def across_faces(directions: np.ndarray) -> np.ndarray:
    """Return the face normals of the convex hull of distinct directions, shape (3, count).

    The hull of each band of z is computed separately, so that all cores are used. The faces found are faces of the
    whole hull. Euler's formula tells whether any are missing: a hull of n corners has 2 n - 4 triangles.
    """
    edges = np.linspace(-1.0, 1.0, BANDS + 1)
    bands = zip(edges, (*edges[1:-1], np.inf), strict=False)
    face_normals = np.concatenate(list(on_all_cores(partial(_across_band, directions), bands)), axis=1)
    is_whole = face_normals.shape[1] == 2 * directions.shape[1] - 4
    return face_normals if is_whole else _hull(directions)[:3]


def _across_band(directions: np.ndarray, band: tuple[float, float]) -> np.ndarray:
    """Return the normals in a band of z of the hull's faces with near corners, shape (3, count); empty if the
    directions near the band have no hull."""
    reach = REACH * math.sqrt(4 * math.pi / directions.shape[1])
    latitudes, (low, high) = np.arcsin(directions[2]), np.arcsin(np.minimum(band, 1.0))
    is_near = (latitudes >= low - reach) & (latitudes <= high + reach)
    try:
        faces = _hull(directions[:, is_near])
    except (RuntimeError, ValueError):  # too few corners for a hull, or all of them in one plane
        return np.empty((3, 0))
    # No corner that is nearer was left out: the face is one of the whole hull.
    is_near = faces[3] <= -math.cos(reach)
    return faces[:3, is_near & (faces[2] >= band[0]) & (faces[2] < band[1])]


def _hull(directions: np.ndarray) -> np.ndarray:
    """Return the triangles of the convex hull of directions of shape (3, count), as (4, triangles): their normals, and
    minus the cosine of the angle from each normal to its corners."""
    from scipy.spatial import ConvexHull

    return ConvexHull(directions.T).equations.T


def _distinct(directions: np.ndarray) -> np.ndarray:
    """Return directions of shape (3, count), sorted and without duplicates."""
    # np.unique of columns takes ten times as long.
    ordered = directions[:, np.lexsort(directions)]
    is_new = (np.diff(ordered, axis=1) != 0.0).any(axis=0)
    return ordered[:, np.concatenate([[True], is_new])]
