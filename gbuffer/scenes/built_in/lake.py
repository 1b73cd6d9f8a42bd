"""A lake between hills under a clear sky, with objects above the water, in it and under it."""

from __future__ import annotations

import numpy as np

from ..mesh import Mesh, box, grid_triangles, grid_uv, joined, smooth_normals, sphere
from ..models.teapot import teapot
from ..scene import Light, Material, Scene, ScenePart, View, Water, placed
from ..setting import Setting, coloured

TITLE = "a lake between hills under a clear sky: trees, a jetty, floats, stones, a teapot under water"
FRAMES = 3
# Metres: the ground's side, the lake's radius and its depth, the sky's radius.
GROUND, SHORE, DEEP, SKY = 90.0, 17.0, 2.6, 110.0
CELLS, BANDS = 96, 24
STONES, TREES = 40, 46
UP = np.array([(1.0, 0, 0), (0, 0, -1.0), (0, 1.0, 0)])
SUN = np.array([0.25, -0.42, 0.8])

EARTH, WOOD, LEAVES, STONE, RED, WHITE, SKIN, POT, GLASS = range(9)
MATERIALS = (
    Material(albedo=(0.36, 0.33, 0.22), specular=(0.02, 0.02, 0.02), power=8.0),
    Material(albedo=(0.34, 0.22, 0.13), specular=(0.05, 0.05, 0.05), power=16.0),
    Material(albedo=(0.1, 0.24, 0.08), specular=(0.03, 0.03, 0.03), power=12.0, bump=0.6, bump_repeat=4.0),
    Material(albedo=(0.42, 0.41, 0.4), specular=(0.06, 0.06, 0.06), power=24.0, bump=0.5, bump_repeat=3.0),
    Material("glossy", albedo=(0.7, 0.08, 0.04), specular=(1.0, 1.0, 1.0), power=256.0),
    Material(albedo=(0.75, 0.75, 0.72), specular=(0.2, 0.2, 0.2), power=64.0),
    Material("skin", albedo=(0.75, 0.5, 0.4), specular=(0.04, 0.04, 0.04), power=24.0),
    Material(albedo=(0.6, 0.5, 0.2), specular=(0.4, 0.4, 0.3), power=128.0),
    Material(albedo=(0.3, 0.5, 0.4), specular=(0.5, 0.5, 0.5), power=128.0, alpha=0.45),
)
# Light of the sky at the horizon and overhead.
HAZE, ZENITH = np.array([0.62, 0.68, 0.74]), np.array([0.1, 0.24, 0.52])


