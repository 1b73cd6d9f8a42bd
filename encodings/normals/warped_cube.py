"""Warped cube map: a cube map in equal angles, which makes its cells more even."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..elementary import CONSTANTS, atan_pi, sincos_pi
from ..vec import Vec3, floor, index_of, normalize, number_of, select

FACES = 6


def encode(n: Vec3, view: Vec3) -> Vec3:
    """Map a unit normal to a point of its face's square [-1, 1]^2, and the index of the face (+x, -x, +y ...) as a
    number in [-1, 1]."""
    a = abs(n)
    # the largest component's axis; the others over it, as angles: 4 atan(u) / pi
    is_z, is_y = (a.z >= a.x) & (a.z >= a.y), a.y >= a.x
    turned = select(is_z, n, select(is_y, Vec3(n.z, n.x, n.y), Vec3(n.y, n.z, n.x)))
    zero = 0.0 * n.z
    axis = select(is_z, 2.0, select(is_y, 1.0, zero))
    face = 2.0 * axis + select(turned.z < 0.0, 1.0, zero)
    uv = turned.xy * (1.0 / abs(turned.z))
    return Vec3(4.0 * atan_pi(uv.x), 4.0 * atan_pi(uv.y), number_of(face, FACES))


def decode(e: Vec3, view: Vec3) -> Vec3:
    """Return the unit normal for a point of a face."""
    face = index_of(e.z, FACES)
    axis = floor(0.5 * face)
    side = 1.0 - 2.0 * (face - 2.0 * axis)
    # (tan(pi e.x / 4), tan(pi e.y / 4), side), at unit length
    (su, cu), (sv, cv) = sincos_pi(0.25 * e.x), sincos_pi(0.25 * e.y)
    n = normalize(Vec3(su * cv, sv * cu, side * cu * cv))
    return select(axis == 2.0, n, select(axis == 1.0, Vec3(n.y, n.z, n.x), Vec3(n.z, n.x, n.y)))


ENCODING = Encoding(
    name="warped_cube",
    title="warped cube map",
    encode=encode,
    decode=decode,
    components=3,
    domain="sphere",
    citation="C. Ronchi et al., The Cubed Sphere, J. Comp. Phys. 124, 1996; in Z. Cigolle et al., JCGT 3(2), 2014",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="a reciprocal and an arc tangent, of which four are taken; two sines, products, one normalise",
    levels=(0, 0, FACES),
    constants={**CONSTANTS, "WARPED_CUBE_FACES": FACES},
)
