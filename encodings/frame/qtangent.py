"""QTangent: a whole quaternion whose sign is the frame's hand.

q and -q are the same rotation, so the sign of w is free. It must not be lost if w is near 0: w is then replaced by
the smallest number with a sign, which changes the angle by up to twice that number.
"""

from pathlib import Path

from ..codecs.frame_encoding import FrameEncoding
from ..rotation import Frame, quaternion_of, rotated_frame
from ..vec import TINY, Vec4, dot, inversesqrt, maximum, select, sign_not_zero, sqrt


def encode(frame: Frame, least) -> Vec4:
    """Return the frame's quaternion with |w| at least `least`; the sign of w is the hand."""
    q = quaternion_of(frame)
    q = q * sign_not_zero(q.w)
    # for w < least: (q.xyz sqrt(1 - least^2), least); e = hand q
    shrunk = q.xyz * sqrt(1.0 - least * least)
    biased = Vec4(shrunk.x, shrunk.y, shrunk.z, least)
    return select(q.w < least, biased, q) * frame.hand


def decode(e: Vec4, least) -> Frame:
    """Return the frame for a quaternion of any length, with w's sign as its hand; for zero, normal +z, tangent +x."""
    # q = e / |e|
    q = e * inversesqrt(maximum(dot(e, e), TINY))
    return rotated_frame(q, sign_not_zero(e.w))


ENCODING = FrameEncoding(
    name="qtangent",
    title="quaternion, with the handedness as its sign",
    encode=encode,
    decode=decode,
    hand_in=3,
    levels=(0, 0, 0, 0),
    storages=("rgba8_snorm", "rgba8", "rgba16_snorm", "rgba16f"),
    citation="I. Z. Frey and I. Herzeg, Spherical Skinning with Dual Quaternions and QTangents, SIGGRAPH Talks 2011",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 8),
    ulps_reason="one normalise; another of numbers that come back shorter, and products of its results, doubled",
)
