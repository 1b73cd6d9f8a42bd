"""Modified Rodrigues parameters of a rotation without handedness: its quaternion, projected from -w onto a ball.

This is the stereographic projection in one more dimension: all rotations are in the unit ball, and for a half turn,
opposite axes give the same rotation. No angle is needed.
"""

from pathlib import Path

from ..codecs.frame_encoding import FrameEncoding
from ..rotation import Frame, quaternion_of, rotated_frame
from ..vec import Vec3, Vec4, dot, sign_not_zero


def encode(frame: Frame, least) -> Vec4:
    """Return q.xyz / (1 + w) for the frame's quaternion q with w >= 0, and 0 in w; the hand is not kept."""
    q = quaternion_of(frame)
    # e = q.xyz / (1 + w)
    e = q.xyz * (sign_not_zero(q.w) / (1.0 + abs(q.w)))
    return Vec4(e.x, e.y, e.z, 0.0 * e.x)


def decode(e: Vec4, least) -> Frame:
    """Return the frame, with hand 1, that a point e.xyz represents; a point outside the unit ball gives the same
    frame as some point inside it."""
    v = Vec3(e.x, e.y, e.z)
    # q = (2 e, 1 - |e|^2) / (1 + |e|^2)
    square = dot(v, v)
    scale = 1.0 / (1.0 + square)
    v = v * (2.0 * scale)
    return rotated_frame(Vec4(v.x, v.y, v.z, (1.0 - square) * scale), 0.0 * e.x + 1.0)


ENCODING = FrameEncoding(
    name="rotation_rodrigues",
    title="rotation as modified Rodrigues parameters",
    encode=encode,
    decode=decode,
    hand_in=None,
    levels=(0, 0, 0),
    storages=("rgba8", "rgb10a2", "rgba16"),
    citation="T. F. Wiener, Theoretical Analysis of Gimballess Inertial Reference Equipment, MIT, 1962; G. Terzakis et "
    "al., Modified Rodrigues Parameters, J. Math. Imaging and Vision 60, 2018",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 8),
    ulps_reason="a normalise, a division and a product; a division and products of its results, doubled",
)
