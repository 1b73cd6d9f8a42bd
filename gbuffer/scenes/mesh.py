"""Triangle meshes and their placement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

# Vertices are in one place where they fall into one of so many cells along a mesh's extent: float32's, or nearly.
WELD = 1 << 22


@dataclass(frozen=True)
class Mesh:
    """Triangles with vertex normals.

    Attributes:
        positions: (vertices, 3), float64.
        normals: (vertices, 3), unit, pointing outward, float64.
        triangles: (triangles, 3), vertex indices in any winding order; the normals define the outer side.
        uv: (vertices, 2), texture coordinates, which also define the tangents of a normal map.
        authored: (vertices, 4), tangents and the signs of their bitangents, as returned by `tangents`, that do not
            follow from `uv`: those in a file, or those for the uv set of its normal map.
        second_uv: (vertices, 2), a second uv set that maps may use; None if the mesh has only one.
    """

    positions: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    uv: np.ndarray
    authored: np.ndarray | None = None
    second_uv: np.ndarray | None = None

    @cached_property
    def uploaded(self) -> tuple[np.ndarray, np.ndarray]:
        """The arrays for a device, kept for later frames: vertices, float32, and triangles from `wound`, int32.

        A vertex consists of its position, its normal, its tangent with the bitangent's sign, and its two uv sets. A
        mesh with one set repeats it.
        """
        second = self.uv if self.second_uv is None else self.second_uv
        vertices = np.concatenate([self.positions, self.normals, tangents(self), self.uv, second], axis=1)
        return vertices.astype(np.float32), wound(self).astype(np.int32)

    def placed(self, linear: np.ndarray, translation) -> Mesh:
        """Return the mesh after p' = p linear + translation (row vectors); normals use the inverse transpose."""
        normals = _unit(self.normals @ np.linalg.inv(linear).T)
        authored = None if self.authored is None else _tangents_placed(self.authored, linear)
        return Mesh(
            self.positions @ linear + np.asarray(translation),
            normals,
            self.triangles,
            self.uv,
            authored,
            self.second_uv,
        )


def _tangents_placed(authored: np.ndarray, linear: np.ndarray) -> np.ndarray:
    """Return tangents transformed like directions in the surface; a reflection flips the bitangent's sign."""
    sign = authored[:, 3:] * np.sign(np.linalg.det(linear))
    return np.concatenate([_unit(authored[:, :3] @ linear), sign], axis=1)


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """Join meshes into one mesh, without authored tangents or second uv sets."""
    starts = np.cumsum([0, *(len(m.positions) for m in meshes[:-1])])
    return Mesh(
        np.concatenate([m.positions for m in meshes]),
        np.concatenate([m.normals for m in meshes]),
        np.concatenate([m.triangles + start for m, start in zip(meshes, starts, strict=True)]),
        np.concatenate([m.uv for m in meshes]),
    )


def rotation(yaw: float, pitch: float, roll: float) -> np.ndarray:
    """Return the matrix, (3, 3), of a roll about z, then a pitch about x, then a yaw about y, for row vectors in a
    left-handed space; angles in radians."""

    def turn(angle: float, a: int, b: int) -> np.ndarray:
        m = np.eye(3)
        m[a, a] = m[b, b] = np.cos(angle)
        m[a, b], m[b, a] = np.sin(angle), -np.sin(angle)
        return m

    return turn(roll, 0, 1) @ turn(pitch, 1, 2) @ turn(yaw, 2, 0)


def grid_triangles(rows: int, columns: int) -> np.ndarray:
    """Return vertex indices, (triangles, 3), of two triangles per cell in a grid of (rows + 1) x (columns + 1)
    vertices, row by row."""
    corner = np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)
    a, b, c, d = corner, corner + 1, corner + columns + 1, corner + columns + 2
    return np.stack([a, b, c, b, d, c], axis=-1).reshape(-1, 3)


