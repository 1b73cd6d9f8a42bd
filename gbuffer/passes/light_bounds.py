"""Bounding meshes for drawing lights: closed, convex and never smaller than the light's reach."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..scenes.mesh import Mesh, sphere

SIDES = 16


def ball() -> Mesh:
    """Return a polyhedron that encloses the unit sphere."""
    mesh = sphere(1.0, SIDES, 10)
    corners = mesh.positions[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(across, axis=1)
    # How near the flat faces come to the middle; at the poles some have no area.
    inside = np.abs(np.sum(across * corners[:, 0], axis=1)[length > 1e-9] / length[length > 1e-9])
    return replace(mesh, positions=mesh.positions / inside.min())


def cone() -> Mesh:
    """Return a pyramid that encloses the unit cone along +z: tip at the origin, rim of radius 1 at z = 1."""
    around = 2 * np.pi * np.arange(SIDES) / SIDES
    widest = 1 / np.cos(np.pi / SIDES)
    rim = np.stack([widest * np.cos(around), widest * np.sin(around), np.ones(SIDES)], axis=1)
    following = np.roll(rim, -1, axis=0)
    flanks = np.stack([np.zeros_like(rim), rim, following], axis=1)
    base = np.stack([np.tile([0.0, 0.0, 1.0], (SIDES, 1)), rim, following], axis=1)
    positions = np.concatenate([flanks, base]).reshape(-1, 3)
    normals = np.repeat([(0.0, 0.0, -1.0), (0.0, 0.0, 1.0)], 3 * SIDES, axis=0)
    # The flanks' outward normals lean back; which way they lean out is the rim's own direction.
    normals[: 3 * SIDES] += np.repeat(rim + following, 3, axis=0) * (1.0, 1.0, 0.0)
    return Mesh(positions, normals, np.arange(6 * SIDES).reshape(-1, 3), np.zeros((6 * SIDES, 2)))
