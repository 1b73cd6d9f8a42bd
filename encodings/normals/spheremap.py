"""Spheremap transform in its Lambert azimuthal equal-area form: the reflection vector's position in a sphere map.

As published. 8 n.z + 8 cancels near -z: in float32, whatever the storage, the rounding of n.z alone turns directions
within 0.01 rad of -z by up to 27 degrees, and within 0.001 rad by up to 90. The n / p form does not cancel.
"""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec2, Vec3, dot, minimum, select, sqrt


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal to a point of the unit disk, +z at the centre; -z, which is the whole rim, becomes (1, 0)."""
    # f = sqrt(8 n.z + 8), enc = n.xy / f in [-1/2, 1/2]
    f = sqrt(8.0 * n.z + 8.0)
    return select(n.z > -1.0, n.xy * (2.0 / f), Vec2(1.0, 0.0))


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the unit normal for a point of the disk; beyond the rim, which only rounding can reach, -z."""
    # fenc = 2 e, f = fenc . fenc, n.xy = fenc sqrt(1 - f/4), n.z = 1 - f/2
    fenc = e * 2.0
    f = minimum(dot(fenc, fenc), 4.0)
    g = sqrt(1.0 - f / 4.0)
    return Vec3(fenc.x * g, fenc.y * g, 1.0 - f / 2.0)


ENCODING = Encoding(
    name="spheremap",
    title="#4 spheremap (Lambert azimuthal)",
    encode=encode,
    decode=decode,
    components=2,
    domain="sphere",
    citation="S. Barrett, Lambert azimuthal equal-area projection, in method #4 of A. Pranckevicius 2010",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="8 z + 8 fused or not, a root, a division; one root",
)
