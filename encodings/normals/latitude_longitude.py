"""Longitude and latitude: the angle around the z axis and the angle from the z axis, both in equal steps."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..elementary import CONSTANTS, atan2_pi, sincos_pi
from ..vec import Vec2, Vec3, sqrt


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal to (atan2(y, x) / pi, 2 acos(z) / pi - 1); the poles, which have no longitude, get 0."""
    # acos(n.z) = atan2(sqrt(n.x^2 + n.y^2), n.z)
    polar = atan2_pi(sqrt(n.x * n.x + n.y * n.y), n.z)
    return Vec2(atan2_pi(n.y, n.x), 2.0 * polar - 1.0)


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the unit normal at longitude pi e.x and at the angle pi (e.y + 1) / 2 from +z."""
    # n = (sin theta (cos phi, sin phi), cos theta)
    s, c = sincos_pi(e.x)
    r, z = sincos_pi(0.5 * e.y + 0.5)
    return Vec3(c * r, s * r, z)


ENCODING = Encoding(
    name="latitude_longitude",
    title="latitude and longitude (atan2, acos)",
    encode=encode,
    decode=decode,
    components=2,
    domain="sphere",
    citation="geographical coordinates; in Z. Cigolle et al., JCGT 3(2), 2014, as `spherical`",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="a root and two arc tangents, one of them twice; two sines and a product",
    constants=CONSTANTS,
)
