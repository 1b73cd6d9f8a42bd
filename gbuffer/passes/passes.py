"""The passes that pipelines are made of. Each is built once for a frame and then run as often as wanted.

A stage is a name and a builder: given a frame, it compiles, and returns what to run. No stage knows which pipeline it
is in; what differs between two uses of one stage is an argument.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import moderngl

from ...encodings.storages.storage import FORMATS
from ..codecs.light_passes import ADD
from ..frame.frame import SHADOW_SIZE, Frame
from ..gl import raw
from .light_volumes import LightVolumes

Run = Callable[[], None]

# The shadow map keeps far sides, which shadow no lit side of their own: they are moved away by their slope over one
# texel and a few of the smallest steps, just so that wrapped light on them is not torn by rounding.
SHADOW_OFFSET = (1.0, 4.0)
# What has two sides shadows with both: as far away as the slope reaches over the texels that are compared, corners too.
THIN_SHADOW_OFFSET = (8.0, 16.0)
# Of surfaces that meet in one depth, as the two faces of a silhouette do, the first wins: passes that write the depth
# keep it, passes over that depth change each sample once. Every pass leaves the stencil at 0.
NEAREST, AGAIN = "<", "<="
# Lights are told apart in eight bits of stencil: lamps by 1 to 254 in turn, the sun by 255.
LAMP_NUMBERS = 254
OVER = (moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA)


@dataclass(frozen=True)
class Stage:
    """A pass of a pipeline: its name in tables, and what makes it for a frame."""

    name: str
    build: Callable[[Frame], Run]


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
            frame.state(NEAREST)
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
            frame.state(NEAREST)
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
            frame.state(None)
            frame.prepare(resolve.program, frame.buffer_size, native_depth=frame.depth.texture)
            resolve.render(moderngl.TRIANGLES, vertices=3)

        return run

    return Stage("linear_depth", build)


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
    frame.state(">")
    frame.prepare(unpack.program, frame.buffer_size, **frame.gbuffer_textures)
    unpack.render(moderngl.TRIANGLES, vertices=3)
    return textures


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
            frame.state(">")
            frame.prepare(program, frame.buffer_size, light_texels=frame.light, **frame.gbuffer_textures)
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
            frame.state(AGAIN if guarded else NEAREST, ADD if adds else OVER if blends else None)
            if guarded:
                frame.context.enable_direct(raw.STENCIL_TEST)
                raw.once_a_pixel(1)
            read = frame.gbuffer_textures if filters else {}
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
            frame.state(NEAREST)
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
            frame.state(AGAIN, ADD)
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
            frame.state(NEAREST, OVER)
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
