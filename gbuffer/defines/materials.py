"""The numbers of the material model: what `material.glsl`, `light.glsl` and `accumulation.glsl` are given."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from ...encodings import chromaticity
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
        **chromaticity.CONSTANTS,
        "FILTER_DEPTH": 0.03,  # taps within this share of the depth are of the same surface
        "FILTER_COSINE": 0.7,  # and with normals no further apart than this cosine
    }
)
