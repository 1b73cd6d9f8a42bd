"""Spherical coordinates: the angle around the z axis, and z itself.

Few normals in a view have a z near -1: a bias and a scale put the codes for z where the normals are.
"""

from pathlib import Path

from ..codecs.encoding import Encoding, Parameter
from ..elementary import CONSTANTS, atan2_pi, sincos_pi
from ..vec import Vec2, Vec3, maximum, sqrt

# As published the whole of Z is stored as it is.
BIAS, SCALE = 0.0, 1.0


def encode(n: Vec3, view: Vec3, bias: float = BIAS, scale: float = SCALE) -> Vec2:
    """Map a unit normal to (atan2(y, x) / pi, (z - bias) / scale); the poles, which have no angle, get angle 0."""
    return Vec2(atan2_pi(n.y, n.x), (n.z - bias) / scale)


def decode(e: Vec2, view: Vec3, bias: float = BIAS, scale: float = SCALE) -> Vec3:
    """Return the unit normal at the angle pi e.x and the height z = scale e.y + bias. A height beyond 1 or -1 is
    kept, with x and y at 0: the vector is then longer than 1."""
    s, c = sincos_pi(e.x)
    # sin(phi) = sqrt(1 - cos^2(phi)), cos(phi) = scale e.y + bias
    z = e.y * scale + bias
    r = sqrt(maximum(1.0 - z * z, 0.0))
    return Vec3(c * r, s * r, z)


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
    constants={**CONSTANTS, "SPHERICAL_BIAS": BIAS, "SPHERICAL_SCALE": SCALE},
    parameters=(Parameter("bias", "SPHERICAL_BIAS", -1.0, 1.0), Parameter("scale", "SPHERICAL_SCALE", 0.01, 2.0)),
)
