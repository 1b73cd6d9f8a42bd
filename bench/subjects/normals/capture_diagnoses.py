"""Likely mistakes in a captured frame, found from normals that no camera can see.

A camera sees a surface from its front: n . ray < 0 for the ray from the eye through the pixel. If a frame is read as
intended, nearly all normals satisfy this at some angle of view. If it is read in the wrong space, with a transposed
matrix or with swapped channels, many do not.

Arrays are float of shape (count, 3): unit normals as in the file, before the transform to view space.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

# Smooth normals at a silhouette and normal maps reach beyond what is seen: n . ray up to this is nothing special.
BEYOND = 0.1
# The share of normals beyond it that a right frame may have, and how much smaller another reading's must be.
AWAY, LESS = 0.02, 0.2
# Of normals without places in a picture, only nearly all say anything.
AWAY_OF_A_LIST = 0.9
# Vertical angles of view to try where none is given; 0 stands for parallel rays.
FIELDS = (0.0, *range(5, 121, 5))
# Pixels looked at.
MOST = 2**15
MIRRORED = np.diag([1.0, 1.0, -1.0])
SWAPPED = np.eye(3)[::-1]
# How a frame in view space is read wrongly: what mends it turns the file's normals to view space.
IN_VIEW_SPACE: Mapping[str, np.ndarray] = MappingProxyType(
    {
        "z points the other way": MIRRORED,
        "z points towards the viewer": np.eye(3),
        "y points down, or rows run from the bottom up": np.diag([1.0, -1.0, 1.0]),
        "y points down and z into the screen": np.diag([1.0, -1.0, -1.0]),
        "red and blue are swapped": SWAPPED,
    }
)


@dataclass(frozen=True)
class Pixels:
    """A sample of a frame's pixels.

    Attributes:
        n: the normals of the pixels.
        across, up: the positions of the pixels relative to the image's centre, each of shape (count,), in half image
            heights; 0 for normals without positions.
        has_places: whether the pixels have positions.
    """

    n: np.ndarray
    across: np.ndarray
    up: np.ndarray
    has_places: bool

    def away(self, to_view: np.ndarray, fov: float) -> float:
        """Return the share of normals that a camera with this angle of view cannot see, after `to_view` (3, 3)."""
        half = math.tan(math.radians(fov) / 2)
        x, y, z = to_view @ self.n.T
        along = (x * self.across + y * self.up) * half - z
        return float(np.mean(along > BEYOND * np.sqrt(1 + half * half * (self.across**2 + self.up**2))))

    def least_away(self, to_view: np.ndarray, fov: float | None) -> tuple[float, float]:
        """Return the smallest share by `away` and its angle of view: `fov`, or any of FIELDS if it is None."""
        fields = FIELDS if fov is None and self.has_places else (fov or 0.0,)
        return min((self.away(to_view, field), field) for field in fields)


def some_pixels(n: np.ndarray, covered: np.ndarray) -> Pixels:
    """Return at most MOST of a frame's pixels, spread over the frame.

    Args:
        n: normals of shape (height, width, 3) or (count, 3).
        covered: which normals count, of shape (height, width) or (count,).
    """
    index = np.flatnonzero(covered)
    index = index[:: max(1, -(-len(index) // MOST))]
    normals = n.reshape(-1, 3)[index].astype(np.float64)
    if covered.ndim != 2:
        return Pixels(normals, np.zeros(len(index)), np.zeros(len(index)), False)
    height, width = covered.shape
    row, column = np.divmod(index, width)
    return Pixels(normals, (2 * column + 1 - width) / height, 1 - (2 * row + 1) / height, True)


class Finding(NamedTuple):
    """A likely mistake in the space in which normals are read.

    Attributes:
        said: the message, one line without the remedy.
        remedy: the matrix (3, 3) or angle of view to use instead; None if no known remedy helps.
    """

    said: str
    remedy: np.ndarray | float | None


def which_way(pixels: Pixels, to_view: np.ndarray, fov: float | None, is_world: bool) -> Finding | None:
    """Return a message on the share of normals that face away, with a remedy if a known misreading explains it; None
    if few normals face away.

    Args:
        to_view: the matrix that transforms the file's normals to view space as the frame is read.
        fov: the vertical angle of view in degrees; None if it was not given.
        is_world: whether `to_view` is a view matrix.
    """
    share, _ = pixels.least_away(to_view, fov)
    if share <= (AWAY if pixels.has_places else AWAY_OF_A_LIST):
        return None
    message = f"{share:.0%} of the normals face away from the viewer"
    readings = _of_a_matrix(to_view) if is_world else IN_VIEW_SPACE
    for what, matrix in readings.items():
        other, _ = pixels.least_away(matrix, fov)
        if other < LESS * share and other < AWAY:
            return Finding(f"{message}, {other:.0%} if {what}", matrix)
    if fov is not None and pixels.has_places:
        other, field = pixels.least_away(to_view, None)
        if other < LESS * share and other < AWAY:
            return Finding(f"{message} at --fov {fov:g}, {other:.0%} at about {field:g}", field)
    return Finding(message, None)


def _of_a_matrix(to_view: np.ndarray) -> dict[str, np.ndarray]:
    """Return the possible mistakes in a world-to-view matrix: for each description, the matrix to use instead."""
    return {
        "the matrix is transposed (it may be for row vectors, or transform view space to world space)": to_view.T,
        "the matrix transforms to a left-handed view space, z into the screen": MIRRORED @ to_view,
        "the matrix is transposed and left-handed": MIRRORED @ to_view.T,
        "they are in view space already": np.eye(3),
        "they are in left-handed view space already": MIRRORED,
    }
