"""The G-buffer unpacked as passes read it, at one sample per pixel; 0 on pixels without a surface."""

from ..frame.canvas import Canvas
from ..frame.contract import Pass, Run
from ..frame.resource import SURFACES, Resource
from ..frame.resources import DEPTH, SURFACE

# Position and instance, direction and kind, albedo and specular power or roughness, specular colour and occlusion.
NAMES = ("unpacked_position", "unpacked_direction", "unpacked_albedo", "unpacked_specular")
UNPACKED = tuple(Resource(name, "rgba32f", follows=SURFACES) for name in NAMES)


def _build(canvas: Canvas) -> Run:
    return canvas.over("unpack.frag", *UNPACKED, depth=DEPTH)


UNPACK = Pass("unpack", (*SURFACE, DEPTH), UNPACKED, _build)
