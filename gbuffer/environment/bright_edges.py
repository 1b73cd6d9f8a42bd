"""Two dim environments with bright, sharp-edged lights, in which every quantisation step of a normal is visible."""

from __future__ import annotations

import functools

import numpy as np

from .made import drawn, mixed, rises

STRIPS, LAMP = "a dim room with thin strips of light", "one small round lamp in a dim room"
DIM, STRIP, BULB = np.array([0.03, 0.03, 0.035]), np.array([4.0, 4.0, 4.0]), np.array([150.0, 146.0, 138.0])
# Degrees: from strip to strip, along longitudes and latitudes, the half width of one, and how far its edge fades.
APART, HALF, FADE = (15.0, 20.0), 0.9, 0.7
# The lamp: where it hangs, and its half angle.
TOWARDS, RADIUS = np.array([0.48, 0.36, 0.8]), 2.0


@functools.cache
def strips() -> np.ndarray:
    """Return the radiance of the room with strips, (256, 512, 3), float32."""
    return drawn(_hung)


def _hung(towards: np.ndarray) -> np.ndarray:
    turn = np.degrees(np.arctan2(towards[..., 0], -towards[..., 2]))
    height = np.degrees(np.arcsin(np.clip(towards[..., 1], -1.0, 1.0)))
    away = [np.abs((angle / apart) % 1 - 0.5) * apart for angle, apart in zip((turn, height), APART, strict=True)]
    # Upright strips keep their width up to the poles, where there are none.
    away[0] = np.where(np.abs(height) < 60.0, away[0] * np.cos(np.radians(height)), 90.0)
    return mixed(DIM, STRIP, rises(HALF - np.minimum(*away), -FADE / 2, FADE / 2))


@functools.cache
def lamp() -> np.ndarray:
    """Return the radiance of the room with a lamp, (256, 512, 3), float32."""
    return drawn(_bulb)


def _bulb(towards: np.ndarray) -> np.ndarray:
    apart = np.degrees(np.arccos(np.clip(towards @ TOWARDS, -1.0, 1.0)))
    return mixed(DIM, BULB, rises(RADIUS - apart, -FADE / 2, FADE / 2))
