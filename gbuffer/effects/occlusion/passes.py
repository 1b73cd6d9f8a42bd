"""The passes of an ambient occlusion method: depths for its taps, the occlusion itself and, at half size, upsampling.

All methods write the same resource, VISIBILITY, and give their passes the same names, so that a pipeline can use any
of the methods and their times can be compared.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...frame.canvas import Canvas
from ...frame.contract import Pass, Run
from ...frame.resource import SURFACES, Resource
from ...frame.resources import DEPTH, SURFACE
from ..effect import Choice, Effect, Number
from ..noise import NOISE

# The share of ambient light that arrives at a pixel of the G-buffer; 1 on the background. `indirect.glsl` reads it.
VISIBILITY = Resource("visibility", "r32f", follows=SURFACES)
HALF_VISIBILITY = Resource("half_visibility", "r32f", scale=0.5, follows=SURFACES)
# The mean direction from which light arrives, view space, unit; zero on the background.
BENT_NORMAL = Resource("bent_normal", "rgba32f", follows=SURFACES)
HALF_BENT_NORMAL = Resource("half_bent_normal", "rgba32f", scale=0.5, follows=SURFACES)
# Depth in metres whatever the layout keeps; 0 where nothing is covered. Many taps read it, few read a normal.
OCCLUDERS = Resource("occluder_depth", "r32f", follows=SURFACES)

SIZE = Choice(("full", "half"), "Size of the occlusion buffer relative to the G-buffer.")
RADIUS = Number(1.0, 0.01, 100.0, "Distance in metres beyond which nothing occludes.")

CONSTANTS: Mapping[str, float] = {
    "PI": math.pi,
    **NOISE,
    "NORMAL_POWER": 32.0,  # how alike normals must be for upsampling: half the weight at 12 degrees
}


@dataclass(frozen=True, kw_only=True, eq=False)
class AmbientOcclusion(Effect):
    """An ambient occlusion method.

    Attributes:
        falls_off: function that returns the share of a direction's light that a surface blocks at a given distance.
            It takes distances in units of the radius, an array of any shape, 0 or more, and returns numbers from 0 to
            1, which are 0 for distances of 1 or more. The ray caster that checks the method weights its hits with it.
    """

    falls_off: Callable[[np.ndarray], np.ndarray]


def passes(shader: str, size: str, bends: bool, **macros: float) -> tuple[Pass, ...]:
    """Return the passes of one method.

    Args:
        shader: the method's shader, which writes visibility and, if `bends`, the bent normal.
        size: "full" or "half".
        bends: whether the method writes a bent normal.
        macros: macros for the shader, in addition to CONSTANTS.
    """
    whole = (VISIBILITY, BENT_NORMAL) if bends else (VISIBILITY,)
    half = (HALF_VISIBILITY, HALF_BENT_NORMAL) if bends else (HALF_VISIBILITY,)
    # What the passes behind may read once it is all there.
    tells = {"HAS_VISIBILITY": 1, **({"HAS_BENT_NORMAL": 1} if bends else {})}
    depths = _pass("occluder_depth", (*SURFACE, DEPTH), (OCCLUDERS,), "occluder_depth.frag", {})
    reads = (*SURFACE, OCCLUDERS)
    if size == SIZE.words[0]:
        return depths, _pass("ambient_occlusion", reads, whole, shader, macros, tells)
    upsampled = {"BENDS": int(bends)}
    return (
        depths,
        _pass("ambient_occlusion", reads, half, shader, macros),
        _pass("ambient_occlusion_upsampling", (*reads, *half), whole, "upsample.frag", upsampled, tells),
    )


def _pass(
    name: str,
    reads: tuple[Resource, ...],
    writes: tuple[Resource, ...],
    shader: str,
    macros: Mapping[str, float],
    tells: Mapping[str, int] | None = None,
) -> Pass:
    build = partial(_build, shader, writes, {**CONSTANTS, **macros})
    return Pass(name, reads, writes, build, after=("linear_depth",), tells=tells or {})


def _build(shader: str, writes: tuple[Resource, ...], macros: Mapping[str, Any], canvas: Canvas) -> Run:
    return canvas.over(shader, *writes, **macros)
