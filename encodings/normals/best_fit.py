"""Best-fit normals: of all 8-bit codes along a direction, the one that points best, its length found in a table.

Scaling a normal before UNORM8 rounds it moves it among the codes; decoding takes the length away again. The best scale
is the same for a direction's mirror images and whichever axis is the largest, so the table holds a sixth of an octant,
with the look-up coordinates of the source, and is not interpolated. UNORM8 has no code for 0: its values are the odd
multiples of 1/255. The scale puts the largest component right on one of them.

RMS angle in RGBA8 on uniform directions, degrees, by the side of the table: 0.126 for 128, 0.070 for 256, 0.046 for
512, 0.038 for 1024, 0.0357 for 2048; 0.0348 for the nearest of all codes, 0.184 unscaled. The axes are no better than
unscaled, 0.32 degrees. The table is for UNORM8 rounded to nearest: elsewhere the scale only takes from the precision.
"""

from functools import cache
from pathlib import Path

import numpy as np

from ..encoding import Encoding
from ..vec import Vec3, jnp, maximum, minimum, unit

SIZE = 1024  # the side of the table
ROWS = 32  # of the table, made at once
FIXED = 2.0**20  # components become whole numbers of this; times SIZE they fit 32 bits up to a length of 4


def _misfit(x: np.ndarray, y: np.ndarray, k: int) -> np.ndarray:
    """The squared sine of the angle from (x, y, 1) to the nearest code (p, q, k), up to a factor that knows no k."""
    p, q = (2 * np.floor(c * k / 2) + 1 for c in (x, y))
    across = (y * k - q) ** 2 + (p - x * k) ** 2 + (x * q - y * p) ** 2
    return across / (p * p + q * q + k * k)


def _best_scales(y: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """The k / 255 with the least misfit for the directions (ratio y, y, 1), every k tried."""
    x = ratio * y
    least, best = np.full_like(x, np.inf), np.zeros_like(x)
    for k in range(255, 0, -2):
        misfit = _misfit(x, y, k)
        best[misfit < least] = k / 255
        least = np.minimum(least, misfit)
    return best


@cache
def tables() -> dict[str, np.ndarray]:
    """The best scale over (middle / largest, least / middle), for the texel's centre.

    Some rows at a time, which stay in a core's cache: a third of a second in place of a whole one.
    """
    centre = (np.arange(SIZE, dtype=np.float32) + 0.5) / SIZE
    blocks = [_best_scales(*np.meshgrid(centre, rows)) for rows in np.split(centre, SIZE // ROWS)]
    return {"best_fit_scale": np.concatenate(blocks)[..., None]}


def _sorted(a: Vec3) -> Vec3:
    low, high = minimum(a.x, a.y), maximum(a.x, a.y)
    return Vec3(minimum(low, a.z), maximum(low, minimum(high, a.z)), maximum(high, a.z))


def _texel(a: Vec3):
    # i = floor(y SIZE / z), j = floor(x SIZE / y), in whole numbers: GLSL's division of floats is not exact
    x, y, z = ((c * FIXED).astype(jnp.uint32) for c in a)
    i, j = y * SIZE // z, x * SIZE // maximum(y, 1)
    return minimum(j, SIZE - 1), minimum(i, SIZE - 1)


def encode(n: Vec3, view: Vec3) -> Vec3:
    """Unit normal to the vector along it whose UNORM8 code points best; its largest component is the table's scale."""
    # with |n|'s components sorted, x <= y <= z: c = n s(y / z, x / y) / z
    a = _sorted(abs(n))
    scale = jnp.asarray(tables()["best_fit_scale"][..., 0], a.z.dtype)[_texel(a)]
    return n * (scale / a.z)


def decode(e: Vec3, view: Vec3) -> Vec3:
    """The stored vector at unit length; a stored zero, which no normal makes, is +x."""
    return unit(e)


ENCODING = Encoding(
    name="best_fit",
    title="best-fit normals",
    encode=encode,
    decode=decode,
    components=3,
    domain="sphere",
    citation="A. Kaplanyan, CryENGINE 3: Reaching the Speed of Light, SIGGRAPH 2010",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="the same texel, one division and one product; three products summed, one reciprocal root, one product",
    constants={"BEST_FIT_SIZE": SIZE, "BEST_FIT_FIXED": FIXED},
    tables=tables,
)
