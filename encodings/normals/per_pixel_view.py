"""X and Y in the pixel's own frame, whose Z points back along the eye ray: visible normals have z >= 0."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..shared.view_frame import view_frame
from ..vec import Vec2, Vec3, dot, maximum, sqrt


def encode(n: Vec3, view: Vec3) -> Vec2:
    """Map a unit normal to X and Y of the pixel's frame; normals facing the eye and facing away share codes."""
    x, y, _ = view_frame(view)
    return Vec2(dot(x, n), dot(y, n))


def decode(e: Vec2, view: Vec3) -> Vec3:
    """Return the unit normal with z >= 0 in the pixel's frame; a code outside the unit circle gives z = 0 there."""
    x, y, z = view_frame(view)
    return x * e.x + y * e.y + z * sqrt(maximum(1.0 - dot(e, e), 0.0))


ENCODING = Encoding(
    name="per_pixel_view",
    title="#8 per-pixel view space",
    encode=encode,
    decode=decode,
    components=2,
    domain="view",
    citation="Y. O'Donnell, in method #8 of A. Pranckevicius 2010",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 3),
    ulps_reason="two normalises, a cross product and three products summed",
)
