"""The screen-space pass: ambient light, and finished colour from the light buffer."""

from ..frame.canvas import Canvas
from ..frame.contract import Pass, Run
from ..frame.resources import BY_KIND, COLOURS, DEPTH, FINAL, LIGHT, SHADING, SURFACE


def screen() -> Pass:
    """The image of all surfaces; of special materials only the ambient light if the light buffer is BY_KIND."""
    expects = {"LIGHT_HOLDS": (COLOURS, BY_KIND)}
    return Pass("screen", (*SURFACE, LIGHT, DEPTH), (FINAL,), _build, expects=expects, needs=SHADING)


def _build(canvas: Canvas) -> Run:
    return canvas.over("screen.frag", FINAL, depth=DEPTH)
