"""Equal-area map in the pixel's own frame, for normals up to an angle from the line of sight.

Normals of visible surfaces face the camera, but interpolated and mapped normals can be turned a few degrees away. All
codes are within the angle and share the cap equally: 100 degrees cover 59% of the sphere, a gain of 2.3 dB.
"""

from collections.abc import Mapping
from math import cos, radians
from pathlib import Path
from typing import Any

from ..codecs.encoding import Encoding, Parameter
from ..elementary import CONSTANTS, quadrant_pi, sincos_pi
from ..shared.view_frame import view_frame
from ..vec import TINY, Vec2, Vec3, dot, maximum, minimum, select, sign_not_zero, sqrt

# Its angle as published, and those that it may have.
CAP_DEG, CAPS_DEG = 100.0, (90.0, 150.0)


def height_of(cap: float) -> float:
    """Return how far the rim of a spherical cap is below its centre, for the cap's angle in degrees."""
    return 1.0 - cos(radians(cap))


def encode(n: Vec3, view: Vec3, cap: float = CAP_DEG) -> Vec2:
    """Map a unit normal to a point of the square [-1, 1]^2, with the line of sight at its centre. Normals more than
    `cap` degrees from the line of sight are moved to its edge."""
    x, y, z = view_frame(view)
    m = Vec3(dot(x, n), dot(y, n), dot(z, n))
    # r = min(sqrt((1 - m.z) / height), 1), where 1 - m.z = (m.x^2 + m.y^2) / (1 + m.z)
    fall = select(m.z > 0.0, (m.x * m.x + m.y * m.y) / (1.0 + abs(m.z)), 1.0 - m.z)
    r = minimum(sqrt(fall * (1.0 / height_of(cap))), 1.0)
    # v = 2 r atan(|m.y| / |m.x|) / pi, p = (r - v, v) sign(m.xy), e = (p.x + p.y, p.x - p.y)
    v = r * (2.0 * quadrant_pi(abs(m.y), abs(m.x)))
    p = Vec2(r - v, v) * sign_not_zero(m.xy)
    return Vec2(p.x + p.y, p.x - p.y)


def decode(e: Vec2, view: Vec3, cap: float = CAP_DEG) -> Vec3:
    """Return the unit normal for a point of the square."""
    height = height_of(cap)
    x, y, z = view_frame(view)
    # p = (e.x + e.y, e.x - e.y) / 2, r = |p.x| + |p.y|, phi = pi |p.y| / (2 r)
    p = Vec2(e.x + e.y, e.x - e.y) * 0.5
    r = abs(p.x) + abs(p.y)
    sine, cosine = sincos_pi(0.5 * (abs(p.y) / maximum(r, TINY)))
    # m = (r sqrt(height (2 - height r^2)) (cos phi, sin phi) sign(p), 1 - height r^2)
    fall = height * r * r
    m = Vec2(cosine, sine) * (r * sqrt(maximum(height * (2.0 - fall), 0.0))) * sign_not_zero(p)
    return x * m.x + y * m.y + z * (1.0 - fall)


def _cap_constants(constants: Mapping[str, Any]) -> dict[str, float]:
    return {"VIEW_EQUAL_AREA_HEIGHT": height_of(constants["VIEW_EQUAL_AREA_CAP"])}


ENCODING = Encoding(
    name="view_equal_area",
    title="equal-area up to 100 degrees from the line of sight",
    encode=encode,
    decode=decode,
    components=2,
    domain="view",
    citation="P. Clarberg, J. Graphics Tools 13(3), 2008: its hemisphere, with another cap in place of it",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 4),
    ulps_reason="the frame, a quotient, a root and an arc tangent; a quotient, a sine and a root, the frame",
    constants={**CONSTANTS, "VIEW_EQUAL_AREA_CAP": CAP_DEG},
    derived=_cap_constants,
    parameters=(Parameter("cap", "VIEW_EQUAL_AREA_CAP", *CAPS_DEG),),
)
