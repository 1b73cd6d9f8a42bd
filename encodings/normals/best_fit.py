"""Best-fit normals: the most accurate of all 8-bit codes along a direction, with a length from a table.

Scaling a normal before it is rounded to UNORM8 moves it relative to the codes; decoding removes the length again. The
best scale is the same for all mirror images of a direction and for any order of the axes, so the table covers a sixth
of an octant, with the lookup coordinates of the source, and is not interpolated. UNORM8 has no code for 0: its values
are the odd multiples of 1/255. The scale puts the largest component exactly on one of these values.

RMS angle in RGBA8 for uniform directions, in degrees, by the side of the table: 0.126 for 128, 0.070 for 256, 0.046
for 512, 0.038 for 1024, 0.0357 for 2048; 0.0348 for the nearest of all codes, 0.184 unscaled. Directions along the
axes are no better than unscaled: 0.32 degrees. The table is for UNORM8 rounded to nearest: in other storages the
scale only reduces precision, and a different table can be fitted.
"""

from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from ..codecs.encoding import Encoding, LookUp
from ..vec import Vec3, jnp, maximum, minimum, unit

SIZE = 1024  # the side of the table
ROWS = 16  # of the table, made at once
GROUP = 2**15  # normals that are fitted to at once
LEVELS = 256  # of UNORM8
FIXED = 2.0**20  # components become whole numbers of this; times SIZE they fit 32 bits up to a length of 4
_CENTRE = (np.arange(SIZE, dtype=np.float32) + 0.5) / SIZE


def _misfit(x: np.ndarray, y: np.ndarray, k: int) -> np.ndarray:
    """Return the squared sine of the angle from (x, y, 1) to the nearest code (p, q, k), up to a factor without k.

    In units of half a step, p and q are even or odd like k, which is odd if there is no code for 0. Both vectors are
    halved here, so that their components are whole numbers and halves. The result, |(x, y, 1) x (p, q, k)|^2 /
    |(p, q, k)|^2, is computed in place: allocating new arrays would take as long as the arithmetic.
    """
    odd, half = k % 2, k / 2
    u, v = x * half, y * half
    p, q = (np.floor(c) + 0.5 if odd else np.floor(c + 0.5) for c in (u, v))
    u -= p
    cross = x * q
    cross -= y * p
    cross *= cross
    u *= u
    u += (v - q) ** 2
    u += cross
    p *= p
    p += q * q + half * half
    u /= p
    return u


def _best_scales(misfit: Callable[[int], np.ndarray], levels: int) -> np.ndarray:
    """Return the scales k / (levels - 1) with the smallest misfit over all codes k; on a tie, the largest scale."""
    last = levels - 1
    least = misfit(last)
    best = np.ones_like(least)
    for k in range(last - 2, 0, -2):
        tried = misfit(k)
        np.copyto(best, k / last, where=tried < least)
        np.minimum(least, tried, out=least)
    return best


@cache
def centres(levels: int = LEVELS) -> np.ndarray:
    """Return the best scale at each texel's centre, over (middle / largest, smallest / middle).

    The result is float32 of shape (SIZE, SIZE, 1). The function processes blocks of rows that fit in a core's cache,
    which takes a quarter of a second instead of a whole second.
    """
    y, blocks = _CENTRE, []
    for ratio in np.split(_CENTRE[:, None], SIZE // ROWS):
        blocks.append(_best_scales(partial(_misfit, ratio * y, y), levels))
    return np.concatenate(blocks)[..., None]


def tables() -> dict[str, np.ndarray]:
    """Return the table for UNORM8 by its sampler's name: best scales, float32 of shape (SIZE, SIZE, 1)."""
    return {"best_fit_scale": centres()}


def fit(normals: np.ndarray, levels: int, prior: float) -> np.ndarray:
    """Return the table whose scales have the smallest squared error on each texel's normals, for numbers with
    `levels` values; float32 of shape (SIZE, SIZE, 1), like `centres`.

    Args:
        normals: float64 of shape (count, 3), unit.
        prior: number of normals that a texel's centre counts as; a texel without normals has its centre's scale.
    """
    if not len(normals):
        return centres(levels)
    x, y, z = np.sort(np.abs(normals), axis=1).T
    row, column = _place(x, y, z)
    texel = row * np.int64(SIZE) + column
    order = np.argsort(texel, kind="stable")
    met, first = np.unique(texel[order], return_index=True)
    table = centres(levels).copy()
    ends = np.append(first[1:], len(order))
    for part in np.array_split(np.arange(len(met)), min(len(met), 1 + len(order) // GROUP)):
        chosen = order[first[part[0]] : ends[part[-1]]]
        starts = first[part] - first[part[0]]
        ratio, middle = (_CENTRE[c].astype(np.float64) for c in (met[part] // SIZE, met[part] % SIZE))
        summed = partial(_summed, x[chosen] / z[chosen], y[chosen] / z[chosen], starts, ratio * middle, middle, prior)
        table.reshape(-1)[met[part]] = _best_scales(summed, levels)
    return table


def _summed(x, y, starts: np.ndarray, centre_x, centre_y, prior: float, k: int) -> np.ndarray:
    """Return, for each texel, the summed misfits of its normals, plus `prior` times the misfit of its centre."""
    return np.add.reduceat(_misfit(x, y, k), starts) + prior * _misfit(centre_x, centre_y, k)


def _place(x, y, z):
    """Return the row and the column of the table's texel for sorted components x <= y <= z, as `_texel` does."""
    x, y, z = ((c * FIXED).astype(np.uint32) for c in (x, y, z))
    return np.minimum(x * SIZE // np.maximum(y, 1), SIZE - 1), np.minimum(y * SIZE // z, SIZE - 1)


def _sorted(a: Vec3) -> Vec3:
    low, high = minimum(a.x, a.y), maximum(a.x, a.y)
    return Vec3(minimum(low, a.z), maximum(low, minimum(high, a.z)), maximum(high, a.z))


def _texel(a: Vec3):
    # i = floor(y SIZE / z), j = floor(x SIZE / y), in whole numbers: a shader's division of floats is not exact
    x, y, z = ((c * FIXED).astype(jnp.uint32) for c in a)
    i, j = y * SIZE // z, x * SIZE // maximum(y, 1)
    return minimum(j, SIZE - 1), minimum(i, SIZE - 1)


def encode(n: Vec3, view: Vec3, table: Any = None) -> Vec3:
    """Map a unit normal to the multiple whose UNORM8 code has the most accurate direction; the scale is its largest
    component.

    `table` replaces the published table of scales: float32 of shape (SIZE, SIZE, 1).
    """
    # with |n|'s components sorted, x <= y <= z: c = n s(y / z, x / y) / z
    a = _sorted(abs(n))
    scale = jnp.asarray((centres() if table is None else table)[..., 0], a.z.dtype)[_texel(a)]
    return n * (scale / a.z)


def decode(e: Vec3, view: Vec3) -> Vec3:
    """Return the stored vector at unit length; a stored zero, which no normal produces, gives +x."""
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
    look_up=LookUp("best_fit_scale", range(2**4 - 1, 2**10 + 1), fit),
)
