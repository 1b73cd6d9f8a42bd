"""Environments prefiltered for surfaces of each roughness, in levels to interpolate between."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from .environment import Environment

# Denser where the picture changes faster: linear interpolation between two neighbours is off by less than 3 % at 95 of
# 100 texels of an outdoor picture, and by less than 1 % from 0.1.
FINE = (0, 0.025, 0.0375, 0.05, 0.0625, 0.075, 0.1, 0.125, 0.15, 0.175, 0.2, 0.225, 0.25, 0.3, 0.35, 0.4)
COARSE = (0.4, 0.45, 0.5, 0.55, 0.6, 0.7, 0.8, 0.9, 1)
# Texels of the environment to one of a coarse level, along either side.
STEP = 4
# Changes with every change of what levels are; what was kept by an older one is not used.
VERSION = "1"

Arrays = Mapping[str, np.ndarray]
# From a key and what makes arrays to those arrays: made now, or what was kept under that key.
Keep = Callable[[str, Callable[[], Arrays]], Arrays]


@dataclass(frozen=True, eq=False)
class Prefiltered:
    """An environment filtered by GGX's lobe around each direction r, with normal and viewer equal to r.

    A texel is the sum of L K divided by the sum of K, with K = D((1 + r.l) / 2) max(r.l, 0).

    Attributes:
        fine: (levels, height, width, 3), float32, in the environment's own size; level 0 is its radiance.
        fine_roughness: roughness of each fine level, from 0 up.
        coarse: (levels, height / 4, width / 4, 3), float32.
        coarse_roughness: roughness of each coarse level, from that of the last fine level up to 1.
    """

    fine: np.ndarray
    coarse: np.ndarray
    fine_roughness: tuple[float, ...] = FINE
    coarse_roughness: tuple[float, ...] = COARSE

    @property
    def irradiance(self) -> np.ndarray:
        """Integral of L max(n.l, 0), divided by pi, (height / 4, width / 4, 3). This is the level of roughness 1, at
        which D is constant."""
        return self.coarse[-1]


def _made_now(_: str, make: Callable[[], Arrays]) -> Arrays:
    return make()


# By what frames have levels kept.
_keepers: list[Keep] = [_made_now]


def keep_levels_by(keep: Keep) -> None:
    """Set the function that stores and returns the prefiltered levels for all later frames."""
    _keepers[:] = [keep]


def kept_prefiltered(environment: Environment) -> Prefiltered:
    """Return the levels of an environment, kept by the function that `keep_levels_by` set. Raises ValueError as
    `prefiltered` does."""
    return prefiltered(environment, _keepers[0])


def prefiltered(environment: Environment, keep: Keep = _made_now) -> Prefiltered:
    """Return the levels of an environment. 512 x 256 texels take 4 seconds on one core, 1024 x 512 half a minute.

    Raises:
        ValueError: the environment's height is not a multiple of 4, or its width is not twice its height.
    """
    radiance = environment.radiance
    height, width = radiance.shape[:2]
    if width != 2 * height or height % STEP:
        raise ValueError(
            f"{environment.name}: {width} x {height} texels; the width must be twice the height, and the "
            f"height a multiple of {STEP}"
        )
    levels = keep(key_of(radiance), lambda: _levels(radiance))
    return Prefiltered(np.concatenate([radiance[None].astype(np.float32), levels["fine"]]), levels["coarse"])


def key_of(radiance: np.ndarray) -> str:
    """Return a cache key that changes with the radiance, the levels and VERSION."""
    stored = np.ascontiguousarray(radiance, np.float32)
    facts = json.dumps([VERSION, FINE, COARSE, STEP, stored.shape])
    return hashlib.sha256(facts.encode() + stored.tobytes()).hexdigest()


def _levels(radiance: np.ndarray) -> Arrays:
    """Return the levels other than the radiance itself, stacked by roughness: "fine" in its size, "coarse" smaller by
    STEP per side."""
    # SciPy's transforms: who only asks what environments there are does not wait for them.
    from .lobe_sums import seen_through_lobe

    fine = [seen_through_lobe(radiance, roughness**2).astype(np.float32) for roughness in FINE[1:]]
    coarse = [seen_through_lobe(radiance, roughness**2, STEP).astype(np.float32) for roughness in COARSE]
    return {"fine": np.stack(fine), "coarse": np.stack(coarse)}
