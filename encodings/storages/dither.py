"""Noise that is added to a code before a fixed-point format rounds it. The noise spans a whole step, so that the mean
of the stored values is the code itself, except at the ends of the format's range, where values are clipped. Each
number of a code has its own part of a tile of blue noise.

Moving noise starts at a different pixel of the tile in each frame. These pixels are spread over the tile by the
golden ratio in two dimensions: M. Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .blue_noise import SIZE, blue_noise

# The numbers of a code that moving noise is added to, at most; still noise has a fourth one. And the golden ratio of
# two dimensions, x^3 = x + 1.
NUMBERS, RATIO = 3, 1.3247179572447460


@dataclass(frozen=True)
class Dither:
    """Noise for one frame.

    Attributes:
        steps: distance between neighbouring values of each number in a storage; 0 for a number without noise.
        frame: number of the frame for moving noise; 0 in every frame for still noise.
    """

    steps: tuple[float, ...]
    frame: int = 0

    @property
    def added(self) -> np.ndarray:
        """The noise added to the numbers of a code at each pixel, float32 of shape (SIZE, SIZE, 4); it repeats."""
        noise = np.zeros((SIZE, SIZE, 4), np.float32)
        for number, step in enumerate(self.steps):
            noise[..., number] = (_tile_from(self.frame * NUMBERS + number) - 0.5) * step
        return noise


def laid_out(noise: np.ndarray, width: int, count: int) -> np.ndarray:
    """Return the noise for the codes of `count` pixels in an image `width` pixels wide, row by row, of shape
    (count, 4), as the shader reads it (`dither.glsl`). The noise, of shape (height, width, 4), repeats."""
    rows, columns = np.divmod(np.arange(count), width)
    return noise[rows % noise.shape[0], columns % noise.shape[1]]


def _tile_from(place: int) -> np.ndarray:
    """Return the blue-noise tile, shifted cyclically by an amount that depends on `place`; unshifted for place 0."""
    return np.roll(blue_noise(), [-int(SIZE * (place / RATIO**axis % 1.0)) for axis in (1, 2)], axis=(0, 1))
