"""One frame's resources: the targets of a layout, light buffers, shadow map, and programs over a scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import moderngl
import numpy as np

from ...encodings.codecs.light_codec import LightCodec
from ...encodings.storages.storage import FORMATS, R32F, ROUNDINGS, Storage
from ..codecs.codec_passes import encoding_defines, levels_of, storage_kind
from ..codecs.depth_passes import depth_defines
from ..codecs.light_passes import light_defines
from ..defines import materials
from ..gl.device import Device, FormatError, bind
from ..gl.raw import DepthBuffer, depth_stencil
from ..layouts.layout import COMPONENTS, PACKINGS, Layout
from ..scenes.scene import Scene
from .scene_buffers import SceneBuffers, sun_matrix

SHADOW_SIZE = 1024
FRAME_BINDING = 0


@dataclass(frozen=True)
class Plan:
    """What a frame is made of.

    Attributes:
        size: width and height of the final image.
        samples: of each pixel.
        layout, light_buffer: what the G-buffer and the light are kept in.
        light_targets: 1 or 2, see `accumulation.glsl`.
        shadows: whether the sun has a shadow map.
        scale: of the G-buffer's and light buffer's size to the image's, for pipelines that have the choice.
    """

    size: tuple[int, int]
    samples: int
    layout: Layout
    light_buffer: LightCodec
    light_targets: int
    shadows: bool
    scale: float


class Frame:
    """The resources of one plan over one scene, made when first asked for; a context manager that releases them.

    Args:
        device: where.
        scene: what is drawn.
        plan: with which targets.
        scaled: whether G-buffer and light buffer have the plan's scale, and one sample a pixel.
    """

    def __init__(self, device: Device, scene: Scene, plan: Plan, scaled: bool):
        self.device, self.context, self.scene, self.plan = device, device.context, scene, plan
        self.stack = ExitStack()
        width, height = plan.size
        self.buffer_size = (
            (max(round(width * plan.scale), 1), max(round(height * plan.scale), 1)) if scaled else plan.size
        )
        self.buffer_samples = 1 if scaled else plan.samples
        # Without anything that casts one there is no shadow to keep a map of.
        self.shadows = plan.shadows and scene.sun is not None and any(part.casts for part in scene.parts)
        try:
            self.scene_buffers = SceneBuffers(device, self.stack, scene)
            self.blocks = {size: self._frame_block(size) for size in {self.buffer_size, plan.size}}
            tables = plan.layout.codec.encoding.tables().items()
            self.tables = {name: device.owned(self.stack, device.upload(table)) for name, table in tables}
        except BaseException:
            self.stack.close()
            raise

    def __enter__(self) -> Frame:
        return self

    def __exit__(self, *_: object) -> None:
        self.device.idle.use()
        self.stack.close()

    def _frame_block(self, size: tuple[int, int]) -> moderngl.Buffer:
        view = self.scene.view
        projection = view.projection(self.plan.size[0] / self.plan.size[1])
        to_world = np.linalg.inv(self.scene_buffers.view)
        to_sun = sun_matrix(self.scene) @ to_world if self.shadows else np.eye(4)
        previous = projection @ self.scene.previous.matrix() @ to_world
        up = np.tan(np.radians(view.fov) / 2)
        rays = (up * self.plan.size[0] / self.plan.size[1], up, view.near, view.far)
        vectors = [(*self.scene.ambient, 0.0), rays, (*size, SHADOW_SIZE, 0.0)]
        matrices = [projection, np.linalg.inv(projection), to_world, to_sun, previous]
        data = np.concatenate([*(m.T.ravel() for m in matrices), *map(np.array, vectors)])
        return self.device.owned(self.stack, self.context.buffer(data.astype(np.float32).tobytes()))

    def texture(self, size: tuple[int, int], storage: Storage, samples: int) -> moderngl.Texture:
        """A render target, released with the frame."""
        return self.device.owned(self.stack, self.device.target(size, storage, samples))

    @cached_property
    def gbuffer(self) -> list[moderngl.Texture]:
        targets = self.plan.layout.targets
        return [self.texture(self.buffer_size, target.storage, self.buffer_samples) for target in targets]

    @cached_property
    def light(self) -> list[moderngl.Texture]:
        return self._light_targets()

    @cached_property
    def next_light(self) -> list[moderngl.Texture]:
        """The light buffer's second copy, for a code that is read while it is written."""
        return self._light_targets()

    def _light_targets(self) -> list[moderngl.Texture]:
        storage, targets = self.plan.light_buffer.storage, self.plan.light_targets
        return [self.texture(self.buffer_size, storage, self.buffer_samples) for _ in range(targets)]

    @cached_property
    def linear_depth(self) -> moderngl.Texture:
        return self.texture(self.buffer_size, R32F, self.buffer_samples)

    @cached_property
    def final(self) -> moderngl.Texture:
        return self.texture(self.plan.size, FORMATS["rgba32f"], self.plan.samples)

    @cached_property
    def depth(self) -> DepthBuffer:
        """Depth and stencil of the G-buffer."""
        return self._depth_stencil(self.buffer_size, self.buffer_samples)

    @cached_property
    def final_depth(self) -> DepthBuffer:
        """Depth and stencil of the final image: the G-buffer's own where the two have one size."""
        same = (self.buffer_size, self.buffer_samples) == (self.plan.size, self.plan.samples)
        return self.depth if same else self._depth_stencil(self.plan.size, self.plan.samples)

    def _depth_stencil(self, size: tuple[int, int], samples: int) -> DepthBuffer:
        made = depth_stencil(self.context, size, samples)
        self.stack.callback(made.release)
        return made

    @cached_property
    def shadow_map(self) -> moderngl.Texture:
        texture = self.device.owned(self.stack, self.context.depth_texture((SHADOW_SIZE, SHADOW_SIZE)))
        texture.compare_func = ""
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def framebuffer(
        self, colours: Sequence[moderngl.Texture], depth: DepthBuffer | None = None, writes_depth: bool = False
    ) -> moderngl.Framebuffer:
        """Targets to draw into. Raises FormatError where the device cannot."""
        try:
            made = self.device.owned(self.stack, self.context.framebuffer(list(colours)))
            if depth:
                depth.attach(made)
        except moderngl.Error as error:
            raise FormatError(f"{self.device.renderer} cannot render to these targets: {error}") from error
        made.depth_mask = writes_depth
        return made

    @cached_property
    def _defines(self) -> dict[str, object]:
        plan = self.plan
        return {
            **materials.CONSTANTS,
            **encoding_defines(plan.layout.codec.encoding),
            **depth_defines(plan.layout.depth_encoding),
            **layout_defines(plan.layout, shader_roundings(self.device, plan.layout)),
            "SAMPLES": self.buffer_samples,
            "LIGHT_TARGETS": plan.light_targets,
            **light_defines(plan.light_buffer),
            "SHADOWS": int(self.shadows),
        }

    def program(self, vertex: str, fragment: str, **defines: object) -> moderngl.Program:
        """A compiled pair of shaders that knows the frame's layout. Raises ShaderError."""
        plan = self.plan
        names: Mapping[str, Path] = {
            "ENCODING": plan.layout.codec.encoding.glsl,
            "DEPTH_ENCODING": plan.layout.depth_encoding.glsl,
            "LIGHT_ENCODING": plan.light_buffer.glsl,
        }
        return self.device.shared_program(vertex, fragment, {**self._defines, **defines}, names)

    def fullscreen(self, program: moderngl.Program) -> moderngl.VertexArray:
        """A program to run over a whole target: `render(vertices=3)`."""
        return self.array(program, [])

    def array(self, program: moderngl.Program, content: list[Any], indices: Any = None) -> moderngl.VertexArray:
        """Vertices under a program, released with the frame."""
        made = self.context.vertex_array(program, content, indices)
        # Several arrays share a program: each releases itself alone.
        self.stack.callback(made.release)
        return made

    def geometry(self, program: moderngl.Program) -> Geometry:
        """A program to draw the scene's meshes with."""
        return Geometry(self, program)

    def state(self, depth: str | None, blend: tuple[int, int] | None = None, cull: str | None = None) -> None:
        """Depth test, blending and culling of the draws that follow; everything else off."""
        flags = moderngl.NOTHING
        if depth:
            self.context.depth_func = depth
            flags |= moderngl.DEPTH_TEST
        if blend:
            self.context.blend_func = blend
            flags |= moderngl.BLEND
        if cull:
            self.context.cull_face = cull
            flags |= moderngl.CULL_FACE
        self.context.enable_only(flags)

    @property
    def gbuffer_textures(self) -> dict[str, Any]:
        """What a pass that reads the G-buffer binds."""
        given: dict[str, Any] = {"gbuffer": self.gbuffer}
        if "depth" not in self.plan.layout.components:
            given["linear_depth"] = self.linear_depth
        return given

    def prepare(self, program: moderngl.Program, size: tuple[int, int], **textures: Any) -> None:
        """Bind what shaders read before a draw into a target of this size: tables, textures, G-buffer, light."""
        self.blocks[size].bind_to_uniform_block(FRAME_BINDING)
        self.scene_buffers.bind()
        given: dict[str, Any] = {"bumps": self.scene_buffers.bumps, **self.tables, **textures}
        if self.shadows:
            given["shadow_map"] = self.shadow_map
        bind(program, given)


