"""All three components, renormalised when read."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec3, unit


def encode(n: Vec3, view: Vec3) -> Vec3:
    """Return a unit normal unchanged: the code is exact until it is stored."""
    return n


def decode(e: Vec3, view: Vec3) -> Vec3:
    """Return the stored vector at unit length; a stored zero, which no normal produces, gives +x."""
    return unit(e)


ENCODING = Encoding(
    name="xyz_renormalised",
    title="X, Y and Z, renormalised",
    encode=encode,
    decode=decode,
    components=3,
    domain="sphere",
    citation="Z. Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, JCGT 2014 (snorm)",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(0, 2),
    ulps_reason="three products summed, one reciprocal square root, one product",
)
