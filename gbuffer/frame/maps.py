"""Metallic-roughness materials on the device: their parameters and their texture maps."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack

import numpy as np

from ..gl.device import Device
from ..gl.handles import Program, Texture
from ..scenes.metal_rough import MAPS, Map, MetalRough
from ..scenes.scene import Scene

# Pictures lie behind all else that a pass samples; GL has at least this many units and one for each of them.
FIRST_UNIT = 10
# Where a material has no map: white changes nothing.
WHITE = np.full((1, 1, 4), 255, np.uint8)


class Maps:
    """The texture maps of a scene's materials, released with `stack`; materials may share maps."""

    def __init__(self, device: Device, stack: ExitStack, scene: Scene):
        def kept(make: Callable[[], Texture]) -> Texture:
            return device.owned(stack, make())

        white = kept(lambda: device.picture(WHITE, False, (True, True)))
        textures: dict[tuple[object, ...], Texture] = {}
        for material in scene.materials:
            for texture_map in material.maps if isinstance(material, MetalRough) else ():
                if texture_map is not None and _sampled(texture_map) not in textures:
                    textures[_sampled(texture_map)] = kept(
                        lambda image=texture_map: device.picture(image.texels, image.is_srgb, _repeats(image))
                    )
        self._bound = [
            [white if material_map is None else textures[_sampled(material_map)] for material_map in material.maps]
            for material in scene.materials
            if isinstance(material, MetalRough)
        ]

    def bind(self, program: Program, material: int) -> None:
        """Bind the map textures of material number `material` to a program's samplers; skip samplers that the
        compiler dropped."""
        for unit, (name, texture) in enumerate(zip(MAPS, self._bound[material], strict=True), FIRST_UNIT):
            if f"{name}_map" in program:
                program[f"{name}_map"] = unit
                texture.use(unit)


def _sampled(texture_map: Map) -> tuple[object, ...]:
    """Return a key for a map's texture: maps that differ only in their texture coordinates have equal keys."""
    return id(texture_map.texels), texture_map.is_srgb, _repeats(texture_map)


def _repeats(texture_map: Map) -> tuple[bool, bool]:
    along_u, along_v = (wrap == "repeat" for wrap in texture_map.wrap)
    return along_u, along_v


def metal_rough_numbers(material: MetalRough) -> list[float]:
    """Return the parameters of a metallic-roughness material, in the order in which `instance.glsl` declares them."""
    numbers = [*material.base, material.alpha, material.metalness, material.roughness, material.reflectance]
    has_normals = float(material.normal_map is not None)
    numbers += [material.cutoff, *material.emission, 0.0]
    numbers += [material.normal_scale, material.occlusion_strength, has_normals, float(any(material.maps))]
    for material_map in material.maps:
        placed = np.eye(3)[:2] if material_map is None else material_map.placed
        uv_set, wrap = (0, ("repeat", "repeat")) if material_map is None else (material_map.uv_set, material_map.wrap)
        mirrors = sum(bit for bit, way in zip((1, 2), wrap, strict=True) if way == "mirror")
        numbers += [*map(float, placed[0]), float(uv_set), *map(float, placed[1]), float(mirrors)]
    return numbers
