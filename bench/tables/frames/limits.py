"""The theoretical limit for tangent frames: the smallest possible errors of any N codes.

By Haar's measure, rotations by up to theta make up a share of (theta - sin theta) / pi of all rotations. At best,
each code is the nearest to a ball with a share of 1 / N, so no N codes have a maximum error below the theta of this
ball, or a mean or mean square error below the ball's own. A mirrored frame is not a rotation: each handedness gets
half of the codes.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.optimize import root_scalar

from ...measures.metrics.code_limits import SCATTER, CodeLimit

HANDS = 2
# Of Gauss and Legendre; what they integrate is as smooth as a cosine.
NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)


def ball_moment(theta: float, power: int) -> float:
    """Return the integral of angle^power, in radians, over rotations by up to `theta`; all rotations measure 1."""
    angle = (NODES + 1) * theta / 2
    # The density (1 - cos angle) / pi, written so that it does not cancel.
    return float(WEIGHTS @ (angle**power * 2 * np.sin(angle / 2) ** 2)) / math.pi * theta / 2


def _root_angle(function: Callable[[float], float], least: float) -> float:
    """Return the root of an increasing function between `least`, at which it is not above 0, and pi, to the precision
    of float64."""
    return float(root_scalar(function, bracket=(least, math.pi), method="brentq", xtol=1e-30).root)


def frame_limit(codes: int, hands: int = HANDS) -> CodeLimit:
    """Return the smallest possible mean, RMS and maximum angle for this number of codes (2 or more), over all frames,
    or over all rotations if `hands` is 1."""
    share = hands / codes
    # theta - sin theta is below theta^3 / 6.
    least = min((6 * math.pi * share) ** (1 / 3), math.pi)
    theta = _root_angle(lambda t: ball_moment(t, 0) / share - 1, least * (1 - 1e-9)) if share < 1 else math.pi
    mean, square = (ball_moment(theta, power) / share for power in (1, 2))
    return CodeLimit(math.degrees(mean), math.degrees(math.sqrt(square)), math.degrees(theta))


def frame_effective_bits(rms_deg: float, hands: int = HANDS) -> float:
    """Return log2 of the number of ideally placed codes with this RMS angle over all frames, or over all rotations if
    `hands` is 1; infinite if the angle is 0."""
    if rms_deg == 0:
        return math.inf
    square = math.radians(rms_deg) ** 2

    def excess(theta: float) -> float:
        return ball_moment(theta, 2) / ball_moment(theta, 0) / square - 1

    if excess(math.pi) < 0:
        return math.log2(hands)
    # The mean square of a ball is 3/5 theta^2 where it is small, and less where not.
    theta = _root_angle(excess, math.sqrt(square))
    return math.log2(hands / ball_moment(theta, 0))


def frames_broken(codes: int, count: int, mean_deg: float, rms_deg: float, hands: int = HANDS) -> str:
    """Return a message if the RMS or the mean angle measured over uniform frames is below the bound for this number
    of codes by more than scatter explains; empty otherwise. Such a figure means a wrong measurement or a set that is
    not uniform."""
    least, spared = frame_limit(codes, hands), 1 - SCATTER / math.sqrt(count)
    for what, figure, bound in (("RMS", rms_deg, least.rms_deg), ("mean", mean_deg, least.mean_deg)):
        if figure < bound * spared:
            return f"{what} {figure:.5g} degrees is below the bound of {bound:.5g} degrees"
    return ""
