"""Encoding and decoding by JAX: two programs per encoding, compiled once for all storages, sets and operations."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.rounding import fixed, shared
from ....encodings.storages.storage import Storage
from ....encodings.vec import Vec2, Vec3, direction_or_forward


@cache
def _encoder(encoding: Encoding, like: Storage, rounding: str) -> Callable[..., Any]:
    """Return a compiled function from normals to two codes: the code before storage, precisely rounded if the
    encoding requires it, and the code as read back from storage."""

    def encode(n: Vec3, view: Vec3, *scales: Any):
        codec = Codec(encoding, fixed(like, scales), rounding)
        n = direction_or_forward(n)
        stored = codec.stored(n, view)
        code = stored if encoding.is_precise else encoding.encode(n, view)
        return jnp.stack(_planes(code, n)), jnp.stack(_planes(stored, n))

    return jax.jit(encode)


def _planes(code: Any, n: Vec3) -> list[Any]:
    return [jnp.broadcast_to(jnp.asarray(c, jnp.float32), n.z.shape) for c in code]


@cache
def _decoder(encoding: Encoding) -> Callable[..., Any]:
    kind = Vec2 if encoding.components + encoding.sign_bits == 2 else Vec3
    return jax.jit(lambda planes, view: jnp.stack(encoding.decode(kind(*planes), view)))


class Programs:
    """A codec's encoder and decoder for arrays, applied to blocks of one size.

    Args:
        codec: the codec.
        block: number of normals per block; the last block is padded, so that each program is compiled once.
    """

    def __init__(self, codec: Codec, block: int):
        self._codec, self._block = codec, block
        self._like, self._scales = shared(codec.storage, codec.encoding.components)

    def codes(self, normals: np.ndarray, views: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the codes of unit normals (count, 3) before storage and as stored: two float32 arrays of shape
        (numbers, count)."""
        encode = _encoder(self._codec.encoding, self._like, self._codec.rounding)
        parts = [
            [np.asarray(array)[:, :count] for array in encode(Vec3(*n), Vec3(*view), *self._scales)]
            for count, n, view in self._blocks(normals.T, views.T)
        ]
        code, stored = (np.concatenate(side, axis=1) for side in zip(*parts, strict=True))
        return code, stored

    def normals(self, codes: np.ndarray, views: np.ndarray) -> np.ndarray:
        """Return the normals decoded from codes (numbers, count), float32 of shape (count, 3), not renormalised."""
        decode = _decoder(self._codec.encoding)
        parts = [
            np.asarray(decode(tuple(code), Vec3(*view)))[:, :count].T
            for count, code, view in self._blocks(codes, views.T)
        ]
        return np.concatenate(parts)

    def _blocks(self, *planes: np.ndarray):
        """Yield arrays of shape (rows, count) in padded blocks: the number of real columns, then the rows of each
        array in JAX."""
        total = planes[0].shape[1]
        for start in range(0, total, self._block):
            cut = [a[:, start : start + self._block].astype(np.float32) for a in planes]
            count = cut[0].shape[1]
            padded = (np.pad(a, ((0, 0), (0, self._block - count)), mode="edge") for a in cut)
            yield count, *([jnp.asarray(plane) for plane in a] for a in padded)
