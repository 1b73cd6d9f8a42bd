"""Blue noise: a tile of numbers, each used once; neighbours differ and no patch stands out.

Method: R. Ulichney, The void-and-cluster method for dither array generation, SPIE 1913, 1993.
"""

from __future__ import annotations

from functools import cache

import numpy as np

SIZE, SEED = 64, 1993
# The article's width of the filter in pixels, and the share of pixels in the pattern that it begins with.
WIDTH, SHARE = 1.5, 0.1


class _Pattern:
    """A set of pixels on a torus, and how much the set crowds each pixel."""

    def __init__(self, pixels: np.ndarray):
        self.pixels = np.zeros(SIZE * SIZE, bool)
        self._crowd = np.zeros(SIZE * SIZE)
        away = np.minimum(np.arange(SIZE), SIZE - np.arange(SIZE))
        self._filter = np.tile(np.exp(-(away[:, None] ** 2 + away**2) / (2 * WIDTH**2)), (2, 2))
        for pixel in pixels:
            self.turn(int(pixel))

    def turn(self, pixel: int) -> None:
        """Set a pixel, given by its row-major index, or clear it if it is already set."""
        y, x = divmod(pixel, SIZE)
        around = self._filter[SIZE - y : 2 * SIZE - y, SIZE - x : 2 * SIZE - x].ravel()
        self._crowd += -around if self.pixels[pixel] else around
        self.pixels[pixel] ^= True

    @property
    def cluster(self) -> int:
        """The index of the most crowded set pixel."""
        return int(np.argmax(np.where(self.pixels, self._crowd, -np.inf)))

    @property
    def void(self) -> int:
        """The index of the least crowded pixel that is not set."""
        return int(np.argmin(np.where(self.pixels, np.inf, self._crowd)))


@cache
def blue_noise() -> np.ndarray:
    """Return evenly spaced numbers in (0, 1), float64 of shape (SIZE, SIZE). The tile repeats without a seam."""
    first = _spread_pattern()
    ranks = np.empty(SIZE * SIZE)
    thinned = _Pattern(first)
    for rank in range(len(first) - 1, -1, -1):
        ranks[thinned.cluster] = rank
        thinned.turn(thinned.cluster)
    filled = _Pattern(first)
    # Where more than half is set the article looks for clusters of what is not: those are the voids again.
    for rank in range(len(first), SIZE * SIZE):
        ranks[filled.void] = rank
        filled.turn(filled.void)
    ranks.flags.writeable = False
    return ((ranks + 0.5) / ranks.size).reshape(SIZE, SIZE)


def _spread_pattern() -> np.ndarray:
    """Return the indices of a fraction SHARE of the pixels, drawn with SEED and moved from clusters to voids until
    none moves."""
    drawn = np.random.default_rng(SEED).choice(SIZE * SIZE, round(SHARE * SIZE * SIZE), replace=False)
    pattern = _Pattern(drawn)
    while True:
        moved = pattern.cluster
        pattern.turn(moved)
        void = pattern.void
        pattern.turn(void)
        if void == moved:
            return np.flatnonzero(pattern.pixels)
