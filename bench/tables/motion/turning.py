"""The rotations of cameras and objects, and the normals that are followed during them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ....gbuffer.scenes.scene import View

SPACES, MOVES = ("view", "world"), ("camera", "object")
# A turn goes on for this many degrees and back again: what is followed stays before the camera.
SWING_DEG = 32.0
# Normals are spread evenly over z >= LEAST_Z of the first frame's view space. Surfaces that the camera sees more nearly
# edge-on cover few pixels. Figures depend on it: from 0 on, spheremap at 1 degree a frame wobbles by a tenth more.
LEAST_Z = 0.2
# Half the picture's height and width at distance 1: 46 degrees high, 4 by 3.
HALF_HEIGHT = math.tan(math.radians(23.0))
HALF_WIDTH = HALF_HEIGHT * 4 / 3
CHUNK = 2**15
# Additive recurrence in four dimensions, which covers evenly however many are taken: powers of 1/g with g^5 = g + 1
# (M. Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018).
STEPS = 1.1673039782614187 ** -np.arange(1.0, 5.0)
AHEAD = View(eye=(0.0, 0.0, 0.0), target=(0.0, 0.0, -1.0), fov=46.0, near=0.1, far=10.0)


@dataclass(frozen=True)
class Points:
    """Points on surfaces, as seen in the first frame.

    Attributes:
        normals: unit normals, float64 of shape (count, 3).
        positions: in view space, on the plane at distance 1, float64 of shape (count, 3).
    """

    normals: np.ndarray
    positions: np.ndarray


def angles(turn: float, frames: int, swing: float = SWING_DEG) -> np.ndarray:
    """Return the angle at each frame in degrees, (frames,): it grows by `turn` per frame up to `swing`, then shrinks
    to 0, and so on."""
    steps = max(1, math.floor(swing / turn + 1e-9))
    phase = np.arange(frames) % (2 * steps)
    return turn * np.minimum(phase, 2 * steps - phase)


def rotations(axis: str, turn: float, frames: int) -> np.ndarray:
    """Return the rotations from the first frame's view space to the view space of each frame of a turning camera,
    float64 of shape (frames, 3, 3).

    An object that turns the other way has the same effect on its normals.
    """
    return np.stack([AHEAD.turned(axis, angle).matrix()[:3, :3] for angle in angles(turn, frames)])


def points(space: str, count: int, seed: int) -> Iterator[Points]:
    """Yield points in chunks of at most CHUNK.

    A camera may look anywhere in the world, so in world space, normals point in all directions.

    Args:
        space: one of SPACES.
        count: number of points, 1 or more.
        seed: seed for the start of the sequence; a larger count begins with the same points.
    """
    least = LEAST_Z if space == SPACES[0] else -1.0
    low, high = np.array([least, 0, -HALF_WIDTH, -HALF_HEIGHT]), np.array([1, 2 * np.pi, HALF_WIDTH, HALF_HEIGHT])
    shift = np.random.default_rng(seed).uniform(size=len(STEPS))
    for start in range(0, count, CHUNK):
        indices = np.arange(start, min(start + CHUNK, count))
        z, turn, x, y = (low + (high - low) * ((shift + indices[:, None] * STEPS) % 1)).T
        out = np.sqrt(1 - z * z)
        normals = np.stack([out * np.cos(turn), out * np.sin(turn), z], axis=1)
        yield Points(normals, np.stack([x, y, np.full_like(x, -1.0)], axis=1))
