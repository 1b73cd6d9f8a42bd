"""Spherical Fibonacci lattice of 2^16 points: the index of the nearest point, in two bytes.

Point i is at z = 1 - (2 i + 1) / N, rotated around the z axis from the previous point by 0.618 of a turn, the golden
ratio.
"""

import math
from pathlib import Path

from ..codecs.encoding import Encoding
from ..elementary import CONSTANTS, atan2_pi, log2_of, sincos_pi
from ..vec import TINY, Vec2, Vec3, dot, floor, index_of, jnp, maximum, number_of, select, sqrt

COUNT, BYTE = 2**16, 256
PHI = (1 + math.sqrt(5)) / 2
# 2^32 / PHI as a signed 32-bit integer: products of it wrap around as turns do.
GOLDEN = round(2**32 / PHI) - 2**32
HALF_TURNS = 2.0**-31
# Fibonacci numbers F_k, and how far F_k steps turn: F_k / PHI less the nearest whole number.
NUMBERS = [1, 1]
while NUMBERS[-1] < COUNT:
    NUMBERS.append(NUMBERS[-1] + NUMBERS[-2])
NUMBERS = (0.0, *map(float, NUMBERS[:20]))
TURNS = tuple(-((-PHI) ** -k) for k in range(len(NUMBERS)))
# log of N pi sqrt(5) s to base PHI^2 is (log2(s) + OCTAVES) / PER_STEP.
PER_STEP, OCTAVES = 2 * math.log2(PHI), math.log2(COUNT * math.pi * math.sqrt(5))


def _point(i) -> Vec3:
    # phi = 2 pi frac(i / PHI), z = 1 - (2 i + 1) / N
    turned = i.astype(jnp.uint32) * jnp.uint32(GOLDEN % 2**32)
    sine, cosine = sincos_pi(turned.view(jnp.int32).astype(i.dtype) * HALF_TURNS)
    z = 1.0 - (2.0 * i + 1.0) * (1.0 / COUNT)
    r = sqrt((1.0 - z) * (1.0 + z))
    return Vec3(cosine * r, sine * r, z)


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal to the index of the nearest lattice point: the high and the low byte, each as a number in
    [-1, 1]."""
    # k = max(2, floor(log(N pi sqrt(5) (1 - n.z^2)) / log(PHI^2))): here steps of F_k and F_k+1 are the shortest
    around = maximum(n.x * n.x + n.y * n.y, TINY)
    k = maximum(floor((log2_of(around) + OCTAVES) * (1.0 / PER_STEP)), 2.0).astype(jnp.int32)
    f, t = (Vec2(*(jnp.asarray(table, n.x.dtype)[k + step] for step in (0, 1))) for table in (NUMBERS, TURNS))
    # c0 T_k + c1 T_k+1 = phi / (2 pi), c0 F_k + c1 F_k+1 = (N (1 - n.z) - 1) / 2, of determinant 1 or -1
    turn, place = 0.5 * atan2_pi(n.y, n.x), 0.5 * (COUNT * (1.0 - n.z) - 1.0)
    side = select((k & 1) == 1, jnp.ones_like(n.x), jnp.full_like(n.x, -1.0))
    c = Vec2(floor(side * (turn * f.y - place * t.y)), floor(side * (place * t.x - turn * f.x)))
    best, least = jnp.zeros_like(n.x), jnp.full_like(n.x, 8.0)
    for corner in ((0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)):
        i = (c.x + corner[0]) * f.x + (c.y + corner[1]) * f.y
        # beyond a pole: mirrored
        i = select(i < 0.0, -1.0 - i, select(i > COUNT - 1.0, 2.0 * COUNT - 1.0 - i, i))
        miss = n - _point(i)
        is_nearer = dot(miss, miss) < least
        best, least = select(is_nearer, i, best), select(is_nearer, dot(miss, miss), least)
    high = floor(best * (1.0 / BYTE))
    return Vec2(number_of(high, BYTE), number_of(best - BYTE * high, BYTE))


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the unit normal at the lattice point whose index the two bytes hold."""
    return _point(index_of(e.x, BYTE) * BYTE + index_of(e.y, BYTE))


ENCODING = Encoding(
    name="spherical_fibonacci",
    title="spherical Fibonacci lattice",
    encode=encode,
    decode=decode,
    components=2,
    domain="sphere",
    citation="B. Keinert et al., Spherical Fibonacci Mapping, ACM Transactions on Graphics 34(6), 2015",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="of two points that are as near either may be taken; a sine, a root and a product",
    levels=(BYTE, BYTE),
    searches=True,
    constants={
        **CONSTANTS,
        "FIBONACCI_COUNT": float(COUNT),
        "FIBONACCI_BYTE": BYTE,
        "FIBONACCI_GOLDEN": GOLDEN,
        "FIBONACCI_HALF_TURNS": HALF_TURNS,
        "FIBONACCI_NUMBERS": NUMBERS,
        "FIBONACCI_TURNS": TURNS,
        "FIBONACCI_OCTAVES": OCTAVES,
        "FIBONACCI_PER_STEP": PER_STEP,
    },
)
