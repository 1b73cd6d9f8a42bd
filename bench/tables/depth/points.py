"""The points at which depth errors are measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....encodings.shared.position import Camera

WIDTH = 4096


@dataclass(frozen=True, eq=False)
class Points:
    """Screen positions and depths at which errors are measured.

    Attributes:
        places: coordinates from -1 to 1, right and up; float32 of shape (count, 2).
        depths: view depth, float32 of shape (count,).
        width: number of points in a row when they are drawn, which determines the noise at each point.
    """

    places: np.ndarray
    depths: np.ndarray
    width: int = WIDTH

    def positions(self, camera: Camera) -> np.ndarray:
        """Return the true positions in view space, float64 of shape (count, 3)."""
        return self.rays(camera) * self.depths[:, None].astype(np.float64)

    def rays(self, camera: Camera) -> np.ndarray:
        """Return the vectors from the eye to the points at depth 1: float64 of shape (count, 3)."""
        straight = np.full((len(self.places), 1), -1.0)
        return np.concatenate([self.places.astype(np.float64) * camera.rays, straight], axis=1)
