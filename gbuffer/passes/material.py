"""The second geometry pass: materials lit by the accumulated light."""

from functools import partial

from ..frame.canvas import AGAIN, NEAREST, Canvas
from ..frame.contract import Pass, Run
from ..frame.resources import BY_KIND, DEPTH, FINAL, FINAL_DEPTH, LIGHT, SURFACE, TERMS
from ..gl import raw
from ..gl.device import ADD, OVER


def material(draws: str, filters: bool = False) -> Pass:
    """Return the pass that shades surfaces with the light in the light buffer.

    Args:
        draws: which of the scene's lists to draw: "opaque" begins the image, "special" is added to the image with its
            ambient light, and "transparent" is blended over the image.
        filters: whether the light buffer has its own size and is read through the discontinuity-sensitive filter.
    """
    depth = FINAL_DEPTH if filters else DEPTH
    begins = draws == "opaque"
    reads = (LIGHT, *(SURFACE if filters else ()), *(() if begins else (FINAL,)))
    # Behind a filter the G-buffer's depth is another size: depth is drawn anew.
    draws_depth = filters and begins
    expects = {"LIGHT_HOLDS": (BY_KIND,) if draws == "special" else (TERMS,), "FILTERS": (int(filters),)}
    return Pass(
        "transparent" if draws == "transparent" else "material",
        reads=reads if draws_depth else (*reads, depth),
        writes=(FINAL, depth) if draws_depth else (FINAL,),
        build=partial(_filtered if filters else _guarded, draws),
        expects=expects,
    )


def _guarded(draws: str, canvas: Canvas) -> Run:
    """Return a function that shades each sample once, with the G-buffer's depth as the depth buffer."""
    target, surfaces = canvas.target(FINAL, depth=DEPTH), canvas.geometry("geometry.vert", "material.frag")
    context, blend = canvas.device.context, ADD if draws == "special" else None

    def run() -> None:
        target.use()
        canvas.device.state(AGAIN, blend)
        context.enable_direct(raw.STENCIL_TEST)
        raw.once_a_pixel(1)
        canvas.prepare(surfaces.program)
        surfaces.draw(draws)
        context.disable_direct(raw.STENCIL_TEST)
        raw.clear_stencil()

    return run


def _filtered(draws: str, canvas: Canvas) -> Run:
    """Return a function that shades surfaces with the image's own depth buffer; transparent surfaces are blended."""
    target, surfaces = canvas.target(FINAL, depth=FINAL_DEPTH), canvas.geometry("geometry.vert", "material.frag")
    blend = OVER if draws == "transparent" else None

    def run() -> None:
        target.use()
        canvas.device.state(NEAREST, blend)
        canvas.prepare(surfaces.program)
        surfaces.draw(draws)

    return run
