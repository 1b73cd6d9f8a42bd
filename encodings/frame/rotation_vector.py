"""Axis and angle of a rotation without handedness, as one vector: the axis times the angle in half turns.

Also called the exponential map. All rotations are in the unit ball; for a half turn, opposite axes give the same
rotation.
"""

from pathlib import Path

from ..codecs.frame_encoding import FrameEncoding
from ..elementary import CONSTANTS, quadrant_pi, sincos_pi
from ..rotation import Frame, quaternion_of, rotated_frame
from ..vec import TINY, Vec3, Vec4, dot, inversesqrt, maximum, minimum, sign_not_zero


def encode(frame: Frame, least) -> Vec4:
    """Return the rotation's axis times its angle in half turns, and 0 in w; the hand is not kept."""
    q = quaternion_of(frame)
    v = q.xyz * sign_not_zero(q.w)
    # e = axis 2 atan2(|v|, w) / pi
    square = maximum(dot(v, v), TINY)
    inverse = inversesqrt(square)
    e = v * (2.0 * quadrant_pi(square * inverse, abs(q.w)) * inverse)
    return Vec4(e.x, e.y, e.z, 0.0 * e.x)


def decode(e: Vec4, least) -> Frame:
    """Return the frame, with hand 1, rotated about e.xyz by its length in half turns, at most one half turn."""
    v = Vec3(e.x, e.y, e.z)
    # q = (v / |v| sin(pi |v| / 2), cos(pi |v| / 2))
    square = maximum(dot(v, v), TINY)
    inverse = inversesqrt(square)
    sine, cosine = sincos_pi(0.5 * minimum(square * inverse, 1.0))
    v = v * (inverse * sine)
    return rotated_frame(Vec4(v.x, v.y, v.z, cosine), 0.0 * e.x + 1.0)


ENCODING = FrameEncoding(
    name="rotation_vector",
    title="rotation as its axis times its angle",
    encode=encode,
    decode=decode,
    hand_in=None,
    levels=(0, 0, 0),
    storages=("rgba8", "rgb10a2", "rgba16"),
    citation="F. S. Grassia, Practical Parameterization of Rotations Using the Exponential Map, 1998",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(6, 10),
    ulps_reason="a normalise, an inverse root and an arc tangent; an inverse root, two sines and products, doubled",
    constants=CONSTANTS,
)