class Geometry:
    """The scene's meshes under one program."""

    def __init__(self, frame: Frame, program: moderngl.Program):
        self._frame, self.program = frame, program
        # The compiler drops what nobody reads; its bytes are skipped.
        attributes = {"in_position": 3, "in_normal": 3, "in_tangent": 4, "in_uv": 2}
        form = " ".join(f"{n}f" if name in program else f"{4 * n}x" for name, n in attributes.items())
        read = [name for name in attributes if name in program]
        self._arrays = [
            frame.array(program, [(vertices, form, *read)], triangles)
            for vertices, triangles in frame.scene_buffers.meshes
        ]

    def draw(self, name: str | int, cull: str = "back") -> None:
        """Draw one of the scene's lists, without the "back" or "front" sides of what is closed."""
        buffers, context = self._frame.scene_buffers, self._frame.context
        context.cull_face = cull
        for draw in buffers.draws[name]:
            (context.disable if buffers.two_sided[draw.mesh] else context.enable)(moderngl.CULL_FACE)
            self.program["first"] = draw.first
            self._arrays[draw.mesh].render(moderngl.TRIANGLES, instances=draw.count)


def layout_defines(layout: Layout, rounds: tuple[int, ...]) -> dict[str, object]:
    """The macros that make `gbuffer.glsl` speak of a layout; `rounds` is `shader_roundings`."""
    words = layout.words
    storages = [target.storage for target in layout.targets]
    first = {"DEPTH": "depth", "ALBEDO": "albedo.r", "SPECULAR": "specular.r", "MOTION": "motion.x"}
    first |= {"POWER": "power", "KIND": "kind", "INSTANCE": "instance"}
    widen, bias = PACKINGS[layout.packing]
    return {
        **{name: COMPONENTS.index(component) for name, component in first.items()},
        "NUMBERS": len(COMPONENTS),
        "WORDS": len(words),
        "WORD_COMPONENT": tuple(COMPONENTS.index(word.component) for word in words),
        "WORD_TARGET": tuple(word.target for word in words),
        "WORD_FIRST": tuple(word.first for word in words),
        "WORD_BITS": tuple(word.bits for word in words),
        "TARGETS": len(storages),
        "TARGET_KIND": tuple(storage_kind(storage) for storage in storages),
        "TARGET_SCALE": tuple(float(s.scale(i % s.channels)) for s in storages for i in range(4)),
        "TARGET_BITS": tuple(s.bits[i % s.channels] for s in storages for i in range(4)),
        "TARGET_ROUNDS": rounds,
        "NORMAL_LEVELS": levels_of(layout.encoding),
        "NORMAL_SCALE": layout.normal_scales,
        "NORMAL_BIASED": int(layout.codec.storage.is_biased),
        "PACK_WIDEN": widen,
        "PACK_BIAS": bias,
        "HAS_DEPTH": int("depth" in layout.components),
        "HAS_POWER": int("power" in layout.components),
        "HAS_KIND": int("kind" in layout.components),
        "HAS_INSTANCE": int("instance" in layout.components),
        "WORLD_SPACE": int(layout.space == "world"),
    }


def shader_roundings(device: Device, layout: Layout) -> tuple[int, ...]:
    """For each target 0 where the device rounds as asked, else one more than how `storage.glsl` counts the way."""
    asked = ROUNDINGS.index(layout.rounding) + 1
    return tuple(0 if device.native_rounding(t.storage) == layout.rounding else asked for t in layout.targets)
