"""Lights on what the G-buffer holds: each on what its bounds enclose, added up in the light buffer."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import moderngl
import numpy as np

from ..codecs.light_passes import BLEND_OF
from ..defines.materials import CONSTANTS
from ..frame.frame import Frame
from ..gl import raw
from ..scenes.mesh import Mesh, wound
from ..scenes.scene import Light
from .volumes import ball, cone

# What lights.frag's ACCUMULATES counts.
ACCUMULATES = ("light", "colour", "by_id")


class LightVolumes:
    """Every light on what its bounds enclose: by the stencil for point and spot lights, the whole screen for a sun.

    A code that cannot be blended is read from one copy of the light buffer and written to another with the light added;
    a second draw over the same pixels brings it back.

    Attributes:
        queries: where set, a query around the shading of each local light and not of its marking.
    """

    def __init__(self, frame: Frame, accumulates: str, clears: int):
        self._frame = frame
        code = frame.plan.light_buffer
        self._reads, self._blend, self._no_light = code.blend == "read", BLEND_OF[code.blend], code.no_light
        self._target = frame.framebuffer(frame.light, frame.depth)
        self._next = frame.framebuffer(frame.next_light, frame.depth) if self._reads else self._target
        self._cleared = [frame.framebuffer([texture]) for texture in frame.light[clears:]]
        kind = ACCUMULATES.index(accumulates)
        self._mark = frame.program("lights.vert", "nothing.frag")
        self._shade = frame.program("lights.vert", "lights.frag", ACCUMULATES=kind, LIT_BY_SUN=0)
        self._back = frame.program("lights.vert", "copy_light.frag") if self._reads else None
        self._sun = frame.fullscreen(frame.program("fullscreen.vert", "lights.frag", ACCUMULATES=kind, LIT_BY_SUN=1))
        self._sun_back = frame.fullscreen(frame.program("fullscreen.vert", "copy_light.frag")) if self._reads else None
        self._ball, self._cone = self._upload(ball()), self._upload(cone())
        self.queries: list[moderngl.Query] | None = None

    def _upload(self, bounds: Mesh) -> list[moderngl.VertexArray]:
        corners = bounds.positions[wound(bounds)].astype(np.float32)
        vertices = self._frame.context.buffer(corners.tobytes())
        self._frame.device.owned(self._frame.stack, vertices)
        programs = [self._mark, self._shade, *filter(None, [self._back])]
        return [self._frame.array(program, [(vertices, "3f", "in_position")]) for program in programs]

    def __call__(self) -> None:
        frame = self._frame
        none = self._no_light
        for target in self._cleared:
            target.clear(none, none, none, none)
        textures = frame.gbuffer_textures | {"light_before": frame.light}
        lights, first = frame.scene_buffers.lights, frame.scene_buffers.first_lamp
        if first:
            self._sunlight(textures)
        frame.context.enable_direct(raw.STENCIL_TEST)
        frame.context.enable_direct(raw.DEPTH_CLAMP)
        for index in range(first, len(lights)):
            self._local(index, lights[index], textures)
        frame.context.disable_direct(raw.STENCIL_TEST)
        frame.context.disable_direct(raw.DEPTH_CLAMP)

    def _sunlight(self, textures: dict[str, Any]) -> None:
        # The triangle lies at the far plane: it is in front of nothing but the background.
        self._frame.state(">", self._blend)
        self._next.use()
        self._frame.prepare(self._sun.program, self._frame.buffer_size, **textures)
        self._sun.render(moderngl.TRIANGLES, vertices=3)
        if self._sun_back:
            self._bring_back(self._sun_back, vertices=3)

    def _bring_back(self, drawn: moderngl.VertexArray, vertices: int = -1) -> None:
        self._target.use()
        self._frame.prepare(drawn.program, self._frame.buffer_size, light_before=self._frame.next_light)
        drawn.render(moderngl.TRIANGLES, vertices=vertices)

    def _local(self, index: int, light: Light, textures: dict[str, Any]) -> None:
        # Shader and shape go by the same number.
        narrow = light.kind == "spot" and np.float32(np.cos(np.radians(light.outer))) > CONSTANTS["CONE_COSINE"]
        mark, shade, *back = self._cone if narrow else self._ball
        self._frame.state("<=")
        self._next.use()
        raw.mark_volume()
        for program in filter(None, (self._mark, self._shade, self._back)):
            program["light"] = index
        self._frame.prepare(self._mark, self._frame.buffer_size)
        mark.render()
        # Back faces only: they cover the volume once, and the eye may be inside.
        self._frame.state(None, self._blend, "front")
        raw.shade_marked(again=self._reads)
        self._frame.prepare(self._shade, self._frame.buffer_size, **textures)
        with self._counted():
            shade.render()
        for drawn in back:
            raw.shade_marked()
            self._bring_back(drawn)

    @contextmanager
    def _counted(self) -> Iterator[None]:
        if self.queries is None:
            yield
            return
        self.queries.append(self._frame.context.query(samples=True))
        with self.queries[-1]:
            yield
