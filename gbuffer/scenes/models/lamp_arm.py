"""A mechanical lamp arm, like the four in the article's scene; the original's mesh may not be redistributed.

The arm follows the plane y = 0: a bracket, a thick ring, a tapering tube to a fork joint, a second tube to a head
with flat facets, and bent cables along both tubes. Round parts are tessellated coarsely and have smooth normals, so
that interpolated normals face away from the eye at silhouettes. The dimensions reproduce the statistics of the
original's four arms: the number of pixels that they cover, how many of their normals have z < 0 or face away, and the
histograms of z and of n . v (tests/gbuffer/test_lamp_arm.py).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from ..mesh import Mesh, grid_triangles, grid_uv, joined, smooth_normals

# Places in the plane, x and z: the bracket's foot, the ring, the elbow and the head.
FOOT, RING, ELBOW, HEAD = np.array(((-4.361, 3.854), (0.312, 1.995), (4.807, -3.855), (1.111, -1.287)))
THICK = 0.13
RING_RADIUS, RING_HOLE, RING_BULGE, RING_SLICES = 0.748, 0.383, 0.077, 16
FOOT_RADIUS, NECK_RADIUS, ROUNDING = 0.213, 0.219, 5
TUBE_RADII, TUBE_SIDES = (0.24, 0.07, 0.087), 7
JOINT_RADIUS, PIN_SLICES = 0.268, 10
CABLE_RADIUS, CABLE_SAG, CABLE_SIDES, CABLE_STEPS = 0.025, 0.246, 8, 8
HEAD_RADII, HEAD_LENGTH, HEAD_SIDES, HEAD_FACES = (0.153, 0.15), 0.251, 7, (3.263, -2.38, 3.117)


@cache
def lamp_arm() -> Mesh:
    """Return the arm in its own space, about 900 triangles."""
    return joined([*_shoulder(), *_elbow(), *_cables(), _head()])


def _shoulder() -> Iterator[Mesh]:
    """Yield the meshes of the bracket, the ring at its end, and the tube behind the ring."""
    neck = RING + _way(RING, FOOT) * (0.9 * RING_RADIUS + NECK_RADIUS)
    yield plate(FOOT, neck, FOOT_RADIUS, NECK_RADIUS, 0.4 * THICK)
    yield disc(RING_RADIUS, 0.8 * THICK, RING_SLICES, RING_HOLE, RING_BULGE).placed(np.eye(3), _at(RING))
    along = _way(RING, ELBOW)
    ends = RING + 0.9 * RING_RADIUS * along, ELBOW - 0.8 * JOINT_RADIUS * along
    yield swept(np.stack([_at(end) for end in ends]), TUBE_RADII[:2], TUBE_SIDES)


def _elbow() -> Iterator[Mesh]:
    """Yield the meshes of the fork's two prongs, its pin, the tongue between them, and the second tube."""
    back, on = _way(ELBOW, RING), _way(ELBOW, HEAD)
    for side in (-1.0, 1.0):
        prong = plate(ELBOW + 1.2 * JOINT_RADIUS * back, ELBOW, JOINT_RADIUS, JOINT_RADIUS, 0.18 * THICK)
        yield prong.placed(np.eye(3), (0, 0.62 * side * THICK, 0))
    yield disc(0.55 * JOINT_RADIUS, THICK, PIN_SLICES).placed(np.eye(3), _at(ELBOW))
    yield plate(ELBOW, ELBOW + 1.6 * JOINT_RADIUS * on, 0.9 * JOINT_RADIUS, 0.7 * JOINT_RADIUS, 0.4 * THICK)
    yield swept(np.stack([_at(ELBOW + JOINT_RADIUS * on), _at(HEAD)]), TUBE_RADII[1:], TUBE_SIDES)


def _cables() -> Iterator[Mesh]:
    """Yield the meshes of two cables along each tube, above and below the plane, bent away from the tube."""
    along = _way(RING, ELBOW)
    aside = np.array([-along[1], along[0]])
    start = RING + RING_RADIUS * (0.8 * aside - 0.5 * along)
    for side in (-1.0, 1.0):
        y = 0.5 * side * THICK
        first, last = (RING + ELBOW) / 2 + aside * (side * CABLE_SAG + 0.2), (ELBOW + HEAD) / 2 + aside * CABLE_SAG
        yield _cable(_at(start, y), _at(first, 1.6 * y), _at(ELBOW, 1.8 * y))
        yield _cable(_at(ELBOW, 1.8 * y), _at(last, 1.6 * y), _at(HEAD, y))


def _cable(start: np.ndarray, middle: np.ndarray, end: np.ndarray) -> Mesh:
    """Return the mesh of a cable along a quadratic Bezier curve."""
    t = np.linspace(0, 1, CABLE_STEPS)[:, None]
    path = (1 - t) ** 2 * start + 2 * t * (1 - t) * middle + t * t * end
    return swept(path, (CABLE_RADIUS,) * CABLE_STEPS, CABLE_SIDES)


