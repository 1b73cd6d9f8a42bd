"""A scene on the device: meshes, instances, materials, lights and the draw lists of the passes."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache
from typing import Protocol

import numpy as np

from ..gl.device import Device
from ..gl.handles import Buffer, Program, Texture
from ..scenes.mesh import Mesh
from ..scenes.metal_rough import MetalRough
from ..scenes.scene import KINDS, LIGHT_KINDS, Light, Material, Scene
from .maps import Maps, metal_rough_numbers

INSTANCES, ORDER, LIGHTS, MATERIALS = 0, 1, 2, 3
LAYERS = 3
# Instances are told apart by 1 to 255, so that eight bits hold them.
IDENTITIES = 255


class Sight(Protocol):
    """A viewpoint in a scene: a `View`, or any other hashable value that has these methods."""

    def matrix(self) -> np.ndarray:
        """World to view space, (4, 4)."""
        ...

    def projection(self, aspect: float) -> np.ndarray:
        """View to clip space, (4, 4)."""
        ...

    def rays(self, size: tuple[int, int]) -> tuple[float, float, float, float]:
        """Return x and y of the image's upper right corner at depth 1, and the near and far distances."""
        ...


@dataclass(frozen=True)
class Draw:
    """Some instances of one mesh: `count` entries of the instance order from `first` on. In a scene with maps they
    all have the same material, whose maps are bound before the draw."""

    mesh: int
    first: int
    count: int
    material: int


