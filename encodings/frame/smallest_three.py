"""Smallest three: the three smallest components of a quaternion, and the index of the largest.

q and -q are the same rotation, so the largest component is made positive and follows from the squares of the others,
which are in [-1, 1] / sqrt(2). The third of these is stored as its distance from the lower end of that range, with
the hand as its sign: this takes one bit of its precision, and no additional bit.
"""

import math
from pathlib import Path

from ..codecs.frame_encoding import FrameEncoding
from ..rotation import Frame, quaternion_of, rotated_frame
from ..vec import Vec3, Vec4, dot, index_of, maximum, number_of, select, sign_not_zero, sqrt

RANGE = math.sqrt(0.5)


def encode(frame: Frame, least) -> Vec4:
    """Return the three smallest components of the frame's quaternion over RANGE, with z remapped to a magnitude of at
    least `least` whose sign is the hand, and in w the index of the largest, 0 to 3, as a number in [-1, 1]."""
    q = quaternion_of(frame)
    a = abs(q)
    xy, zw = maximum(a.x, a.y), maximum(a.z, a.w)
    # i = the largest component's index; s = sign(q_i) (the others) sqrt(2)
    i = select(xy >= zw, select(a.x >= a.y, 0.0, 1.0), select(a.z >= a.w, 2.0, 3.0))
    rest = select(i < 2.0, Vec3(select(i == 0.0, q.y, q.x), q.z, q.w), Vec3(q.x, q.y, select(i == 2.0, q.w, q.z)))
    largest = select(i < 2.0, select(i == 0.0, q.x, q.y), select(i == 2.0, q.z, q.w))
    s = rest * (sign_not_zero(largest) / RANGE)
    # e = (s.xy, hand (least + (1 - least) (s.z + 1) / 2), i)
    magnitude = least + (1.0 - least) * maximum(s.z * 0.5 + 0.5, 0.0)
    return Vec4(s.x, s.y, frame.hand * magnitude, number_of(i, 4))


def decode(e: Vec4, least) -> Frame:
    """Return the frame for three components and the index of the largest, with the sign of e.z as its hand.
    Components that no unit quaternion has do not give unit vectors."""
    # s.z = 2 (|e.z| - least) / (1 - least) - 1; q_i = sqrt(1 - |s|^2 / 2)
    third = (abs(e.z) - least) / (1.0 - least) * 2.0 - 1.0
    s = Vec3(e.x, e.y, third) * RANGE
    largest = sqrt(maximum(1.0 - dot(s, s), 0.0))
    i = index_of(e.w, 4)
    first = Vec4(select(i == 0.0, largest, s.x), select(i == 0.0, s.x, largest), s.y, s.z)
    last = Vec4(s.x, s.y, select(i == 2.0, largest, s.z), select(i == 2.0, s.z, largest))
    return rotated_frame(select(i < 2.0, first, last), sign_not_zero(e.z))


ENCODING = FrameEncoding(
    name="smallest_three",
    title="the smallest three components of the quaternion",
    encode=encode,
    decode=decode,
    hand_in=2,
    levels=(0, 0, 0, 4),
    storages=("rgb10a2", "rgba8", "rgba16", "rgba16f"),
    citation="N. Frykholm, The BitSquid low level animation system, 2009; G. Fiedler, Snapshot Compression, 2015",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(6, 6),
    ulps_reason="a normalise, a division and a product; a root of what three squares leave of 1, and products, doubled",
    constants={"SMALLEST_THREE_RANGE": RANGE},
)
