"""Ground-truth ambient occlusion: the exact cosine-weighted visibility between two horizons, slice by slice.

XeGTAO adds adjustments made by eye: a power of 2.2, |m| moved towards 1 by 0.05, a floor of 0.03, and a fade where
the radius is small on the screen. Of these, only the power is implemented; by default it is 1. Mip levels of depth
and the denoiser are left out. `radius` is XeGTAO's radius times 1.457: the distance beyond which nothing occludes.
"""

from __future__ import annotations

import numpy as np

from ...encodings import elementary
from ..frame.contract import Pass
from .effect import Number
from .noise import SEED
from .occlusion.passes import RADIUS, SIZE, VISIBILITY, AmbientOcclusion, passes

CONSTANTS = {
    **elementary.CONSTANTS,
    "FALL_OFF": 0.615,  # the share of the radius over which occlusion fades out (XeGTAO.h, DefaultFalloffRange)
    "STEP_POWER": 2.0,  # taps are denser near the pixel (SampleDistributionPower)
    "FIRST": 1.3,  # pixels to the first tap
    "NEARER": 0.99999,  # the surface is drawn towards the eye, so that rounding does not make it occlude itself
    "GOLDEN": 0.6180339887498949,
}


def _passes(size: str, radius: float, slices: int, steps: int, power: float, seed: int) -> tuple[Pass, ...]:
    macros = {"RADIUS": radius, "SLICES": slices, "STEPS": steps, "FINAL_POWER": power, "SEED": seed}
    return passes("gtao.frag", size, True, **macros, **CONSTANTS)


def _falloff_weights(distance: np.ndarray) -> np.ndarray:
    return np.clip((1 - distance) / CONSTANTS["FALL_OFF"], 0, 1)


SETTINGS = {
    "size": SIZE,
    "radius": RADIUS,
    "slices": Number(3, 1, 128, "Number of slices through the line of sight."),
    "steps": Number(3, 1, 128, "Number of taps per slice on each side."),
    "power": Number(1.0, 0.1, 10.0, "Exponent of the result; XeGTAO uses 2.2."),
    "seed": SEED,
}
EFFECT = AmbientOcclusion(
    "gtao",
    "ground-truth ambient occlusion, with bent normals",
    "Jimenez, Wu, Pesce and Jarabo 2016; Intel's XeGTAO",
    VISIBILITY,
    _passes,
    SETTINGS,
    falls_off=_falloff_weights,
)
