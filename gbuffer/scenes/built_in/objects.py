"""Jo Kyeong-jun's test scene: many objects with one general and one special part each, point lights and a sun."""

from __future__ import annotations

import numpy as np

from ..mesh import plane, sphere
from ..scene import Light, Material, Scene, ScenePart, View, placed
from ..setting import Setting, coloured

TITLE = "objects with one general and one special part each (Jo Kyeong-jun), 64 point lights and a sun"
FRAMES = 1
FIELD = (30.0, 30.0)

GENERAL = (
    Material(albedo=(0.55, 0.3, 0.2), specular=(0.25, 0.2, 0.15), power=48.0, bump=0.5, bump_repeat=4.0),
    Material(albedo=(0.25, 0.4, 0.3), specular=(0.1, 0.1, 0.1), power=16.0, bump=0.8, bump_repeat=4.0),
    Material(albedo=(0.3, 0.32, 0.45), specular=(0.5, 0.5, 0.55), power=128.0),
)
SPECIAL = (
    Material("skin", albedo=(0.75, 0.5, 0.4), specular=(0.04, 0.04, 0.04), power=24.0),
    Material("hair", albedo=(0.3, 0.18, 0.08), specular=(0.15, 0.12, 0.08), power=64.0),
    Material("glossy", albedo=(0.5, 0.05, 0.05), specular=(1.0, 1.0, 1.0), power=256.0),
)
GROUND = Material(albedo=(0.35, 0.33, 0.3), specular=(0.06, 0.06, 0.06), power=24.0, bump=0.6, bump_repeat=1.0)


def _places(count: int, rng: np.random.Generator) -> np.ndarray:
    """Return positions on a jittered grid, (count, 3), so that no two objects are in the same place."""
    columns = int(np.ceil(np.sqrt(count)))
    cell = np.arange(count)
    grid = np.stack([cell % columns, cell // columns], axis=1) + 0.5 + rng.uniform(-0.25, 0.25, (count, 2))
    x, z = ((grid / columns - 0.5) * FIELD).T
    return np.stack([x, np.zeros(count), z], axis=1)


def objects(setting: Setting) -> Scene:
    """Return `setting.objects` objects on a field, and `setting.lights` point lights that circle above it."""
    rng = np.random.default_rng(setting.seed)
    places = _places(setting.objects, rng)
    # A field of few objects has large ones; many are as small as their cells.
    size = min(0.9, 0.35 * FIELD[0] / np.ceil(np.sqrt(setting.objects)))
    sizes, turns = size * rng.uniform(0.7, 1.0, setting.objects), rng.uniform(0, 2 * np.pi, setting.objects)
    up = np.stack([0 * sizes, sizes, 0 * sizes], axis=1)
    upright = sphere(1.0, 20, 12).placed(np.array([(1.0, 0, 0), (0, 0, -1.0), (0, 1.0, 0)]), (0, 0, 0))
    body = upright.placed(np.diag([0.7, 0.9, 0.7]), (0, 0, 0))
    bodies = ScenePart(body, placed(places + 0.85 * up, sizes, turns), rng.integers(0, 3, setting.objects))
    special = ScenePart(
        upright, placed(places + 2.2 * up, 0.65 * sizes, turns), 3 + rng.integers(0, 3, setting.objects)
    )
    ground = ScenePart(plane(160.0, 160.0, 105.0), placed((0, 0, 0)), np.array([6]), casts=False)
    return Scene(
        parts=(ground, bodies, special),
        materials=(*GENERAL, *SPECIAL, GROUND),
        lights=(_sun(), *_lights(setting, rng)),
        ambient=(0.03, 0.035, 0.05),
        view=View((0.0, 9.5, 15.5), (0.0, 0.0, 0.0), 50.0, 2.0, 120.0),
        previous=View((0.1, 9.5, 15.5), (0.0, 0.0, 0.0), 50.0, 2.0, 120.0),
    )


def _sun() -> Light:
    direction = np.array([0.6, -1.0, -0.35])
    return Light("sun", colour=(0.55, 0.5, 0.42), direction=tuple(direction / np.linalg.norm(direction)))


def _lights(setting: Setting, rng: np.random.Generator) -> list[Light]:
    x, z = rng.uniform(-0.5, 0.5, (2, setting.lights)) * np.array(FIELD)[:, None]
    angle = 2 * np.pi * (setting.time + rng.uniform(0, 1, setting.lights))
    height, radius = rng.uniform(1.0, 2.2, setting.lights), rng.uniform(2.5, 4.5, setting.lights)
    positions = np.stack([x + 0.5 * np.cos(angle), height, z + 0.5 * np.sin(angle)], axis=1)
    colours = coloured(rng, setting.lights, 2.2)
    return [
        Light("point", tuple(colour), tuple(position), float(r))
        for colour, position, r in zip(colours, positions, radius, strict=True)
    ]
