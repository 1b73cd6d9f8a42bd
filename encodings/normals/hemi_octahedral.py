"""Hemi-octahedral map: the upper half of the octahedron, rotated by 45 degrees, fills the whole square."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec2, Vec3, normalize


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal with z >= 0 to a point of the square [-1, 1]^2, +z at its centre, z = 0 on its edges; the
    sign of a negative z is lost."""
    # p = n.xy / (|n.x| + |n.y| + |n.z|), e = (p.x + p.y, p.x - p.y)
    p = n.xy * (1.0 / (abs(n.x) + abs(n.y) + abs(n.z)))
    return Vec2(p.x + p.y, p.x - p.y)


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the unit normal, with z >= 0, for a point of the square."""
    # p = (e.x + e.y, e.x - e.y) / 2, n = (p, 1 - |p.x| - |p.y|)
    p = Vec2(e.x + e.y, e.x - e.y) * 0.5
    return normalize(Vec3(p.x, p.y, 1.0 - abs(p.x) - abs(p.y)))


ENCODING = Encoding(
    name="hemi_octahedral",
    title="hemi-octahedral",
    encode=encode,
    decode=decode,
    components=2,
    domain="hemisphere",
    citation="Z. Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, JCGT 3(2), 2014",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="one reciprocal and one product; one normalise",
)