class SceneBuffers:
    """Buffers from which a scene's frames are drawn, released with `stack`; the scene may move from frame to frame.

    Attributes:
        draws: draw lists by name: "opaque", "general", "special", "transparent" (farthest first), "casters"
            (closed) and "thin casters" (two-sided); and, by the index of each light, the opaque instances within its
            range.
        view: matrix from world space to the scene's own view space, by which transparent instances are ordered.
        lights, first_lamp: the lights in the order of the shaders, and the index of the first that is not a sun.
        meshes: vertex and index buffers.
        two_sided: for each mesh, whether its back faces are drawn as well.
        bumps: the normal map.
    """

    def __init__(self, device: Device, stack: ExitStack, scene: Scene):
        self._device, self._stack, self._scene = device, stack, scene
        self.two_sided = [part.two_sided for part in scene.parts]
        self.meshes = [self._upload_mesh(part.mesh) for part in scene.parts]
        self.bumps = device.owned(stack, _bump_texture(device))
        self._maps = Maps(device, stack, scene) if scene.has_maps else None
        # Tables of the moment.
        self._moment = ExitStack()
        stack.callback(lambda: self._moment.close())
        self.show(scene)

    def show(self, scene: Scene) -> None:
        """Replace the scene with another moment of it: create its tables and draw lists for the following draws.

        Raises:
            ValueError: the scene has other meshes, kinds of light or surroundings; see `what_is_built`.
        """
        if what_is_built(scene) != what_is_built(self._scene):
            raise ValueError("another moment of a scene must have the same meshes and kinds of light")
        self._moment.close()
        self._scene, self.view = scene, scene.view.matrix()
        self._material = np.concatenate([part.materials for part in scene.parts])
        self._transparent = np.array([m.alpha < 1 for m in scene.materials])[self._material]
        self.draws: dict[str | int, list[Draw]] = {}
        # The shaders find the sun in the first place.
        self.lights = tuple(sorted(scene.lights, key=lambda light: light.kind != "sun"))
        self.first_lamp = int(scene.sun is not None)
        self._tables = {
            ORDER: self._table_buffer(self._ordered_instances()),
            MATERIALS: self._table_buffer(self._material_table()),
        }
        self._seen: dict[Sight, dict[int, Buffer]] = {}

    def bind(self, view: Sight | None = None) -> None:
        """Bind the tables of instances, lights and materials for shaders. Instances and lights are in the space of
        `view` or, if None, of the scene's camera."""
        sight = view or self._scene.view
        if sight not in self._seen:
            matrix = sight.matrix()
            tables = {INSTANCES: self._instance_table(matrix), LIGHTS: self._light_table(matrix)}
            self._seen[sight] = {binding: self._table_buffer(data) for binding, data in tables.items()}
        for binding, buffer in (self._tables | self._seen[sight]).items():
            buffer.bind_to_storage_buffer(binding)

    def bind_maps(self, program: Program, material: int) -> None:
        """Bind the map textures of material number `material` to a program's samplers, if the scene has maps."""
        if self._maps:
            self._maps.bind(program, material)

    def _table_buffer(self, data: np.ndarray) -> Buffer:
        # An empty list is a buffer all the same.
        return self._device.owned(self._moment, self._device.context.buffer(data.tobytes() or bytes(16)))

    def _upload_mesh(self, mesh: Mesh) -> tuple[Buffer, Buffer]:
        corners, triangles = (self._device.context.buffer(data.tobytes() or bytes(16)) for data in mesh.uploaded)
        return self._device.owned(self._stack, corners), self._device.owned(self._stack, triangles)

    def _instance_table(self, view: np.ndarray) -> np.ndarray:
        models = np.concatenate([part.models for part in self._scene.parts])
        count = len(models)
        table = np.zeros(count, [("model_view", np.float32, (4, 4)), ("numbers", np.int32, 4)])
        # GLSL's matrices go column by column.
        table["model_view"] = np.swapaxes(view @ models, 1, 2)
        layers = np.where(self._transparent, (np.cumsum(self._transparent) - 1) % LAYERS + 1, 0)
        table["numbers"][:, 0], table["numbers"][:, 1] = self._material, layers
        table["numbers"][:, 2] = np.arange(count) % IDENTITIES + 1
        return table

    def _material_table(self) -> np.ndarray:
        materials = self._scene.materials
        rows = [metal_rough_numbers(m) if isinstance(m, MetalRough) else _blinn_phong_numbers(m) for m in materials]
        return np.array(rows, np.float32)

    def _light_table(self, view: np.ndarray) -> np.ndarray:
        return np.array([_light_numbers(light, view) for light in self.lights], np.float32).reshape(-1, 16)

    def _ordered_instances(self) -> np.ndarray:
        """Fill `draws`, and return the indices of the instances, int32, in the order in which the draws list them. An
        instance is repeated for each list that contains it."""
        parts, transparent = self._scene.parts, self._transparent
        mesh = np.repeat(np.arange(len(parts)), [len(part.models) for part in parts])
        special = np.array([m.kind != KINDS[0] for m in self._scene.materials])[self._material]
        casts, thin = (
            np.repeat([getattr(part, field) for part in parts], [len(part.models) for part in parts])
            for field in ("casts", "two_sided")
        )
        chosen: dict[str | int, np.ndarray] = {
            "general": ~transparent & ~special,
            "special": ~transparent & special,
            "casters": ~transparent & casts & ~thin,
            "thin casters": ~transparent & casts & thin,
        }
        centres, radii = bounds(self._scene)
        for index, light in enumerate(self.lights):
            away = np.linalg.norm(centres - np.array(light.position), axis=1)
            chosen[index] = ~transparent & ((light.kind == "sun") | (away < radii + light.radius))
        order: list[int] = []
        for name, mask in chosen.items():
            self.draws[name] = self._listed_draws(np.flatnonzero(mask), mesh, order)
        depth = centres @ self.view[2, :3] + self.view[2, 3]
        glass = np.flatnonzero(transparent)
        glass = glass[np.argsort(depth[glass], kind="stable")]
        self.draws["transparent"] = []
        for instance in glass:
            self.draws["transparent"] += self._listed_draws(np.array([instance]), mesh, order)
        # Special materials first: where a general surface meets one in one depth, both geometry passes keep that one.
        self.draws["opaque"] = self.draws["special"] + self.draws["general"]
        return np.array(order, np.int32)

    def _listed_draws(self, instances: np.ndarray, mesh: np.ndarray, order: list[int]) -> list[Draw]:
        """Append instances to `order`, grouped by mesh and, if there are maps, by material. Return one draw for each
        group."""
        of_material = self._material if self._maps else np.zeros_like(self._material)
        kinds = np.stack([mesh[instances], of_material[instances]], axis=1)
        draws = []
        for index, material in np.unique(kinds, axis=0):
            chosen = instances[np.all(kinds == (index, material), axis=1)]
            draws.append(Draw(int(index), len(order), len(chosen), int(material)))
            order += chosen.tolist()
        return draws


