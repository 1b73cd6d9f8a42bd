"""Hexadecachoral: a quaternion over the sum of its absolute components, the octahedral map in four dimensions.

q and -q are the same rotation, so w is made positive and follows from the other three. The hand is a separate
number.
"""

from pathlib import Path

from ..codecs.frame_encoding import FrameEncoding
from ..rotation import Frame, quaternion_of, rotated_frame
from ..vec import Vec4, dot, inversesqrt, maximum, sign_not_zero


def encode(frame: Frame, least) -> Vec4:
    """Return three components in the octahedron |x| + |y| + |z| <= 1, and the hand in w; `least` is ignored."""
    # p = sign(q.w) q.xyz / (|q.x| + |q.y| + |q.z| + |q.w|)
    q = quaternion_of(frame)
    a = abs(q)
    p = q.xyz * (sign_not_zero(q.w) / (a.x + a.y + a.z + a.w))
    return Vec4(p.x, p.y, p.z, frame.hand)


def decode(e: Vec4, least) -> Frame:
    """Return the frame for three components and a hand, which is the sign of e.w; `least` is ignored."""
    # q = (p, 1 - |p.x| - |p.y| - |p.z|) at length 1
    q = Vec4(e.x, e.y, e.z, maximum(1.0 - abs(e.x) - abs(e.y) - abs(e.z), 0.0))
    return rotated_frame(q * inversesqrt(dot(q, q)), sign_not_zero(e.w))


ENCODING = FrameEncoding(
    name="hexadecachoral",
    title="quaternion over the sum of its absolute components",
    encode=encode,
    decode=decode,
    hand_in=3,
    levels=(0, 0, 0, 2),
    storages=("rgba8_10_10_11_1", "rgb10a2", "rgba8", "rgba16", "rgba16f"),
    citation="NVIDIA, RTX Remix, packing.slangh (dxvk-remix 574be6b): tangent frames in 10:10:11:1",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(6, 8),
    ulps_reason="a normalise, a division and a product; what three numbers leave of 1, a normalise, products, doubled",
)
