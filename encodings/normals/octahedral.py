"""Octahedral map: the sphere projected onto an octahedron, whose lower half is folded out into a square's corners."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec2, Vec3, maximum, normalize, select, sign_not_zero


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal to a point of the square [-1, 1]^2, +z at its centre, -z at its corners."""
    # p = n.xy / (|n.x| + |n.y| + |n.z|), and for z < 0 (1 - |p.yx|) sign(p)
    p = n.xy * (1.0 / (abs(n.x) + abs(n.y) + abs(n.z)))
    return select(n.z < 0.0, (1.0 - abs(p.yx)) * sign_not_zero(p), p)


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the unit normal for a point of the square."""
    # n = (e, 1 - |e.x| - |e.y|), and for z < 0 n.xy - sign(e) (-n.z)
    z = 1.0 - abs(e.x) - abs(e.y)
    p = e - sign_not_zero(e) * maximum(-z, 0.0)
    return normalize(Vec3(p.x, p.y, z))


ENCODING = Encoding(
    name="octahedral",
    title="octahedral",
    encode=encode,
    decode=decode,
    components=2,
    domain="sphere",
    citation="Q. Meyer et al., On Floating-Point Normal Vectors, EGSR 2010; Z. Cigolle et al., JCGT 2014",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="one reciprocal and one product; one normalise",
)
