"""A chart of metallic-roughness materials with each attribute over its whole range: no encoding excels by chance."""

from __future__ import annotations

from functools import cache

import numpy as np

from ...environment.catalogue import ENVIRONMENTS
from ..mesh import sphere
from ..metal_rough import Map, MetalRough
from ..scene import Light, Scene, ScenePart, View, placed
from ..setting import Setting
from .studio import panel, tiles

TITLE = "panels that span the whole range of roughness, metalness, base colour, occlusion and emission"
FRAMES = 1
EXPOSURE = -1.0
# Texels of a ramp, in 16 bits: its own steps are finer than those of any code.
SIZE = 256
ONE = 65535
# Of the panels: columns, their size, and how far they are apart.
COLUMNS, WIDTH, HEIGHT, APART = 4, 1.7, 1.35, 0.1
TURNS = (24.0, 14.0)
REFLECTANCES = tuple(float(x) for x in np.linspace(0.02, 0.08, 8))


def ramps(setting: Setting) -> Scene:  # noqa: ARG001 # nothing moves, and the lights are its own
    """Return the chart: panels of all materials and a row of spheres of rising reflectance. `setting` is unused."""
    materials = _materials()
    balls = [MetalRough(base=(0.05, 0.05, 0.05), roughness=0.25, reflectance=r) for r in REFLECTANCES]
    shape = panel(WIDTH, HEIGHT, *TURNS)
    parts = [
        ScenePart(shape, placed(_place(number)), np.array([number]), two_sided=True) for number in range(len(materials))
    ]
    across = np.linspace(-3.2, 3.2, len(balls))
    rows = np.stack([across, np.full(len(balls), -2.55), np.full(len(balls), 0.3)], axis=1)
    numbers = np.arange(len(materials), len(materials) + len(balls))
    view = View((0.0, -0.36, 8.0), (0.0, -0.36, 0.0), 38.0, 1.0, 40.0)
    return Scene(
        parts=(*parts, ScenePart(sphere(1.0, 64, 48), placed(rows, 0.3), numbers)),
        materials=(*materials, *balls),
        lights=(_sun(),),
        ambient=(0.0, 0.0, 0.0),
        view=view,
        previous=view,
        environment=ENVIRONMENTS["studio"].make(),
    )


def _place(number: int) -> tuple[float, float, float]:
    row, column = divmod(number, COLUMNS)
    return (column - 1.5) * (WIDTH + APART), 1.45 - row * (HEIGHT + APART), 0.0


def _materials() -> tuple[MetalRough, ...]:
    """Return the materials of the panels, starting at the upper left."""
    along, up = _ramp(0.0, 1.0), _ramp(0.0, 1.0).T
    copper, steel = (0.95, 0.64, 0.54), (0.78, 0.78, 0.8)
    return (
        MetalRough(steel, 1.0, 1.0, rough_metal_map=_rough_metal(_ramp(0.0, 0.25))),
        MetalRough(copper, 1.0, 1.0, rough_metal_map=_rough_metal(_ramp(0.2, 1.0))),
        MetalRough((0.08, 0.02, 0.02), 0.0, 1.0, rough_metal_map=_rough_metal(along)),
        MetalRough(steel, 1.0, 0.05),
        MetalRough((1.0, 1.0, 1.0), 0.0, 0.6, base_map=Map(_hues())),
        MetalRough((1.0, 1.0, 1.0), 0.0, 0.8, base_map=_map(np.stack([along**2.2] * 3, axis=-1))),
        MetalRough(copper, 1.0, 1.0, rough_metal_map=_rough_metal(np.full_like(along, 0.3), along)),
        MetalRough((1.0, 1.0, 1.0), 1.0, 0.2, base_map=Map(_hues())),
        MetalRough((0.6, 0.6, 0.6), 0.0, 0.7, occlusion_map=_map(np.stack([along] * 3, axis=-1))),
        MetalRough(steel, 1.0, 0.25, normal_map=Map(tiles())),
        MetalRough((0.02, 0.02, 0.02), 0.0, 0.9, emission=(0.9, 0.55, 0.2), emission_map=_map(_warm(along, up))),
        MetalRough((1.0, 1.0, 1.0), 1.0, 1.0, base_map=Map(_hues()), rough_metal_map=_rough_metal(up, along)),
    )


def _ramp(low: float, high: float) -> np.ndarray:
    """Return a linear ramp from `low` to `high` along u, (SIZE, SIZE)."""
    return np.tile(np.linspace(low, high, SIZE), (SIZE, 1))


def _map(colours: np.ndarray) -> Map:
    """Return a 16-bit map, clamped at its edges, of numbers in [0, 1], (SIZE, SIZE, 3)."""
    texels = np.full((*colours.shape[:2], 4), ONE, np.uint16)
    texels[..., :3] = np.round(colours * ONE)
    return Map(texels, wrap=("clamp", "clamp"))


def _rough_metal(roughness: np.ndarray, metalness: np.ndarray | None = None) -> Map:
    full = np.ones_like(roughness)
    return _map(np.stack([full, roughness, full if metalness is None else metalness], axis=-1))


@cache
def _hues() -> np.ndarray:
    """Return all hues along u, from black to white along v; uint16 of shape (SIZE, SIZE, 4)."""
    hue, value = _ramp(0.0, 6.0), _ramp(0.0, 1.0).T
    pure = np.stack([np.clip(np.abs((hue - phase) % 6 - 3) - 1, 0, 1) for phase in (0.0, 2.0, 4.0)], axis=-1)
    # Dark to the hue, and on to white.
    mixed = pure * np.minimum(2 * value, 1)[..., None]
    mixed += (1 - mixed) * np.maximum(2 * value - 1, 0)[..., None]
    return _map(mixed**2.2).texels


def _warm(along: np.ndarray, up: np.ndarray) -> np.ndarray:
    return np.stack([along, along * (0.5 + 0.5 * up), along * up], axis=-1)


def _sun() -> Light:
    direction = np.array([0.35, -0.5, -0.8])
    return Light("sun", (0.6, 0.58, 0.54), direction=tuple(direction / np.linalg.norm(direction)))
