"""Pixels as a scene: each pixel becomes a square that faces the camera and has the pixel's G-buffer attributes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..environment.catalogue import ENVIRONMENTS
from .files.read import AROUND
from .mesh import Mesh
from .metal_rough import Map, MetalRough
from .scene import Scene, ScenePart, View

# A reflectance is a number of a material: materials of so many are made, and more are rounded to as many steps.
REFLECTANCES = 256
# Along u, with the bitangent's sign that has a normal map's y up where v goes down.
TANGENT = (1.0, 0.0, 0.0, -1.0)


@dataclass(frozen=True, eq=False)
class PixelSurfaces:
    """The surfaces that are visible at the pixels of an image, float32, row 0 at the top.

    Attributes:
        depth: (height, width), along the viewing direction; 0 without a surface.
        normal: (height, width, 3), unit, in view space.
        base_color, emissive: (height, width, 3), linear.
        roughness, metallic, f0, ao: (height, width); `f0` is the reflectance of a dielectric.
    """

    depth: np.ndarray
    normal: np.ndarray
    base_color: np.ndarray
    roughness: np.ndarray
    metallic: np.ndarray
    f0: np.ndarray
    ao: np.ndarray
    emissive: np.ndarray


def pixel_scene(pixels: PixelSurfaces, view: View) -> Scene:
    """Return a scene of the pixels as `view` sees them, without lights of its own, in an environment.

    Each square samples its texel at the texel's centre, so that nothing is filtered, whatever the image size.
    """
    covered = pixels.depth > 0
    reflectances, level = _levels(pixels.f0, covered)
    meshes = [_squares(pixels.depth, level == index, view) for index in range(len(reflectances))]
    to_world, surface = np.linalg.inv(view.matrix())[None], _surface(pixels)
    return Scene(
        parts=tuple(ScenePart(mesh, to_world, np.array([i]), casts=False) for i, mesh in enumerate(meshes)),
        materials=tuple(replace(surface, reflectance=float(reflectance)) for reflectance in reflectances),
        lights=(),
        ambient=(0.0, 0.0, 0.0),
        view=view,
        previous=view,
        environment=ENVIRONMENTS[AROUND].make(),
    )


def _levels(reflectance: np.ndarray, covered: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the distinct reflectances of covered pixels, rounded to REFLECTANCES steps if there are more, and the
    index of each pixel's reflectance, (height, width), which is -1 if no surface covers the pixel."""
    values, index = np.unique(reflectance[covered], return_inverse=True)
    if len(values) > REFLECTANCES:
        values = np.linspace(values[0], values[-1], REFLECTANCES)
        steps = np.rint((reflectance[covered] - values[0]) / (values[1] - values[0])).astype(int)
        values, index = values[np.unique(steps)], np.unique(steps, return_inverse=True)[1]
    level = np.full(reflectance.shape, -1)
    level[covered] = index
    return values, level


def _surface(pixels: PixelSurfaces) -> MetalRough:
    """Return a material whose maps have one texel per pixel, with all attributes except the reflectance."""
    ones = np.ones_like(pixels.roughness)

    def lying(*planes: np.ndarray) -> Map:
        return Map(np.dstack([*planes, ones]).astype(np.float32), wrap=("clamp", "clamp"))

    white = (1.0, 1.0, 1.0)
    return MetalRough(
        base=white,
        metalness=1.0,
        roughness=1.0,
        emission=white,
        base_map=lying(pixels.base_color),
        rough_metal_map=lying(ones, pixels.roughness, pixels.metallic),
        # Read as 2 c - 1.
        normal_map=lying(pixels.normal * 0.5 + 0.5),
        occlusion_map=lying(pixels.ao, ones, ones),
        emission_map=lying(pixels.emissive),
    )


def _squares(depth: np.ndarray, chosen: np.ndarray, view: View) -> Mesh:
    """Return a view-space mesh with one square per chosen pixel: the pixel's corners at its depth."""
    height, width = depth.shape
    row, column = np.nonzero(chosen)
    across, up, _, _ = view.rays((width, height))
    right, down = np.array([0, 1, 0, 1]), np.array([0, 0, 1, 1])
    x = ((column[:, None] + right) / width * 2 - 1) * across
    y = (1 - (row[:, None] + down) / height * 2) * up
    places = np.stack([x, y, np.full_like(x, -1.0)], axis=-1) * depth[row, column].astype(np.float64)[:, None, None]
    count = 4 * len(row)
    uv = np.repeat(np.stack([(column + 0.5) / width, (row + 0.5) / height], axis=1), 4, axis=0)
    triangles = (4 * np.arange(len(row))[:, None] + (0, 2, 1, 1, 2, 3)).reshape(-1, 3)
    towards = np.tile((0.0, 0.0, 1.0), (count, 1))
    return Mesh(places.reshape(-1, 3), towards, triangles, uv, np.tile(TANGENT, (count, 1)))