def _head() -> Mesh:
    """Return the mesh of a lamp shade with flat facets and a recessed front."""
    (narrow, wide), long = HEAD_RADII, HEAD_LENGTH
    profile = [(0, 0), (narrow, 0), (wide, 0.6 * long), (wide, long), (0.85 * wide, long)]
    profile += [(0.8 * wide, 0.9 * long), (0, 0.85 * long)]
    axis = np.array(HEAD_FACES) / np.linalg.norm(HEAD_FACES)
    across = np.cross((0.3, 0.5, 0.81), axis)
    across = across / np.linalg.norm(across)
    turned_to = np.stack([across, axis, np.cross(across, axis)])
    return faceted(turned(profile, HEAD_SIDES)).placed(turned_to, _at(HEAD))


# Parts


def surface(points: np.ndarray) -> Mesh:
    """Return the mesh of a grid of points, (rows, columns, 3), with smooth normals."""
    rows, columns = points.shape[0] - 1, points.shape[1] - 1
    positions, triangles = points.reshape(-1, 3), grid_triangles(rows, columns)
    return Mesh(positions, smooth_normals(positions, triangles), triangles, grid_uv(rows, columns))


def swept(path: np.ndarray, radii: tuple[float, ...], sides: int) -> Mesh:
    """Return a tube with flat ends along a path, (steps, 3), that never runs along y, with a radius per step."""
    tangents = np.gradient(path, axis=0)
    tangents = tangents / np.linalg.norm(tangents, axis=1, keepdims=True)
    up = (0.0, 1.0, 0.0) - tangents * tangents[:, 1:2]
    up = up / np.linalg.norm(up, axis=1, keepdims=True)
    angle = _around(sides)[:, None]
    circle = np.cos(angle) * up[:, None] + np.sin(angle) * np.cross(tangents, up)[:, None]
    rings = path[:, None] + np.array(radii)[:, None, None] * circle
    first, last = (np.broadcast_to(path[end], rings[end].shape) for end in (0, -1))
    return joined([surface(rings), surface(np.stack([first, rings[0]])), surface(np.stack([rings[-1], last]))])


def turned(profile: list[tuple[float, float]], slices: int) -> Mesh:
    """Return a surface of revolution around y; the profile lists points (radius, height)."""
    radius, height = np.array(profile, float).T[..., None]
    angle = -_around(slices)
    return surface(np.stack([radius * np.cos(angle), height + 0 * angle, radius * np.sin(angle)], axis=-1))


def disc(radius: float, half: float, slices: int, hole: float = 0.0, bulge: float = 0.0) -> Mesh:
    """Return a disc or a ring around y, with flat ends at y = half and y = -half and a rim that bulges by `bulge`."""
    rim = [(radius, -half), (radius + bulge, 0.0), (radius, half)] if bulge else [(radius, -half), (radius, half)]
    profiles = [[(radius, half), (hole, half)], [(hole, -half), (radius, -half)], rim]
    profiles += [[(hole, half), (hole, -half)]] if hole else []
    return joined([turned(profile, slices) for profile in profiles])


def plate(start: np.ndarray, end: np.ndarray, first: float, last: float, half: float) -> Mesh:
    """Return a plate from y = -half to half: two circles in the plane and the area between them.

    Args:
        start, end: the circles' centres; `first` and `last` are their radii.
    """
    along = _way(start, end)
    turn = np.arctan2(along[1], along[0]) + np.linspace(np.pi / 2, 3 * np.pi / 2, ROUNDING + 1)
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    outline = np.concatenate([start + first * circle, end - last * circle])
    outline = np.concatenate([outline, outline[:1]])[::-1]
    low, high = (np.stack([_at(point, y) for point in outline]) for y in (-half, half))
    bottom, top = (np.broadcast_to(_at((start + end) / 2, y), low.shape) for y in (-half, half))
    return joined([surface(np.stack(rows)) for rows in ((high, top), (bottom, low), (low, high))])


def faceted(mesh: Mesh) -> Mesh:
    """Return the mesh with flat normals, three vertices per triangle; triangles with zero area are left out."""
    corners = mesh.positions[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(across, axis=1)
    kept = area > 1e-12
    normals = np.repeat(across[kept] / area[kept, None], 3, axis=0)
    uv = mesh.uv[mesh.triangles][kept].reshape(-1, 2)
    return Mesh(corners[kept].reshape(-1, 3), normals, np.arange(len(normals)).reshape(-1, 3), uv)


def _around(count: int) -> np.ndarray:
    """Return `count` + 1 angles around a circle, in radians; the last is 0 again, so that a ring closes."""
    return np.arange(count + 1) % count * (2 * np.pi / count)


def _way(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return the unit direction from one point to another."""
    return (end - start) / np.linalg.norm(end - start)


def _at(place: np.ndarray, y: float = 0.0) -> np.ndarray:
    """Return a point (x, z) of the plane as (x, y, z)."""
    return np.array([place[0], y, place[1]])
