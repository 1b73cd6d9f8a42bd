"""Three components of a quaternion whose fourth is positive: a rotation without handedness.

q and -q are the same rotation, so w is made positive and follows from the squares of the others. If w is near 0, it
changes most with a step of another component: half turns are far less accurate than small rotations. Gaussian splats
are stored this way.
"""

from pathlib import Path

from ..codecs.frame_encoding import FrameEncoding
from ..rotation import Frame, quaternion_of, rotated_frame
from ..vec import Vec3, Vec4, dot, inversesqrt, maximum, sign_not_zero, sqrt


def encode(frame: Frame, least) -> Vec4:
    """Return x, y and z of the frame's quaternion with w >= 0, and 0 in w; the hand is not kept."""
    q = quaternion_of(frame)
    e = q.xyz * sign_not_zero(q.w)
    return Vec4(e.x, e.y, e.z, 0.0 * e.x)


def decode(e: Vec4, least) -> Frame:
    """Return the frame, with hand 1, for a quaternion's x, y and z, with w >= 0; beyond length 1, a half turn."""
    # w = sqrt(1 - |e|^2)
    v = Vec3(e.x, e.y, e.z)
    square = dot(v, v)
    v = v * inversesqrt(maximum(square, 1.0))
    return rotated_frame(Vec4(v.x, v.y, v.z, sqrt(maximum(1.0 - square, 0.0))), 0.0 * e.x + 1.0)


ENCODING = FrameEncoding(
    name="rotation_xyz",
    title="rotation as three components of its quaternion",
    encode=encode,
    decode=decode,
    hand_in=None,
    levels=(0, 0, 0),
    storages=("rgba8", "rgb10a2", "rgba16"),
    citation="Niantic, SPZ 2, load-spz.cc, 2024: three bytes, w positive",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(16384, 8192),
    ulps_reason="of a half turn three squares leave 2^-22 of 1 by rounding, whose root is 2^-11; on either side",
)
