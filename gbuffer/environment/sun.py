"""Suns: a small, very bright part of an environment that is removed and replaced by a directional light."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .environment import Environment, directions, solid_angles

# Radiance that a sun rises above: what is left in its place. Skies and clouds have less where the ground has about 1.
MOST = 30.0
# Texels above it are a sun where all of them are this near to their middle, in degrees. The sun is half a degree wide;
# cameras and the averaging of texels make several of it.
REACH = 5.0


@dataclass(frozen=True)
class Sun:
    """Radiance above a threshold, in one small part of an environment.

    Attributes:
        towards: unit direction to its centre.
        irradiance: irradiance from it on a surface that faces it, linear colour.
    """

    towards: tuple[float, float, float]
    irradiance: tuple[float, float, float]


def found_sun(radiance: np.ndarray, most: float = MOST) -> Sun | None:
    """Return the sun in an image, (height, 2 height, 3); None if no texel exceeds `most`, or if such texels are too
    far apart."""
    excess = np.maximum(radiance.astype(np.float64) - most, 0) * solid_angles(len(radiance))[..., None]
    bright = excess.any(-1)
    if not bright.any():
        return None
    towards, light = directions(len(radiance))[bright], excess[bright]
    middle = (towards * light.sum(-1, keepdims=True)).sum(0)
    middle /= max(np.linalg.norm(middle), np.finfo(np.float64).tiny)
    if (towards @ middle).min() < np.cos(np.radians(REACH)):
        return None
    return Sun(_three(middle), _three(light.sum(0)))


def without_sun(environment: Environment, most: float = MOST) -> Environment:
    """Return an environment with its sun replaced by a directional light of equal irradiance; the environment itself
    if `found_sun` finds no sun.

    Args:
        most: maximum radiance per channel that stays in the image.
    """
    sun = found_sun(environment.radiance, most)
    if sun is None:
        return environment
    x, y, z = sun.towards
    changes = (*environment.changes, f"sun above {most:g} moved to a separate light")
    dim = np.minimum(environment.radiance, np.float32(most))
    return replace(environment, radiance=dim, sun=((-x, -y, -z), sun.irradiance), changes=changes)


def _three(values: np.ndarray) -> tuple[float, float, float]:
    first, second, third = (float(value) for value in values)
    return first, second, third
