"""The final image; each pixel is the mean of its samples."""

from ..frame.canvas import Canvas
from ..frame.contract import Pass, Run
from ..frame.resource import Resource
from ..frame.resources import FINAL

RESOLVED = Resource("resolved", "rgba32f")


def _build(canvas: Canvas) -> Run:
    return canvas.over("resolve.frag", RESOLVED, SAMPLES=canvas.plan.samples)


RESOLVE = Pass("resolve", (FINAL,), (RESOLVED,), _build)
