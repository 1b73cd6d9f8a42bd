"""Smallest three for a rotation without handedness: three components of a quaternion, and the index of the largest.

Like `smallest_three`, but all three components use their whole range, because no component's sign stores the hand.
"""

import math
from pathlib import Path

from ..codecs.frame_encoding import FrameEncoding
from ..rotation import Frame, quaternion_of, rotated_frame
from ..vec import Vec3, Vec4, dot, index_of, maximum, number_of, select, sign_not_zero, sqrt

RANGE = math.sqrt(0.5)


def encode(frame: Frame, least) -> Vec4:
    """Return the three smallest components of the frame's quaternion over RANGE, and in w the index of the largest, 0
    to 3, as a number in [-1, 1]. The hand is not kept."""
    q = quaternion_of(frame)
    a = abs(q)
    xy, zw = maximum(a.x, a.y), maximum(a.z, a.w)
    # i = the largest component's index; e = (sign(q_i) (the others) sqrt(2), i)
    i = select(xy >= zw, select(a.x >= a.y, 0.0, 1.0), select(a.z >= a.w, 2.0, 3.0))
    rest = select(i < 2.0, Vec3(select(i == 0.0, q.y, q.x), q.z, q.w), Vec3(q.x, q.y, select(i == 2.0, q.w, q.z)))
    largest = select(i < 2.0, select(i == 0.0, q.x, q.y), select(i == 2.0, q.z, q.w))
    s = rest * (sign_not_zero(largest) / RANGE)
    return Vec4(s.x, s.y, s.z, number_of(i, 4))


def decode(e: Vec4, least) -> Frame:
    """Return the frame, with hand 1, for three components and the index of the largest. Components that no unit
    quaternion has do not give unit vectors."""
    # q_i = sqrt(1 - |e.xyz|^2 / 2)
    s = Vec3(e.x, e.y, e.z) * RANGE
    largest = sqrt(maximum(1.0 - dot(s, s), 0.0))
    i = index_of(e.w, 4)
    first = Vec4(select(i == 0.0, largest, s.x), select(i == 0.0, s.x, largest), s.y, s.z)
    last = Vec4(s.x, s.y, select(i == 2.0, largest, s.z), select(i == 2.0, s.z, largest))
    return rotated_frame(select(i < 2.0, first, last), 0.0 * e.x + 1.0)


ENCODING = FrameEncoding(
    name="rotation_smallest_three",
    title="rotation as the smallest three components of its quaternion",
    encode=encode,
    decode=decode,
    hand_in=None,
    levels=(0, 0, 0, 4),
    storages=("rgb10a2", "rgba8", "rgba16"),
    citation="N. Frykholm, The BitSquid low level animation system, 2009; G. Fiedler, Snapshot Compression, 2015",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(6, 6),
    ulps_reason="a normalise, a division and a product; a root of what three squares leave of 1, and products, doubled",
    constants={"ROTATION_SMALLEST_THREE_RANGE": RANGE},
)
