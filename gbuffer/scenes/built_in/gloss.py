"""Smooth spheres with dull to sharp highlights under moving lights, which make quantised normals visible."""

from __future__ import annotations

import numpy as np

from ..mesh import plane, sphere
from ..scene import Light, Material, Scene, ScenePart, View, placed
from ..setting import Setting, coloured

TITLE = "spheres of specular power 4 to 1024 under moving lights"
FRAMES = 3
POWERS = tuple(2.0**n for n in range(2, 11))


def gloss(setting: Setting) -> Scene:
    """Return nine spheres in three rows before a wall, and `setting.lights` point lights that circle in front."""
    rng = np.random.default_rng(setting.seed)
    row, column = np.divmod(np.arange(len(POWERS)), 3)
    places = np.stack([2.3 * (column - 1), 2.3 * (1 - row), np.zeros(len(POWERS))], axis=1)
    wall = plane(40.0, 40.0).placed(np.array([(1.0, 0, 0), (0, 0, 1.0), (0, 1.0, 0)]), (0, 0, -1.5))
    spheres = ScenePart(sphere(1.0, 96, 48), placed(places), np.arange(len(POWERS)))
    materials = [Material(albedo=(0.12, 0.12, 0.14), specular=(0.3, 0.3, 0.3), power=power) for power in POWERS]
    return Scene(
        parts=(spheres, ScenePart(wall, placed((0, 0, 0)), np.array([len(POWERS)]), casts=False)),
        materials=(*materials, Material(albedo=(0.2, 0.2, 0.22), specular=(0.05, 0.05, 0.05), power=16.0)),
        lights=(
            Light("sun", (0.12, 0.12, 0.12), direction=(-0.48, -0.6, -0.64)),
            *_lights(setting, rng),
        ),
        ambient=(0.02, 0.02, 0.025),
        view=View((0.0, 0.0, 9.5), (0.0, 0.0, 0.0), 46.0, 2.0, 50.0),
        previous=View((0.05, 0.0, 9.5), (0.0, 0.0, 0.0), 46.0, 2.0, 50.0),
    )


def _lights(setting: Setting, rng: np.random.Generator) -> list[Light]:
    turn = 2 * np.pi * (setting.time + np.arange(setting.lights) / setting.lights)
    out, height = rng.uniform(1.5, 5.5, setting.lights), rng.uniform(1.5, 4.0, setting.lights)
    colours = coloured(rng, setting.lights, 8.5 / np.sqrt(max(setting.lights, 1)))
    return [
        Light("point", tuple(colour), (float(r * np.cos(a)), float(r * np.sin(a)), float(h)), 4.2)
        for colour, a, r, h in zip(colours, turn, out, height, strict=True)
    ]
