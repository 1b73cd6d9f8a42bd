"""Axis and angle of a frame's rotation: the axis on the octahedral square, and the angle with the hand as its sign.

An angle of 0 has no sign, so the smallest number with a sign replaces it. For a half turn, opposite axes give the
same rotation.
"""

from pathlib import Path

from ..codecs.frame_encoding import FrameEncoding
from ..elementary import CONSTANTS, quadrant_pi, sincos_pi
from ..rotation import Frame, quaternion_of, rotated_frame
from ..vec import TINY, Vec2, Vec3, Vec4, dot, inversesqrt, maximum, minimum, normalize, select, sign_not_zero


def encode(frame: Frame, least) -> Vec4:
    """Return the rotation's axis, as a point of the octahedral square, in x and y; the angle in half turns, at least
    `least`, times the hand, in z; and 0 in w."""
    q = quaternion_of(frame)
    v = q.xyz * sign_not_zero(q.w)
    # p = v.xy / (|v.x| + |v.y| + |v.z|), and for v.z < 0 (1 - |p.yx|) sign(p)
    p = v.xy * (1.0 / maximum(abs(v.x) + abs(v.y) + abs(v.z), TINY))
    p = select(v.z < 0.0, (1.0 - abs(p.yx)) * sign_not_zero(p), p)
    # a = 2 atan2(|v|, w) / pi
    square = maximum(dot(v, v), TINY)
    a = 2.0 * quadrant_pi(square * inversesqrt(square), abs(q.w))
    return Vec4(p.x, p.y, maximum(a, least) * frame.hand, 0.0 * p.x)


def decode(e: Vec4, least) -> Frame:
    """Return the frame rotated by |e.z| half turns about the axis in e.xy, with the sign of e.z as its hand."""
    # k = (e, 1 - |e.x| - |e.y|), and for k.z < 0 k.xy - sign(e) (-k.z)
    xy = Vec2(e.x, e.y)
    z = 1.0 - abs(xy.x) - abs(xy.y)
    p = xy - sign_not_zero(xy) * maximum(-z, 0.0)
    k = normalize(Vec3(p.x, p.y, z))
    # q = (k sin(pi a / 2), cos(pi a / 2))
    sine, cosine = sincos_pi(0.5 * minimum(abs(e.z), 1.0))
    return rotated_frame(Vec4(k.x * sine, k.y * sine, k.z * sine, cosine), sign_not_zero(e.z))


ENCODING = FrameEncoding(
    name="axis_angle",
    title="axis and angle of the rotation, with the handedness as the sign",
    encode=encode,
    decode=decode,
    hand_in=2,
    levels=(0, 0, 0),
    storages=("rgba8_snorm", "rgb10a2", "rgba16_snorm"),
    citation="Bevy's compressed tangents, bevyengine/bevy pull request 24535, 2026",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(6, 10),
    ulps_reason="a normalise, a reciprocal and an arc tangent; a normalise, two sines and products, doubled",
    constants=CONSTANTS,
)
