"""Noise with a fixed value for each texel: the constants of noise.glsl."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .effect import Number

SEED = Number(0, 0, 65535, "Seed of the noise.")
NOISE: Mapping[str, int] = MappingProxyType(
    {
        "PCG_FACTOR": 1664525,  # of the linear congruential generator of pcg3d (Jarzynski and Olano 2020, listing 7)
        "PCG_SUMMAND": 1013904223,
    }
)
