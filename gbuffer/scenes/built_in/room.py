"""A room with axis-aligned walls, floor and boxes, in which an encoding that cannot store 0 tilts every surface."""

from __future__ import annotations

import numpy as np

from ..mesh import Mesh, box, plane, sphere
from ..models.teapot import teapot
from ..scene import Light, Material, Scene, ScenePart, View, placed
from ..setting import Setting, coloured

TITLE = "axis-aligned walls, floor and boxes, a teapot, glass; spot lights, point lights and a sun"
FRAMES = 1
SIZE = (10.0, 6.0, 12.0)

FLOOR, WALL, STUDS, CRATE, POT, SKIN, HAIR, PAINT, LAMP, GLASS = range(10)
# Axis, side and material; the wall behind the camera is open.
FACES = ((0, -1.0, STUDS), (0, 1.0, WALL), (1, -1.0, FLOOR), (1, 1.0, WALL), (2, -1.0, WALL))
MATERIALS = (
    Material(albedo=(0.4, 0.36, 0.32), specular=(0.2, 0.2, 0.2), power=64.0),
    Material(albedo=(0.5, 0.5, 0.48), specular=(0.04, 0.04, 0.04), power=16.0),
    Material(albedo=(0.5, 0.48, 0.45), specular=(0.04, 0.04, 0.04), power=16.0, bump=0.5, bump_repeat=4.0),
    Material(albedo=(0.45, 0.3, 0.15), specular=(0.08, 0.08, 0.08), power=24.0, bump=0.7),
    Material(albedo=(0.35, 0.4, 0.5), specular=(0.4, 0.4, 0.4), power=256.0),
    Material("skin", albedo=(0.75, 0.5, 0.4), specular=(0.04, 0.04, 0.04), power=24.0),
    Material("hair", albedo=(0.35, 0.2, 0.1), specular=(0.2, 0.15, 0.1), power=64.0),
    Material("glossy", albedo=(0.1, 0.2, 0.5), specular=(1.0, 1.0, 1.0), power=512.0),
    Material(albedo=(0.8, 0.8, 0.8), emissive=(0.9, 0.8, 0.55)),
    Material(albedo=(0.2, 0.5, 0.4), specular=(0.5, 0.5, 0.5), power=128.0, alpha=0.45),
)


def _wall(axis: int, side: float) -> Mesh:
    """Return the wall of the room at one end, -1 or 1, of an axis, 0 to 2; its normal points inwards."""
    turned = {
        0: np.array([(0, 1.0, 0), (-side, 0, 0), (0, 0, 1.0)]),
        1: np.diag([1.0, -side, 1.0]),
        2: np.array([(1.0, 0, 0), (0, 0, -side), (0, 1.0, 0)]),
    }[axis]
    extent = {0: (SIZE[1], SIZE[2]), 1: (SIZE[0], SIZE[2]), 2: (SIZE[0], SIZE[1])}[axis]
    centre = np.eye(3)[axis] * side * SIZE[axis] / 2 + (0, SIZE[1] / 2, 0)
    return plane(*extent).placed(turned, centre)


def room(setting: Setting) -> Scene:
    """Return the room, lit by `setting.lights` point lights, three spot lights and a sun."""
    rng = np.random.default_rng(setting.seed)
    up = np.array([(1.0, 0, 0), (0, 0, -1.0), (0, 1.0, 0)])
    pot = teapot(8).placed(0.45 * up, (0, 0, 0))
    ball = sphere(1.0, 40, 24).placed(up, (0, 0, 0))
    crates = placed([(-3.2, 0.8, -2.5), (-2.4, 0.5, 0.2), (3.4, 0.7, -3.4)], [1.6, 1.0, 1.4], 0.0)
    balls = placed([(2.9, 0.8, 0.4), (1.2, 0.6, 1.8), (3.4, 2.1, -3.4), (-3.2, 3.9, -2.5)], [0.8, 0.6, 0.7, 0.35])
    panes = placed([(-1.4, 1.1, 2.2), (0.2, 1.2, 2.8), (2.2, 1.3, 3.3)], [1.0, 1.0, 1.0])
    view = View((0.4, 3.2, 8.0), (0.0, 1.9, -1.0), 55.0, 0.5, 40.0)
    return Scene(
        parts=(
            *(
                ScenePart(_wall(axis, side), placed((0, 0, 0)), np.array([material]), casts=False)
                for axis, side, material in FACES
            ),
            ScenePart(box(1.0, 1.0, 1.0), crates, np.full(3, CRATE)),
            ScenePart(pot, placed((0.0, 0.0, -1.8), 1.3, 0.5), np.array([POT])),
            ScenePart(ball, balls, np.array([SKIN, HAIR, PAINT, LAMP])),
            ScenePart(box(1.3, 1.8, 0.06), panes, np.full(3, GLASS), casts=False),
        ),
        materials=MATERIALS,
        lights=(*_fixed_lights(), *_point_lights(setting, rng)),
        ambient=(0.04, 0.04, 0.05),
        view=view,
        previous=View((0.45, 3.2, 8.0), (0.0, 1.9, -1.0), 55.0, 0.5, 40.0),
    )


def _fixed_lights() -> list[Light]:
    down = np.array([(0.2, -1.0, -0.1), (-0.3, -1.0, -0.5), (0.5, -0.8, -0.3)])
    down = down / np.linalg.norm(down, axis=1, keepdims=True)
    places = ((0.0, 5.5, -1.0), (3.0, 5.5, 1.0), (-3.5, 5.0, 1.5))
    spots = [
        Light("spot", (16.0, 15.0, 13.0), place, 9.0, tuple(way), 18.0, 28.0)
        for place, way in zip(places, down, strict=True)
    ]
    sun = np.array([-0.55, -0.75, -0.45])
    return [Light("sun", (0.9, 0.85, 0.72), direction=tuple(sun / np.linalg.norm(sun))), *spots]


def _point_lights(setting: Setting, rng: np.random.Generator) -> list[Light]:
    size = np.array(SIZE)
    places = rng.uniform(-0.48, 0.48, (setting.lights, 3)) * size + (0, size[1] / 2, 0)
    turn = 2 * np.pi * setting.time
    places = places @ np.array([(np.cos(turn), 0, np.sin(turn)), (0, 1, 0), (-np.sin(turn), 0, np.cos(turn))])
    colours, radii = coloured(rng, setting.lights, 0.9), rng.uniform(2.0, 3.5, setting.lights)
    return [
        Light("point", tuple(colour), tuple(place), float(radius))
        for colour, place, radius in zip(colours, places, radii, strict=True)
    ]
