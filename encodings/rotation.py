"""Tangent frames, and the quaternions of their rotations.

A quaternion x, y, z, w rotates the axes onto the frame: x onto the tangent, y onto normal x tangent, z onto the
normal. A quaternion and its negative are the same rotation; the one whose largest component is positive is used. The
GLSL twin of this file is `rotation.glsl`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from .vec import TINY, Vec3, Vec4, cross, direction_or_forward, dot, inversesqrt, maximum, select, sign_not_zero


class Frame(NamedTuple):
    """A unit normal and a unit tangent at right angles, and the handedness: the bitangent is hand (normal x tangent).

    Attributes:
        normal, tangent: Vec3.
        hand: 1, or -1 for a mirrored frame.
    """

    normal: Vec3
    tangent: Vec3
    hand: Any


def frame_of(normal: Vec3, tangent: Vec3, hand) -> Frame:
    """Return a frame from any numbers. An invalid normal becomes +z, an invalid tangent +x; the hand becomes 1 or -1.

    Every input of a frame encoder passes through this function once, so that no texel becomes NaN.
    """
    length2 = dot(tangent, tangent)
    is_direction = (length2 > TINY) & (length2 < 1.0 / TINY)
    kept = select(is_direction, tangent, Vec3(1.0, 0.0, 0.0))
    return Frame(direction_or_forward(normal), kept, sign_not_zero(hand))


def quaternion_of(frame: Frame) -> Vec4:
    """Return the unit quaternion of a frame's rotation, with its largest component positive."""
    n, t = frame.normal, frame.tangent
    b = cross(n, t)
    # 4 q_i q for each component i; the one with the largest 4 q_i q_i, which is 1 or more, has no digits to lose
    x = Vec4(1.0 + t.x - b.y - n.z, t.y + b.x, t.z + n.x, b.z - n.y)
    y = Vec4(t.y + b.x, 1.0 - t.x + b.y - n.z, b.z + n.y, n.x - t.z)
    z = Vec4(t.z + n.x, b.z + n.y, 1.0 - t.x - b.y + n.z, t.y - b.x)
    w = Vec4(b.z - n.y, n.x - t.z, t.y - b.x, 1.0 + t.x + b.y + n.z)
    xy, zw = select(x.x > y.y, x, y), select(z.z > w.w, z, w)
    q = select(maximum(x.x, y.y) > maximum(z.z, w.w), xy, zw)
    return q * inversesqrt(dot(q, q))


def rotated_frame(q: Vec4, hand) -> Frame:
    """Return the frame whose normal and tangent are z and x rotated by a unit quaternion; `hand` is unchanged."""
    t = Vec3(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.z * q.w), 2.0 * (q.x * q.z - q.y * q.w))
    n = Vec3(2.0 * (q.x * q.z + q.y * q.w), 2.0 * (q.y * q.z - q.x * q.w), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))
    return Frame(n, t, hand)
