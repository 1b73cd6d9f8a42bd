"""Points that move over the screen, with their motion vector in each frame.

Point i of N, at speed s: its first direction is 2 pi (i + u) / N, and in frame t of 16 its motion is, in pixels,

    s (1 + a / 10) (1 + sin(2 pi (t / 16 + p)) / 10)    at the first direction plus t times d

with u and p random in [0, 1], a in [-1, 1] and d in [-2, 2] degrees, each fixed for the point. Thus the speed differs
between points, and both speed and direction change a little from frame to frame: no single code decides a figure.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

FRAMES = 16
SPREAD, SWING, TURN = 0.1, 0.1, np.radians(2.0)
# Points at once: with all their frames 2^16 motions.
POINTS = 2**12


@dataclass(frozen=True)
class Paths:
    """Moving points on a screen.

    Attributes:
        count: number of points.
        seed: seed for the points.
        size: size of the image in pixels.
    """

    count: int
    seed: int
    size: tuple[int, int]

    def chunks(self, speed: float) -> Iterator[np.ndarray]:
        """Yield the motions at a speed in pixels per frame, for up to POINTS points at a time: float32 in screens, of
        shape (FRAMES, points, 2)."""
        for start in range(0, self.count, POINTS):
            yield (self._motions_px(start, speed) / self.size).astype(np.float32)

    def _motions_px(self, start: int, speed: float) -> np.ndarray:
        some = min(self.count - start, POINTS)
        u, a, d, p = np.random.default_rng([self.seed, start]).random((4, some))
        frame = np.arange(FRAMES)[:, None]
        # s (1 + a / 10) (1 + sin(2 pi (t / 16 + p)) / 10)
        length = speed * (1 + SPREAD * (2 * a - 1)) * (1 + SWING * np.sin(2 * np.pi * (frame / FRAMES + p)))
        angle = 2 * np.pi * (start + np.arange(some) + u) / self.count + frame * TURN * (2 * d - 1)
        return length[..., None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
