"""Water in float64, written from the formulas rather than the shaders."""

from __future__ import annotations

import numpy as np

INDEX = 1.333


def fresnel(angle: np.ndarray) -> np.ndarray:
    """Return the share of unpolarised light that water reflects, by Snell and Fresnel; angles in radians."""
    inside = np.arcsin(np.sin(angle) / INDEX)
    across = (np.cos(angle) - INDEX * np.cos(inside)) / (np.cos(angle) + INDEX * np.cos(inside))
    along = (INDEX * np.cos(angle) - np.cos(inside)) / (INDEX * np.cos(angle) + np.cos(inside))
    return (across**2 + along**2) / 2


def surface(waves, x: np.ndarray, z: np.ndarray, chop: float) -> tuple[np.ndarray, np.ndarray]:
    """Return points of the moved surface, from their places in still water, and its unit normals; (..., 3) each."""
    k, a = waves.wave_numbers, waves.heights
    turn = x[..., None] * k[:, 0] + z[..., None] * k[:, 1] - 2 * np.pi * waves.phases
    height, wave = (a * np.cos(turn)).sum(axis=-1), a * np.sin(turn)
    slope_x, slope_z = -(wave * k[:, 0]).sum(axis=-1), -(wave * k[:, 1]).sum(axis=-1)
    bend = [-(a * np.cos(turn) * k[:, i] * k[:, j]).sum(axis=-1) for i, j in ((0, 0), (0, 1), (1, 1))]
    along_x = np.stack([1 + chop * bend[0], slope_x, chop * bend[1]], axis=-1)
    along_z = np.stack([chop * bend[1], slope_z, 1 + chop * bend[2]], axis=-1)
    points = np.stack([x + chop * slope_x, height, z + chop * slope_z], axis=-1)
    return points, unit(np.cross(along_z, along_x))


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def still_rays(view, size: tuple[int, int]) -> np.ndarray:
    """Return unit directions from the eye through the pixels, world space, (height, width, 3); row 0 is the top."""
    right, up, *_ = view.rays(size)
    x = ((np.arange(size[0]) + 0.5) / size[0] * 2 - 1) * right
    y = (1 - (np.arange(size[1]) + 0.5) / size[1] * 2) * up
    ways = np.stack(np.broadcast_arrays(x[None, :], y[:, None], -1.0), axis=-1)
    return unit(ways) @ view.matrix()[:3, :3]
