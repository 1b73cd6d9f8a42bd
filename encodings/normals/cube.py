"""Cube map: the cube face that a normal points to, and the point on that face."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec3, floor, index_of, normalize, number_of, select

FACES = 6


def encode(n: Vec3, view: Vec3) -> Vec3:
    """Map a unit normal to a point of its face's square [-1, 1]^2, and the index of the face (+x, -x, +y ...) as a
    number in [-1, 1]."""
    a = abs(n)
    # the largest component's axis; the others over it
    is_z, is_y = (a.z >= a.x) & (a.z >= a.y), a.y >= a.x
    turned = select(is_z, n, select(is_y, Vec3(n.z, n.x, n.y), Vec3(n.y, n.z, n.x)))
    zero = 0.0 * n.z
    axis = select(is_z, 2.0, select(is_y, 1.0, zero))
    face = 2.0 * axis + select(turned.z < 0.0, 1.0, zero)
    uv = turned.xy * (1.0 / abs(turned.z))
    return Vec3(uv.x, uv.y, number_of(face, FACES))


def decode(e: Vec3, view: Vec3) -> Vec3:
    """Return the unit normal for a point of a face."""
    face = index_of(e.z, FACES)
    axis = floor(0.5 * face)
    side = 1.0 - 2.0 * (face - 2.0 * axis)
    n = normalize(Vec3(e.x, e.y, side))
    return select(axis == 2.0, n, select(axis == 1.0, Vec3(n.y, n.z, n.x), Vec3(n.z, n.x, n.y)))


ENCODING = Encoding(
    name="cube",
    title="cube map",
    encode=encode,
    decode=decode,
    components=3,
    domain="sphere",
    citation="N. Greene, Environment Mapping, IEEE CG&A 6(11), 1986; in Z. Cigolle et al., JCGT 3(2), 2014",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="one reciprocal and one product; one normalise",
    levels=(0, 0, FACES),
    constants={"CUBE_FACES": FACES},
)
