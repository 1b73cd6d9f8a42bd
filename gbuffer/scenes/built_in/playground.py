"""The scene on which the quality table of Pranckevicius' article was measured.

World space is left-handed, y up, z into the screen, the eye at (0, 0, -5); view space is OpenGL's, so z is negated.
Back faces are culled, as in Direct3D 9 by default. Most normals that per-pixel view space cannot represent face away
from the eye; they are interpolated normals at the silhouettes of four lamp arms. The original's arms may not be
redistributed: lamp_arm.py makes an arm with the same statistics. Teapots are tessellated finely enough that the table
no longer changes: from 10 x 10 to 24 x 24 cells per patch, every row stays within 0.15 dB.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from ..mesh import Mesh, box, facing, joined, rotation, sphere
from ..models.lamp_arm import lamp_arm
from ..models.teapot import HEIGHT, teapot
from ..rasterise import Camera, Rendered, rasterise
from ..scene import Light, Material, Scene, ScenePart, View, placed
from ..setting import Setting, coloured

TITLE = "the article's playground, with four lamp arms like those of the original"
CAMERA = Camera(width=640, height=480, fov=60.0, near=0.1, far=100.0)
EYE = (0.0, 0.0, -5.0)
TEAPOT_CELLS = 16
FRAMES = 1
TO_VIEW = np.diag([1.0, 1.0, -1.0])

TEAPOTS = ((3, 2, -1), (-3, -2, -1), (3, -2, -1), (-3, 2, -1))
SPHERES = (((0, -2, -3), 1.0), ((2, -2, 1), 1.0), ((-2, 3, 3), 1.0), ((0, 0, 20), 15.0))
BOXES = (((0, -4, 3), 0.3), ((0, 4, 3), -0.3))
# Where, and turned by which yaw, pitch and roll.
ARMS = (
    ((0, -1, -2), (3.2, 0.3, 0.4)),
    ((0, 0, -2), (0.7, 0.9, 1.1)),
    ((0, -1, -4), (1.2, 1.5, 1.8)),
    ((0, -1, -1), (1.5, 3.9, 4.3)),
)


def meshes() -> list[Mesh]:
    """The scene's objects in world space."""
    # Half the classic size, centred in height; the teapot's z becomes y, its y becomes z.
    up = np.array([(1.0, 0, 0), (0, 0, 1.0), (0, 1.0, 0)])
    pot = teapot(TEAPOT_CELLS).placed(0.5 * up, (0, -0.25 * HEIGHT, 0))
    ball = sphere(1.0, slices=32, stacks=32)
    slab = box(10.0, 0.1, 10.0)
    return [
        *(pot.placed(np.eye(3), position) for position in TEAPOTS),
        *(ball.placed(np.eye(3) * size, position) for position, size in SPHERES),
        *(slab.placed(3.0 * rotation(0.0, pitch, 0.0), position) for position, pitch in BOXES),
        *(lamp_arm().placed(rotation(*turn), position) for position, turn in ARMS),
    ]


def in_view_space() -> list[Mesh]:
    """Return the scene's objects in the camera's view space."""
    return [mesh.placed(TO_VIEW, -(np.array(EYE) @ TO_VIEW)) for mesh in meshes()]


@cache
def playground() -> Rendered:
    """Return the scene as the camera sees it, without back faces: normals, positions and coverage of the pixels."""
    return rasterise(facing(joined(in_view_space())), CAMERA)


def lit_playground(setting: Setting) -> Scene:
    """Return the scene with materials, a sun and `setting.lights` lights around its middle; the eye is the origin."""
    rng = np.random.default_rng(setting.seed)
    pot, ball, slab, arm = range(4)
    kinds = [pot] * len(TEAPOTS) + [ball] * len(SPHERES) + [slab] * len(BOXES) + [arm] * len(ARMS)
    here = placed((0, 0, 0))
    parts = tuple(ScenePart(mesh, here, np.array([kind])) for mesh, kind in zip(in_view_space(), kinds, strict=True))
    materials = (
        Material(albedo=(0.5, 0.42, 0.3), specular=(0.3, 0.28, 0.25), power=96.0),
        Material(albedo=(0.3, 0.35, 0.45), specular=(0.2, 0.2, 0.2), power=32.0),
        Material(albedo=(0.4, 0.4, 0.38), specular=(0.08, 0.08, 0.08), power=16.0),
        Material(albedo=(0.42, 0.42, 0.44), specular=(0.35, 0.35, 0.35), power=64.0),
    )
    view = View((0, 0, 0), (0, 0, -1.0), CAMERA.fov, CAMERA.near, CAMERA.far)
    return Scene(
        parts=parts,
        materials=materials,
        lights=(Light("sun", (0.5, 0.48, 0.45), direction=(-0.968, -0.08, -0.23778)), *_lights(setting, rng)),
        ambient=(0.05, 0.05, 0.06),
        view=view,
        previous=View((0.05, 0, 0), (0.05, 0, -1.0), CAMERA.fov, CAMERA.near, CAMERA.far),
    )


def _lights(setting: Setting, rng: np.random.Generator) -> list[Light]:
    turn = 2 * np.pi * (setting.time + rng.uniform(0, 1, setting.lights))
    out, depth = rng.uniform(0.5, 6.0, setting.lights), rng.uniform(-10.0, -2.5, setting.lights)
    return [
        Light("point", tuple(colour), (float(r * np.cos(a)), float(r * np.sin(a)), float(z)), 4.0)
        for colour, a, r, z in zip(coloured(rng, setting.lights, 1.2), turn, out, depth, strict=True)
    ]
