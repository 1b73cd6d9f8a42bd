"""Blue noise: numbers for the pixels of a tile, each used once; neighbours differ and no patch stands out.

Method: R. Ulichney, The void-and-cluster method for dither array generation, SPIE 1913, 1993.
"""

from __future__ import annotations

from functools import cache

import numpy as np

SIZE, SEED = 64, 1993
# The article's width of the filter in pixels, and the share of pixels in the pattern that it begins with.
WIDTH, SHARE = 1.5, 0.1


class _Pattern:
    """Pixels that are set, and how crowded every pixel is by them, on a torus."""

    def __init__(self, pixels: np.ndarray):
        self.pixels = np.zeros(SIZE * SIZE, bool)
        self._crowd = np.zeros(SIZE * SIZE)
        away = np.minimum(np.arange(SIZE), SIZE - np.arange(SIZE))
        self._filter = np.tile(np.exp(-(away[:, None] ** 2 + away**2) / (2 * WIDTH**2)), (2, 2))
        for pixel in pixels:
            self.turn(int(pixel))

    def turn(self, pixel: int) -> None:
        """Set a pixel, given by its index row by row, or clear it if it is set."""
        y, x = divmod(pixel, SIZE)
        around = self._filter[SIZE - y : 2 * SIZE - y, SIZE - x : 2 * SIZE - x].ravel()
        self._crowd += -around if self.pixels[pixel] else around
        self.pixels[pixel] ^= True

    @property
    def cluster(self) -> int:
        """The index of the most crowded pixel of those that are set."""
        return int(np.argmax(np.where(self.pixels, self._crowd, -np.inf)))

    @property
    def void(self) -> int:
        """The index of the least crowded pixel of those that are not set."""
        return int(np.argmin(np.where(self.pixels, np.inf, self._crowd)))


@cache
def blue_noise() -> np.ndarray:
    """Numbers in (0, 1), evenly spread, float64 of shape (SIZE, SIZE). The tile repeats without a seam."""
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
    """Return the indices of a few pixels, drawn at random and moved from clusters to voids until none moves."""
    drawn = np.random.default_rng(SEED).choice(SIZE * SIZE, round(SHARE * SIZE * SIZE), replace=False)
    pattern = _Pattern(drawn)
    while True:
        moved = pattern.cluster
        pattern.turn(moved)
        void = pattern.void
        pattern.turn(void)
        if void == moved:
            return np.flatnonzero(pattern.pixels)
