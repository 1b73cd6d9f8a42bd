"""What `metrics/meter.py` measures, of large sets and faster: the same JAX functions, compiled by the C compiler."""

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
from ...ground.native.library import address, compiler, library, source
from ..metrics.histogram import BINS, bin_of, bins_of, lower_edge
from ..metrics.meter import Load, errors, is_smaller, worst_of
from ..metrics.totals import ChunkTotal, Figures, Worst

HERE = Path(__file__).parent
FLOAT = np.dtype(np.float32)
FLOATS = Vec3(FLOAT, FLOAT, FLOAT)
# Normals that are measured at once.
BLOCK = 256


class _Codec(ctypes.Structure):
    """What row.c calls so."""

    _fields_ = (("decode", ctypes.c_void_p), ("given", ctypes.c_void_p))


class _Chunk(ctypes.Structure):
    """What row.c calls so."""

    _fields_ = (
        ("planes", ctypes.c_void_p * 6),
        ("covered", ctypes.c_void_p),
        ("tops", ctypes.c_void_p),
        ("count", ctypes.c_size_t),
    )


class _Chunks:
    """Chunks for row.c, all in one call: between calls a thread waits for Python's lock.

    Attributes:
        given: what its functions take of them.
    """

    def __init__(self, chunks: Sequence[Any]):
        held = ([*map(np.asarray, (*chunk.n, *chunk.view, chunk.covered))] for chunk in chunks)
        self._held = [(*arrays, np.empty(arrays[0].size // BLOCK, np.float32)) for arrays in held]
        made = (_Chunk * len(chunks))()
        for one, (*planes, covered, tops) in zip(made, self._held, strict=True):
            one.planes[:] = [*map(address, planes)]
            one.covered, one.tops, one.count = address(covered), address(tops), planes[0].size
        self.given = made, ctypes.c_size_t(len(chunks))


@cache
def _row_library() -> ctypes.CDLL:
    """The library of row.c, the same for all codecs."""

    def errors_of(n: Vec3, decoded: Vec3) -> tuple:
        squared, article, angle, invalid = errors(n, decoded, True)
        # In numbers as wide as the others: what holds as many of these makes four times as many of the others.
        return squared, article, angle, *(jnp.asarray(one, jnp.int32) for one in (invalid, bins_of(angle, True)))

    function = c_function("errors_of", errors_of, FLOATS, FLOATS)
    made = library(source(HERE / "row.c", function, (), bins=BINS, block=BLOCK), "row", "in_bin")
    made.in_bin.restype = ctypes.c_size_t
    return made


class NativeMeter:
    """Measures what a round trip makes of chunks of normals. All chunks that it is given at once are one part.

    Args:
        round_trip: (normals, view positions, *given) -> decoded normals; elementwise.
        given: what it is called with besides: named tuples of float32.

    Raises:
        NotElementwiseError, NoCompilerError: it cannot be compiled here.
    """

    def __init__(self, round_trip: Callable[..., Vec3], given: Sequence[Any] = ()):
        types = [type(one)(*[FLOAT] * len(one)) for one in given]
        self._given = np.array([number for one in given for number in one], np.float64)
        function = c_function("round_trip", round_trip, FLOATS, FLOATS, *types)
        text = source(HERE / "decode.c", function, [c_type(FLOAT)] * len(self._given), block=BLOCK)
        self._library = library(text, "decode")
        decode = ctypes.cast(self._library.decode, ctypes.c_void_p)
        self._codec, self._row_library = ctypes.byref(_Codec(decode, address(self._given))), _row_library()

    @property
    def compiler(self) -> str:
        """What compiled it."""
        return compiler()

    def parts(self, loads: Sequence[Load], met_deg: float = 0.0, device: Any = None) -> list[ChunkTotal]:  # noqa: ARG002
        """The statistics of chunks, as `Meter.parts` gives them; JAX's device is of no concern."""
        figures, counts = np.zeros(len(Figures._fields)), np.zeros(BINS + 1, np.uint32)
        chunks = _Chunks([load() for load in loads])
        self._row_library.row(self._codec, *chunks.given, address(figures), address(counts))
        found = Figures(*figures.tolist())
        worst = None if is_smaller(found.largest, met_deg) else self._worst(chunks, found.largest, counts)
        return [(found, counts.astype(np.int64), worst)]

    def _worst(self, chunks: _Chunks, largest: float, counts: np.ndarray) -> Worst | None:
        """The normal with the largest angle, among those of the highest bin; None where none counts."""
        number = bin_of(largest)
        found, least = np.empty((counts[number], 6), np.float32), ctypes.c_float(lower_edge(number))
        room = ctypes.c_size_t(len(found))
        have = self._row_library.in_bin(self._codec, *chunks.given, least, number, room, address(found))
        return worst_of(found[:have, :3], found[:have, 3:])
