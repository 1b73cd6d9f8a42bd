"""Depth as seen from the sun; not drawn if the frame has no shadows."""

from ..frame.canvas import NEAREST, Canvas
from ..frame.contract import Pass, Run
from ..frame.resources import SHADOW_MAP

# The shadow map keeps far sides, which shadow no lit side of their own: they are moved away by their slope over one
# texel and a few of the smallest steps, just so that wrapped light on them is not torn by rounding.
SHADOW_OFFSET = (1.0, 4.0)
# What has two sides shadows with both: as far away as the slope reaches over the texels that are compared, corners too.
THIN_SHADOW_OFFSET = (8.0, 16.0)


def shadow_map() -> Pass:
    """Return the pass that draws the depth of shadow casters as seen from the sun: back faces of closed casters, both
    sides of thin casters."""
    return Pass("shadow_map", reads=(), writes=(SHADOW_MAP,), build=_build)


def _build(canvas: Canvas) -> Run:
    target, context = canvas.target(depth=SHADOW_MAP), canvas.device.context
    casters = canvas.geometry("shadow_map.vert", "nothing.frag")

    def run() -> None:
        target.use()
        canvas.device.state(NEAREST)
        canvas.prepare(casters.program)
        # The far sides of what is closed (Wang and Molnar 1994): no lit side can shadow itself.
        context.polygon_offset = SHADOW_OFFSET
        casters.draw("casters", cull="front")
        context.polygon_offset = THIN_SHADOW_OFFSET
        casters.draw("thin casters")
        context.polygon_offset = (0.0, 0.0)

    return run
