"""A picture of all directions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Environment:
    """Radiance from every direction, as an equirectangular image.

    The centre of texel (row, column) of (height, width) is at polar angle t = pi (row + 1/2) / height from +y and
    longitude p = 2 pi (column + 1/2) / width - pi: the direction (sin p sin t, cos t, -cos p sin t) in world space,
    so that -z is in the middle.

    Attributes:
        name: its name in tables.
        radiance: linear light, (height, width, 3), float32; width is twice the height.
        sun: the sun that was removed from the image and turned into a light: the unit direction in which its light
            travels, and its irradiance on a perpendicular surface, linear colour; None if no sun was removed.
        changes: changes to the image since it was read or computed, as rows name them.
    """

    name: str
    radiance: np.ndarray
    sun: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None
    changes: tuple[str, ...] = ()


def directions(height: int) -> np.ndarray:
    """Return the unit directions of an environment's texel centres, (height, 2 height, 3), float64."""
    t = (np.arange(height)[:, None] + 0.5) * np.pi / height
    return towards(t, (np.arange(2 * height) + 0.5) * np.pi / height - np.pi)


def towards(t: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Return unit directions from polar angles `t` and longitudes `p`, in radians. The shape is the broadcast shape
    of both, plus an axis of 3."""
    return np.stack(np.broadcast_arrays(np.sin(p) * np.sin(t), np.cos(t), -np.cos(p) * np.sin(t)), -1)


def solid_angles(height: int) -> np.ndarray:
    """Return the solid angle of one texel in each row, (height, 1), float64, in steradians."""
    edges = np.cos(np.arange(height + 1) * np.pi / height)
    return -np.diff(edges)[:, None] * np.pi / height
