"""The Utah teapot, evaluated from its Bezier patches.

The control points are by M. Newell, 1975, as published by F. Crow, The Origins of the Teapot, IEEE CG&A 7(1), 1987: z
is up, the base is at z = 0, the spout points to +x, and Blinn's squashed height (3.15 to the tip of the lid) is kept.
Rim, body, lid and bottom are solids of revolution, so their patches are given by profiles. Handle and spout are given
on one side of the plane y = 0 and mirrored.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..mesh import Mesh, grid_triangles, grid_uv, joined

# A quarter circle's inner control points lie at this share of the radius, unless a circle names another.
QUARTER = 0.56

# (radius, height) of the four control circles of each turned patch; a third number stands in for QUARTER.
PROFILES: dict[str, tuple[tuple[float, ...], ...]] = {
    "rim": ((1.4, 2.4), (1.3375, 2.53125), (1.4375, 2.53125), (1.5, 2.4)),
    "upper body": ((1.5, 2.4), (1.75, 1.875), (2.0, 1.35), (2.0, 0.9)),
    "lower body": ((2.0, 0.9), (2.0, 0.45), (1.5, 0.225), (1.5, 0.15)),
    "knob": ((0.0, 3.15), (0.8, 3.15, 0.5625), (0.0, 2.85), (0.2, 2.7)),
    "lid": ((0.2, 2.7), (0.4, 2.55), (1.3, 2.55), (1.3, 2.4)),
    "bottom": ((0.0, 0.0), (1.425, 0.0), (1.5, 0.075), (1.5, 0.15)),
}

# (x, y, z) of 4 x 4 control points each: a row goes from the plane y = 0 around to it again.
MIRRORED = {
    "upper handle": (
        ((-1.6, 0, 2.025), (-1.6, 0.3, 2.025), (-1.5, 0.3, 2.25), (-1.5, 0, 2.25)),
        ((-2.3, 0, 2.025), (-2.3, 0.3, 2.025), (-2.5, 0.3, 2.25), (-2.5, 0, 2.25)),
        ((-2.7, 0, 2.025), (-2.7, 0.3, 2.025), (-3.0, 0.3, 2.25), (-3.0, 0, 2.25)),
        ((-2.7, 0, 1.8), (-2.7, 0.3, 1.8), (-3.0, 0.3, 1.8), (-3.0, 0, 1.8)),
    ),
    "lower handle": (
        ((-2.7, 0, 1.8), (-2.7, 0.3, 1.8), (-3.0, 0.3, 1.8), (-3.0, 0, 1.8)),
        ((-2.7, 0, 1.575), (-2.7, 0.3, 1.575), (-3.0, 0.3, 1.35), (-3.0, 0, 1.35)),
        ((-2.5, 0, 1.125), (-2.5, 0.3, 1.125), (-2.65, 0.3, 0.9375), (-2.65, 0, 0.9375)),
        ((-2.0, 0, 0.9), (-2.0, 0.3, 0.9), (-1.9, 0.3, 0.6), (-1.9, 0, 0.6)),
    ),
    "lower spout": (
        ((1.7, 0, 1.425), (1.7, 0.66, 1.425), (1.7, 0.66, 0.6), (1.7, 0, 0.6)),
        ((2.6, 0, 1.425), (2.6, 0.66, 1.425), (3.1, 0.66, 0.825), (3.1, 0, 0.825)),
        ((2.3, 0, 2.1), (2.3, 0.25, 2.1), (2.4, 0.25, 2.025), (2.4, 0, 2.025)),
        ((2.7, 0, 2.4), (2.7, 0.25, 2.4), (3.3, 0.25, 2.4), (3.3, 0, 2.4)),
    ),
    "upper spout": (
        ((2.7, 0, 2.4), (2.7, 0.25, 2.4), (3.3, 0.25, 2.4), (3.3, 0, 2.4)),
        ((2.8, 0, 2.475), (2.8, 0.25, 2.475), (3.525, 0.25, 2.49375), (3.525, 0, 2.49375)),
        ((2.9, 0, 2.475), (2.9, 0.15, 2.475), (3.45, 0.15, 2.5125), (3.45, 0, 2.5125)),
        ((2.8, 0, 2.4), (2.8, 0.15, 2.4), (3.2, 0.15, 2.4), (3.2, 0, 2.4)),
    ),
}

HEIGHT = 3.15


def _quarter_circle(turn: int, radius: float, height: float, k: float = QUARTER) -> list[tuple[float, float, float]]:
    c, s = np.round([np.cos(turn * np.pi / 2), np.sin(turn * np.pi / 2)])
    xy = radius * np.array([(1.0, 0.0), (1.0, k), (k, 1.0), (0.0, 1.0)]) @ np.array([[c, s], [-s, c]])
    return [(x, y, height) for x, y in xy]


def control_points() -> np.ndarray:
    """Return the control points of the 32 patches, float64 of shape (32, 4, 4, 3)."""
    patches = []
    for profile in PROFILES.values():
        for turn in range(4):
            patches.append([_quarter_circle(turn, *circle) for circle in profile])
    for half in MIRRORED.values():
        for side in (1.0, -1.0):
            patches.append(np.array(half, float) * (1.0, side, 1.0))
    return np.array(patches, float)


def _bernstein(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    s = 1 - t
    values = np.stack([s**3, 3 * s**2 * t, 3 * s * t**2, t**3], axis=-1)
    slopes = np.stack([-3 * s**2, 3 * s**2 - 6 * s * t, 6 * s * t - 3 * t**2, 3 * t**2], axis=-1)
    return values, slopes


def _evaluate(patch: np.ndarray, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and unscaled normals on a patch at parameters u (down the rows) and v (along them)."""
    (bu, du), (bv, dv) = _bernstein(u), _bernstein(v)
    position = np.einsum("ni,nj,ijk->nk", bu, bv, patch)
    along_u = np.einsum("ni,nj,ijk->nk", du, bv, patch)
    along_v = np.einsum("ni,nj,ijk->nk", bu, dv, patch)
    return position, np.cross(along_u, along_v)


def _patch_mesh(patch: np.ndarray, steps: int) -> Mesh:
    t = np.linspace(0.0, 1.0, steps + 1)
    u, v = (a.ravel() for a in np.meshgrid(t, t, indexing="ij"))
    positions, normals = _evaluate(patch, u, v)
    # Where a row of control points falls together (knob and bottom) the normal is the limit from inside the patch.
    flat = np.linalg.norm(normals, axis=1) < 1e-9
    normals[flat] = _evaluate(patch, np.clip(u[flat], 1e-4, 1 - 1e-4), np.clip(v[flat], 1e-4, 1 - 1e-4))[1]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return Mesh(positions, normals, grid_triangles(steps, steps), grid_uv(steps, steps))


def teapot(steps: int) -> Mesh:
    """Return the teapot in its own units, z up, with `steps` x `steps` cells per patch and analytic normals."""
    meshes = [_patch_mesh(patch, steps) for patch in control_points()]
    return joined([_outward(mesh, index) for index, mesh in enumerate(meshes)])


def _outward(mesh: Mesh, index: int) -> Mesh:
    """Return patch number `index` with its normals outward: if they point inwards on average, all are negated."""
    middle = mesh.positions.mean(axis=0)
    turned = index < 4 * len(PROFILES)
    inside = np.array([0.0, 0.0, HEIGHT / 2]) if turned else middle * (1.0, 0.0, 1.0)
    out = np.sum(mesh.normals * (mesh.positions - inside))
    return mesh if out > 0 else replace(mesh, normals=-mesh.normals)
