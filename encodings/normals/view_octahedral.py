"""Octahedral map in the pixel's own frame, for normals up to an angle from the line of sight.

Normals of visible surfaces face the camera, but interpolated and mapped normals can be turned a few degrees away. The
pyramid of the hemi-octahedral map holds these normals if its base is at that angle instead of 90 degrees; at 90
degrees, the two maps are the same. The base is a square around the cap's circle, so some codes are beyond the
angle.
"""

from collections.abc import Mapping
from math import cos, radians, sin
from pathlib import Path
from typing import Any

from ..codecs.encoding import Encoding, Parameter
from ..shared.view_frame import view_frame
from ..vec import TINY, Vec2, Vec3, dot, maximum, normalize

# Its angle as published, and those that it may have.
CAP_DEG, CAPS_DEG = 100.0, (90.0, 150.0)


def foot(cap: float) -> tuple[float, float]:
    """Return how far the pyramid's base is below its apex, and half the base's diagonal, for an angle in degrees."""
    return 1.0 - cos(radians(cap)), sin(radians(cap))


def encode(n: Vec3, view: Vec3, cap: float = CAP_DEG) -> Vec2:
    """Map a unit normal to a point of the square [-1, 1]^2, with the line of sight at its centre. Normals beyond the
    pyramid's base, at `cap` degrees, are moved to its edge."""
    height, half = foot(cap)
    x, y, z = view_frame(view)
    m = Vec3(dot(x, n), dot(y, n), dot(z, n))
    # s = |m.x| + |m.y|, p = m.xy / max(height s + half m.z, s), e = (p.x + p.y, p.x - p.y)
    s = abs(m.x) + abs(m.y)
    p = m.xy * (1.0 / maximum(maximum(height * s + half * m.z, s), TINY))
    return Vec2(p.x + p.y, p.x - p.y)


def decode(e: Vec2, view: Vec3, cap: float = CAP_DEG) -> Vec3:
    """Return the unit normal for a point of the square."""
    height, half = foot(cap)
    x, y, z = view_frame(view)
    # p = (e.x + e.y, e.x - e.y) / 2, m = (half p, 1 - height (|p.x| + |p.y|))
    p = Vec2(e.x + e.y, e.x - e.y) * 0.5
    m = normalize(Vec3(half * p.x, half * p.y, 1.0 - height * (abs(p.x) + abs(p.y))))
    return x * m.x + y * m.y + z * m.z


def _foot_constants(constants: Mapping[str, Any]) -> dict[str, float]:
    height, half = foot(constants["VIEW_OCTAHEDRAL_CAP"])
    return {"VIEW_OCTAHEDRAL_HEIGHT": height, "VIEW_OCTAHEDRAL_HALF": half}


ENCODING = Encoding(
    name="view_octahedral",
    title="octahedral up to 100 degrees from the line of sight",
    encode=encode,
    decode=decode,
    components=2,
    domain="view",
    citation="after Z. Cigolle et al., JCGT 3(2), 2014: their hemi-octahedral map, its foot at another angle",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 4),
    ulps_reason="two normalises, a cross product and three products summed; a normalise more",
    constants={"VIEW_OCTAHEDRAL_CAP": CAP_DEG},
    derived=_foot_constants,
    parameters=(Parameter("cap", "VIEW_OCTAHEDRAL_CAP", *CAPS_DEG),),
)
