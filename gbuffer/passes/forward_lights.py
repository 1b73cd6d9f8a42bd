"""Opaque surfaces drawn once for each light that reaches them, and added to the image."""

from ..frame.canvas import AGAIN, Canvas
from ..frame.contract import Pass, Run
from ..frame.resources import DEPTH, FINAL, SHADOW_MAP
from ..gl import raw
from ..gl.device import ADD
from .forward_surfaces import ForwardSurfaces

# Lights are told apart in eight bits of stencil: lamps by 1 to 254 in turn, the sun by 255.
LAMP_NUMBERS = 254


def forward_lights() -> Pass:
    """Return the pass that draws opaque surfaces once per light."""
    return Pass("lights", (FINAL, DEPTH, SHADOW_MAP), (FINAL,), _build)


def _build(canvas: Canvas) -> Run:
    target, context = canvas.target(FINAL, depth=DEPTH), canvas.device.context
    sunlit, lamplit = ForwardSurfaces(canvas, True), ForwardSurfaces(canvas, False)

    def run() -> None:
        target.use()
        canvas.device.state(AGAIN, ADD)
        context.enable_direct(raw.STENCIL_TEST)
        if canvas.frame.scene_buffers.first_lamp:
            raw.once_a_pixel(LAMP_NUMBERS + 1)
            sunlit.prepare(base=0.0)
            sunlit.draw("opaque", 0, 0)
        _draw_lamps(lamplit)
        context.disable_direct(raw.STENCIL_TEST)
        raw.clear_stencil()

    return run


def _draw_lamps(surfaces: ForwardSurfaces) -> None:
    surfaces.prepare(base=0.0)
    for lamp in range(*surfaces.lamps):
        number = lamp % LAMP_NUMBERS + 1
        if number == 1:
            raw.clear_stencil()
        raw.once_a_pixel(number)
        surfaces.draw(lamp, lamp, lamp + 1)
