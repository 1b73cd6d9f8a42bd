"""The first geometry pass, which draws surfaces to the G-buffer."""

from functools import partial

from ..frame.canvas import NEAREST, Canvas
from ..frame.contract import Pass, Run
from ..frame.resources import DEPTH, GBUFFER, LIGHT, TERMS


def geometry(light_holds: int, stipple: bool = False) -> Pass:
    """Return the pass that draws opaque surfaces to the G-buffer and, unless it holds TERMS, to the light buffer.

    Args:
        light_holds: the content of the light buffer: TERMS, COLOURS or BY_KIND.
        stipple: whether the G-buffer and the light buffer have their own size, which later passes filter, and
            transparent surfaces are drawn as well, each layer in one of four pixels.
    """
    writes = (GBUFFER, DEPTH, *((LIGHT,) if light_holds != TERMS else ()))
    tells = {"LIGHT_HOLDS": light_holds, "FILTERS": int(stipple)}
    return Pass("geometry", reads=(), writes=writes, build=partial(_build, stipple, writes), tells=tells)


def _build(stipple: bool, writes: tuple, canvas: Canvas) -> Run:
    colours = [resource for resource in writes if resource != DEPTH]
    # Of the light buffer's two targets the first is for what surfaces give off.
    target = canvas.target(*colours, depth=DEPTH, most=len(canvas.textures(GBUFFER)) + (LIGHT in writes))
    opaque = canvas.geometry("geometry.vert", "geometry.frag", STIPPLE=0)
    glass = canvas.geometry("geometry.vert", "geometry.frag", STIPPLE=1) if stipple else None

    def run() -> None:
        target.use()
        canvas.device.state(NEAREST)
        canvas.prepare(opaque.program)
        opaque.draw("opaque")
        if glass:
            canvas.prepare(glass.program)
            glass.draw("transparent")

    return run
