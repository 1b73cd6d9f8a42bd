"""Scalable ambient obscurance: taps on a spiral, weighted by height above the tangent plane and by distance."""

from __future__ import annotations

from math import gcd

import numpy as np

from ..frame.contract import Pass
from .effect import Number
from .noise import SEED
from .occlusion.passes import RADIUS, SIZE, VISIBILITY, AmbientOcclusion, passes

GOLDEN = (5**0.5 - 1) / 2
EPSILON = 0.01  # square metres, which keep near taps from weighing too much
LEAST = 3.0  # pixels of the radius on the screen; with fewer nothing is computed


def turns(taps: int) -> int:
    """Return the number of turns of the spiral: the whole number nearest to GOLDEN times `taps` that has no factor in
    common with `taps`, so that no two taps are in the same direction. For the paper's 11 taps it is 7."""
    return min((n for n in range(1, taps + 1) if gcd(n, taps) == 1), key=lambda n: abs(n - GOLDEN * taps))


def _passes(size: str, radius: float, taps: int, bias: float, strength: float, seed: int) -> tuple[Pass, ...]:
    own = {"TURNS": turns(taps), "EPSILON": EPSILON, "LEAST": LEAST, "STRENGTH": strength}
    return passes("sao.frag", size, False, RADIUS=radius, TAPS=taps, BIAS=bias, SEED=seed, **own)


def _falloff_weights(distance: np.ndarray) -> np.ndarray:
    return np.maximum(1 - distance**2, 0) ** 3


SETTINGS = {
    "size": SIZE,
    "radius": RADIUS,
    "taps": Number(11, 1, 1024, "Number of taps on the spiral."),
    "bias": Number(0.01, 0.0, 1.0, "Height above the tangent plane, in metres, below which a tap does not occlude."),
    "strength": Number(1.0, 0.0, 100.0, "The paper's sigma, in metres; scale it with the radius."),
    "seed": SEED,
}
EFFECT = AmbientOcclusion(
    "sao",
    "scalable ambient obscurance, without depth mipmaps",
    "McGuire, Mara and Luebke 2012",
    VISIBILITY,
    _passes,
    SETTINGS,
    falls_off=_falloff_weights,
)
