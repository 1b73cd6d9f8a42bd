"""The settings of scenes, and code that several scenes share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Setting:
    """The settings with which a procedural scene is made.

    Attributes:
        objects, lights: number of objects and of lights, in scenes that use them.
        seed: seed of the random numbers.
        time: position of moving lights on their orbits, 0 to 1.
    """

    objects: int = 200
    lights: int = 64
    seed: int = 0
    time: float = 0.0


def coloured(rng: np.random.Generator, count: int, brightness: float) -> np.ndarray:
    """Return random light colours, (count, 3): any hue, a third white, with `brightness` as the largest channel."""
    hue = rng.uniform(0, 1, count)[:, None]
    wheel = np.clip(np.abs((hue + np.array([0, 2 / 3, 1 / 3])) % 1 * 6 - 3) - 1, 0, 1)
    return brightness * (0.35 + 0.65 * wheel)
