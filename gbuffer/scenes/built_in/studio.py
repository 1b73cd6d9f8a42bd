"""A photographer's studio with metallic-roughness materials, in whose reflections a normal's steps are visible."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from ...environment.catalogue import ENVIRONMENTS
from ...environment.environment import Environment, directions, solid_angles
from ..mesh import Mesh, grid_triangles, grid_uv, plane, sphere
from ..metal_rough import Map, MetalRough
from ..scene import Light, Scene, ScenePart, View, placed
from ..setting import Setting, coloured

TITLE = "metal and dielectric spheres of roughness 0 to 1, curved panels, a mirror, normal-mapped tiles, soft boxes"
FRAMES = 1
# In stops: its soft boxes are just not clipped.
EXPOSURE = -1.5
ROUGHNESS = tuple(float(r) for r in np.linspace(0.0, 1.0, 9))
# Of the panels, in degrees across: what turns so slowly shows each step of a code as a band.
PANELS = ((20.0, 8.0), (4.0, 2.0))

MIRROR_TURNS = (3.0, 3.0)

METAL = MetalRough(base=(0.95, 0.93, 0.88), metalness=1.0)
PLASTIC = MetalRough(base=(0.55, 0.08, 0.06))
GLOSSY_PAINT = MetalRough(base=(0.03, 0.09, 0.28), roughness=0.12)
BRUSHED = MetalRough(base=(0.78, 0.78, 0.8), metalness=1.0, roughness=0.3)
MIRROR = MetalRough(base=(0.98, 0.98, 0.98), metalness=1.0, roughness=0.0)
FLOOR = MetalRough(base=(0.3, 0.27, 0.24), roughness=0.35)
WALL = MetalRough(base=(0.42, 0.42, 0.43), roughness=0.6)
SUN_WAY = np.array([0.45, -0.75, -0.5])
SUN = Light("sun", (0.5, 0.48, 0.44), direction=tuple(SUN_WAY / np.linalg.norm(SUN_WAY)))
# The middle of the spheres, and what mirrors see of the room: the floor at the least y, the back wall at the least z.
MIDDLE, LEAST, MOST = np.array([0.0, 0.8, 1.1]), np.array([-7.0, 0.0, -2.5]), np.array([7.0, 9.0, 6.0])
NEARLY = 1e-6
LAMP = MetalRough(base=(0.8, 0.8, 0.8), roughness=1.0, emission=(50.0, 50.0, 50.0))


def studio(setting: Setting) -> Scene:
    """Return the studio, lit by `setting.lights` point lights and a sun."""
    materials = _materials()
    across = np.linspace(-2.85, 2.85, len(ROUGHNESS))
    rows = [np.stack([across, 0 * across + y, 0 * across + z], axis=1) for y, z in ((0.33, 1.6), (1.2, 0.6))]
    balls = ScenePart(sphere(1.0, 96, 64), placed(np.concatenate(rows), 0.33), np.arange(2 * len(ROUGHNESS)))
    first = 2 * len(ROUGHNESS)
    view = View((0.0, 2.1, 8.6), (0.0, 1.45, 0.0), 38.0, 1.0, 40.0)
    return Scene(
        parts=(balls, *_panels(first), *_room(first + 2)),
        materials=materials,
        lights=(SUN, *_lights(setting)),
        ambient=(0.0, 0.0, 0.0),
        view=view,
        previous=View((0.05, 2.1, 8.6), (0.0, 1.45, 0.0), 38.0, 1.0, 40.0),
        environment=_surroundings(),
    )


@cache
def _surroundings() -> Environment:
    """Return the environment `studio`, occluded by the scene's floor and back wall, as the spheres see it."""
    radiance = ENVIRONMENTS["studio"].make().radiance.copy()
    ways = directions(len(radiance))
    before = radiance * solid_angles(len(radiance))[..., None]
    for axis, material in ((1, FLOOR), (2, WALL)):
        along = ways[..., axis, None]
        # L = base E / pi, where a sun of colour c gives E = pi c (n . l)
        irradiance = np.sum(before * np.maximum(along, 0.0), axis=(0, 1))
        light = np.array(material.base) * (irradiance / np.pi - np.array(SUN.colour) * SUN.direction[axis])
        place = MIDDLE + ways * (LEAST - MIDDLE)[axis] / np.minimum(along, -NEARLY)
        is_seen = np.all((place >= LEAST - NEARLY) & (place <= MOST), axis=-1) & (along[..., 0] < 0)
        radiance[is_seen] = light
    radiance.setflags(write=False)
    return Environment("studio room", radiance)


def _materials() -> tuple[MetalRough, ...]:
    """Return the materials of the spheres, of the panels, then of the room: mirror, floor, wall, lamp."""
    spheres = [MetalRough(kind.base, kind.metalness, roughness) for kind in (PLASTIC, METAL) for roughness in ROUGHNESS]
    floor = replace(FLOOR, normal_map=Map(tiles(), wrap=("repeat", "repeat")))
    return (*spheres, GLOSSY_PAINT, BRUSHED, MIRROR, floor, WALL, LAMP)


