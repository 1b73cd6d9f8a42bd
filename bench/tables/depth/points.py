"""The points at which depths are measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....encodings.shared.position import Camera

WIDTH = 4096


@dataclass(frozen=True, eq=False)
class Points:
    """Places on the screen and depths to measure at.

    Attributes:
        places: coordinates from -1 to 1, right and up; float32 of shape (count, 2).
        depths: view depth, float32 of shape (count,).
        width: number of points in a row when they are drawn, which determines the noise of each.
    """

    places: np.ndarray
    depths: np.ndarray
    width: int = WIDTH

    def positions(self, camera: Camera) -> np.ndarray:
        """Return the true positions in view space, float64 of shape (count, 3)."""
        return self.rays(camera) * self.depths[:, None].astype(np.float64)

    def rays(self, camera: Camera) -> np.ndarray:
        """Return the rays from the eye through the points, at depth 1: float64 of shape (count, 3)."""
        straight = np.full((len(self.places), 1), -1.0)
        return np.concatenate([self.places.astype(np.float64) * camera.rays, straight], axis=1)
