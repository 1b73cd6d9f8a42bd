"""Spheremap transform in the traditional form of sphere-map texture coordinates: n / p.

Equal to the Lambert form for unit normals only, because p depends on the length of n. Nothing cancels in this sum of
squares, so it is the only one of the three forms that keeps float32's precision all the way to -z; expanded to
n . n + 2 n.z + 1, it would not.
"""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec2, Vec3, dot, maximum, select, sqrt


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal to a point of the unit disk, +z at the centre; -z, which is the whole rim, becomes (1, 0)."""
    # p = sqrt(n.x^2 + n.y^2 + (n.z + 1)^2), enc = n.xy / p
    p2 = dot(n.xy, n.xy) + (n.z + 1.0) * (n.z + 1.0)
    return select(p2 > 0.0, n.xy / sqrt(p2), Vec2(1.0, 0.0))


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the unit normal for a point of the disk; beyond the rim, which only rounding can reach, -z."""
    # with t = (e + 1) / 2: f = t.x - t.x^2 + t.y - t.y^2, m = sqrt(4 f - 1), n.xy = m (4 t - 2), n.z = 8 f - 3
    f = maximum((2.0 - dot(e, e)) / 4.0, 0.25)
    m = sqrt(4.0 * f - 1.0)
    return Vec3(m * 2.0 * e.x, m * 2.0 * e.y, 8.0 * f - 3.0)


ENCODING = Encoding(
    name="spheremap_classic",
    title="spheremap, n / p form",
    encode=encode,
    decode=decode,
    components=2,
    domain="sphere",
    citation="SIGGRAPH 99 advanced OpenGL course notes, sphere maps; method #4 of A. Pranckevicius 2009",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="three squares, a root and a division; one root",
)