def _panels(first: int) -> tuple[ScenePart, ...]:
    """Return two panels that face the camera, one gently curved and the other almost flat."""
    places = ((-2.1, 2.75, -0.9), (0.6, 2.75, -0.9))
    return tuple(
        ScenePart(panel(2.4, 1.5, *turns), placed(place), np.array([first + number]), two_sided=True)
        for number, (turns, place) in enumerate(zip(PANELS, places, strict=True))
    )


def _room(first: int) -> tuple[ScenePart, ...]:
    mirror, floor, wall, lamp = range(first, first + 4)
    upright = np.array([(1.0, 0, 0), (0, 0, 1.0), (0, 1.0, 0)])
    # Turned by 25 degrees towards the spheres, and hardly bent: a flat one would have one code, and its luck decide.
    glass = panel(1.4, 2.0, *MIRROR_TURNS)
    back = plane(14.0, 9.0, 3.0).placed(upright, (0.0, 4.5, -2.5))
    side = plane(9.0, 9.0, 3.0).placed(np.array([(0, 0, -1.0), (1.0, 0, 0), (0, 1.0, 0)]), (-5.0, 4.5, 2.0))
    here = placed((0.0, 0.0, 0.0))
    return (
        ScenePart(glass, placed((3.1, 2.75, -0.9), 1.0, -0.44), np.array([mirror]), two_sided=True),
        ScenePart(plane(14.0, 12.0, 6.0), here, np.array([floor]), casts=False),
        ScenePart(back, here, np.array([wall]), casts=False, two_sided=True),
        ScenePart(side, here, np.array([wall]), casts=False, two_sided=True),
        ScenePart(sphere(1.0, 24, 16), placed((4.0, 3.9, -1.2), 0.16), np.array([lamp]), casts=False),
    )


def panel(width: float, height: float, across: float, up: float, cells: int = 64) -> Mesh:
    """Return a patch of an ellipsoid that faces +z, around the origin.

    Args:
        width, height: size of the patch.
        across, up: the angles by which the normal turns from one side to the other, in degrees.
        cells: number of grid cells along each side.
    """
    v, u = np.meshgrid(np.linspace(-0.5, 0.5, cells + 1), np.linspace(-0.5, 0.5, cells + 1), indexing="ij")
    a, b = u.ravel() * np.radians(across), v.ravel() * np.radians(up)
    normals = np.stack([np.sin(a) * np.cos(b), np.sin(b), np.cos(a) * np.cos(b)], axis=1)
    # Arcs of these turns and lengths have the radii width / across and height / up.
    depth = -(width / np.radians(across)) * (1 - np.cos(a)) - (height / np.radians(up)) * (1 - np.cos(b))
    positions = np.stack([u.ravel() * width, v.ravel() * height, depth], axis=1)
    return Mesh(positions, normals, grid_triangles(cells, cells), grid_uv(cells, cells))


@cache
def tiles(size: int = 512) -> np.ndarray:
    """Return a normal map of 4 x 4 slightly uneven tiles with rounded joints; uint16 of shape (size, size, 4)."""
    v, u = np.meshgrid((np.arange(size) + 0.5) / size, (np.arange(size) + 0.5) / size, indexing="ij")
    cell_u, cell_v = (4 * u) % 1 - 0.5, (4 * v) % 1 - 0.5
    slopes = np.zeros((size, size, 2))
    for axis, along in enumerate((cell_u, cell_v)):
        edge = np.clip((np.abs(along) - 0.42) / 0.08, 0.0, 1.0)
        slopes[..., axis] = -0.8 * np.sign(along) * np.sin(np.pi * edge)
    turn = 2 * np.pi
    slopes[..., 0] += 0.05 * np.sin(turn * (3 * u + np.sin(turn * v) / 3)) + 0.02 * np.sin(turn * (11 * u + 7 * v))
    slopes[..., 1] += 0.05 * np.sin(turn * (2 * v + np.sin(turn * u) / 3)) + 0.02 * np.sin(turn * (5 * u - 13 * v))
    # A picture's v goes down, a normal map's y up.
    normals = np.stack([-slopes[..., 0], slopes[..., 1], np.ones((size, size))], axis=-1)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    texels = np.full((size, size, 4), 65535, np.uint16)
    texels[..., :3] = np.round((normals * 0.5 + 0.5) * 65535)
    return texels


def _lights(setting: Setting) -> list[Light]:
    """Return point lights that circle above the spheres."""
    rng = np.random.default_rng(setting.seed)
    turn = 2 * np.pi * (setting.time + (np.arange(setting.lights) + 0.5) / max(setting.lights, 1))
    out, height = rng.uniform(0.6, 1.0, setting.lights), rng.uniform(2.0, 4.0, setting.lights)
    places = np.stack([4.0 * out * np.cos(turn), height, 2.0 + 2.0 * out * np.sin(turn)], axis=1)
    colours = coloured(rng, setting.lights, 2.0 / np.sqrt(max(setting.lights, 1)))
    return [Light("point", tuple(colour), tuple(place), 6.0) for colour, place in zip(colours, places, strict=True)]
