"""What `metrics/meter.py` measures, of large sets and faster: the same JAX functions, compiled by the C compiler."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import jax.numpy as jnp
import numpy as np

from ...encodings.vec import Vec3
from ..metrics.histogram import BINS, bin_of, bins_of, lower_edge
from ..metrics.meter import Load, errors, is_smaller, worst_of
from ..metrics.totals import Figures, Part, Worst
from .elementwise import c_function, c_type
from .library import address, compiler, library, source

FLOAT = np.dtype(np.float32)
FLOATS = Vec3(FLOAT, FLOAT, FLOAT)
# Normals that are measured at once.
BLOCK = 1024


class _Codec(ctypes.Structure):
    """What row.c calls so."""

    _fields_ = (("decode", ctypes.c_void_p), ("given", ctypes.c_void_p))


class _Chunk(ctypes.Structure):
    """What row.c calls so, of planes that are held as long as it is."""

    _fields_ = (("planes", ctypes.c_void_p * 6), ("covered", ctypes.c_void_p), ("count", ctypes.c_size_t))

    def __init__(self, chunk: Any):
        self._held = [*map(np.asarray, (*chunk.n, *chunk.view, chunk.covered))]
        *planes, covered = (array.__array_interface__["data"][0] for array in self._held)
        super().__init__((ctypes.c_void_p * 6)(*planes), covered, self._held[0].size)
        self.tops = np.empty(self.count // BLOCK, np.float32)


@cache
def _row() -> ctypes.CDLL:
    """The library of row.c, the same for all codecs."""

    def errors_of(n: Vec3, decoded: Vec3) -> tuple:
        squared, article, angle, invalid = errors(n, decoded, True)
        # In numbers as wide as the others: what holds as many of these makes four times as many of the others.
        return squared, article, angle, *(jnp.asarray(one, jnp.int32) for one in (invalid, bins_of(angle, True)))

    function = c_function("errors_of", errors_of, FLOATS, FLOATS)
    made = library(source("row.c", function, (), bins=BINS, block=BLOCK), "row", "moments", "in_bin")
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
        text = source("decode.c", function, [c_type(FLOAT)] * len(self._given), block=BLOCK)
        self._library = library(text, "decode")
        decode = ctypes.cast(self._library.decode, ctypes.c_void_p)
        self._codec, self._row = ctypes.byref(_Codec(decode, address(self._given))), _row()

    @property
    def compiler(self) -> str:
        """What compiled it."""
        return compiler()

    def parts(self, loads: Sequence[Load], met_deg: float = 0.0, device: Any = None) -> list[Part]:  # noqa: ARG002
        """The statistics of chunks, as `Meter.parts` gives them; JAX's device is of no concern."""
        figures, counts = np.zeros(len(Figures._fields)), np.zeros(BINS + 1, np.int64)
        chunks = [_Chunk(load()) for load in loads]
        for chunk in chunks:
            self._row.row(self._codec, ctypes.byref(chunk), *map(address, (figures, counts, chunk.tops)))
        found = Figures(*figures.tolist())
        worst = None if is_smaller(found.largest, met_deg) else self._worst(chunks, found.largest)
        return [(found, counts, worst)]

    def moments(self, loads: Sequence[Load]) -> tuple[float, float]:
        """The sum and the largest of |n - n'|^2 of chunks, and nothing else."""
        figures = np.zeros(2)
        for chunk in (_Chunk(load()) for load in loads):
            self._row.moments(self._codec, ctypes.byref(chunk), address(figures))
        return float(figures[0]), float(figures[1])

    def _worst(self, chunks: Sequence[_Chunk], largest: float) -> Worst | None:
        """The normal with the largest angle, among those of the highest bin; None where none counts."""
        number = bin_of(largest)
        least, some = lower_edge(number), [np.empty((0, 6), np.float32)]
        for chunk in chunks:
            if chunk.tops.max() >= least:
                rows = np.empty((chunk.count, 6), np.float32)
                given = address(chunk.tops), ctypes.c_float(least), number, address(rows)
                some.append(rows[: self._row.in_bin(self._codec, ctypes.byref(chunk), *given)])
        found = np.concatenate(some)
        return worst_of(found[:, :3], found[:, 3:])
