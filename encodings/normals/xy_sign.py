"""X and Y, with the sign of Z as an additional bit."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec2, Vec3, dot, maximum, sign_not_zero, sqrt


def encode(n: Vec3, view: Vec3) -> Vec3:
    """Map a unit normal to X, Y and the sign of Z (1 or -1, and 1 for z = 0)."""
    return Vec3(n.x, n.y, sign_not_zero(n.z))


def decode(e: Vec3, view: Vec3) -> Vec3:
    """Return the normal whose z has the stored sign; a code outside the unit circle gives z = 0."""
    xy = Vec2(e.x, e.y)
    # n.z = sign sqrt(1 - e . e)
    return Vec3(e.x, e.y, e.z * sqrt(maximum(1.0 - dot(xy, xy), 0.0)))


ENCODING = Encoding(
    name="xy_sign",
    title="X, Y and the sign of Z",
    encode=encode,
    decode=decode,
    components=2,
    sign_bits=1,
    domain="sphere",
    citation="ozlael, sign of the normal's Z in the sign of the G-buffer's depth, 2010",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(0, 2),
    ulps_reason="two squares summed, one root",
)
