"""CryEngine 3's form of the spheremap transform, turned so that +z, not -z, is the exact direction.

Drobot's slides ("Sphere Map - macro") write the same map with the other orientation: enc = normalize(n.xy)
sqrt(n.z/2 + 1/2), n.z = 2 |enc|^2 - 1, n.xy = normalize(enc) sqrt(1 - n.z^2).

Here 1/2 - n.z/2 cancels near +z: in float32, directions around +z, though not +z itself, are off by 0.014 degrees in
every storage.
"""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec2, Vec3, dot, maximum, sqrt, unit


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal to a point of the unit disk, +z at the centre; -z, which is the whole rim, becomes (1, 0)."""
    # enc = normalize(n.xy) sqrt(-n.z/2 + 1/2)
    return unit(n.xy) * sqrt(maximum(0.5 - n.z * 0.5, 0.0))


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the unit normal for a point of the disk; beyond the rim, which only rounding can reach, -z."""
    # l = (e, 1) . -(e, -1), n.xy = 2 e sqrt(l), n.z = 2 l - 1
    l = maximum(1.0 - dot(e, e), 0.0)  # noqa: E741 - the source's symbol
    g = 2.0 * sqrt(l)
    return Vec3(e.x * g, e.y * g, 2.0 * l - 1.0)


ENCODING = Encoding(
    name="cryengine3",
    title="CryEngine 3",
    encode=encode,
    decode=decode,
    components=2,
    domain="sphere",
    citation="M. Mittring, A bit more Deferred - CryEngine 3, Triangle Game Conference 2009; M. Drobot, slide 46",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(3, 2),
    ulps_reason="a normalise of two components and a root; one root",
)
