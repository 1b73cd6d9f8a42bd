"""The screen-space pass: ambient light, and finished colour from the light buffer."""

from ..frame.canvas import Canvas
from ..frame.contract import Pass, Run
from ..frame.resources import BY_KIND, COLOURS, DEPTH, FINAL, LIGHT, SHADING, SURFACE


def screen() -> Pass:
    """Return the pass that draws the image of all surfaces. If the light buffer is BY_KIND, special materials receive
    only ambient light."""
    expects = {"LIGHT_HOLDS": (COLOURS, BY_KIND)}
    return Pass("screen", (*SURFACE, LIGHT, DEPTH), (FINAL,), _build, expects=expects, needs=SHADING)


def _build(canvas: Canvas) -> Run:
    return canvas.over("screen.frag", FINAL, depth=DEPTH)
