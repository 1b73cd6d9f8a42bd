"""The round trip of a codec as a function of normals: by JAX, or by GLSL if the encoding has no Python version."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

import jax
import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.rounding import Scale, fixed, shared
from ....encodings.storages.storage import Storage
from ....encodings.vec import Vec3
from ....gbuffer.codecs.codec_passes import CodecPasses
from ...ground.machine.devices import require_device
from ...shaders.code.twin import has_twin

WIDTH = 256
CHUNK = 2**15

# From unit normals and view positions, float32 of shape (count, 3), to codes (count, numbers) and decodes (count, 3).
Trip = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


@contextmanager
def trip_of(codec: Codec) -> Iterator[Trip]:
    """Yield the round trip of a codec.

    Raises:
        MissingError: the encoding exists only in GLSL, and there is no OpenGL device.
        ShaderError, FormatError: the device does not support the codec.
    """
    if has_twin(codec.encoding):
        yield _in_chunks(_trip_by_jax(codec))
        return
    with CodecPasses(require_device(), codec) as passes:
        yield _in_chunks(_trip_by_glsl(codec, passes))


def backend_of(codec: Codec) -> str:
    """Return the backend that `trip_of` uses: "jax" or "glsl"."""
    return "jax" if has_twin(codec.encoding) else "glsl"


@cache
def _program(encoding: Encoding, like: Storage, rounding: str) -> Callable[..., Any]:
    """Return a compiled (n, view, *scales) -> (stored code, decoded normal), which fixed-point formats share."""

    def through(n: Vec3, view: Vec3, *scales: Scale) -> tuple[Any, Vec3]:
        codec = Codec(encoding, fixed(like, scales), rounding)
        stored = codec.stored(n, view)
        return stored, encoding.decode(stored, view)

    return jax.jit(through)


def _trip_by_jax(codec: Codec) -> Trip:
    like, scales = shared(codec.storage, codec.encoding.components)
    program = _program(codec.encoding, like, codec.rounding)

    def trip(n: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        codes, decoded = program(_planes(n), _planes(view), *scales)
        return _planes_as_rows(codes), _planes_as_rows(decoded)

    return trip


def _planes(rows: np.ndarray) -> Vec3:
    return Vec3(*np.ascontiguousarray(rows.T))


def _planes_as_rows(planes: Any) -> np.ndarray:
    return np.stack([np.asarray(plane) for plane in planes], axis=1)


def _trip_by_glsl(codec: Codec, passes: CodecPasses) -> Trip:
    size = codec.encoding.components + codec.encoding.sign_bits

    def trip(n: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        decoded = passes.round_trip(*(np.pad(a, ((0, 0), (0, 1))).reshape(-1, WIDTH, 4) for a in (n, view)))
        return decoded.codes.reshape(-1, 4)[:, :size], decoded.normals.reshape(-1, 3)

    return trip


def _in_chunks(trip: Trip) -> Trip:
    """Return the same round trip for any count, in padded chunks of CHUNK rows: it is compiled once, and a chunk
    fills a rectangle of pixels."""

    def whole(n: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        codes, decoded = zip(*(part(n, view, start) for start in range(0, len(n), CHUNK)), strict=True)
        return np.concatenate(codes)[: len(n)], np.concatenate(decoded)[: len(n)]

    def part(n: np.ndarray, view: np.ndarray, start: int) -> tuple[np.ndarray, np.ndarray]:
        rows = (a[start : start + CHUNK] for a in (n, view))
        return trip(*(np.pad(a, ((0, CHUNK - len(a)), (0, 0)), mode="edge") for a in rows))

    return whole
