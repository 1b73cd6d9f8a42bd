"""The passes that pipelines are made of. Each is built once for a frame and then run as often as wanted.

A stage is a name and a builder: given a frame, it compiles, and returns what to run. No stage knows which pipeline it
is in; what differs between two uses of one stage is an argument.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from . import raw
from .formats import FORMATS
from .frame import SHADOW_SIZE, Frame
from .materials import CONSTANTS
from .scenes.mesh import Mesh, wound
from .scenes.scene import Light
from .volumes import ball, cone

Run = Callable[[], None]

# The shadow map keeps far sides, which shadow no lit side of their own: they are moved away by their slope over one
# texel and a few of the smallest steps, just so that wrapped light on them is not torn by rounding.
SHADOW_OFFSET = (1.0, 4.0)
# What has two sides shadows with both: as far away as the slope reaches over the texels that are compared, corners too.
THIN_SHADOW_OFFSET = (8.0, 16.0)
# What light.frag's ACCUMULATES counts.
ACCUMULATES = ("light", "colour", "by_id")
# Of surfaces that meet in one depth, as the two faces of a silhouette do, the first wins: passes that write the depth
# keep it, passes over that depth change each sample once. Every pass leaves the stencil at 0.
NEAREST, AGAIN = "<", "<="
# Lights are told apart in eight bits of stencil: lamps by 1 to 254 in turn, the sun by 255.
LAMP_NUMBERS = 254
ADD = (moderngl.ONE, moderngl.ONE)
OVER = (moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA)


@dataclass(frozen=True)
class Stage:
    """A pass of a pipeline: its name in tables, and what makes it for a frame."""

    name: str
    build: Callable[[Frame], Run]


def _state(frame: Frame, depth: str | None, blend: tuple[int, int] | None = None, cull: str | None = None) -> None:
    """Depth test, blending and culling of the draws that follow; everything else off."""
    context = frame.context
    flags = moderngl.NOTHING
    if depth:
        context.depth_func = depth
        flags |= moderngl.DEPTH_TEST
    if blend:
        context.blend_func = blend
        flags |= moderngl.BLEND
    if cull:
        context.cull_face = cull
        flags |= moderngl.CULL_FACE
    context.enable_only(flags)


def shadow_map() -> Stage:
    """Depth as the sun sees it; nothing where the frame has no shadows."""

    def build(frame: Frame) -> Run:
        if not frame.shadows:
            return lambda: None
        target = frame.device.owned(frame.stack, frame.context.framebuffer(depth_attachment=frame.shadow_map))
        casters = frame.geometry(frame.program("shadow.vert", "nothing.frag"))

        def run() -> None:
            target.use()
            target.viewport = (0, 0, SHADOW_SIZE, SHADOW_SIZE)
            target.clear(depth=1.0)
            _state(frame, NEAREST)
            frame.prepare(casters.program, frame.plan.size)
            # The far sides of what is closed (Wang and Molnar 1994): no lit side can shadow itself.
            frame.context.polygon_offset = SHADOW_OFFSET
            casters.draw("casters", cull="front")
            frame.context.polygon_offset = THIN_SHADOW_OFFSET
            casters.draw("thin casters")
            frame.context.polygon_offset = (0.0, 0.0)

        return run

    return Stage("shadow_map", build)


def geometry(stipple: bool = False, emissive: str | None = None) -> Stage:
    """The first geometry pass: surfaces to the G-buffer.

    Args:
        stipple: whether transparent surfaces follow, each layer in one pixel of four; else they are left out.
        emissive: whose own light starts the light buffer: "all", "general" or nobody's (None).
    """

    def build(frame: Frame) -> Run:
        targets = [*frame.gbuffer, *frame.light[:1]] if emissive else frame.gbuffer
        target = frame.framebuffer(targets, frame.depth, writes_depth=True)
        shared = {"WRITES_EMISSIVE": int(bool(emissive)), "SPECIAL_APART": str(emissive == "general").lower()}
        opaque = frame.geometry(frame.program("geometry.vert", "gbuffer.frag", STIPPLE=0, **shared))
        glass = frame.geometry(frame.program("geometry.vert", "gbuffer.frag", STIPPLE=1, **shared)) if stipple else None

        def run() -> None:
            target.use()
            target.clear()
            raw.clear_depth_stencil()
            _state(frame, NEAREST)
            frame.prepare(opaque.program, frame.buffer_size)
            opaque.draw("opaque")
            if glass:
                frame.prepare(glass.program, frame.buffer_size)
                glass.draw("transparent")

        return run

    return Stage("geometry", build)


def linear_depth() -> Stage:
    """The native depth buffer resolved to linear view depth; nothing where the layout keeps a depth of its own."""

    def build(frame: Frame) -> Run:
        if "depth" in frame.plan.layout.components:
            return lambda: None
        target = frame.framebuffer([frame.linear_depth])
        resolve = frame.fullscreen(frame.program("fullscreen.vert", "linear_depth.frag"))

        def run() -> None:
            target.use()
            _state(frame, None)
            frame.prepare(resolve.program, frame.buffer_size, native_depth=frame.depth.texture)
            resolve.render(moderngl.TRIANGLES, vertices=3)

        return run

    return Stage("linear_depth", build)


def gbuffer_textures(frame: Frame) -> dict[str, Any]:
    """What a pass that reads the G-buffer binds."""
    given: dict[str, Any] = {"gbuffer": frame.gbuffer}
    if "depth" not in frame.plan.layout.components:
        given["linear_depth"] = frame.linear_depth
    return given


def unpacked(frame: Frame) -> list[moderngl.Texture]:
    """The G-buffer at one sample as passes understand it, on what is covered; 0 elsewhere.

    Returns:
        float textures: position and instance, direction and kind, albedo and specular power, specular colour.
    """
    textures = [frame.texture(frame.buffer_size, FORMATS["rgba32f"], 1) for _ in range(4)]
    target = frame.framebuffer(textures, frame.depth)
    unpack = frame.fullscreen(frame.program("fullscreen.vert", "unpack.frag"))
    target.use()
    target.clear()
    _state(frame, ">")
    frame.prepare(unpack.program, frame.buffer_size, **gbuffer_textures(frame))
    unpack.render(moderngl.TRIANGLES, vertices=3)
    return textures


class LightVolumes:
    """Every light on what its bounds enclose: by the stencil for point and spot lights, the whole screen for a sun.

    Attributes:
        queries: where set, a query around the shading of each local light and not of its marking.
    """

    def __init__(self, frame: Frame, accumulates: str, clears: int):
        self._frame = frame
        self._target = frame.framebuffer(frame.light, frame.depth)
        self._cleared = [frame.framebuffer([texture]) for texture in frame.light[clears:]]
        kind = ACCUMULATES.index(accumulates)
        self._mark = frame.program("volume.vert", "nothing.frag")
        self._shade = frame.program("volume.vert", "light.frag", ACCUMULATES=kind, LIT_BY_SUN=0)
        self._sun = frame.fullscreen(frame.program("fullscreen.vert", "light.frag", ACCUMULATES=kind, LIT_BY_SUN=1))
        self._ball, self._cone = self._upload(ball()), self._upload(cone())
        self.queries: list[moderngl.Query] | None = None

    def _upload(self, bounds: Mesh) -> tuple[moderngl.VertexArray, moderngl.VertexArray]:
        corners = bounds.positions[wound(bounds)].astype(np.float32)
        vertices = self._frame.context.buffer(corners.tobytes())
        self._frame.device.owned(self._frame.stack, vertices)
        mark, shade = (self._frame.array(p, [(vertices, "3f", "in_position")]) for p in (self._mark, self._shade))
        return mark, shade

    def __call__(self) -> None:
        frame = self._frame
        for target in self._cleared:
            target.clear()
        self._target.use()
        textures = gbuffer_textures(frame)
        lights, first = frame.scene_buffers.lights, frame.scene_buffers.first_lamp
        if first:
            self._sunlight(textures)
        frame.context.enable_direct(raw.STENCIL_TEST)
        frame.context.enable_direct(raw.DEPTH_CLAMP)
        for program in (self._mark, self._shade):
            frame.prepare(program, frame.buffer_size, **textures)
        for index in range(first, len(lights)):
            self._local(index, lights[index])
        frame.context.disable_direct(raw.STENCIL_TEST)
        frame.context.disable_direct(raw.DEPTH_CLAMP)

    def _sunlight(self, textures: dict[str, Any]) -> None:
        # The triangle lies at the far plane: it is in front of nothing but the background.
        _state(self._frame, ">", ADD)
        self._frame.prepare(self._sun.program, self._frame.buffer_size, **textures)
        self._sun.render(moderngl.TRIANGLES, vertices=3)

    def _local(self, index: int, light: Light) -> None:
        # Shader and shape go by the same number.
        narrow = light.kind == "spot" and np.float32(np.cos(np.radians(light.outer))) > CONSTANTS["CONE_COSINE"]
        mark, shade = self._cone if narrow else self._ball
        _state(self._frame, "<=")
        raw.mark_volume()
        self._mark["light"] = index
        mark.render()
        # Back faces only: they cover the volume once, and the eye may be inside.
        _state(self._frame, None, ADD, "front")
        raw.shade_marked()
        self._shade["light"] = index
        if self.queries is None:
            shade.render()
            return
        query = self._frame.context.query(samples=True)
        with query:
            shade.render()
        self.queries.append(query)


def lights(accumulates: str) -> Stage:
    """All lights, added up in the light buffer.

    Args:
        accumulates: "light" for a second geometry pass, "colour" that is finished, or "by_id": colour for general
            materials and light for special ones. Colour is added to what the geometry pass began with.
    """
    return Stage("lights", lambda frame: LightVolumes(frame, accumulates, clears=int(accumulates != "light")))


def screen(special_apart: bool) -> Stage:
    """The screen-space pass: ambient light, and finished colour from the light buffer.

    Args:
        special_apart: whether special materials get ambient light only.
    """

    def build(frame: Frame) -> Run:
        target = frame.framebuffer([frame.final], frame.final_depth)
        program = frame.program("fullscreen.vert", "screen.frag", SPECIAL_APART=str(special_apart).lower())
        covered = frame.fullscreen(program)

        def run() -> None:
            target.use()
            target.clear()
            _state(frame, ">")
            frame.prepare(program, frame.buffer_size, light_texels=frame.light, **gbuffer_textures(frame))
            covered.render(moderngl.TRIANGLES, vertices=3)

        return run

    return Stage("screen", build)


def material(draws: str, adds: bool = False, filters: bool = False, blends: bool = False) -> Stage:
    """The second geometry pass: materials under the light that was accumulated.

    Args:
        draws: which of the scene's lists.
        adds: to what is there already, its ambient light included; else the image begins here.
        filters: whether the light buffer has a size of its own, and is read by the discontinuity-sensitive filter.
        blends: whether the surfaces are transparent.
    """

    def build(frame: Frame) -> Run:
        begins = not (adds or blends)
        # Behind a filter the G-buffer's depth is another size: depth is drawn anew.
        target = frame.framebuffer([frame.final], frame.final_depth, writes_depth=filters and begins)
        program = frame.program("geometry.vert", "material.frag", ADDS=int(adds), FILTERS=int(filters))
        surfaces = frame.geometry(program)

        def run() -> None:
            target.use()
            if begins:
                target.clear()
            if begins and filters:
                raw.clear_depth_stencil()
            guarded = not (blends or filters)
            _state(frame, AGAIN if guarded else NEAREST, ADD if adds else OVER if blends else None)
            if guarded:
                frame.context.enable_direct(raw.STENCIL_TEST)
                raw.once_a_pixel(1)
            read = gbuffer_textures(frame) if filters else {}
            frame.prepare(program, frame.buffer_size, light_texels=frame.light, **read)
            if "full_size" in program:
                program["full_size"] = frame.plan.size
            surfaces.draw(draws)
            if guarded:
                frame.context.disable_direct(raw.STENCIL_TEST)
                raw.clear_stencil()

        return run

    return Stage("transparent" if blends else "material", build)


def forward(lights: bool = True) -> Stage:
    """All opaque surfaces, each under all lights at once, or under none of them."""

    def build(frame: Frame) -> Run:
        target = frame.framebuffer([frame.final], frame.final_depth, writes_depth=True)
        surfaces = ForwardSurfaces(frame, lights and bool(frame.scene_buffers.first_lamp))

        def run() -> None:
            target.use()
            target.clear()
            raw.clear_depth_stencil()
            _state(frame, NEAREST)
            surfaces.prepare(base=1.0)
            surfaces.draw("opaque", *(surfaces.lamps if lights else (0, 0)))

        return run

    return Stage("forward" if lights else "ambient", build)


def forward_lights() -> Stage:
    """For each light the opaque surfaces within its reach, added to what is there."""

    def build(frame: Frame) -> Run:
        target = frame.framebuffer([frame.final], frame.final_depth)
        sunlit, lamplit = ForwardSurfaces(frame, True), ForwardSurfaces(frame, False)

        def run() -> None:
            target.use()
            _state(frame, AGAIN, ADD)
            frame.context.enable_direct(raw.STENCIL_TEST)
            if frame.scene_buffers.first_lamp:
                raw.once_a_pixel(LAMP_NUMBERS + 1)
                sunlit.prepare(base=0.0)
                sunlit.draw("opaque", 0, 0)
            lamplit.prepare(base=0.0)
            for lamp in range(*lamplit.lamps):
                number = lamp % LAMP_NUMBERS + 1
                if number == 1:
                    raw.clear_stencil()
                raw.once_a_pixel(number)
                lamplit.draw(lamp, lamp, lamp + 1)
            frame.context.disable_direct(raw.STENCIL_TEST)
            raw.clear_stencil()

        return run

    return Stage("lights", build)


def transparent() -> Stage:
    """Transparent surfaces, farthest first, each under all lights: no deferred pass holds more than one surface."""

    def build(frame: Frame) -> Run:
        target = frame.framebuffer([frame.final], frame.final_depth)
        surfaces = ForwardSurfaces(frame, bool(frame.scene_buffers.first_lamp))

        def run() -> None:
            target.use()
            _state(frame, NEAREST, OVER)
            surfaces.prepare(base=1.0)
            surfaces.draw("transparent", *surfaces.lamps)

        return run

    return Stage("transparent", build)


class ForwardSurfaces:
    """The scene's meshes, lit as they are drawn: by the sun or not, and by a range of lamps."""

    def __init__(self, frame: Frame, by_sun: bool):
        self._frame = frame
        self._program = frame.program("geometry.vert", "forward.frag", LIT_BY_SUN=int(by_sun))
        self._surfaces = frame.geometry(self._program)
        self.lamps = (frame.scene_buffers.first_lamp, len(frame.scene_buffers.lights))

    def prepare(self, base: float) -> None:
        """Bind; `base` is the share of ambient light and the surface's own."""
        self._frame.prepare(self._program, self._frame.plan.size)
        self._program["base"] = base

    def draw(self, name: str | int, first: int, last: int) -> None:
        """Draw one of the scene's lists under lamps `first` to `last` - 1."""
        self._program["lit_by"] = (first, last)
        self._surfaces.draw(name)
