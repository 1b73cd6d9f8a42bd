"""Python twins of users' encoders."""

# Half the sphere in the whole square.
HALF_OCTAHEDRAL = """
from normalbench.encodings.vec import Vec2, Vec3, normalize


def encode(n, view):
    s = abs(n.x) + abs(n.y) + abs(n.z)
    return Vec2((n.x + n.y) / s, (n.x - n.y) / s)


def decode(e, view):
    x, y = (e.x + e.y) * 0.5, (e.x - e.y) * 0.5
    return normalize(Vec3(x, y, 1.0 - abs(x) - abs(y)))
"""
