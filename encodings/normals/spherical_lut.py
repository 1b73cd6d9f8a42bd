"""Spherical coordinates, with trigonometry read from two 256 x 256 lookup textures.

Texel (i, j) represents the point (-1 + 2 i / 255, -1 + 2 j / 255), so that 8-bit codes coincide with texels. The
nearest texel is read, so more than 8 bits of storage gain nothing.
"""

from functools import cache
from pathlib import Path

import numpy as np

from ..codecs.encoding import Encoding
from ..vec import Vec2, Vec3, jnp, maximum, minimum

LAST = 255.0  # the last texel of a row, and of a column


@cache
def tables() -> dict[str, np.ndarray]:
    """Return two lookup tables by sampler name, float32 (rows, columns, channels): atan2(y, x) / pi over (x, y), and
    (cos, sin) of the angle times sqrt(1 - z^2) over (angle / pi, z)."""
    axis = np.linspace(-1.0, 1.0, int(LAST) + 1)
    x, y = np.meshgrid(axis, axis)
    r = np.sqrt(1.0 - y * y)
    xy = np.stack([np.cos(np.pi * x) * r, np.sin(np.pi * x) * r], axis=-1)
    angle = np.arctan2(y, x)[..., None] / np.pi
    return {"spherical_lut_angle": angle.astype(np.float32), "spherical_lut_xy": xy.astype(np.float32)}


def _texel(p: Vec2):
    i, j = (jnp.floor(minimum(maximum(c * 0.5 + 0.5, 0.0), 1.0) * LAST + 0.5).astype(jnp.int32) for c in p)
    return j, i


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal to (angle / pi, z); the angle is read from the table's texel nearest to (x, y)."""
    angle = jnp.asarray(tables()["spherical_lut_angle"][..., 0], n.z.dtype)
    return Vec2(angle[_texel(n.xy)], n.z)


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the normal at height e.y, with x and y from the table's texel nearest to the code; not normalised."""
    xy = jnp.asarray(tables()["spherical_lut_xy"], e.y.dtype)
    texel = _texel(e)
    return Vec3(xy[..., 0][texel], xy[..., 1][texel], e.y)


ENCODING = Encoding(
    name="spherical_lut",
    title="#3a spherical by look-up textures",
    encode=encode,
    decode=decode,
    components=2,
    domain="sphere",
    citation="method #3a of the first version of A. Pranckevicius, Compact Normal Storage for Small G-Buffers, 2009",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(0, 0),
    ulps_reason="both read the same texels",
    constants={"SPHERICAL_LUT_LAST": LAST},
    tables=tables,
)
