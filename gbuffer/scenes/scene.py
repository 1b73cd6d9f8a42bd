"""Scenes: instances of meshes, materials, lights and a camera."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from ..environment.environment import Environment
from .mesh import Mesh
from .metal_rough import MetalRough

Colour = tuple[float, float, float]
# The order is the Deferred ID's: 0 is the material that the light pass shades in full.
KINDS = ("general", "skin", "hair", "glossy")
# About what a camera turns: its right, its up and its back, each counter-clockwise as the axis points at who looks.
TURNS = ("pitch", "yaw", "roll")
LIGHT_KINDS = ("point", "spot", "sun")


@dataclass(frozen=True)
class Material:
    """A Blinn-Phong material.

    Attributes:
        kind: "general", or one of the special materials of the second geometry pass: "skin", "hair", "glossy".
        albedo, specular: linear colours, each channel in [0, 1].
        power: specular power, 1 to 2048.
        emissive: linear colour, added unchanged.
        bump: strength of the normal map, 0 for none; 1 tilts normals by up to about 35 degrees.
        bump_repeat: how often the normal map repeats over a mesh's uv.
        alpha: opacity; below 1 the surface is transparent and drawn after all opaque surfaces.
    """

    kind: Literal["general", "skin", "hair", "glossy"] = "general"
    albedo: Colour = (0.5, 0.5, 0.5)
    specular: Colour = (0.04, 0.04, 0.04)
    power: float = 32.0
    emissive: Colour = (0.0, 0.0, 0.0)
    bump: float = 0.0
    bump_repeat: float = 1.0
    alpha: float = 1.0


@dataclass(frozen=True)
class Light:
    """A light in world space.

    Attributes:
        kind: "point", "spot" or "sun".
        colour: linear, at a distance of 0.
        position, radius: for point and spot lights; nothing is lit at a distance of `radius` or more.
        direction: the direction in which light travels, unit; for spot lights and the sun.
        inner, outer: half angles of a spot's cone in degrees: full light inside `inner`, none outside `outer`.
    """

    kind: Literal["point", "spot", "sun"]
    colour: Colour
    position: Colour = (0.0, 0.0, 0.0)
    radius: float = 0.0
    direction: Colour = (0.0, -1.0, 0.0)
    inner: float = 20.0
    outer: float = 30.0


@dataclass(frozen=True)
class ScenePart:
    """One mesh and its instances.

    Attributes:
        mesh: the mesh in its own space.
        models: (instances, 4, 4), matrices to world space for column vectors: rotation, uniform scale, translation.
        materials: (instances,), indices into the scene's materials.
        casts: whether it casts shadows; the shadow map is fitted around the parts that do.
        two_sided: whether its back, on the side away from the normals, is drawn as well.
    """

    mesh: Mesh
    models: np.ndarray
    materials: np.ndarray
    casts: bool = True
    two_sided: bool = False


@dataclass(frozen=True)
class View:
    """A camera in world space, right-handed, y up.

    Attributes:
        eye, target: the camera's position and the point that it looks at.
        fov: vertical field of view in degrees.
        near, far: distances along the line of sight.
        up: the up direction of the image, not parallel to the line of sight.
    """

    eye: Colour
    target: Colour
    fov: float
    near: float
    far: float
    up: Colour = (0.0, 1.0, 0.0)

    def matrix(self) -> np.ndarray:
        """Return the matrix from world to view space, (4, 4), for column vectors: x right, y up, looking down -z."""
        back = np.subtract(self.eye, self.target)
        back = back / np.linalg.norm(back)
        right = np.cross(self.up, back)
        right = right / np.linalg.norm(right)
        axes = np.stack([right, np.cross(back, right), back])
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = axes, -axes @ np.array(self.eye)
        return matrix

    def turned(self, axis: str, degrees: float) -> View:
        """Return the camera turned in place: to the left, upwards, or with its image turned clockwise.

        Args:
            axis: one of TURNS.
            degrees: angle in degrees; any number.
        """
        axes, angle = self.matrix()[:3, :3], np.radians(degrees)
        index = TURNS.index(axis)
        # Rodrigues: v' = v cos a + (k x v) sin a + k (k . v) (1 - cos a), with k a unit vector
        k = axes[index]
        turned = axes * np.cos(angle) + np.cross(k, axes) * np.sin(angle) + np.outer(axes @ k, k) * (1 - np.cos(angle))
        away = np.linalg.norm(np.subtract(self.target, self.eye))
        target, up = np.array(self.eye) - turned[2] * away, turned[1]
        return replace(self, target=_float_triple(target), up=_float_triple(up))

    def projection(self, aspect: float) -> np.ndarray:
        """Return the matrix from view to clip space, (4, 4), for column vectors, as in OpenGL: depth from -w to w."""
        f = 1 / np.tan(np.radians(self.fov) / 2)
        near, far = self.near, self.far
        matrix = np.zeros((4, 4))
        matrix[0, 0], matrix[1, 1], matrix[3, 2] = f / aspect, f, -1.0
        matrix[2, 2], matrix[2, 3] = (near + far) / (near - far), 2 * near * far / (near - far)
        return matrix

    def rays(self, size: tuple[int, int]) -> tuple[float, float, float, float]:
        """Return x and y of an image's upper right corner at depth 1, and the near and far distances."""
        up = np.tan(np.radians(self.fov) / 2)
        return up * size[0] / size[1], up, self.near, self.far


