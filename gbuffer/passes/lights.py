"""Lighting of the surfaces in the G-buffer: each light is drawn within its bounds and added to the light buffer."""

from __future__ import annotations

import numpy as np

from ..codecs.light.light_passes import BLEND_OF
from ..defines.materials import CONSTANTS
from ..frame.canvas import AGAIN, COVERED, Canvas, counted
from ..frame.contract import Pass
from ..frame.resource import Resource
from ..frame.resources import BY_KIND, DEPTH, LIGHT, NEXT_LIGHT, SHADING, SHADOW_MAP, SURFACE, TERMS
from ..gl import raw
from ..gl.handles import Query, VertexArray
from ..scenes.mesh import Mesh, wound
from ..scenes.scene import Light
from .light_bounds import ball, cone


def lights(light_holds: int) -> Pass:
    """Return the pass that adds all lights to the light buffer, which is empty before for TERMS and otherwise
    contains the geometry pass's output."""
    begun = () if light_holds == TERMS else (LIGHT,)
    kinds = {"shading_model"} if light_holds == BY_KIND else set()
    return Pass(
        "lights",
        reads=(*SURFACE, SHADOW_MAP, DEPTH, *begun),
        writes=(LIGHT, NEXT_LIGHT),
        build=LightVolumes,
        expects={"LIGHT_HOLDS": (light_holds,)},
        needs=(SHADING if begun else frozenset()) | kinds,
    )


class LightVolumes:
    """The pass that adds every light within its bounds: point and spot lights by stencil, a sun on the whole screen.

    A code that cannot be blended is read from one copy of the light buffer and written to another with the light
    added; a second draw over the same pixels copies it back.

    Attributes:
        queries: the list to which each local light adds a query for its shading, not for its stencil marking; None
            for no queries.
    """

    def __init__(self, canvas: Canvas):
        self._canvas, code = canvas, canvas.plan.light_buffer
        self._reads, self._blend = code.blend == "read", BLEND_OF[code.blend]
        self._target = canvas.target(LIGHT, depth=DEPTH)
        self._next = canvas.target(NEXT_LIGHT, depth=DEPTH) if self._reads else self._target
        self._mark = canvas.program("lights.vert", "nothing.frag")
        self._shade = canvas.program("lights.vert", "lights.frag", LIT_BY_SUN=0)
        self._back = canvas.program("lights.vert", "copy_light.frag") if self._reads else None
        self._sun = canvas.fullscreen("lights.frag", LIT_BY_SUN=1)
        self._sun_back = canvas.fullscreen("copy_light.frag") if self._reads else None
        self._ball, self._cone = self._uploaded_arrays(ball()), self._uploaded_arrays(cone())
        self.queries: list[Query] | None = None

    def _uploaded_arrays(self, bounds: Mesh) -> list[VertexArray]:
        corners = bounds.positions[wound(bounds)].astype(np.float32)
        frame = self._canvas.frame
        vertices = frame.device.owned(frame.stack, frame.context.buffer(corners.tobytes()))
        programs = [self._mark, self._shade, *filter(None, [self._back])]
        return [frame.array(program, [(vertices, "3f", "in_position")]) for program in programs]

    def __call__(self) -> None:
        buffers, context = self._canvas.frame.scene_buffers, self._canvas.device.context
        if buffers.first_lamp:
            self._sunlight()
        context.enable_direct(raw.STENCIL_TEST)
        context.enable_direct(raw.DEPTH_CLAMP)
        for index in range(buffers.first_lamp, len(buffers.lights)):
            self._local(index, buffers.lights[index])
        context.disable_direct(raw.STENCIL_TEST)
        context.disable_direct(raw.DEPTH_CLAMP)

    def _sunlight(self) -> None:
        self._canvas.device.state(COVERED, self._blend)
        self._next.use()
        self._draw(self._sun, LIGHT, vertices=3)
        if self._sun_back:
            self._bring_back(self._sun_back, vertices=3)

    def _draw(self, drawn: VertexArray, before: Resource, vertices: int = -1) -> None:
        """Draw `vertices` of a vertex array, -1 for all; bind the light from `before` if the shaders read it."""
        reads = {"light_before": self._canvas.textures(before)} if self._reads else {}
        self._canvas.prepare(drawn.program, **reads)
        drawn.render(vertices=vertices)

    def _bring_back(self, drawn: VertexArray, vertices: int = -1) -> None:
        self._target.use()
        self._draw(drawn, NEXT_LIGHT, vertices=vertices)

    def _local(self, index: int, light: Light) -> None:
        # Shader and shape go by the same number.
        narrow = light.kind == "spot" and np.float32(np.cos(np.radians(light.outer))) > CONSTANTS["CONE_COSINE"]
        mark, shade, *back = self._cone if narrow else self._ball
        self._canvas.device.state(AGAIN)
        self._next.use()
        raw.mark_volume()
        for program in filter(None, (self._mark, self._shade, self._back)):
            program["light"] = index
        self._draw(mark, LIGHT)
        # Back faces only: they cover the volume once, and the eye may be inside.
        self._canvas.device.state(None, self._blend, "front")
        raw.shade_marked(again=self._reads)
        with counted(self._canvas.device.context, self.queries):
            self._draw(shade, LIGHT)
        for drawn in back:
            raw.shade_marked()
            self._bring_back(drawn)
