"""A clear sky late in the day: blue above, bright towards the horizon and the sun, dark ground below."""

from __future__ import annotations

import functools

import numpy as np

from .made import drawn, mixed, rises

TITLE = "a clear sky with a bright horizon, dark ground and a sun"

ZENITH, HORIZON = np.array([0.16, 0.32, 0.75]), np.array([1.15, 1.2, 1.25])
GROUND, FAR_GROUND = np.array([0.07, 0.062, 0.05]), np.array([0.24, 0.22, 0.2])
GLOW, HALO = np.array([2.2, 1.5, 0.8]), np.array([9.0, 7.5, 5.5])
# Unit; and half the sun's width: wider than the true one, so that it covers several texels.
_TOWARDS = np.array([0.55, 0.5, -0.67])
SUN = _TOWARDS / np.linalg.norm(_TOWARDS)
SUN_RADIUS = np.radians(0.8)
# On a surface across it; the whole sky gives a level surface 2 to 3.
SUN_IRRADIANCE = np.array([9.0, 8.4, 7.2])


@functools.cache
def sky() -> np.ndarray:
    """Return the radiance of the sky, (256, 512, 3), float32, from 0.05 to about 15,000 in the sun."""
    return drawn(_light)


def _light(towards: np.ndarray) -> np.ndarray:
    height, to_sun = towards[..., 1], np.clip(towards @ SUN, -1, 1)
    light = _air(height, to_sun) + _ground(height)
    # The chord, since an arc cosine is inaccurate for small angles.
    away = np.sqrt(((towards - SUN) ** 2).sum(-1))
    disc = (away < 2 * np.sin(SUN_RADIUS / 2))[..., None] * SUN_IRRADIANCE / (np.pi * np.sin(SUN_RADIUS) ** 2)
    return light + disc


def _air(height: np.ndarray, to_sun: np.ndarray) -> np.ndarray:
    up = np.maximum(height, 0)
    air = mixed(HORIZON, ZENITH, 1 - (1 - up) ** 4)
    # Warm near the horizon on the sun's side, and around the sun itself.
    glow = np.exp(-6 * up) * ((1 + to_sun) / 2) ** 3
    halo = 0.1 * np.exp(-14 * (1 - to_sun)) + 0.8 * np.exp(-250 * (1 - to_sun))
    return (air + glow[..., None] * GLOW + halo[..., None] * HALO) * _is_sky(height)[..., None]


def _ground(height: np.ndarray) -> np.ndarray:
    down = np.maximum(-height, 0)
    return mixed(FAR_GROUND, GROUND, rises(down, 0, 0.35)) * (1 - _is_sky(height))[..., None]


def _is_sky(height: np.ndarray) -> np.ndarray:
    """Return the share of sky at a direction's height: 0 below the horizon, 1 above, smooth in the haze between."""
    return rises(height, -0.012, 0.004)