@dataclass(frozen=True)
class Water:
    """An endless, level sheet of water, visible where no ground rises above it. Only the effect `water` draws it.

    Attributes:
        level: its height when still, in metres.
        deep: its colour where no ground is visible through it, as an albedo.
        extinction: extinction coefficients for red, green and blue light in the water, in 1 / m.
        crests: colour of light that comes through a crest, as an albedo.
        patch: distance in metres after which the waves repeat along x and z.
        slope: root mean square slope of the waves.
        heading: direction in which the waves travel, in degrees from x towards z.
        period: time in seconds after which the waves repeat.
        time: the moment, in seconds.
    """

    level: float = 0.0
    deep: Colour = (0.02, 0.07, 0.08)
    extinction: Colour = (0.6, 0.22, 0.17)
    crests: Colour = (0.1, 0.3, 0.25)
    patch: float = 24.0
    slope: float = 0.1
    heading: float = 30.0
    period: float = 20.0
    time: float = 0.0


@dataclass(frozen=True)
class Scene:
    """Everything from which a frame is drawn.

    Attributes:
        parts, materials, lights: the contents; at most one light is a sun. All materials use the same model.
        ambient: linear colour, which is multiplied by the albedo.
        view: the camera.
        previous: the camera one frame earlier; motion vectors, if a G-buffer stores them, are between the two
            cameras.
        water: the water; None for a scene without water.
        environment: the distant surroundings; only for metallic-roughness scenes.
    """

    parts: tuple[ScenePart, ...]
    materials: tuple[Material, ...] | tuple[MetalRough, ...]
    lights: tuple[Light, ...]
    ambient: Colour
    view: View
    previous: View
    water: Water | None = None
    environment: Environment | None = None

    def under(self, environment: Environment) -> Scene:
        """Return the scene in this environment; a sun removed from the environment replaces the scene's own sun."""
        if environment.sun is None:
            return replace(self, environment=environment)
        way, irradiance = environment.sun
        # A light of colour c gives an irradiance of pi c.
        r, g, b = (channel / np.pi for channel in irradiance)
        others = [light for light in self.lights if light.kind != "sun"]
        lights = (Light("sun", (float(r), float(g), float(b)), direction=way), *others)
        return replace(self, environment=environment, lights=lights)

    @property
    def is_metal_rough(self) -> bool:
        """Whether the scene's materials are metallic-roughness and not Blinn-Phong."""
        return isinstance(self.materials[0], MetalRough)

    @property
    def has_maps(self) -> bool:
        """Whether any material of the scene has a map."""
        return any(
            material_map
            for material in self.materials
            if isinstance(material, MetalRough)
            for material_map in material.maps
        )

    @property
    def sun(self) -> Light | None:
        return next((light for light in self.lights if light.kind == "sun"), None)

    def with_power(self, power: float) -> Scene:
        """Return the scene with a different specular power, 1 to 2048, for all Blinn-Phong materials."""
        changed = [replace(m, power=power) if isinstance(m, Material) else m for m in self.materials]
        return replace(self, materials=tuple(changed))


def _float_triple(v: np.ndarray) -> Colour:
    return float(v[0]), float(v[1]), float(v[2])


def placed(positions: ArrayLike, scales: ArrayLike = 1.0, turns: ArrayLike = 0.0) -> np.ndarray:
    """Return model matrices, (instances, 4, 4), with uniform scales, turned about y by `turns` radians and moved to
    `positions`."""
    positions = np.atleast_2d(np.asarray(positions, float))
    scales, turns = (np.broadcast_to(np.asarray(a, float), len(positions)) for a in (scales, turns))
    models = np.tile(np.eye(4), (len(positions), 1, 1))
    c, s = scales * np.cos(turns), scales * np.sin(turns)
    models[:, 0, 0], models[:, 0, 2], models[:, 2, 0], models[:, 2, 2] = c, s, -s, c
    models[:, 1, 1] = scales
    models[:, :3, 3] = positions
    return models
