"""The domains of encodings: the normals that an encoding must represent."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Bool, Float


def in_domain(
    normals: Float[np.ndarray, "*shape 3"], views: Float[np.ndarray, "*shape 3"], domain: str
) -> Bool[np.ndarray, "*shape"]:
    """Return which normals are in a domain: "sphere", "hemisphere" (z >= 0) or "view" (facing the viewer).

    Args:
        views: vectors from the viewer to the surface, of any length.
    """
    if domain == "hemisphere":
        return normals[..., 2] >= 0
    if domain == "view":
        return np.sum(normals * views, axis=-1) <= 0
    return np.ones(normals.shape[:-1], bool)


def view_angles(
    normals: Float[np.ndarray, "*shape 3"], views: Float[np.ndarray, "*shape 3"]
) -> Float[np.ndarray, "*shape"]:
    """Return the angles between unit normals and the directions towards the viewer, in degrees.

    Args:
        views: vectors from the viewer to the surface, of any length except 0.
    """
    facing = -np.sum(normals * views, axis=-1) / np.linalg.norm(views, axis=-1)
    return np.degrees(np.arccos(np.clip(facing, -1.0, 1.0)))
