"""X and Y; Z is reconstructed as if the normal faced the camera."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec2, Vec3, dot, maximum, sqrt


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal to its X and Y; normals facing away (z < 0) share codes with normals facing the camera."""
    return n.xy


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the normal with z >= 0; a code outside the unit circle, which rounding can produce, gives z = 0."""
    # n.z = sqrt(1 - e . e)
    return Vec3(e.x, e.y, sqrt(maximum(1.0 - dot(e, e), 0.0)))


ENCODING = Encoding(
    name="xy",
    title="#1 X and Y, reconstruct Z",
    encode=encode,
    decode=decode,
    components=2,
    domain="hemisphere",
    citation="M. Valient, Deferred Rendering in Killzone 2, 2007; method #1 of A. Pranckevicius 2010",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(0, 2),
    ulps_reason="two squares summed, one root",
)
