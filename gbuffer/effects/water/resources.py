"""Resources that the water passes share, with sizes that depend on the settings, and their shaders' constants."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....encodings import elementary
from ...frame.resource import AS_MANY, DEPTH_STENCIL, Resource
from .grid import FIRST_GAP
from .water_waves import POINTS_A_WAVE, WAVES

# What a codec does to an image is compared here: the colour of the water; alpha is 1 where there is some.
WATER = Resource("water", "rgba32f", samples=AS_MANY)
BEHIND = Resource("water_behind", "r32f", samples=AS_MANY)
MIRROR = Resource("water_mirror", "rgba32f", smooth=True)
MIRROR_DEPTH = Resource("water_mirror_depth", DEPTH_STENCIL)

CONSTANTS = {
    "TURN": float(2 * np.pi),
    "INDEX": 1.333,  # of fresh water, 589 nm, 20 degrees
    "FIRST_GAP": FIRST_GAP,
    "POINTS_A_WAVE": POINTS_A_WAVE,
    "CAUSTIC_SLICES": 5,
    "CAUSTIC_STEP": 0.75,  # metres between two slices; ground deeper than the last is lit as that is
    "BLUR_TAPS": 2,  # on either side, over two standard deviations
    "LEAST_WEIGHT": 0.001,
    # Light in crests, of Island 11: 2.5 max(0, height / 4 + 1 / 4) max(0, -v.l)^2 max(0, 1 - l.n)^8
    "CREST_GAIN": 2.5,
    "CREST_HEIGHT": 0.25,
    "CREST_POWER": 8.0,
}
# Cells of the lattice that carries sunlight to the ground, along a patch, and how many more on each side: light that
# comes in from the next patch starts no farther away.
CELLS, MARGIN = 96, 12


@dataclass(frozen=True)
class Maps:
    """The wave maps and the caustics made from them: volumes with slices of `texels` x `texels`."""

    octaves: int
    texels: int

    @property
    def heights(self) -> Resource:
        """The volume texture that holds the water's height and slope."""
        return Resource("water_heights", "rgba32f", (self.texels, self.texels), depth=self.octaves)

    @property
    def bends(self) -> Resource:
        """The volume texture that holds the second derivatives of the height."""
        return Resource("water_bends", "rgba32f", (self.texels, self.texels), depth=self.octaves)

    @property
    def caustics(self) -> Resource:
        """The volume texture of the ratios of sunlight on the ground to that under still water, one slice per depth."""
        return Resource("water_caustics", "r32f", (self.texels, self.texels), depth=CONSTANTS["CAUSTIC_SLICES"])

    def defines(self, chop: float) -> dict[str, object]:
        """Return the macros for shaders that use the maps; `chop` is the choppiness of the waves."""
        own = {"LEVELS": self.octaves, "TEXELS": self.texels, "WAVE_COUNT": self.octaves * WAVES, "CHOP": float(chop)}
        return {**elementary.CONSTANTS, **CONSTANTS, **own, "CELLS": CELLS, "MARGIN": MARGIN}
