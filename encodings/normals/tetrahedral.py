"""Tetrahedral: X and Y in the frame of the tetrahedron's face nearest to the normal, and the index of the face."""

import math
from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec2, Vec3, dot, floor, index_of, maximum, number_of, select, sign_not_zero, sqrt

FACES = 4
# The faces' normals: (+-SIDE, 0, UP) and (0, +-SIDE, -UP).
SIDE, UP = math.sqrt(2 / 3), math.sqrt(1 / 3)


def encode(n: Vec3, view: Vec3) -> Vec3:
    """Map a unit normal to a point of the disk of radius 0.943 about the nearest face's normal, and the index of the
    face, 0 to 3, as a number in [-1, 1]."""
    # is_upper = SIDE |n.x| + UP n.z > SIDE |n.y| - UP n.z, side = sign of the n.x or n.y that counts
    is_upper = SIDE * abs(n.x) + UP * n.z > SIDE * abs(n.y) - UP * n.z
    deciding = select(is_upper, n.x, n.y)
    side = sign_not_zero(deciding)
    # upper: (side n.y, SIDE n.z - UP |n.x|), lower: (-side n.x, SIDE n.z + UP |n.y|)
    upper = Vec2(side * n.y, SIDE * n.z - UP * abs(n.x))
    lower = Vec2(-side * n.x, SIDE * n.z + UP * abs(n.y))
    p = select(is_upper, upper, lower)
    zero = 0.0 * n.z
    face = select(is_upper, 2.0, zero) + select(deciding < 0.0, 1.0, zero)
    return Vec3(p.x, p.y, number_of(face, FACES))


def decode(e: Vec3, view: Vec3) -> Vec3:
    """Return the normal for a point in a face's frame; outside the unit circle, with no height above the face."""
    face = index_of(e.z, FACES)
    is_upper = face >= 2.0
    side = 1.0 - 2.0 * (face - 2.0 * floor(0.5 * face))
    p = Vec2(e.x, e.y)
    # h = sqrt(1 - p . p)
    h = sqrt(maximum(1.0 - dot(p, p), 0.0))
    # upper: (side (SIDE h - UP p.y), side p.x, SIDE p.y + UP h)
    upper = Vec3(side * (SIDE * h - UP * p.y), side * p.x, SIDE * p.y + UP * h)
    # lower: (-side p.x, side (SIDE h + UP p.y), SIDE p.y - UP h)
    lower = Vec3(-side * p.x, side * (SIDE * h + UP * p.y), SIDE * p.y - UP * h)
    return select(is_upper, upper, lower)


ENCODING = Encoding(
    name="tetrahedral",
    title="tetrahedral",
    encode=encode,
    decode=decode,
    components=3,
    domain="sphere",
    citation="Unity, Scriptable Render Pipeline Core, Packing.hlsl (PackNormalTetraEncode), 2017",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(1, 2),
    ulps_reason="two products summed; two squares summed, one root, two products summed",
    levels=(0, 0, FACES),
    constants={"TETRAHEDRAL_FACES": FACES, "TETRAHEDRAL_SIDE": SIDE, "TETRAHEDRAL_UP": UP},
)
