"""The correct normal for each operation, and the effect of mixing on length and specular power; float64 in NumPy."""

from __future__ import annotations

import numpy as np

from ...ground.angles import angles_deg


def unit_rows(v: np.ndarray) -> np.ndarray:
    """Return vectors (..., 3) scaled to length 1; a vector of length 0 stays 0."""
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.divide(v, length, out=np.zeros_like(v), where=length > 0)


def lerp_angle(theta, t):
    """Return the angle in radians between the first of two unit normals and their mix; the arguments broadcast.

    theta is the angle between the two normals, t the share of the second. Linear filtering gives this angle, whereas
    a rotation at constant speed (slerp) gives t theta: the difference comes from geometry alone.
    """
    # |a (1 - t) + b t| leans from a by atan2(t sin theta, 1 - t + t cos theta)
    return np.arctan2(t * np.sin(theta), 1.0 - t + t * np.cos(theta))


def lerp_length(theta, t):
    """Return the length of the mix in `lerp_angle` before normalisation: 1 if both normals are the same."""
    # |a (1 - t) + b t|^2 = 1 - 2 t (1 - t) (1 - cos theta)
    return np.sqrt(1.0 - 2.0 * t * (1.0 - t) * (1.0 - np.cos(theta)))


def tilted(tilt: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Return unit normals, (..., 3), tilted from +z by the angle `tilt` in the direction `turn`, both in radians."""
    return np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=-1)


def reoriented(base: np.ndarray, detail: np.ndarray) -> np.ndarray:
    """Return a detail's normal laid over a base's normal: rotated by the shortest rotation from +z to the base. The
    result has length 1 and shape (..., 3).

    Source: C. Barre-Brisebois and S. Hill, Blending in Detail, 2012 (reoriented normal mapping). For a base of -z,
    for which no rotation is the shortest, the detail is rotated about x.
    """
    # t = base + z, r = t (t . d') / t.z - d' with d' = (-d.x, -d.y, d.z)
    flipped = detail * np.array([-1.0, -1.0, 1.0])
    t = base + np.array([0.0, 0.0, 1.0])
    depth = t[..., 2:]
    is_behind = depth < 1e-12
    turned = t * np.sum(t * flipped, axis=-1, keepdims=True) / np.where(is_behind, 1.0, depth) - flipped
    return unit_rows(np.where(is_behind, detail * np.array([1.0, -1.0, -1.0]), turned))


def toksvig_power(length: np.ndarray, power: float) -> np.ndarray:
    """Return the specular power for a mean normal of a given length; any shape.

    Source: M. Toksvig, Mipmapping Normal Maps, Journal of Graphics Tools 10(3), 2005. Lengths above 1, which only
    rounding causes, count as 1.
    """
    # s' = f s with f = |n| / (|n| + s (1 - |n|))
    short = np.clip(length, 0.0, 1.0)
    return power * short / (short + power * (1.0 - short))


def angles_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the angles between the vectors of two arrays in degrees; 180 if either vector is not a direction."""
    a, b = a.astype(np.float64), b.astype(np.float64)
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        angles = angles_deg(unit_rows(a), unit_rows(b))
        is_there = np.isfinite(a).all(axis=-1) & np.isfinite(b).all(axis=-1) & a.any(axis=-1) & b.any(axis=-1)
    return np.where(is_there, angles, 180.0)
