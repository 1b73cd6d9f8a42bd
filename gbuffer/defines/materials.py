"""Constants of the material model for `material.glsl`, `light.glsl` and `accumulation.glsl`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from ...encodings.shared import chromaticity
from ..scenes.metal_rough import DIELECTRIC
from ..scenes.scene import KINDS, LIGHT_KINDS

CONSTANTS: Mapping[str, Any] = MappingProxyType(
    {
        **{kind.upper(): number for number, kind in enumerate(KINDS)},
        **{kind.upper(): number for number, kind in enumerate(LIGHT_KINDS)},
        "SKIN_WRAP": 0.5,  # how far light reaches around: to a cosine of -0.5
        "COAT_F0": 0.04,  # a coat of index 1.5, seen straight on
        "BASE_POWER": 12.0,  # the broad lobe of a glossy material's metallic base
        "BASE_SHARE": 0.3,  # and how much of it
        "LIGHT_PASS_POWER": 32.0,  # the light pass's specular power where the G-buffer keeps none
        "CONE_COSINE": 0.17,  # of the half angle of the widest spot drawn as a cone; wider ones are drawn as balls
        "LOG2_POWER_MAX": 11.0,  # powers up to 2048 are stored by their logarithm in fixed-point formats
        "PI": math.pi,
        "DIELECTRIC": DIELECTRIC,  # of a metal/rough surface whose layout does not keep its reflectance
        "LEAST_FACING": 1e-4,  # of n.v: a normal that was decoded may face away
        "SCHLICK_MEAN": 1 / 21,  # of (1 - cosine)^5 over the hemisphere, by the cosine
        "PIXEL_VARIANCE": 1 / (2 * math.pi),  # of a pixel's Gaussian footprint, in pixels squared
        "MOST_WIDENED": 0.18,  # of alpha squared, by specular antialiasing
        "MOST_TAPS": 8.0,  # along the longer side of a pixel's footprint on a map
        **chromaticity.CONSTANTS,
        "FILTER_DEPTH": 0.03,  # taps within this share of the depth are of the same surface
        "FILTER_COSINE": 0.7,  # and with normals no further apart than this cosine
    }
)
