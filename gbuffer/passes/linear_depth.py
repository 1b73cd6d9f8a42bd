"""The native depth buffer resolved to linear view depth, unless the layout stores its own depth."""

from ..frame.canvas import Canvas
from ..frame.contract import Pass, Run
from ..frame.resources import DEPTH, LINEAR_DEPTH


def linear_depth() -> Pass:
    """Return the pass that resolves the native depth to linear view depth, for layouts that store no depth."""
    return Pass("linear_depth", reads=(DEPTH,), writes=(LINEAR_DEPTH,), build=_build)


def _build(canvas: Canvas) -> Run:
    return canvas.over("linear_depth.frag", LINEAR_DEPTH)
