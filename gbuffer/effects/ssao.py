"""Crytek's ambient occlusion: points around the surface, tested against the depth buffer as in front or behind."""

from __future__ import annotations

import numpy as np

from ..frame.contract import Pass
from .effect import Number
from .noise import SEED
from .occlusion.passes import RADIUS, SIZE, VISIBILITY, AmbientOcclusion, passes


def _passes(size: str, radius: float, taps: int, bias: float, seed: int) -> tuple[Pass, ...]:
    return passes("ssao.frag", size, False, RADIUS=radius, TAPS=taps, BIAS=bias, SEED=seed)


def _falloff_weights(distance: np.ndarray) -> np.ndarray:
    # A direction's point lies anywhere up to the radius: it is behind a surface at `distance` with this probability.
    return np.maximum(1 - distance, 0)


SETTINGS = {
    "size": SIZE,
    "radius": RADIUS,
    "taps": Number(16, 1, 1024, "Number of points in the hemisphere above each pixel."),
    "bias": Number(0.01, 0.0, 1.0, "Distance in metres that a point must be behind a surface to be occluded."),
    "seed": SEED,
}
EFFECT = AmbientOcclusion(
    "ssao",
    "ambient occlusion by points in the hemisphere above a surface",
    "Mittring, Finding Next Gen: CryEngine 2, 2007; points flipped into the hemisphere of the normal",
    VISIBILITY,
    _passes,
    SETTINGS,
    falls_off=_falloff_weights,
)
