"""Equal-area octahedral map: equal areas of the square represent equal areas of the sphere."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..elementary import CONSTANTS, quadrant_pi, sincos_pi
from ..vec import TINY, Vec2, Vec3, maximum, select, sign_not_zero, sqrt


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal to a point of the square [-1, 1]^2, +z at its centre, -z at its corners."""
    # r = sqrt(1 - |n.z|) = sqrt((n.x^2 + n.y^2) / (1 + |n.z|))
    r = sqrt((n.x * n.x + n.y * n.y) / (1.0 + abs(n.z)))
    # v = 2 r atan(|n.y| / |n.x|) / pi, u = r - v; for n.z < 0 (1 - v, 1 - u)
    v = r * (2.0 * quadrant_pi(abs(n.y), abs(n.x)))
    u = r - v
    folded = select(n.z < 0.0, Vec2(1.0 - v, 1.0 - u), Vec2(u, v))
    return folded * sign_not_zero(n.xy)


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the unit normal for a point of the square."""
    a = abs(e)
    # d = 1 - |e.x| - |e.y|, r = 1 - |d|, phi = pi / 4 ((|e.y| - |e.x|) / r + 1)
    d = 1.0 - a.x - a.y
    r = 1.0 - abs(d)
    sine, cosine = sincos_pi(0.25 * ((a.y - a.x) / maximum(r, TINY) + 1.0))
    # n = (r sqrt(2 - r^2) (cos phi, sin phi) sign(e), sign(d) (1 - r^2))
    f = r * sqrt(maximum(2.0 - r * r, 0.0))
    xy = Vec2(cosine, sine) * f * sign_not_zero(e)
    return Vec3(xy.x, xy.y, sign_not_zero(d) * (1.0 - r * r))


ENCODING = Encoding(
    name="equal_area_octahedral",
    title="equal-area octahedral",
    encode=encode,
    decode=decode,
    components=2,
    domain="sphere",
    citation="P. Clarberg, Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD, J. Graphics Tools 13(3), 2008",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="a division, a root and an arc tangent; a division, a sine and a product",
    constants=CONSTANTS,
)
