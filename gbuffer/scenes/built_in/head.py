"""Two busts of the same shape, of skin and of stone, with the sun behind an ear: a test of transmitted light."""

from __future__ import annotations

import numpy as np

from ..mesh import Mesh, box, joined, plane, rotation, smooth_normals, sphere, wound
from ..scene import Light, Material, Scene, ScenePart, View, placed
from ..setting import Setting, coloured

TITLE = "life-size busts of skin and of stone, with the sun behind an ear; point lights"
FRAMES = 1

SKIN, STONE, FLOOR = range(3)
MATERIALS = (
    Material(
        "skin", albedo=(0.78, 0.56, 0.46), specular=(0.028, 0.028, 0.028), power=40.0, bump=0.12, bump_repeat=24.0
    ),
    Material(albedo=(0.48, 0.46, 0.43), specular=(0.04, 0.04, 0.04), power=16.0, bump=0.12, bump_repeat=24.0),
    Material(albedo=(0.3, 0.29, 0.28), specular=(0.05, 0.05, 0.05), power=24.0, bump=0.15, bump_repeat=8.0),
)
# A sphere whose poles are above and below, for row vectors.
UPRIGHT = np.array([(1.0, 0, 0), (0, 0, -1.0), (0, 1.0, 0)])
SKULL, NECK = (0.074, 0.112, 0.09), (0.05, 0.12, 0.055)
# What is added to the skull, on both sides where x is not 0: a direction, its width on a sphere of radius 1, and its
# height in metres.
FEATURES = (
    ((0.0, -0.16, 1.0), 0.10, 0.022),  # the nose's tip
    ((0.0, 0.0, 1.0), 0.07, 0.010),  # and its bridge
    ((0.0, 0.14, 1.0), 0.07, 0.008),
    ((0.11, -0.2, 1.0), 0.06, 0.009),  # nostrils
    ((0.28, 0.36, 1.0), 0.15, 0.009),  # brows
    ((0.36, 0.12, 1.0), 0.14, -0.016),  # sockets
    ((0.36, 0.11, 1.0), 0.08, 0.012),  # lids
    ((0.62, -0.12, 0.9), 0.2, 0.008),  # cheekbones
    ((0.55, -0.5, 0.8), 0.2, -0.007),  # cheeks
    ((0.1, -0.5, 1.0), 0.08, 0.007),  # lips
    ((0.12, -0.56, 1.0), 0.03, -0.006),
    ((0.0, -0.565, 1.0), 0.035, -0.005),
    ((0.06, -0.64, 1.0), 0.07, 0.009),
    ((0.0, -1.05, 0.85), 0.2, 0.020),  # the chin
    ((0.0, 0.25, -1.0), 0.6, 0.012),  # the back of the skull
)
# Half the ear's thickness, height and depth; how far its rim is bent outwards, and how far it stands off, in radians.
EAR, BENT, STANDS_OFF = (0.0035, 0.034, 0.021), 0.006, 1.0
EAR_PLACE = (0.082, 0.0, -0.012)


def head(setting: Setting) -> Scene:
    """Return the busts; `setting.lights` point lights circle in front of them, and a sun is behind them."""
    rng = np.random.default_rng(setting.seed)
    places = [(-0.11, 0.0, 0.0), (0.12, 0.0, -0.04)]
    bars = placed([(-0.42, 0.2, -0.2), (-0.42, 0.155, -0.2), (-0.42, 0.11, -0.2)])
    plinths = placed(np.add(places, (0.0, -0.24, -0.02)))
    ground = plane(3.0, 3.0).placed(np.eye(3), (0.0, -0.29, 0.0))
    wall = plane(3.0, 3.0).placed(UPRIGHT.T, (0.0, 0.0, -0.9))
    return Scene(
        parts=(
            ScenePart(bust(), placed(places, turns=(-0.1, -0.35)), np.array([SKIN, STONE])),
            ScenePart(box(0.17, 0.1, 0.17), plinths, np.full(2, STONE)),
            ScenePart(box(0.012, 0.012, 0.4), bars, np.full(3, STONE)),
            ScenePart(joined([ground, wall]), placed((0, 0, 0)), np.array([FLOOR]), casts=False),
        ),
        materials=MATERIALS,
        lights=(_sun(), *_lamps(setting, rng)),
        ambient=(0.03, 0.032, 0.04),
        view=View((-0.2, 0.04, 0.85), (0.0, -0.045, 0.0), 24.0, 0.1, 8.0),
        previous=View((-0.195, 0.04, 0.85), (0.0, -0.045, 0.0), 24.0, 0.1, 8.0),
    )


def bust() -> Mesh:
    """Return a head that looks along +z, with ears and a neck, centred at the origin."""
    ears = [_ear_mesh(side) for side in (-1.0, 1.0)]
    neck = sphere(1.0, 48, 32).placed(UPRIGHT @ np.diag(NECK), (0.0, -0.12, -0.025))
    return joined([_skull_mesh(), neck, *ears])


def _skull_mesh() -> Mesh:
    ball = sphere(1.0, 160, 128).placed(UPRIGHT, (0, 0, 0))
    way = ball.positions
    # |x / a| = 1 of an ellipsoid along each way from the middle.
    radius = 1 / np.linalg.norm(way / SKULL, axis=1)
    for (x, y, z), width, height in FEATURES:
        for side in {x, -x}:
            middle = np.array([side, y, z]) / np.linalg.norm([x, y, z])
            radius = radius + height * np.exp(-np.sum((way - middle) ** 2, axis=1) / (2 * width**2))
    return _smooth(ball, way * radius[:, None])


def _ear_mesh(side: float) -> Mesh:
    ball = sphere(1.0, 48, 32).placed(UPRIGHT, (0, 0, 0))
    x, y, z = ball.positions.T
    bent = np.stack([EAR[0] * x + BENT * (y**2 + z**2), EAR[1] * y, EAR[2] * z], axis=1)
    # In front it lies at the head, behind it stands off.
    right = bent @ rotation(-STANDS_OFF, 0.0, 0.0) + EAR_PLACE
    return _smooth(ball, right * (side, 1.0, 1.0), flips=side < 0)


def _smooth(ball: Mesh, positions: np.ndarray, flips: bool = False) -> Mesh:
    """Return a sphere's mesh with these positions and smooth normals; `flips` reverses the winding, for mirrored
    positions."""
    triangles = wound(ball)[:, ::-1] if flips else wound(ball)
    return Mesh(positions, smooth_normals(positions, triangles), triangles, ball.uv)


def _sun() -> Light:
    direction = np.array([0.76, -0.42, 0.5])
    return Light("sun", (1.9, 1.75, 1.5), direction=tuple((direction / np.linalg.norm(direction)).tolist()))


def _lamps(setting: Setting, rng: np.random.Generator) -> list[Light]:
    turn = 2 * np.pi * (setting.time + np.arange(setting.lights) / max(setting.lights, 1))
    out, height = rng.uniform(0.3, 0.7, setting.lights), rng.uniform(0.3, 0.8, setting.lights)
    colours = coloured(rng, setting.lights, 1.4 / max(setting.lights, 1))
    return [
        Light("point", tuple(colour), (float(r * np.cos(a)), float(r * np.sin(a)), float(h)), 2.0)
        for colour, a, r, h in zip(colours, turn, out, height, strict=True)
    ]
