"""The positions of the volumes in the world, and the lights' views of the volumes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...frame.scene_buffers import Sight
from ...scenes.scene import Light, Scene, View

# A volume of side s is centred this part of s ahead of the eye.
AHEAD = 0.25
# Cells kept free around the scene: surfaces lie off the border, however the snapping falls, and those at one end of the
# scene are a whole cell inside.
MARGIN = 1.25
# Metres of the smallest scene.
LEAST = 0.001
# Half the angle of the widest spot whose light is taken whole; the picture of a wider one would be mostly rim.
WIDEST = 80.0
# A spot's near plane, in parts of its radius.
NEAR = 0.01


@dataclass(frozen=True)
class Cascade:
    """The place of a volume in the world.

    Attributes:
        origin: position of its low corner, in its own cells from the origin of the world.
        cell: the side of a cell in metres.
        cells: number of cells along each axis.
    """

    origin: tuple[int, int, int]
    cell: float
    cells: int

    @property
    def box(self) -> np.ndarray:
        """The low and the high corner of the volume in the world, (2, 3)."""
        low = np.array(self.origin, float)
        return np.stack([low, low + self.cells]) * self.cell


@dataclass(frozen=True)
class LightSight:
    """A light's view of the scene, in a square image: a `Sight`.

    Attributes:
        rows: the matrix from world to view space, 16 numbers row by row.
        half: half the image's width and height: in metres for parallel rays, otherwise at distance 1.
        near, far: distances along the line of sight.
        is_parallel: whether its rays are parallel.
    """

    rows: tuple[float, ...]
    half: tuple[float, float]
    near: float
    far: float
    is_parallel: bool

    def matrix(self) -> np.ndarray:
        """Return the matrix from world to view space, (4, 4)."""
        return np.array(self.rows).reshape(4, 4)

    def projection(self, aspect: float) -> np.ndarray:  # noqa: ARG002 (the picture is square whatever it is drawn into)
        """Return the matrix from view to clip space, (4, 4), parallel or in perspective; `aspect` is ignored."""
        (x, y), near, far = self.half, self.near, self.far
        matrix = np.diag([1 / x, 1 / y, 0.0, 0.0])
        if self.is_parallel:
            matrix[2, 2:], matrix[3, 3] = (2 / (near - far), (near + far) / (near - far)), 1.0
        else:
            matrix[2, 2:], matrix[3, 2] = ((near + far) / (near - far), 2 * near * far / (near - far)), -1.0
        return matrix

    def rays(self, size: tuple[int, int]) -> tuple[float, float, float, float]:  # noqa: ARG002
        """Return half the image's extent, right and up, and the near and far distances; `size` is ignored."""
        return *self.half, self.near, self.far


def box_of(scene: Scene) -> np.ndarray:
    """Return the low and the high corner of the box around everything that a scene draws, (2, 3)."""
    ends = []
    for part in scene.parts:
        low, high = part.mesh.positions.min(axis=0), part.mesh.positions.max(axis=0)
        corners = np.stack(np.meshgrid(*zip(low, high, strict=True)), axis=-1).reshape(-1, 3)
        ends.append(np.einsum("nij,cj->nci", part.models[:, :3, :3], corners) + part.models[:, None, :3, 3])
    placed = np.concatenate([corners.reshape(-1, 3) for corners in ends])
    return np.stack([placed.min(axis=0), placed.max(axis=0)])


def finest_cell(box: np.ndarray, extent: float, cells: int, cascades: int) -> float:
    """Return the side of the finest cascade's cells in metres: extent / cells or, if the extent is 0, the side at
    which the coarsest cascade contains the box."""
    if extent > 0:
        return extent / cells
    longest = max(float((box[1] - box[0]).max()), LEAST)
    return longest / (cells - 2 * MARGIN) / 2 ** (cascades - 1)


def cascades_of(view: View, box: np.ndarray, cell: float, cells: int, cascades: int) -> tuple[Cascade, ...]:
    """Return the cascades around a view, the finest first; the side of the cells doubles from cascade to cascade."""
    return tuple(_placed_cascade(view, box, cell * 2**index, cells) for index in range(cascades))


def _placed_cascade(view: View, box: np.ndarray, cell: float, cells: int) -> Cascade:
    """Return the cascade ahead of the eye, aligned to whole cells. Along each axis it is clamped to the scene's box,
    or centred on the box if the cascade is larger."""
    forward = np.subtract(view.target, view.eye)
    wanted = view.eye + AHEAD * cell * cells * forward / np.linalg.norm(forward)
    reach = (cells / 2 - MARGIN) * cell
    least, most = box[0] + reach, box[1] - reach
    centre = np.where(least < most, np.clip(wanted, least, np.maximum(least, most)), box.mean(axis=0))
    x, y, z = np.round(centre / cell - cells / 2).astype(int).tolist()
    return Cascade((x, y, z), cell, cells)


def sun_sight(sun: Light, cascade: Cascade, box: np.ndarray, texels: int) -> Sight:
    """Return a parallel view along the sun's rays that covers a cascade and begins in front of the whole scene. Its
    texels keep their positions in the world when the cascade moves."""
    back = -np.array(sun.direction)
    right = np.cross(back, np.eye(3)[np.argmin(abs(back))])
    right = right / np.linalg.norm(right)
    axes = np.stack([right, np.cross(back, right), back])
    # A turned box is as wide as its edges' shadows.
    half = np.abs(axes[:2]).sum(axis=1) * cascade.cell * cascade.cells / 2
    texel = 2 * half / texels
    centre = np.round(axes[:2] @ cascade.box.mean(axis=0) / texel) * texel
    ends = np.stack([axes[2] @ corner for corner in np.stack(np.meshgrid(*box.T), axis=-1).reshape(-1, 3)])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = axes, -np.array([*centre, ends.max()])
    # A margin of a cell, so that nothing right at an end is cut off.
    near, far = -cascade.cell, float(np.ptp(ends)) + cascade.cell
    return LightSight(tuple(matrix.ravel().tolist()), (float(half[0]), float(half[1])), near, far, True)


def spot_sight(spot: Light) -> Sight:
    """Return the perspective view for a spotlight's shadow: the light's cone, up to WIDEST degrees from its axis."""
    way = np.array(spot.direction)
    up = tuple(np.eye(3)[np.argmin(abs(way))].tolist())
    view = View(spot.position, tuple((np.array(spot.position) + way).tolist()), 90.0, 1.0, 2.0, up)
    half = float(np.tan(np.radians(min(spot.outer, WIDEST))))
    near, far = NEAR * spot.radius, spot.radius
    return LightSight(tuple(view.matrix().ravel().tolist()), (half, half), near, far, False)
