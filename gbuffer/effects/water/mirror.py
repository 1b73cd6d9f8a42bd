"""The camera mirrored at still water."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...scenes.scene import View


@dataclass(frozen=True)
class MirrorSight:
    """A view's reflection in still water, as a `Sight`. Left and right are exchanged in its image, because the camera
    is rotated, not reflected.

    Attributes:
        view: the mirrored camera.
        level: height of the water; everything below it is clipped.
    """

    view: View
    level: float

    def matrix(self) -> np.ndarray:
        """Return the matrix from world to view space, (4, 4)."""
        return self.view.matrix()

    def projection(self, aspect: float) -> np.ndarray:
        """Return the matrix from view to clip space, (4, 4), whose near plane is the water's surface (Lengyel,
        Oblique View Frustum Depth Projection and Clipping, 2005)."""
        matrix = self.view.projection(aspect)
        # The plane in view space, by the inverse transpose: positive above the water.
        c = np.linalg.inv(self.matrix()).T @ np.array([0.0, 1.0, 0.0, -self.level])
        # q = M^-1 (sign C.x, sign C.y, 1, 1); row 3 = 2 C / (C . q) - row 4
        q = np.linalg.inv(matrix) @ np.array([np.sign(c[0]), np.sign(c[1]), 1.0, 1.0])
        matrix[2] = c * (2 / (c @ q)) - matrix[3]
        return matrix

    def rays(self, size: tuple[int, int]) -> tuple[float, float, float, float]:
        """Return the rays of the mirrored camera; see `View.rays`."""
        return self.view.rays(size)


def mirrored_view(view: View, level: float) -> View:
    """Return the view mirrored at the water's level, with the camera below the water; left and right are exchanged in
    its image."""

    def across(point: tuple[float, float, float]) -> tuple[float, float, float]:
        return point[0], 2 * level - point[1], point[2]

    up = (view.up[0], -view.up[1], view.up[2])
    return replace(view, eye=across(view.eye), target=across(view.target), up=up)
