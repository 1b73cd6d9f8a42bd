"""Signed octahedron: each half of the octahedron, rotated by 45 degrees, fills the square; one bit tells the half."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec2, Vec3, normalize, sign_not_zero


def encode(n: Vec3, view: Vec3) -> Vec3:
    """Map a unit normal to a point of the square [-1, 1]^2 and the sign of z: 1 or -1, and 1 for z = 0."""
    # p = n.xy / (|n.x| + |n.y| + |n.z|), e = (p.x + p.y, p.x - p.y, sign n.z)
    p = n.xy * (1.0 / (abs(n.x) + abs(n.y) + abs(n.z)))
    return Vec3(p.x + p.y, p.x - p.y, sign_not_zero(n.z))


def decode(e: Vec3, view: Vec3) -> Vec3:
    """Return the unit normal for a point of the square, in the hemisphere that the sign selects."""
    # p = (e.x + e.y, e.x - e.y) / 2, n = (p, sign (1 - |p.x| - |p.y|))
    p = Vec2(e.x + e.y, e.x - e.y) * 0.5
    return normalize(Vec3(p.x, p.y, sign_not_zero(e.z) * (1.0 - abs(p.x) - abs(p.y))))


ENCODING = Encoding(
    name="signed_octahedral",
    title="signed octahedral",
    encode=encode,
    decode=decode,
    components=3,
    domain="sphere",
    citation="J. White, Signed Octahedron Normal Encoding, 2017",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="one reciprocal and one product; one normalise",
    levels=(0, 0, 2),
)