def wound(mesh: Mesh) -> np.ndarray:
    """Return the mesh's triangles, (triangles, 3), with corners in counter-clockwise order as seen from the side to
    which the normals point."""
    corners = mesh.positions[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inwards = np.sum(across * mesh.normals[mesh.triangles].sum(axis=1), axis=1) < 0
    triangles = mesh.triangles.copy()
    triangles[inwards] = triangles[inwards][:, ::-1]
    return triangles


def facing(mesh: Mesh) -> Mesh:
    """Return a view-space mesh without its back faces: only triangles that face the eye, at the origin."""
    triangles = wound(mesh)
    corners = mesh.positions[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return replace(mesh, triangles=triangles[np.sum(across * corners[:, 0], axis=1) < 0])


def smooth_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return vertex normals for a mesh without normals, (vertices, 3): means over the adjacent triangles, weighted by
    angle (Thuermer and Wuethrich 1998). Vertices at the same position, up to rounding, share a normal, which is zero
    if all adjacent triangles have zero area.

    A triangle's corners run counter-clockwise when seen from outside.
    """
    corners = positions[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(across, axis=1)
    triangles, corners = triangles[area > 0], corners[area > 0]
    across = across[area > 0] / area[area > 0, None]
    extent = float(np.ptp(positions, axis=0).max()) or 1.0
    cells = np.round((positions - positions.min(axis=0)) / extent * WELD).astype(np.int64)
    # In two steps of whole numbers, which sort ten times faster than rows do.
    _, column = np.unique(cells[:, 0] << 32 | cells[:, 1], return_inverse=True)
    _, place = np.unique(column << 32 | cells[:, 2], return_inverse=True)
    total = np.zeros((len(positions), 3))
    for corner in range(3):
        a, b = (corners[:, (corner + step) % 3] - corners[:, corner] for step in (1, 2))
        angle = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.sum(a * b, axis=1))
        np.add.at(total, place[triangles[:, corner]], across * angle[:, None])
    length = np.linalg.norm(total, axis=1, keepdims=True)
    normals = np.divide(total, length, out=np.zeros_like(total), where=length > 1e-9)
    return normals[place]


def grid_uv(rows: int, columns: int) -> np.ndarray:
    """Return the uv, (vertices, 2), of a grid of (rows + 1) x (columns + 1) vertices, row by row: u grows from 0 to 1
    along a row, v along a column."""
    v, u = np.meshgrid(np.linspace(0, 1, rows + 1), np.linspace(0, 1, columns + 1), indexing="ij")
    return np.stack([u.ravel(), v.ravel()], axis=1)


def tangents(mesh: Mesh, uv: np.ndarray | None = None) -> np.ndarray:
    """Return unit tangents perpendicular to the normals, in the direction of increasing u, and the bitangents' signs.

    The shape is (vertices, 4). The bitangent is sign x (normal x tangent), on the side towards which v increases.
    Where u does not increase, as at a pole, the tangent is arbitrary. Authored tangents are returned unchanged,
    unless `uv` is given.
    """
    if uv is None and mesh.authored is not None:
        return mesh.authored
    along_u, along_v, side = _gradients(mesh, mesh.uv if uv is None else uv)
    t, b, most = np.zeros_like(mesh.positions), np.zeros_like(mesh.positions), np.zeros(len(mesh.positions))
    length = np.linalg.norm(along_u, axis=1)
    for corner in mesh.triangles.T:
        np.add.at(t, corner, along_u * side)
        np.add.at(b, corner, along_v * side)
        np.add.at(most, corner, length)
    n = mesh.normals
    least = np.eye(3)[np.argmin(abs(n), axis=1)]
    t = t - n * np.sum(n * t, axis=1, keepdims=True)
    lost = np.linalg.norm(t, axis=1) <= 1e-9 * most
    t[lost] = np.cross(n[lost], least[lost])
    sign = np.where(np.sum(np.cross(n, t) * b, axis=1) < 0, -1.0, 1.0)
    return np.concatenate([_unit(t), sign[:, None]], axis=1)


def _gradients(mesh: Mesh, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return, for each triangle, the directions of increasing u and of increasing v, (triangles, 3) each, times twice
    its signed area in uv, and the sign of that area, (triangles, 1)."""
    corners, uv = mesh.positions[mesh.triangles], uv[mesh.triangles]
    (e1, e2), (d1, d2) = (np.moveaxis(a[:, 1:] - a[:, :1], 1, 0) for a in (corners, uv))
    # e = du T + dv B for two edges, solved for T and B; the area in uv weighs each triangle.
    along_u = e1 * d2[:, 1:] - e2 * d1[:, 1:]
    along_v = e2 * d1[:, :1] - e1 * d2[:, :1]
    return along_u, along_v, np.sign(d1[:, :1] * d2[:, 1:] - d2[:, :1] * d1[:, 1:])


def laid_by(mesh: Mesh, uv: np.ndarray) -> Mesh:
    """Return the mesh with the tangents of a map whose texture coordinates are `uv`, (vertices, 2).

    Triangles on which the map is mirrored share no vertices with other triangles, because their bitangents have the
    opposite sign.
    """
    corners = mesh.positions[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    out = np.sign(np.sum(across * mesh.normals[mesh.triangles].sum(axis=1), axis=1))
    is_mirrored = out * _gradients(mesh, uv)[2][:, 0] < 0
    shared = np.intersect1d(mesh.triangles[is_mirrored], mesh.triangles[~is_mirrored])
    twin = np.arange(len(mesh.positions))
    twin[shared] = len(mesh.positions) + np.arange(len(shared))
    source = np.concatenate([np.arange(len(mesh.positions)), shared])
    second = None if mesh.second_uv is None else mesh.second_uv[source]
    triangles = np.where(is_mirrored[:, None], twin[mesh.triangles], mesh.triangles)
    split_mesh = Mesh(mesh.positions[source], mesh.normals[source], triangles, mesh.uv[source], second_uv=second)
    return replace(split_mesh, authored=tangents(split_mesh, uv[source]))


def plane(width: float, depth: float, repeat: float = 1.0) -> Mesh:
    """Return a horizontal rectangle around the origin that faces up (+y); its uv run from 0 to `repeat`."""
    corners = np.array([(x, 0.0, z) for z in (0.5, -0.5) for x in (-0.5, 0.5)])
    up = np.tile([0.0, 1.0, 0.0], (4, 1))
    return Mesh(corners * (width, 1.0, depth), up, grid_triangles(1, 1), grid_uv(1, 1) * repeat)


def sphere(radius: float, slices: int, stacks: int) -> Mesh:
    """Return a sphere with `slices` slices around the z axis and `stacks` stacks along it."""
    polar = np.linspace(0.0, np.pi, stacks + 1)[:, None]
    # The last meridian is the first one to the bit, so that the seam neither gapes nor overlaps.
    around = (np.arange(slices + 1) % slices * (2 * np.pi / slices))[None, :]
    normals = np.stack(
        [np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar) * np.ones_like(around)], axis=-1
    ).reshape(-1, 3)
    return Mesh(radius * normals, normals, grid_triangles(stacks, slices), grid_uv(stacks, slices))


def box(width: float, height: float, depth: float) -> Mesh:
    """Return an axis-aligned box with flat faces around the origin."""
    half = np.array([width, height, depth]) / 2
    positions, normals = [], []
    for axis in range(3):
        for side in (-1.0, 1.0):
            n = np.zeros(3)
            n[axis] = side
            u, v = np.roll(np.eye(3)[axis], 1), np.roll(np.eye(3)[axis], 2)
            positions += [(n + a * u + b * v) * half for a in (-1, 1) for b in (-1, 1)]
            normals += [n] * 4
    triangles = np.concatenate([grid_triangles(1, 1) + 4 * face for face in range(6)])
    return Mesh(np.array(positions), np.array(normals), triangles, np.tile(grid_uv(1, 1), (6, 1)))


def _unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)
