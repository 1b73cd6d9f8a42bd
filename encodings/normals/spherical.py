"""Spherical coordinates: the angle around Z, and Z itself."""

from pathlib import Path

from ..elementary import CONSTANTS, atan2_pi, sincos_pi
from ..encoding import Encoding
from ..vec import Vec2, Vec3, maximum, sqrt


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Unit normal to (atan2(y, x) / pi, z); the poles, where there is no angle, get angle 0."""
    return Vec2(atan2_pi(n.y, n.x), n.z)


def decode(e: Vec2, view: Vec3) -> Vec3:
    """The unit normal of the angle pi e.x at height e.y."""
    s, c = sincos_pi(e.x)
    # sin(phi) = sqrt(1 - cos^2(phi)), cos(phi) = e.y
    r = sqrt(maximum(1.0 - e.y * e.y, 0.0))
    return Vec3(c * r, s * r, e.y)


ENCODING = Encoding(
    name="spherical",
    title="#3 spherical (atan2, z)",
    encode=encode,
    decode=decode,
    components=2,
    domain="sphere",
    citation="P. Wilson, Garage Games, 2008; method #3 of A. Pranckevicius 2010",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="polynomials of nine and five terms, which a compiler may or may not fuse",
    constants=CONSTANTS,
)
