"""The waves of a sheet of water: a sum of cosines that repeats in space and in time (see water_waves.frag).

Tessendorf, Simulating Ocean Water, 2001: the dispersion of deep water, w^2 = g k, with frequencies rounded so that
all waves repeat together. The spectrum is not measured: every octave has nearly the same slope.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...scenes.scene import Water

# The longest waves: how many of them are in a patch. Each octave's are up to half as long as those of the one before.
FIRST = 1.5
OCTAVES = 5
# Of each octave.
WAVES = 8
# Directions scatter around the heading by this many radians, by a normal distribution.
SPREAD = 0.7
# The slope of a wave falls with this power of its number in a patch.
FALL = 0.25
GRAVITY = 9.80665
# Points of a lattice that the shortest wave of a level has at least: fewer would not show it.
POINTS_A_WAVE = 4.0


@dataclass(frozen=True)
class Waves:
    """eta(x, z) = sum of a cos(2 pi (n . (x, z) / patch - phase)), the longest waves first.

    Attributes:
        numbers: n, (waves, 2), integers: waves per patch along x and z.
        heights: a, (waves,), in metres.
        phases: (waves,), in turns, at the scene's moment.
        patch: side of the patch, in metres.
    """

    numbers: np.ndarray
    heights: np.ndarray
    phases: np.ndarray
    patch: float

    @property
    def wave_numbers(self) -> np.ndarray:
        """Wave vectors k, (waves, 2), in radians per metre."""
        return 2 * np.pi * self.numbers / self.patch

    @property
    def deviation(self) -> float:
        """Standard deviation of the height, in metres."""
        # The mean of (a cos)^2 is a^2 / 2.
        return float(np.sqrt(np.sum(self.heights**2) / 2))

    @property
    def slopes(self) -> np.ndarray:
        """Mean square slopes, (octaves + 1,): for all waves, then with one more octave of the shortest waves left out
        each time; the last, for no waves, is 0."""
        each = (self.heights**2 * np.sum(self.wave_numbers**2, axis=1) / 2).reshape(-1, WAVES).sum(axis=1)
        return np.append(np.cumsum(each)[::-1], 0.0)

    @property
    def table(self) -> np.ndarray:
        """Input for the shader, (waves, 4), float32: wave number n (x, y), height a and phase, from 0 to 1."""
        return np.column_stack([self.numbers, self.heights, self.phases % 1.0]).astype(np.float32)


def waves_of(water: Water, octaves: int, seed: int, strength: float) -> Waves:
    """Return the waves of a sheet of water at its moment: the `octaves` longest octaves, with random numbers from
    `seed` and slopes multiplied by `strength`."""
    rng = np.random.default_rng(seed)
    octave = np.repeat(np.arange(OCTAVES), WAVES)
    size = FIRST * 2.0 ** (octave + rng.uniform(0, 1, len(octave)))
    way = np.radians(water.heading) + SPREAD * rng.standard_normal(len(octave))
    phases, used = rng.uniform(0, 1, len(octave)), octave < octaves
    numbers = np.round(size[:, None] * np.stack([np.cos(way), np.sin(way)], axis=1))[used]
    count = np.linalg.norm(numbers, axis=1)
    k = 2 * np.pi * count / water.patch
    # Of the root mean square slope the given one: sum of (a k)^2 / 2 = slope^2
    steep = count**-FALL
    steep *= strength * water.slope * np.sqrt(2 / np.sum(steep**2))
    # w = sqrt(g k), in whole turns a period
    turns = np.maximum(np.round(np.sqrt(GRAVITY * k) * water.period / (2 * np.pi)), 1)
    return Waves(numbers, steep / k, phases[used] + turns * (water.time / water.period), water.patch)


def shortest(patch: float, octaves: int) -> float:
    """Return the length of the shortest waves, in metres, before wave numbers are rounded."""
    return patch / (FIRST * 2**octaves)
