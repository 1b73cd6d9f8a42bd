"""The normals that browsers encode, bit-identical to those in live/measure.js: hard normals, then random normals.

Random normals are made from hashed integers by float32 sums, products and square roots, which every machine rounds
identically. Hard normals are stored in the page, as bits.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from ...ground.directions import RANDOM, directions

COUNT = 2**16
# lowbias32 of C. Wellons, "Prospecting for Hash Functions" (2018): x ^= x >> shift, then x *= factor, in turn.
SHIFTS, FACTORS = (16, 15, 16), (0x7FEB352D, 0x846CA68B)
# Where each use of the hash begins to count.
NORMALS, VIEWS, WEIGHTS, SUMS = 0, 1 << 30, 2 << 30, 3 << 30
# Numbers of the hash that a normal takes at each try, and a view.
PER_TRY, PER_VIEW = 2, 3
# Points on each line where maps fold, and how far beside it they lie.
ON_LINES, BESIDE = 24, (0.0, -0.0, 1e-7, -1e-7)
NEXT_TO_0 = 1e-30
PAIRS = ((0, 1), (1, 2), (2, 0))


def hashed(words: np.ndarray) -> np.ndarray:
    """Return a well-mixed hash of each integer, uint32 of the same shape."""
    mixed = words.astype(np.uint32)
    for shift, factor in zip(SHIFTS, (*FACTORS, 1), strict=True):
        mixed = (mixed ^ mixed >> np.uint32(shift)) * np.uint32(factor)
    return mixed


def _uniform_numbers(words: np.ndarray) -> np.ndarray:
    """Return a number in [-1, 1) for each word, from the upper 24 bits of its hash, exact in float32."""
    return (hashed(words) >> np.uint32(8)).astype(np.float32) * np.float32(2.0**-23) - np.float32(1)


def _random_normals(index: np.ndarray) -> np.ndarray:
    """Return uniformly distributed unit normals, float32 of shape (count, 3), which depend only on the indices.

    G. Marsaglia, "Choosing a Point from the Surface of a Sphere" (1972): the first (a, b) with s = a^2 + b^2 < 1
    gives (2 a sqrt(1 - s), 2 b sqrt(1 - s), 1 - 2 s).
    """
    unity, two = np.float32(1), np.float32(2)
    a, b, open_, turn = (np.zeros(len(index), kind) for kind in ("f4", "f4", "?", "u4"))
    open_[:] = True
    while open_.any():
        word = np.uint32(NORMALS) + np.uint32(PER_TRY) * (turn[open_] * np.uint32(COUNT) + index[open_])
        a[open_], b[open_] = _uniform_numbers(word), _uniform_numbers(word + np.uint32(1))
        turn += 1
        open_ = a * a + b * b >= unity
    s = a * a + b * b
    root = np.sqrt(unity - s)
    return np.stack([two * a * root, two * b * root, unity - two * s], axis=1)


def _at_length_1(vectors: np.ndarray) -> np.ndarray:
    return (vectors / np.linalg.norm(vectors, axis=1, keepdims=True)).astype(np.float32)


def _fold_normals() -> np.ndarray:
    """Return normals on the planes where encodings fold, x = 0 and |x| = |y| for all pairs of axes, and close to
    x = 0."""
    points, parts = _random_normals(np.arange(ON_LINES, dtype=np.uint32)).astype(np.float64), []
    for axis, other in PAIRS:
        for value in BESIDE:
            parts.append(points.copy())
            parts[-1][:, axis] = value
        for sign in (1.0, -1.0):
            parts.append(points.copy())
            parts[-1][:, other] = sign * points[:, axis]
    return _at_length_1(np.concatenate(parts))


def _neighbour_normals(n: np.ndarray) -> np.ndarray:
    """Return six neighbours of each normal, not renormalised: one component is moved up or down by one float32 step.
    A component of 0 becomes NEXT_TO_0 or -NEXT_TO_0, whose products are still normal numbers: devices may flush
    subnormal numbers."""
    parts = []
    for axis in range(3):
        for toward in (-2.0, 2.0):
            next_ = np.nextafter(n[:, axis], np.float32(toward))
            parts.append(n.copy())
            parts[-1][:, axis] = np.where(n[:, axis] == 0, np.float32(np.sign(toward) * NEXT_TO_0), next_)
    return np.concatenate(parts)


@cache
def hard() -> np.ndarray:
    """Return the axes with zeros of both signs, the diagonals, neighbours of both, and normals where encodings fold:
    float32 of shape (count, 3)."""
    known = directions()[:-RANDOM]
    diagonals = known[-26:]
    return np.concatenate([known, _neighbour_normals(diagonals), _fold_normals()])


@cache
def normals(domain: str) -> tuple[np.ndarray, np.ndarray]:
    """Return unit normals in a domain, hard normals first, and view-space positions: float32, (COUNT, 3) each.

    Args:
        domain: "sphere", "hemisphere" (z >= 0) or "view" (normals that face the viewer).
    """
    given = hard()
    n = np.concatenate([given, _random_normals(np.arange(len(given), COUNT, dtype=np.uint32))])
    view = _view_positions()
    if domain == "hemisphere":
        n[:, 2] = np.abs(n[:, 2])
    if domain == "view":
        # summed in this order, which is the browser's
        away = n[:, 0] * view[:, 0] + n[:, 1] * view[:, 1] + n[:, 2] * view[:, 2] > 0
        n[away] = -n[away]
    return n, view


def _view_positions() -> np.ndarray:
    """Return positions in front of a viewer, float32, (COUNT, 3): x and y in [-1, 1), z in [-3, -1/2)."""
    index = np.arange(COUNT * PER_VIEW, dtype=np.uint32).reshape(COUNT, PER_VIEW)
    view = _uniform_numbers(np.uint32(VIEWS) + index)
    view[:, 2] = view[:, 2] * np.float32(1.25) - np.float32(1.75)
    return view


def checksum(values: np.ndarray) -> int:
    """Return a checksum of 32-bit numbers that depends on their order: the sum of hashed words modulo 2^32."""
    words = np.ascontiguousarray(values).view(np.uint32).ravel()
    places = hashed(np.uint32(SUMS) + np.arange(len(words), dtype=np.uint32))
    return int(np.sum(hashed(words ^ places), dtype=np.uint32))
