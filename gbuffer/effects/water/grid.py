"""The radial grid below the camera (GPU Gems 2, chapter 18): rings with growing gaps and equal vertex counts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...scenes.scene import View

# Metres between the first rings.
FIRST_GAP = 0.1
# The centre stays where it is until the eye has gone this far, in metres, and then moves by as much.
STEP = 0.5


@dataclass(frozen=True)
class Grid:
    """A disc of `rings` rings around its centre, each with `spokes` vertices.

    Ring i has the radius r = FIRST_GAP i + curve i^4. GPU Gems 2 uses r = a0 + a1 i^4. If 256 rings reach 40 km, its
    first rings are then 9 um apart, which float32 cannot resolve 100 m from the origin. The linear term keeps the
    rings apart, and the fan in the middle closes the disc.
    """

    rings: int
    spokes: int

    @cached_property
    def vertices(self) -> np.ndarray:
        """Cosine and sine of each vertex's spoke and the number of its ring, (1 + rings x spokes, 3), float32; the
        first vertex is the centre."""
        angle = 2 * np.pi * np.arange(self.spokes) / self.spokes
        ring, spoke = np.divmod(np.arange(self.rings * self.spokes), self.spokes)
        rows = np.stack([np.cos(angle)[spoke], np.sin(angle)[spoke], ring + 1.0], axis=1)
        return np.concatenate([np.zeros((1, 3)), rows]).astype(np.float32)

    @cached_property
    def triangles(self) -> np.ndarray:
        """Vertex indices, (triangles, 3), int32: a fan around the centre, then two per cell between rings."""
        here = np.arange(self.spokes)
        after = (here + 1) % self.spokes
        fan = np.stack([np.zeros_like(here), 1 + after, 1 + here], axis=1)
        inner = 1 + self.spokes * np.arange(self.rings - 1)[:, None]
        a, b = inner + here, inner + after
        c, d = a + self.spokes, b + self.spokes
        cells = np.stack([a, b, c, b, d, c], axis=-1).reshape(-1, 3)
        return np.concatenate([fan, cells]).astype(np.int32)

    def curve(self, outer: float) -> float:
        """Return the factor of i^4 in the radius of ring i that gives the last ring a radius of `outer` metres; 0 if
        the linear term alone reaches that radius."""
        return max(outer - FIRST_GAP * self.rings, 0.0) / self.rings**4

    def radii(self, outer: float) -> np.ndarray:
        """Return the radii of the rings, (rings,), in metres; the last is at least `outer`."""
        i = np.arange(1, self.rings + 1)
        return FIRST_GAP * i + self.curve(outer) * i.astype(float) ** 4


def centre_under(view: View) -> tuple[float, float]:
    """Return the world x and z of the grid's centre: below the camera, rounded to a multiple of STEP."""
    return round(view.eye[0] / STEP) * STEP, round(view.eye[2] / STEP) * STEP


def reach(view: View, aspect: float) -> float:
    """Return the radius in metres at which the grid covers every visible point, up to the far plane's corners."""
    up = np.tan(np.radians(view.fov) / 2)
    return float(view.far * np.sqrt(1 + up**2 + (up * aspect) ** 2)) + STEP
