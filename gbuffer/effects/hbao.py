"""Horizon-based ambient occlusion as shipped: taps above the horizon occlude according to angle and distance."""

from __future__ import annotations

import numpy as np

from ..frame.contract import Pass
from .effect import Number
from .noise import SEED
from .occlusion.passes import RADIUS, SIZE, VISIBILITY, AmbientOcclusion, passes


def _passes(size: str, radius: float, directions: int, steps: int, bias: float, seed: int) -> tuple[Pass, ...]:
    macros = {"RADIUS": radius, "DIRECTIONS": directions, "STEPS": steps, "BIAS": bias, "SEED": seed}
    return passes("hbao.frag", size, False, **macros)


def _falloff_weights(distance: np.ndarray) -> np.ndarray:
    return np.maximum(1 - distance**2, 0)


SETTINGS = {
    "size": SIZE,
    "radius": RADIUS,
    "directions": Number(8, 1, 64, "Number of directions on the screen."),
    "steps": Number(4, 1, 64, "Number of taps per direction."),
    "bias": Number(0.1, 0.0, 0.9, "Sine of the angle above the tangent plane below which a tap does not occlude."),
    "seed": SEED,
}
EFFECT = AmbientOcclusion(
    "hbao",
    "horizon-based ambient occlusion, as shipped in HBAO+",
    "Bavoil and Sainz 2008; NVIDIA's gl_ssao sample",
    VISIBILITY,
    _passes,
    SETTINGS,
    falls_off=_falloff_weights,
)
