"""Opaque surfaces, drawn once: lit by all lights at once, or by ambient light only."""

from functools import partial

from ..frame.canvas import NEAREST, Canvas
from ..frame.contract import Pass, Run
from ..frame.resources import DEPTH, FINAL, SHADOW_MAP
from .forward_surfaces import ForwardSurfaces


def forward() -> Pass:
    """Return the pass that draws all opaque surfaces, lit by all lights."""
    return Pass("forward", (SHADOW_MAP,), (FINAL, DEPTH), partial(_build, True))


def ambient() -> Pass:
    """Return the pass that draws all opaque surfaces with ambient light only; later passes add the lights."""
    return Pass("ambient", (), (FINAL, DEPTH), partial(_build, False))


def _build(lights: bool, canvas: Canvas) -> Run:
    target = canvas.target(FINAL, depth=DEPTH)
    surfaces = ForwardSurfaces(canvas, lights and bool(canvas.frame.scene_buffers.first_lamp))

    def run() -> None:
        target.use()
        canvas.device.state(NEAREST)
        surfaces.prepare(base=1.0)
        surfaces.draw("opaque", *(surfaces.lamps if lights else (0, 0)))

    return run
