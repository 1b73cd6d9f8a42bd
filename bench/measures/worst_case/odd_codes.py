"""Wasted and strange codes: codes that are never made, that point in the same direction as another code, or that
decode to a normal with a different code.

A code is used if some normal in the domain is encoded to it. The search tries normals at the middle, corners and
edges of its cell, and directions spread over the domain: if a code has three numbers, the sphere only grazes some
cells, and if it comes from a lookup table, its cell may be anywhere. A code that none of these normals makes is
called unused, although a sliver of directions might make it. Unused and duplicate codes are found in float64, which
stands for the exact map. Codes that decode to a normal with a different code are found in float32, as a shader
computes them.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from ....encodings.codecs.codec import Codec
from ...ground.machine.cores import on_all_cores
from .cells import sides
from .exact_codec import BLOCK, ExactCodec
from .search import spread

MOST_CODES = 2**24
SAMPLES_A_CODE, MOST_SAMPLES = 64, 2**26
# Directions this near are one: far below what tells codes apart, far above what float64 adds. They are sorted by boxes
# of this side, whose borders lie elsewhere in a second go, for two equal ones may lie across a border.
SAME, OFFSETS = 2.0**-26, (0.2718, 0.7183)
MIX = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)


@dataclass(frozen=True)
class OddCodes:
    """Counts of a codec's odd codes.

    Attributes:
        unused: codes that no normal in the domain makes.
        duplicate: codes minus distinct directions: the number of codes that could be spared.
        unstable: used codes that decode to a normal with a different code.
    """

    unused: int
    duplicate: int
    unstable: int


@cache
def odd_codes(codec: Codec, is_half: bool = False) -> OddCodes | None:
    """Return the counts of odd codes on the sphere, or on z >= 0 if `is_half`; None for more than 2^24 codes."""
    if codec.codes > MOST_CODES:
        return None
    exact, numbers = ExactCodec(codec, is_half), _Numbers(codec)
    is_used = np.zeros(codec.codes, bool)
    tables = sides(exact)
    for index in on_all_cores(partial(_made_within, exact, numbers, tables), _index_blocks(codec.codes)):
        is_used[index] = True
    samples = min(MOST_SAMPLES, SAMPLES_A_CODE * codec.codes)
    for index in on_all_cores(lambda make: numbers.index(exact.codes(make())), spread(samples, is_half)):
        is_used[index] = True
    stays = np.concatenate(list(on_all_cores(partial(_comes_back, exact, numbers), _index_blocks(codec.codes))))
    distinct = _distinct_count(exact, numbers)
    unused = codec.codes - int(is_used.sum())
    return OddCodes(unused, codec.codes - distinct, int((is_used & ~stays).sum()))


def _index_blocks(count: int) -> Iterator[np.ndarray]:
    return (np.arange(start, min(start + BLOCK, count)) for start in range(0, count, BLOCK))


class _Numbers:
    """A codec's codes as indices: the first component's number varies slowest."""

    def __init__(self, codec: Codec):
        self.tables = [codec.numbers(i) for i in range(codec.encoding.components + codec.encoding.sign_bits)]
        self.shape = tuple(len(table) for table in self.tables)
        self._middles = [(table[:-1] + table[1:]) / 2 for table in self.tables]
        self._is_even = [np.allclose(np.diff(table), table[1] - table[0], rtol=1e-6) for table in self.tables]

    def places(self, index: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return for each component the index of each code's number among the numbers of that component."""
        return np.unravel_index(index, self.shape)

    def codes(self, index: np.ndarray) -> np.ndarray:
        """Return the codes with these indices, shape (components, count)."""
        return np.stack([table[place] for table, place in zip(self.tables, self.places(index), strict=True)])

    def index(self, codes: np.ndarray) -> np.ndarray:
        """Return the index of each stored code; `codes` has shape (components, count)."""
        return np.ravel_multi_index([self._nearest_index(i, c) for i, c in enumerate(codes)], self.shape, mode="clip")

    def _nearest_index(self, component: int, c: np.ndarray) -> np.ndarray:
        table = self.tables[component]
        if self._is_even[component]:
            return np.rint((c - table[0]) * (1.0 / (table[1] - table[0]))).astype(np.int64)
        return np.searchsorted(self._middles[component], c)


def _made_within(exact: ExactCodec, numbers: _Numbers, tables: list[np.ndarray], index: np.ndarray) -> np.ndarray:
    """Return the elements of `index` whose codes are made by normals at the middle, edges or corners of the cell."""
    is_made = np.zeros(len(index), bool)
    for where in _stencil(exact):
        left = np.flatnonzero(~is_made)
        if not len(left):
            break
        normals = exact.normals(_code_points(exact, numbers, tables, index[left], where))
        makes = numbers.index(exact.codes(normals)) == index[left]
        is_made[left] = makes & (normals[2] >= 0.0) if exact.is_half else makes
    return index[is_made]


def _stencil(exact: ExactCodec) -> list[tuple[int, ...]]:
    """Return the points of a cell to try, each as -1, 0 or 1 for each free component: the beginning, middle or end of
    its interval. The middle comes first; edges are left out if there are three or more free components."""
    every: list[tuple[int, ...]] = list(itertools.product((0, -1, 1), repeat=len(exact.free)))
    return every if len(exact.free) < 3 else [where for where in every if len({abs(side) for side in where}) == 1]


def _code_points(
    exact: ExactCodec, numbers: _Numbers, tables: list[np.ndarray], index: np.ndarray, where
) -> np.ndarray:
    code = numbers.codes(index)
    places = numbers.places(index)
    for component, side in zip(exact.free, where, strict=True):
        if side:
            code[component] = tables[component][2 * places[component] + (side > 0)]
    return code


def _comes_back(exact: ExactCodec, numbers: _Numbers, index: np.ndarray) -> np.ndarray:
    """Return a mask of the codes that decode to a normal with the same code, in float32; codes are given by index."""
    normals = exact.normals(numbers.codes(index).astype(np.float32))
    return numbers.index(exact.codes(normals).astype(np.float64)) == index


def _distinct_count(exact: ExactCodec, numbers: _Numbers) -> int:
    """Count the directions to which the codes decode; directions closer than SAME count once (the lowest count over
    several shifted grids)."""
    keys = np.empty((len(OFFSETS), exact.codec.codes), np.uint64)

    def boxes(index: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        place = exact.normals(numbers.codes(index)) / SAME
        cells = [np.floor(place + offset).astype(np.int64).view(np.uint64) for offset in OFFSETS]
        return index, np.stack([(box * MIX[:, None]).sum(axis=0, dtype=np.uint64) for box in cells])

    for index, hashes in on_all_cores(boxes, _index_blocks(exact.codec.codes)):
        keys[:, index] = hashes
    keys.sort(axis=1)
    return int((np.diff(keys, axis=1) != 0).sum(axis=1).min()) + 1
