"""A frame on the device: the resources of a pipeline's plan, and programs over a scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ...encodings.storages.storage import ROUNDINGS, Storage, rounds_to
from ..codecs.codec_passes import encoding_defines
from ..codecs.depth.depth_passes import depth_defines
from ..codecs.light.light_passes import light_defines
from ..defines import materials
from ..defines.layouts import SAMPLERS, WORD_SAMPLERS, curve_defines, curve_files, layout_defines
from ..environment.dfg import dfg_table
from ..environment.prefilter import COARSE, FINE, Prefiltered, kept_prefiltered
from ..gl import raw
from ..gl.device import Device, bind
from ..gl.handles import Buffer, Framebuffer, Program, Texture3D, VertexArray
from ..layouts.layout import Layout
from ..layouts.words import LayoutError
from ..scenes.metal_rough import MAPS
from ..scenes.scene import Scene
from .contract import Pipeline
from .held import Held
from .plan import Plan
from .resource import DEPTH_MAP, DEPTH_STENCIL, Resource, Texel
from .resources import LIGHT, LIGHT_HOLDS, SHADOW_SIZE
from .scene_buffers import SceneBuffers, Sight, sun_matrix

FRAME_BINDING = 0
KINDS = ((SAMPLERS, False), (WORD_SAMPLERS, True))


class Frame:
    """A pipeline's resources for one scene and plan, created on first use; as a context manager, it releases them.

    Args:
        device: the OpenGL device.
        scene: the scene to draw.
        pipeline: the pipeline whose passes draw it.
        plan: the settings of the frame.
    """

    def __init__(self, device: Device, scene: Scene, pipeline: Pipeline, plan: Plan):
        self.device, self.context, self.scene, self.pipeline = device, device.context, scene, pipeline
        # Without anything that casts one there is no shadow to keep a map of.
        casts = scene.sun is not None and any(part.casts for part in scene.parts)
        self.plan = replace(pipeline.planned(plan), shadows=plan.shadows and casts)
        self.stack = ExitStack()
        self._held: dict[Resource, Held] = {}
        self._framebuffers: dict[tuple[Any, ...], Framebuffer] = {}
        self._blocks: dict[tuple[Any, ...], Buffer] = {}
        try:
            self.scene_buffers = SceneBuffers(device, self.stack, scene)
            tables = plan.layout.codec.encoding.tables().items()
            self.tables: dict[str, Any] = {
                **{name: device.owned(self.stack, device.upload(table)) for name, table in tables},
                **self._material_tables(),
                **self._dither_tables(),
            }
        except BaseException:
            self.stack.close()
            raise

    def __enter__(self) -> Frame:
        return self

    def __exit__(self, *_: object) -> None:
        self.device.idle.use()
        self.stack.close()

    # Resources

    def show(self, scene: Scene) -> None:
        """Replace the scene with another moment of it for the following draws. Raises ValueError as
        `SceneBuffers.show` does."""
        self.scene_buffers.show(scene)
        self.scene = scene
        for block in self._blocks.values():
            block.release()
        self._blocks.clear()

    def advance(self) -> None:
        """Begin the next frame: switch each resource that is kept between frames to its next copy, or clear all its
        copies if it is new."""
        for resource in self.pipeline.resources.values():
            if resource.kept and resource not in self._held:
                for _ in range(resource.copies):
                    self.clear(resource)
                    self.held(resource).move_on()
            elif resource.kept:
                self.held(resource).move_on()

    def held(self, resource: Resource) -> Held:
        """Return a resource's `Held` textures, created on first use; for a shared resource, the textures of the
        resource that it shares."""
        if resource.shares and resource.is_shared(self.plan):
            return self.held(resource.shares)
        if resource not in self._held:
            self._held[resource] = Held(self.device, self.stack, resource, self.plan)
        return self._held[resource]

    def textures(self, resource: Resource, copy: int = 0) -> list[Any]:
        """Return a resource's textures in the current copy, or `copy` copies before it; a depth buffer is returned as
        its texture. The list is empty if the plan leaves the resource out."""
        held = self.held(resource).copy(copy)
        return [target.texture if isinstance(target, raw.DepthBuffer) else target for target in held]

    def clear(self, resource: Resource) -> None:
        """Clear a resource's current copy: colour to 0 (the light buffer to its code for no light), depth to 1 and
        stencil to 0."""
        none = self.plan.light_buffer.no_light if resource == LIGHT else 0.0
        textures, is_depth = self.textures(resource), resource.texels(self.plan)[:1] in ((DEPTH_MAP,), (DEPTH_STENCIL,))
        if not textures:
            return
        framebuffer = self.framebuffer([], resource, True) if is_depth else self.framebuffer(textures)
        if resource.format == DEPTH_STENCIL:
            framebuffer.use()
            raw.clear_depth_stencil()
        else:
            framebuffer.clear(none, none, none, none, depth=1.0)
            raw.clear_words(i for i, storage in enumerate(resource.texels(self.plan)) if _is_integer(storage))

    def framebuffer(
        self,
        colours: Sequence[Any],
        depth: Resource | None = None,
        writes_depth: bool = False,
        layer: int | None = None,
    ) -> Framebuffer:
        """Return a framebuffer for these targets, created on first use.

        Args:
            colours: textures, or volumes of one size.
            depth: the resource whose current copy is the depth attachment; not used with volumes.
            writes_depth: whether draws write depth.
            layer: the slice of the volumes to draw into; None for all slices.

        Raises:
            FormatError: the device cannot render to the formats."""
        against = self.held(depth).copy(0)[0] if depth else None
        key = (*(texture.glo for texture in colours), against, writes_depth, layer)
        if key not in self._framebuffers:
            volumes = bool(colours) and isinstance(colours[0], Texture3D)
            make = (
                self.device.slice_framebuffer(colours, layer) if volumes else self.device.framebuffer(colours, against)
            )
            make.depth_mask = writes_depth
            self._framebuffers[key] = self.device.owned(self.stack, make)
        return self._framebuffers[key]

    # Programs

    @cached_property
    def _defines(self) -> dict[str, object]:
        plan = self.plan
        return {
            **materials.CONSTANTS,
            **LIGHT_HOLDS,
            **encoding_defines(plan.layout.codec.encoding),
            **depth_defines(plan.layout.depth_encoding),
            **layout_defines(plan.layout, shader_roundings(self.device, plan.layout), self.scene.is_metal_rough),
            **self._material_defines(),
            "SAMPLES": plan.surface_samples,
            "LIGHT_TARGETS": plan.light_targets,
            **self._light_defines(),
            "SHADOWS": int(plan.shadows),
            "DITHERED": int(plan.noise is not None),
            "PLACED": int(plan.sampled_from is not None),
        }

    def _light_defines(self) -> dict[str, object]:
        """Return the macros of the light buffer and those of the layout's curves and light encoding, by name. Raises
        LayoutError if the light buffer and the layout have different ranges."""
        light, kept = light_defines(self.plan.light_buffer), curve_defines(self.plan.layout)
        if any(light[name] != kept[name] for name in light.keys() & kept.keys()):
            buffer = self.plan.light_buffer.name
            raise LayoutError(
                f"layout {self.plan.layout.name}: emissive and the light buffer {buffer} have different ranges"
            )
        return {**light, **kept}

    def _material_defines(self) -> dict[str, object]:
        """Return the macros for metallic-roughness materials and the environment."""
        around = self.scene.environment
        defines: dict[str, object] = {"HAS_MAPS": int(self.scene.has_maps), "HAS_ENVIRONMENT": int(around is not None)}
        defines |= {"SPECULAR_ANTIALIASING": int(self.plan.antialiased), "LEAST_ROUGHNESS": self.plan.least_roughness}
        defines |= {f"{name.upper()}_MAP": number for number, name in enumerate(MAPS)} | {"MAP_COUNT": len(MAPS)}
        for name, levels in (("FINE", FINE), ("COARSE", COARSE)):
            defines |= {f"{name}_ROUGHNESS": tuple(map(float, levels)), f"{name}_LEVELS": len(levels)}
        return defines

    def _material_tables(self) -> dict[str, Any]:
        """Return lookup textures for metallic-roughness surfaces, by sampler: the split sum and, if the scene has an
        environment, its two sets of levels. Empty for other scenes. The device keeps the textures after the frame."""
        if not self.scene.is_metal_rough:
            return {}
        device = self.device
        (sums,) = device.lasting(self.stack, "dfg", lambda: [device.upload(dfg_table())])
        if (around := self.scene.environment) is None:
            return {"dfg": sums}
        fine, coarse = device.lasting(self.stack, around, lambda: _levels_uploaded(device, kept_prefiltered(around)))
        return {"dfg": sums, "environment_fine": fine, "environment_coarse": coarse}

    def _dither_tables(self) -> dict[str, Any]:
        noise = self.plan.noise
        return {"dither": self.device.owned(self.stack, self.device.upload(noise.added))} if noise else {}

    def program(self, vertex: str | Path, fragment: str | Path, **defines: object) -> Program:
        """Return a program of a vertex and a fragment shader, compiled with the frame's macros and `defines`, which
        take precedence. Raises ShaderError."""
        plan = self.plan
        names: Mapping[str, Path | tuple[Path, ...]] = {
            "ENCODING": plan.layout.codec.encoding.glsl,
            "DEPTH_ENCODING": plan.layout.depth_encoding.glsl,
            "LIGHT_ENCODING": plan.light_buffer.glsl,
            "CURVES": curve_files(plan.layout),
        }
        return self.device.shared_program(self.stack, vertex, fragment, {**self._defines, **defines}, names)

    def array(self, program: Program, content: list[Any], indices: Any = None) -> VertexArray:
        """Return a vertex array for a program, released with the frame; `content` and `indices` are moderngl's."""
        vertex_array = self.context.vertex_array(program, content, indices)
        # Several arrays share a program: each releases itself alone.
        self.stack.callback(vertex_array.release)
        return vertex_array

    def bind(self, program: Program, size: tuple[int, int], view: Sight | None, textures: Mapping[str, Any]) -> None:
        """Bind the inputs of a draw into a target of this size, from `view` or, if None, from the scene's camera."""
        if (size, view) not in self._blocks:
            self._blocks[size, view] = self._frame_buffer(size, view)
        self._blocks[size, view].bind_to_uniform_block(FRAME_BINDING)
        self.scene_buffers.bind(view)
        bind(program, {"bumps": self.scene_buffers.bumps, **self.tables, **self._by_kind(textures)})

    def _by_kind(self, textures: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return textures by sampler, with the G-buffer's textures of integer formats moved to a separate sampler."""
        storages = [target.storage for target in self.plan.layout.targets]
        if SAMPLERS not in textures or not any(storage.is_integer for storage in storages):
            return textures
        pairs = list(zip(textures[SAMPLERS], storages, strict=True))
        parts = {
            name: [texture for texture, storage in pairs if storage.is_integer is is_words] for name, is_words in KINDS
        }
        return {**textures, **{name: several for name, several in parts.items() if several}}

    def _frame_buffer(self, size: tuple[int, int], view: Sight | None) -> Buffer:
        """Return a new uniform buffer, as `frame.glsl` declares it, for a target of this size, as seen from `view`
        or, if None, the scene's camera."""
        sight, previous = view or self.scene.view, view or self.scene.previous
        picture = size if view else self.plan.sampled_from or self.plan.size
        projection, to_world = sight.projection(picture[0] / picture[1]), np.linalg.inv(sight.matrix())
        to_sun = sun_matrix(self.scene) @ to_world if self.plan.shadows else np.eye(4)
        previous_clip = projection @ previous.matrix() @ to_world
        sizes = (*self.plan.surface_size, SHADOW_SIZE, 0.0)
        vectors = [(*self.scene.ambient, 0.0), sight.rays(picture), sizes, (*size, 0.0, 0.0)]
        matrices = [projection, np.linalg.inv(projection), to_world, to_sun, previous_clip]
        data = np.concatenate([*(m.T.ravel() for m in matrices), *map(np.array, vectors)])
        return self.device.owned(self.stack, self.context.buffer(data.astype(np.float32).tobytes()))


def _is_integer(texel: Texel) -> bool:
    return isinstance(texel, Storage) and texel.is_integer


def _levels_uploaded(device: Device, levels: Prefiltered) -> list[Any]:
    return [device.layers(levels.fine), device.layers(levels.coarse)]


def shader_roundings(device: Device, layout: Layout) -> tuple[int, ...]:
    """Return, per target, 0 if the device rounds as requested, else 1 + the rounding's number in `storage.glsl`."""
    homes = {word.target for word in layout.words if word.component.startswith("normal.")}
    return tuple(
        _shader_rounding(device, target.storage, rounds_to(layout.rounding) if i in homes else "nearest")
        for i, target in enumerate(layout.targets)
    )


def _shader_rounding(device: Device, storage: Storage, asked: str) -> int:
    # Colours on the sRGB curve are codes of it before the device sees them (`curve_defines`).
    is_native = storage.curved > 0 or storage.is_integer or device.native_rounding(storage) == asked
    return 0 if is_native else ROUNDINGS.index(asked) + 1
