"""The passes of screen-space reflections: inverse depths, ray tracing and blending into the image."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

from ...frame.canvas import Canvas
from ...frame.contract import Pass, Run
from ...frame.resource import SURFACES, Resource
from ...frame.resources import DEPTH, FINAL, SURFACE
from ...gl.device import ADD
from ..noise import NOISE

# One over the depth of each pixel's surface, in 1 / m; 0 on the background.
NEAR = Resource("ssr_near", "r32f", follows=SURFACES)
# Light that mirrored rays bring, and the share of the rays that meet something on the screen.
REFLECTED = Resource("reflected", "rgba32f", follows=SURFACES)
# Where the first ray of each pixel meets something: x and y in pixels from the lower left; how often its rays looked at
# the screen; 1, or 0 where the ray meets nothing.
HITS = Resource("ssr_hits", "rgba32f", follows=SURFACES)

CONSTANTS: Mapping[str, Any] = {
    **NOISE,
    "GOLDEN": 0.6180339887498949,
    "HALVINGS": 8,  # of a step that a surface lies in: of the longest to some hundredths of a pixel
    "EDGE": 0.05,  # share of the depth by which four pixels of one surface differ at most
    "SELF": 0.125,  # pixels from its start within which a ray meets what it leaves
    "ROUNDING": 1e-4,  # share of the depth by which a surface is nearer than a depth in 16 bits says
}
# Where the image of what is opaque is finished: of metal/rough surfaces `material` draws none.
AFTER = ("screen",)


def passes(steps: int, rays: int, thickness: float, around: bool, seed: int) -> tuple[Pass, ...]:
    """Return all passes, in order; the arguments are the effect's settings."""
    macros = {"STEPS": steps, "RAYS": rays, "THICKNESS": thickness, "AROUND": int(around), "SEED": seed}
    return (
        Pass("ssr_near", (*SURFACE, DEPTH), (NEAR,), _near, AFTER),
        Pass("ssr", (*SURFACE, NEAR, FINAL), (REFLECTED, HITS), partial(_traced, macros), AFTER),
        Pass("ssr_over", (*SURFACE, DEPTH, REFLECTED, FINAL), (FINAL,), partial(_over, int(around)), AFTER),
    )


def _near(canvas: Canvas) -> Run:
    return canvas.over("ssr_near.frag", NEAR)


def _traced(macros: Mapping[str, Any], canvas: Canvas) -> Run:
    return canvas.over("ssr.frag", REFLECTED, HITS, **CONSTANTS, **macros)


def _over(around: int, canvas: Canvas) -> Run:
    return canvas.over("ssr_over.frag", FINAL, depth=DEPTH, blend=ADD, AROUND=around)
