"""Transparent surfaces, drawn farthest first and lit by all lights: a G-buffer stores one surface per pixel."""

from ..frame.canvas import NEAREST, Canvas
from ..frame.contract import Pass, Run
from ..frame.resources import DEPTH, FINAL, SHADOW_MAP
from ..gl.device import OVER
from .forward_surfaces import ForwardSurfaces


def transparent() -> Pass:
    """Return the pass that draws transparent surfaces over the image, farthest first and lit by all lights."""
    return Pass("transparent", (FINAL, DEPTH, SHADOW_MAP), (FINAL,), _build)


def _build(canvas: Canvas) -> Run:
    target = canvas.target(FINAL, depth=DEPTH)
    surfaces = ForwardSurfaces(canvas, bool(canvas.frame.scene_buffers.first_lamp))

    def run() -> None:
        target.use()
        canvas.device.state(NEAREST, OVER)
        surfaces.prepare(base=1.0)
        surfaces.draw("transparent", *surfaces.lamps)

    return run
