"""An octahedral normal, and the angle of the tangent around it from a tangent that is fixed for each normal.

The fixed tangent belongs to the decoded normal: every field of tangents has a seam or a pole, at which a normal moved
by rounding would have a different fixed tangent. -1 and 1 are the same angle, so one of 2^n codes is unused.
"""

from pathlib import Path

from ..codecs.frame_encoding import FrameEncoding
from ..elementary import CONSTANTS, atan2_pi, sincos_pi
from ..rotation import Frame
from ..vec import Vec2, Vec3, Vec4, cross, dot, maximum, normalize, select, sign_not_zero

# Where the fixed tangents part, a height on the octahedron: steps of no fixed point or half float come to it, so that
# both languages, and both ends of a storage, are on one side of it.
SEAM = -0.3


def point(n: Vec3) -> Vec2:
    """Return the point of the octahedral square [-1, 1]^2 for a unit normal."""
    # p = n.xy / (|n.x| + |n.y| + |n.z|), and for z < 0 (1 - |p.yx|) sign(p)
    p = n.xy * (1.0 / (abs(n.x) + abs(n.y) + abs(n.z)))
    return select(n.z < 0.0, (1.0 - abs(p.yx)) * sign_not_zero(p), p)


def fixed(p: Vec2) -> Frame:
    """Return the frame at a point of the octahedral square: the unit normal, its fixed tangent, and hand 1."""
    # n = (p, 1 - |p.x| - |p.y|), and for z < 0 n.xy - sign(p) (-n.z)
    z = 1.0 - abs(p.x) - abs(p.y)
    xy = p - sign_not_zero(p) * maximum(-z, 0.0)
    n = normalize(Vec3(xy.x, xy.y, z))
    # s = 1, and -1 below the seam; t = (1 - s n.x^2 / (s + n.z), -s n.x n.y / (s + n.z), -s n.x)
    s = select(z < SEAM, -1.0, 1.0)
    a = s * n.x / (s + n.z)
    return Frame(n, Vec3(1.0 - n.x * a, -n.y * a, -s * n.x), 1.0)


def settle(frame: Frame, stored: Vec4) -> Vec4:
    """Return the code: in x and y the normal's numbers as stored, in z the tangent's angle around the stored normal,
    in half turns, and in w the hand."""
    f = fixed(Vec2(stored.x, stored.y))
    # a = atan2(t' . (n x t), t' . t) / pi
    angle = atan2_pi(dot(frame.tangent, cross(f.normal, f.tangent)), dot(frame.tangent, f.tangent))
    return Vec4(stored.x, stored.y, angle, frame.hand)


def encode(frame: Frame, least) -> Vec4:
    """Return the code: in x and y the normal's point on the octahedral square, in z the tangent's angle around the
    normal, in half turns, and in w the hand. `least` is ignored."""
    p = point(frame.normal)
    return settle(frame, Vec4(p.x, p.y, 0.0, 0.0))


def decode(e: Vec4, least) -> Frame:
    """Return the frame for a point of the square, an angle in half turns, and a hand, which is the sign of e.w."""
    f = fixed(Vec2(e.x, e.y))
    # t' = cos(pi a) t + sin(pi a) (n x t)
    sine, cosine = sincos_pi(e.z)
    return Frame(f.normal, cosine * f.tangent + sine * cross(f.normal, f.tangent), sign_not_zero(e.w))


ENCODING = FrameEncoding(
    name="octahedral_angle",
    title="octahedral normal and the tangent's angle",
    encode=encode,
    decode=decode,
    settle=settle,
    hand_in=3,
    levels=(0, 0, 0, 2),
    storages=("rgb10a2", "rgba8_10_10_11_1", "rgba8", "rgba16", "rgba16f"),
    citation="J. Ong, Tangent Spaces and Diamond Encoding, 2023; the fixed tangent: T. Duff et al., Building an "
    "Orthonormal Basis, Revisited, JCGT 6(1), 2017",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 6),
    ulps_reason="one reciprocal and an arc tangent; a normalise, a division, two sines and their products",
    constants={"OCTAHEDRAL_ANGLE_SEAM": SEAM, **CONSTANTS},
)
