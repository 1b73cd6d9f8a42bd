"""Stereographic projection from -z, scaled so that the normals that occur in practice fill the unit disk.

At scale s the disk reaches 2 atan(s) from +z, so normals up to an angle t need s = tan(t / 2), which wastes no codes.
The normal of a visible surface is at most 90 degrees from the direction to the eye: a view whose corners are at an
angle f from its axis sees normals up to t = 90 degrees + f.
"""

from pathlib import Path

from ..codecs.encoding import Encoding, Parameter
from ..vec import Vec2, Vec3, dot, select

# Found by hand in 2010, for that scene and field of view: the disk reaches 121.3 degrees from +z.
SCALE = 1.7777
# From a disk that ends 1 degree from +z to one that ends 1 degree from -z.
SCALES = 0.0088, 114.0


def encode(n: Vec3, view: Vec3, scale: float = SCALE) -> Vec2:
    """Map a unit normal to a point of the plane, +z at the origin; -z, which is infinitely far, becomes (1, 0)."""
    # enc = n.xy / (n.z + 1) / scale
    return select(n.z > -1.0, n.xy / ((n.z + 1.0) * scale), Vec2(1.0, 0.0))


def decode(e: Vec2, view: Vec3, scale: float = SCALE) -> Vec3:
    """Return the unit normal for a point of the plane."""
    # nn = (scale e, 1), g = 2 / (nn . nn), n = (g nn.xy, g - 1)
    nn = e * scale
    g = 2.0 / (dot(nn, nn) + 1.0)
    return Vec3(g * nn.x, g * nn.y, g - 1.0)


ENCODING = Encoding(
    name="stereographic",
    title="#7 stereographic, scale 1.7777",
    encode=encode,
    decode=decode,
    components=2,
    domain="hemisphere",
    citation="S. Barrett and I. Castano, in method #7 of A. Pranckevicius 2010",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="one division each way, the encoder's by a sum that is 1 or more on the hemisphere",
    constants={"STEREOGRAPHIC_SCALE": SCALE},
    parameters=(Parameter("scale", "STEREOGRAPHIC_SCALE", *SCALES),),
)