def height(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Return the ground's height, in metres above the still water; the ground slopes into the lake on every side."""
    out = np.hypot(x, 1.15 * z) / (SHORE + 2.2 * np.sin(2 * np.arctan2(z, x) + 0.6))
    bowl = -DEEP + (DEEP + 0.6) * out**2 / (0.55 + 0.45 * out**2)
    hills = 3.0 * np.clip(out - 1.2, 0, 2) ** 1.5 * (1.2 + np.sin(0.21 * x + 0.8) * np.cos(0.17 * z))
    return bowl + hills + 0.12 * np.sin(1.3 * x + 0.4) * np.sin(1.1 * z)


def lake(setting: Setting) -> Scene:
    """Return the lake with `setting.lights` lanterns on its shore and a sun; the waves move with time."""
    rng = np.random.default_rng(setting.seed)
    none = placed((0, 0, 0))
    water = Water(patch=16.0, time=setting.time * Water.period)
    view = View((1.5, 2.4, 15.5), (-1.0, 0.6, 0.0), 52.0, 0.3, 260.0)
    first = len(MATERIALS)
    sky = [ScenePart(_sky_band(i), none, np.array([first + i]), casts=False, two_sided=True) for i in range(BANDS)]
    return Scene(
        parts=(ScenePart(_ground_mesh(), none, np.array([EARTH]), casts=False), *sky, *_thing_parts(rng)),
        materials=(*MATERIALS, *(_sky_material(i) for i in range(BANDS))),
        lights=(Light("sun", (1.5, 1.38, 1.15), direction=tuple(SUN / np.linalg.norm(SUN))), *_lanterns(setting, rng)),
        ambient=(0.2, 0.24, 0.3),
        view=view,
        previous=View((1.55, 2.4, 15.5), (-1.0, 0.6, 0.0), 52.0, 0.3, 260.0),
        water=water,
    )


def _ground_mesh() -> Mesh:
    uv = grid_uv(CELLS, CELLS)
    # Rows go from front to back: so their corners lie counter-clockwise from above.
    x, z = GROUND * (uv[:, 0] - 0.5), GROUND * (0.5 - uv[:, 1])
    positions, triangles = np.stack([x, height(x, z), z], axis=1), grid_triangles(CELLS, CELLS)
    return Mesh(positions, smooth_normals(positions, triangles), triangles, uv)


def _sky_band(index: int, slices: int = 48) -> Mesh:
    """Return a ring of the sky dome, number `index` from the horizon up, with normals that point inwards."""
    # Bands are narrow near the horizon; the first reaches below it.
    low, high = (np.pi / 2 * ((index + step) / BANDS) ** 1.5 for step in (0, 1))
    low = low if index else -0.06
    around = 2 * np.pi * (np.arange(slices + 1) % slices) / slices
    rows = [
        np.stack([np.cos(a) * np.cos(around), np.full_like(around, np.sin(a)), np.cos(a) * np.sin(around)], axis=1)
        for a in (low, high)
    ]
    out = np.concatenate(rows)
    return Mesh(SKY * out, -out, grid_triangles(1, slices), grid_uv(1, slices))


def _sky_material(index: int) -> Material:
    share = ((index + 0.5) / BANDS) ** 0.9
    light = (1 - share) * HAZE + share * ZENITH
    black = (0.0, 0.0, 0.0)
    return Material(albedo=black, specular=black, emissive=tuple(light.tolist()))


def _thing_parts(rng: np.random.Generator) -> tuple[ScenePart, ...]:
    ball, post = sphere(1.0, 24, 16).placed(UP, (0, 0, 0)), box(0.22, 3.2, 0.22)
    x, z = np.meshgrid([-1.0, 1.0], [-1.4, -4.2, -7.0], indexing="ij")
    legs = np.stack([-6.2 + x.ravel(), np.full(6, -0.7), 6.0 + z.ravel()], axis=1)
    stones, sizes = _scattered(rng, STONES, 0.0, 1.15), rng.uniform(0.12, 0.5, STONES)
    trees, tall = _scattered(rng, TREES, 1.25, 2.3), rng.uniform(1.4, 2.6, TREES)
    floats = placed([(2.6, 0.12, 7.2), (-1.6, 0.1, 4.6), (4.6, 0.08, 2.4)], [0.42, 0.36, 0.34])
    return (
        ScenePart(box(2.4, 0.14, 7.6), placed((-6.2, 0.85, 1.8)), np.array([WOOD])),
        ScenePart(post, placed(legs), np.full(6, WOOD)),
        ScenePart(ball, floats, np.array([RED, WHITE, SKIN])),
        ScenePart(ball, placed(stones, sizes), np.full(STONES, STONE)),
        ScenePart(_tree(), placed(trees, tall, rng.uniform(0, 6, TREES)), np.full(TREES, LEAVES)),
        ScenePart(teapot(6).placed(0.3 * UP, (0, 0, 0)), placed(_ground_point(0.6, 7.0), 1.0, 0.7), np.array([POT])),
        ScenePart(box(1.1, 1.5, 0.06), placed((-3.6, 0.9, 9.0)), np.array([GLASS]), casts=False),
    )


def _ground_point(x: float, z: float) -> np.ndarray:
    return np.array([x, float(height(np.array(x), np.array(z))), z])


def _scattered(rng: np.random.Generator, count: int, least: float, most: float) -> np.ndarray:
    """Return random points on the ground, (count, 3), at distances of `least` to `most` from the middle, in units of
    the lake's radius."""
    out, angle = SHORE * rng.uniform(least, most, count), rng.uniform(0, 2 * np.pi, count)
    x, z = out * np.cos(angle), out * np.sin(angle) / 1.15
    return np.stack([x, height(x, z), z], axis=1)


def _tree(slices: int = 12) -> Mesh:
    """Three cones one above the other."""
    return joined([_cone(0.75 - 0.18 * i, 1.1, 0.35 + 0.62 * i, slices) for i in range(3)])


def _cone(radius: float, tall: float, low: float, slices: int) -> Mesh:
    around = 2 * np.pi * (np.arange(slices + 1) % slices) / slices
    ring = np.stack([np.cos(around), np.zeros_like(around), np.sin(around)], axis=1)
    slope = np.array([1.0, radius / tall, 1.0])
    side = ring * slope + np.array([0.0, radius / tall, 0.0])
    side = side / np.linalg.norm(side, axis=1, keepdims=True)
    down = np.tile([0.0, -1.0, 0.0], (slices + 1, 1))
    tip, rim = np.tile([0.0, low + tall, 0.0], (slices + 1, 1)), radius * ring + np.array([0.0, low, 0.0])
    cells = grid_triangles(1, slices)
    bottom = np.tile([0.0, low, 0.0], (slices + 1, 1))
    skirt = Mesh(np.concatenate([rim, tip]), np.concatenate([side, side]), cells, grid_uv(1, slices))
    base = Mesh(np.concatenate([rim, bottom]), np.concatenate([down, down]), cells, grid_uv(1, slices))
    return joined([skirt, base])


def _lanterns(setting: Setting, rng: np.random.Generator) -> list[Light]:
    """Return lanterns on the shore, in a circle that turns with time."""
    turn = 2 * np.pi * (setting.time + rng.uniform(0, 1, setting.lights))
    x, z = 1.02 * SHORE * np.cos(turn), 1.02 * SHORE * np.sin(turn) / 1.15
    places = np.stack([x, height(x, z) + rng.uniform(0.5, 1.2, setting.lights), z], axis=1)
    colours, radii = coloured(rng, setting.lights, 0.8), rng.uniform(2.0, 3.5, setting.lights)
    return [
        Light("point", tuple(colour), tuple(place), float(radius))
        for colour, place, radius in zip(colours, places, radii, strict=True)
    ]
