"""Triangle meshes and their placement."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Mesh:
    """Triangles with vertex normals.

    Attributes:
        positions: (vertices, 3), float64.
        normals: (vertices, 3), unit, pointing out, float64.
        triangles: (triangles, 3) vertex indices; no order of corners is promised, the normals say which side is out.
    """

    positions: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray

    def placed(self, linear: np.ndarray, translation) -> Mesh:
        """The mesh under row vectors' p' = p linear + translation; normals go by the inverse transpose."""
        normals = self.normals @ np.linalg.inv(linear).T
        return Mesh(self.positions @ linear + np.asarray(translation), _unit(normals), self.triangles)


def joined(meshes: list[Mesh]) -> Mesh:
    """One mesh of several."""
    starts = np.cumsum([0, *(len(m.positions) for m in meshes[:-1])])
    return Mesh(
        np.concatenate([m.positions for m in meshes]),
        np.concatenate([m.normals for m in meshes]),
        np.concatenate([m.triangles + start for m, start in zip(meshes, starts, strict=True)]),
    )


def rotation(yaw: float, pitch: float, roll: float) -> np.ndarray:
    """Roll about z, then pitch about x, then yaw about y, for row vectors in a left-handed space; angles in radians."""

    def turn(angle: float, a: int, b: int) -> np.ndarray:
        m = np.eye(3)
        m[a, a] = m[b, b] = np.cos(angle)
        m[a, b], m[b, a] = np.sin(angle), -np.sin(angle)
        return m

    return turn(roll, 0, 1) @ turn(pitch, 1, 2) @ turn(yaw, 2, 0)


def grid_triangles(rows: int, columns: int) -> np.ndarray:
    """Two triangles for each cell of a (rows + 1) x (columns + 1) grid of vertices."""
    corner = np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)
    a, b, c, d = corner, corner + 1, corner + columns + 1, corner + columns + 2
    return np.stack([a, b, c, b, d, c], axis=-1).reshape(-1, 3)


def sphere(radius: float, slices: int, stacks: int) -> Mesh:
    """A sphere of slices around the z axis and stacks along it."""
    polar = np.linspace(0.0, np.pi, stacks + 1)[:, None]
    around = np.linspace(0.0, 2 * np.pi, slices + 1)[None, :]
    normals = np.stack(
        [np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar) * np.ones_like(around)], axis=-1
    ).reshape(-1, 3)
    return Mesh(radius * normals, normals, grid_triangles(stacks, slices))


def box(width: float, height: float, depth: float) -> Mesh:
    """An axis-aligned box around the origin with flat faces."""
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
    return Mesh(np.array(positions), np.array(normals), triangles)


def _unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)
