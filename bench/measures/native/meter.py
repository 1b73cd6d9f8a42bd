"""A faster `metrics/meter.py`: the same JAX functions, compiled by the C compiler."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np

from ....encodings.vec import Vec3
from ...ground.native.elementwise import c_function, c_type
from ...ground.native.library import address, library, source
from ..metrics.histogram import BINS, bin_of, bins_of, lower_edge
from ..metrics.meter import Load, errors, is_smaller, worst_of
from ..metrics.totals import ChunkTotal, Figures, Worst

HERE = Path(__file__).parent
FLOAT = np.dtype(np.float32)
FLOATS = Vec3(FLOAT, FLOAT, FLOAT)
# Normals that are measured at once.
BLOCK = 256


class _Codec(ctypes.Structure):
    """The structure `Codec` of row.c."""

    _fields_ = (("decode", ctypes.c_void_p), ("given", ctypes.c_void_p))


class _Chunk(ctypes.Structure):
    """The structure `Chunk` of row.c."""

    _fields_ = (
        ("planes", ctypes.c_void_p * 6),
        ("covered", ctypes.c_void_p),
        ("tops", ctypes.c_void_p),
        ("count", ctypes.c_size_t),
    )


class _Held:
    """A chunk for row.c, with the arrays that it points to."""

    def __init__(self, chunk: Any):
        *planes, covered = self._arrays = [*map(np.asarray, (*chunk.n, *chunk.view, chunk.covered))]
        self._tops = np.empty(covered.size // BLOCK, np.float32)
        addresses = (ctypes.c_void_p * len(planes))(*map(address, planes))
        self.chunk = ctypes.byref(_Chunk(addresses, address(covered), address(self._tops), covered.size))


@cache
def _row_library() -> ctypes.CDLL:
    """Return the compiled library of row.c, the same for all codecs."""

    def errors_of(n: Vec3, decoded: Vec3) -> tuple:
        squared, article, angle, invalid = errors(n, decoded, True)
        # In numbers as wide as the others: what holds as many of these makes four times as many of the others.
        return squared, article, angle, *(jnp.asarray(figure, jnp.int32) for figure in (invalid, bins_of(angle, True)))

    function = c_function("errors_of", errors_of, FLOATS, FLOATS)
    row_library = library(source(HERE / "row.c", function, (), bins=BINS, block=BLOCK), "row", "in_bin")
    row_library.in_bin.restype = ctypes.c_size_t
    return row_library


def decoder(round_trip: Callable[..., Vec3], given: Sequence[Any] = ()) -> ctypes.CDLL:
    """Return a compiled round trip, for a `NativeMeter`.

    Args:
        round_trip: (normals, view positions, *given) -> decoded normals; elementwise.
        given: named tuples of float32, like the other arguments of `round_trip`; their values do not matter.

    Raises:
        NotElementwiseError, NoCompilerError: the round trip cannot be compiled here.
    """
    types = [type(numbers)(*[FLOAT] * len(numbers)) for numbers in given]
    function = c_function("round_trip", round_trip, FLOATS, FLOATS, *types)
    text = source(HERE / "decode.c", function, [c_type(FLOAT)] * sum(map(len, types)), block=BLOCK)
    return library(text, "decode", "decode_all")


class NativeMeter:
    """A meter for the errors of a round trip on chunks of normals.

    Args:
        compiled: the round trip, from `decoder`.
        given: the other arguments of the round trip.

    Raises:
        NoCompilerError: the statistics cannot be compiled here.
    """

    def __init__(self, compiled: ctypes.CDLL, given: Sequence[Any] = ()):
        self._given = np.array([number for numbers in given for number in numbers], np.float64)
        self._library = compiled
        decode = ctypes.cast(compiled.decode, ctypes.c_void_p)
        self._codec, self._row_library = ctypes.byref(_Codec(decode, address(self._given))), _row_library()

    def decoded(self, block: Any) -> Vec3:
        """Return the decoded normals of a chunk, whose size is a multiple of BLOCK."""
        planes = [*map(np.asarray, (*block.n, *block.view))]
        decoded = Vec3(*(np.empty(planes[0].shape, np.float32) for _ in range(3)))
        taken, given = ((ctypes.c_void_p * len(arrays))(*map(address, arrays)) for arrays in (planes, decoded))
        self._library.decode_all(taken, address(self._given), ctypes.c_size_t(planes[0].size), given)
        return decoded

    def one(self, load: Load, met_deg: float = 0.0, device: Any = None) -> ChunkTotal:  # noqa: ARG002
        """Return one chunk's figures, histogram and worst normal, as `Measures.one` does, always on the processor."""
        sums, counts, held = np.zeros(len(Figures._fields)), np.zeros(BINS + 1, np.uint32), _Held(load())
        self._row_library.row(self._codec, held.chunk, address(sums), address(counts))
        figures = Figures(*sums.tolist())
        return figures, counts, None if is_smaller(figures.largest, met_deg) else self._worst(held, figures, counts)

    def _worst(self, held: _Held, figures: Figures, counts: np.ndarray) -> Worst | None:
        """Return the normal with the largest angle in a chunk, from that angle's bin; None if no normal counts."""
        number = bin_of(figures.largest)
        vectors, least = np.empty((counts[number], 6), np.float32), ctypes.c_float(lower_edge(number))
        room = ctypes.c_size_t(len(vectors))
        have = self._row_library.in_bin(self._codec, held.chunk, least, number, room, address(vectors))
        return worst_of(vectors[:have, :3], vectors[:have, 3:])
