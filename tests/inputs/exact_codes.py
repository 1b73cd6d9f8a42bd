"""Encodings made for tests: storages of any size, and a lattice of points in a lookup table."""

from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np

from normalbench.encodings.codecs.encoding import Encoding
from normalbench.encodings.storages.storage import Storage
from normalbench.encodings.vec import Vec2, Vec3


def storage(kind: str, *bits: int) -> Storage:
    """Return a fixed-point storage with these bits for each number."""
    return Storage(f"{kind}{'_'.join(map(str, bits))}", "", kind, bits, 0)


def nearest_of(points: np.ndarray, side: int) -> Encoding:
    """Return an encoding that stores the index of the nearest of side x side points."""

    def encode(n: Vec3, _: Vec3) -> Vec2:
        table = jnp.asarray(points, n.z.dtype)
        rows = jnp.stack(n, axis=-1).reshape(-1, 3)
        index = jax.lax.map(lambda row: jnp.argmax(table @ row), rows, batch_size=2**12).reshape(n.z.shape)
        parts = (part.astype(n.z.dtype) for part in (index // side, index % side))
        return Vec2(*(part * (2.0 / (side - 1)) - 1.0 for part in parts))

    def decode(e: Vec2, _: Vec3) -> Vec3:
        i, j = (jnp.round((c * 0.5 + 0.5) * (side - 1.0)).astype(jnp.int32) for c in e)
        return Vec3(*(jnp.asarray(axis, e.x.dtype)[i * side + j] for axis in points.T))

    return Encoding(
        name="nearest",
        title="the nearest of given points",
        encode=encode,
        decode=decode,
        components=2,
        domain="sphere",
        citation="",
        glsl=Path("nearest.glsl"),
        ulps=(0, 0),
        ulps_reason="",
        levels=(side, side),
    )


def fibonacci(count: int) -> np.ndarray:
    """Return points along a spiral, each for an equal area of the sphere; shape (count, 3)."""
    index = np.arange(count) + 0.5
    z, angle = 1 - 2 * index / count, np.pi * (1 + np.sqrt(5)) * index
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)
