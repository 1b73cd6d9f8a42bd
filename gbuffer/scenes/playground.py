"""The scene that the seeds' quality table was measured on.

World space is left-handed, y up, z into the screen, the eye at (0, 0, -5); view space is GL's, so z is turned around.
Both sides of every surface are drawn: one looks into the lower teapots through the gap around their lids, and those
normals, which face away from the eye, are most of what per-pixel view space loses. Teapots are cut so finely that the
table no longer moves: from 10 x 10 cells a patch to 24 x 24 every row stays within 0.15 dB, while a coarse 6 x 6 takes
0.5 dB from per-pixel view space.

The original also holds four copies of a mechanical lamp arm whose mesh may not be redistributed. Nothing stands in for
them: what they covered shows what lies behind.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from .mesh import Mesh, box, joined, rotation, sphere
from .rasterise import Camera, Rendered, rasterise
from .teapot import HEIGHT, teapot

TITLE = "the seeds' playground, without its four lamp arms"
CAMERA = Camera(width=640, height=480, fov=60.0, near=0.1, far=100.0)
EYE = (0.0, 0.0, -5.0)
TEAPOT_CELLS = 16

TEAPOTS = ((3, 2, -1), (-3, -2, -1), (3, -2, -1), (-3, 2, -1))
SPHERES = (((0, -2, -3), 1.0), ((2, -2, 1), 1.0), ((-2, 3, 3), 1.0), ((0, 0, 20), 15.0))
BOXES = (((0, -4, 3), 0.3), ((0, 4, 3), -0.3))


def meshes() -> list[Mesh]:
    """The scene's objects in world space."""
    # Half the classic size, centred in height; the teapot's z becomes y, its y becomes z.
    up = np.array([(1.0, 0, 0), (0, 0, 1.0), (0, 1.0, 0)])
    pot = teapot(TEAPOT_CELLS).placed(0.5 * up, (0, -0.25 * HEIGHT, 0))
    ball = sphere(1.0, slices=32, stacks=32)
    slab = box(10.0, 0.1, 10.0)
    return [
        *(pot.placed(np.eye(3), at) for at in TEAPOTS),
        *(ball.placed(np.eye(3) * size, at) for at, size in SPHERES),
        *(slab.placed(3.0 * rotation(0.0, pitch, 0.0), at) for at, pitch in BOXES),
    ]


@cache
def playground() -> Rendered:
    """The scene as its camera sees it."""
    to_view = np.diag([1.0, 1.0, -1.0])
    return rasterise(joined(meshes()).placed(to_view, -(np.array(EYE) @ to_view)), CAMERA)
