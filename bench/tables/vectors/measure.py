"""Measurement of the vectors table: the errors of stored motion vectors, by JAX and by GLSL."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.motion_codec import NUMBERS, MotionCodec, MotionEncoding
from ....encodings.storages.dither import laid_out
from ....encodings.storages.rounding import fixed, shared
from ....encodings.storages.storage import Storage
from ....encodings.vec import Vec2
from ....gbuffer.codecs.motion.motion_passes import MotionPasses
from ....gbuffer.gl.device import device
from ..table import Row
from ..unmeasurable import UNMEASURABLE
from .paths import FRAMES, POINTS, Paths
from .table import TABLE

CHUNK, WIDTH = FRAMES * POINTS, 256
# Along x and y, both ways: where motions are looked for that are just told from rest, from 2^-60 of a screen on.
DIRECTIONS = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
LEAST = 2.0**-60

# float32 motions of shape (count, 2), in screens, to what they come back as.
Trip = Callable[[np.ndarray], np.ndarray]
How = dict[str, str]
# What is added to the codes of CHUNK motions, by pixel of a picture of WIDTH: float32 of shape (height, width, 4).
Noise = np.ndarray | None


@dataclass(frozen=True)
class MotionVectorCase:
    """A codec of motion vectors to measure with one backend, in one row for each speed.

    Attributes:
        codec: encoding and storage of the motion vectors.
        backend: "jax" or "glsl".
        largest: range of the motion vectors in screens.
        speeds: speeds in pixels per frame.
        paths: the moving points.
    """

    codec: MotionCodec
    backend: str
    largest: float
    speeds: tuple[float, ...]
    paths: Paths

    @property
    def name(self) -> str:
        return f"{self.codec.name} {self.backend}" + (f" {self.largest:g}" if self.codec.needs_range else "")

    @property
    def size(self) -> str:
        return "x".join(map(str, self.paths.size))


@cache
def _compiled_trip(encoding: MotionEncoding, storage: Storage, rounding: str) -> Callable[..., Any]:
    def trip(motions, largest, scales, noise):
        codec, added = MotionCodec(encoding, fixed(storage, scales), rounding), None if noise is None else Vec2(*noise)
        return jnp.stack(codec.round_trip(Vec2(*motions), largest, added))

    return jax.jit(trip)


@contextmanager
def _trip_by_jax(codec: MotionCodec, largest: float, noise: Noise) -> Iterator[tuple[Trip, How]]:
    like, scales = shared(codec.storage, NUMBERS)
    compiled = _compiled_trip(codec.encoding, like, codec.rounding)
    added = None if noise is None else np.ascontiguousarray(laid_out(noise, WIDTH, CHUNK)[:, :NUMBERS].T)

    def trip(motions: np.ndarray) -> np.ndarray:
        return np.asarray(compiled(np.ascontiguousarray(motions.T), np.float32(largest), scales, added)).T

    yield trip, {"device": jax.devices()[0].device_kind, "rounded_by": "emulation"}


@contextmanager
def _trip_by_glsl(codec: MotionCodec, largest: float, noise: Noise) -> Iterator[tuple[Trip, How]]:
    gl = device()
    with MotionPasses(gl, codec, noise) as passes:

        def trip(motions: np.ndarray) -> np.ndarray:
            return passes.round_trip(motions.reshape(-1, WIDTH, NUMBERS), largest).reshape(-1, NUMBERS)

        yield trip, {"device": gl.renderer, "rounded_by": passes.rounded_by}


Backend = Callable[[MotionCodec, float, Noise], AbstractContextManager[tuple[Trip, How]]]
BACKENDS: Mapping[str, Backend] = MappingProxyType({"jax": _trip_by_jax, "glsl": _trip_by_glsl})


def measure(case: MotionVectorCase) -> list[Row]:
    """Return a row for each speed; if the device cannot measure the case, the rows have the reason in `skipped` and
    no figures."""
    rows = [_case_columns(case, speed) for speed in case.speeds]
    try:
        with ExitStack() as stack:
            # Rest, and what is just told from it, are exact cases: they have no noise.
            exact, how = stack.enter_context(BACKENDS[case.backend](case.codec, case.largest, None))
            still = _of_any_count(exact)
            rest = still(np.zeros((1, NUMBERS), np.float32))
            both = {"still_px": _length_px(rest, case.paths.size), "least_px": _least_speed_px(still, rest, case)}
            trip = _noisy_trip(stack, case) if case.codec.is_dithered else exact
            all_figures = [_figures(case, speed, trip, rest) for speed in case.speeds]
    except UNMEASURABLE as error:
        return [row | {"skipped": str(error)} for row in rows]
    return [row | both | figures | how for row, figures in zip(rows, all_figures, strict=True)]


def _noisy_trip(stack: ExitStack, case: MotionVectorCase) -> Trip:
    """Return a round trip that adds separate noise to each frame; the noise of all frames is stacked vertically."""
    noise = np.concatenate([case.codec.dither(frame).added[: POINTS // WIDTH] for frame in range(FRAMES)])
    return stack.enter_context(BACKENDS[case.backend](case.codec, case.largest, noise))[0]


def _case_columns(case: MotionVectorCase, speed: float) -> Row:
    return TABLE.empty() | {
        "encoding": case.codec.encoding.name,
        "storage": case.codec.storage.name,
        "rounding": case.codec.rounding,
        "backend": case.backend,
        "range": case.largest if case.codec.needs_range or case.codec.encoding.own_range else None,
        "size": case.size,
        "speed": speed,
        "bits": case.codec.bits,
        "count": case.paths.count,
        "seed": case.paths.seed,
    }


def _of_any_count(trip: Trip) -> Trip:
    """Return the same round trip for up to CHUNK motions. They are padded to CHUNK with the last motion, so that the
    trip is compiled once and the motions fill a rectangle of pixels."""

    def whole(motions: np.ndarray) -> np.ndarray:
        padded = np.pad(motions, ((0, CHUNK - len(motions)), (0, 0)), mode="edge")
        return trip(padded)[: len(motions)]

    return whole


def _length_px(motion: np.ndarray, size: tuple[int, int]) -> float:
    return math.hypot(*(motion[0].astype(np.float64) * size))


def _figures(case: MotionVectorCase, speed: float, trip: Trip, rest: np.ndarray) -> Row:
    """Return the figures on the motions of all points in all frames at a speed.

    The error of a motion v is |decode(v) - v| in pixels. The drift of a point that the stored vectors move is the sum
    of its errors over all frames.
    """
    total, largest, lost, clipped, square = 0.0, 0.0, 0, 0, 0.0
    for motions in case.paths.chunks(speed):
        decoded = _through(trip, motions)
        apart = (decoded.astype(np.float64) - motions) * case.paths.size
        errors = np.hypot(apart[..., 0], apart[..., 1])
        total, largest = total + errors.sum(), max(largest, errors.max())
        lost += np.count_nonzero((decoded == rest[0]).all(axis=-1))
        clipped += np.count_nonzero((abs(motions) > np.float32(case.largest)).any(axis=-1))
        square += (apart.sum(axis=0) ** 2).sum()
    count = FRAMES * case.paths.count
    return {
        "error_mean_px": float(total / count),
        "error_max_px": float(largest),
        "lost_percent": 100 * lost / count,
        "clipped_percent": 100 * clipped / count if case.codec.clips else 0.0,
        "drift_px": math.sqrt(square / case.paths.count),
    }


def _through(trip: Trip, motions: np.ndarray) -> np.ndarray:
    """Return the decoded motions of up to POINTS points in all frames. They are padded to POINTS with the last point,
    so that each frame keeps its place in the array."""
    count = motions.shape[1]
    whole = np.pad(motions, ((0, 0), (0, POINTS - count), (0, 0)), mode="edge")
    return trip(whole.reshape(-1, NUMBERS)).reshape(whole.shape)[:, :count]


def _least_speed_px(trip: Trip, rest: np.ndarray, case: MotionVectorCase) -> float:
    """Return the lowest speed, in pixels, from which motions along an axis decode differently from no motion, in the
    worst of the four directions; 0 if every tested motion does."""
    low, high = np.full(len(DIRECTIONS), LEAST), np.full(len(DIRECTIONS), max(case.largest, 1.0))
    # Each pass divides the ratio of the two ends by many steps; two come to the digits that float32 has.
    for _ in range(2):
        tried = np.geomspace(low, high, CHUNK // len(DIRECTIONS), axis=1)
        motions = (tried[..., None] * DIRECTIONS[:, None]).astype(np.float32)
        told = (trip(motions.reshape(-1, NUMBERS)) != rest[0]).any(axis=-1).reshape(tried.shape)
        low, high = _around(tried, told)
    return float((np.where(high > LEAST, high, 0.0) * (abs(DIRECTIONS) @ case.paths.size)).max())


def _around(tried: np.ndarray, told: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return, for each direction, the last of ascending motions that decodes like no motion, and the next motion; if
    there is no such motion, twice the first.

    Args:
        tried: motions, (directions, count).
        told: whether each motion decodes differently from no motion."""
    end, everything = tried.shape[1] - 1, told.all(axis=1)
    last = np.where(everything, 0, end - np.argmax(~told[:, ::-1], axis=1))
    after = np.where(everything, 0, np.minimum(last + 1, end))
    directions = np.arange(len(tried))
    return tried[directions, last], tried[directions, after]