def _blinn_phong_numbers(material: Material) -> list[float]:
    kind, bump = KINDS.index(material.kind), (material.bump, material.bump_repeat)
    return [*material.albedo, material.alpha, *material.specular, material.power, *material.emissive, kind, *bump, 0, 0]


def _light_numbers(light: Light, view: np.ndarray) -> list[float]:
    position = view[:3, :3] @ np.array(light.position) + view[:3, 3]
    direction = view[:3, :3] @ np.array(light.direction)
    outer, inner = np.cos(np.radians([light.outer, light.inner]))
    kind = LIGHT_KINDS.index(light.kind)
    return [*position, light.radius, *light.colour, kind, *direction, outer, inner, 0, 0, 0]


def what_is_built(scene: Scene) -> tuple[object, ...]:
    """Return a key of everything that passes are built for and that may not change from frame to frame: meshes, kinds
    of light, material model, maps and surroundings."""
    meshes = ((part.mesh.positions.tobytes(), part.mesh.triangles.tobytes(), part.casts) for part in scene.parts)
    lights = sorted(light.kind for light in scene.lights)
    return *meshes, *lights, scene.is_metal_rough, scene.has_maps, scene.environment


def bounds(scene: Scene, casters_only: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Return world-space bounding spheres of all instances, or only of those that cast shadows: centres,
    (instances, 3), and radii, (instances,)."""
    centres, radii = [], []
    for part in scene.parts:
        if casters_only and not part.casts:
            continue
        low, high = part.mesh.positions.min(axis=0), part.mesh.positions.max(axis=0)
        middle = (low + high) / 2
        radius = np.linalg.norm(part.mesh.positions - middle, axis=1).max()
        centres.append(part.models[:, :3, :3] @ middle + part.models[:, :3, 3])
        radii.append(radius * np.cbrt(np.abs(np.linalg.det(part.models[:, :3, :3]))))
    return np.concatenate(centres), np.concatenate(radii)


def sun_matrix(scene: Scene) -> np.ndarray:
    """Return the matrix from world space to the shadow map, (4, 4): x, y and depth along the sun's rays, each from 0
    to 1 around the casters.

    Raises:
        ValueError: nothing casts a shadow, or the scene has no sun.
    """
    if scene.sun is None or not any(part.casts for part in scene.parts):
        raise ValueError("the scene has no sun, or nothing in it casts a shadow")
    z = np.array(scene.sun.direction)
    x = np.cross(z, np.eye(3)[np.argmin(abs(z))])
    x = x / np.linalg.norm(x)
    axes = np.stack([x, np.cross(x, z), z])
    centres, radii = bounds(scene, casters_only=True)
    along = centres @ axes.T
    low, high = (along - radii[:, None]).min(axis=0), (along + radii[:, None]).max(axis=0)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = axes / (high - low)[:, None], -low / (high - low)
    return matrix


def _bump_texture(device: Device) -> Texture:
    return device.mipmapped(bumps())


@cache
def bumps(size: int = 256) -> np.ndarray:
    """Return a tiling normal map of round pits: slopes along u and v up to about 0.7, float16, (size, size, 2)."""
    u, v = np.meshgrid((np.arange(size) + 0.5) / size, (np.arange(size) + 0.5) / size)
    cells = 4
    x, y = (u * cells) % 1 - 0.5, (v * cells) % 1 - 0.5
    radius = np.hypot(x, y)
    ring = np.where(radius < 0.42, np.sin(np.pi * radius / 0.42), 0.0)
    slopes = 0.7 * np.stack([x, y], axis=-1) / np.maximum(radius, 1e-9)[..., None] * ring[..., None]
    return slopes.astype(np.float16)
