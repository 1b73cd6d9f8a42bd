"""Lower bounds on the errors of any N codes.

For N points on a surface of area A, the bounds are on the angle, in radians, between a uniformly distributed
direction and its code. The mean square is at least 5 / (18 sqrt 3) A / N, the value for regular hexagons (L. Fejes
Toth's moment theorem). The mean is at least that of a hexagon, and the maximum at least that of a covering of the
whole sphere by N caps (Fejes Toth 1943). The border of a part of the sphere is ignored: the bound uses the density,
N 4 pi / A codes for the whole sphere, and is asymptotic in N.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .totals import Statistics

SPHERE, HEMISPHERE = 4 * math.pi, 2 * math.pi
AREAS = {"sphere": SPHERE, "hemisphere": HEMISPHERE}
# Of a regular hexagon, about its centre: the second moment for area 1, and the mean distance for circumradius 1.
HEXAGON_SQUARE = 5 / (18 * math.sqrt(3))
HEXAGON_MEAN = 1 / 3 + math.log(3) / 4
# Normals are float32: what is finer than their own rounding (an RMS of some 2e-6 degrees) is not measured.
RESOLUTION_DEG = 1e-5
# Standard deviations that are put down to sampling. A mean over `count` samples scatters by half of 1 / sqrt(count) of
# itself or less, for codes near the limit.
SIGMAS = 5
SCATTER = SIGMAS * 0.5
# Sets of uniform directions are lattices, and so are many codes: where a code's cap holds less than one direction on
# average, the two may meet more often than chance has it (twice, of 65536 directions and spherical's 2^20 codes; 1.2
# times, of a million and latitude_longitude's 2^16).
RESONANCE = 4


@dataclass(frozen=True)
class CodeLimit:
    """The smallest possible mean, RMS and maximum of the angle, in degrees."""

    mean_deg: float
    rms_deg: float
    max_deg: float


def code_limit(codes: int, area: float = SPHERE) -> CodeLimit:
    """Return the bounds on the errors of `codes` codes (4 or more) spread over `area` steradians."""
    cell = area / codes
    radius = math.sqrt(2 * cell / (3 * math.sqrt(3)))
    return CodeLimit(
        mean_deg=math.degrees(HEXAGON_MEAN * radius),
        rms_deg=math.degrees(math.sqrt(HEXAGON_SQUARE * cell)),
        max_deg=covering_deg(codes * SPHERE / area),
    )


def covering_deg(codes: float) -> float:
    """Return the smallest angle that `codes` (4 or more) equal caps need to cover the sphere, in degrees.

    The angle is arccos(cot(w) / sqrt 3) with w = pi/6 N / (N - 2); it is computed from the sine of half the angle,
    which avoids cancellation.
    """
    excess = math.pi / (3 * (codes - 2))
    half_squared = math.sin(excess) / (math.sqrt(3) * math.sin(math.pi / 6 + excess))
    return math.degrees(2 * math.asin(math.sqrt(half_squared)))


def effective_bits(angle_rms_deg: float, area: float | None) -> float | None:
    """Return log2 of the number of codes that, ideally placed on `area` steradians, have this RMS angle; infinite for
    an angle of 0. Return None if `area` is None, which means that the set is not uniform."""
    if area is None:
        return None
    if angle_rms_deg == 0:
        return math.inf
    return math.log2(HEXAGON_SQUARE * area / math.radians(angle_rms_deg) ** 2)


def is_measurable(least: CodeLimit) -> bool:
    """Whether float32 normals can resolve errors as small as this limit."""
    return least.rms_deg > RESOLUTION_DEG


def broken(codes: int, area: float, s: Statistics) -> str:
    """Return a message about the first figure over uniform directions that is impossible with this number of codes,
    allowing for sampling noise; empty if all are possible. An impossible figure means that the measurement is wrong,
    or the set is not uniform."""
    least = code_limit(codes, area)
    spared = 1 - SCATTER / math.sqrt(s.count)
    for what, figure, bound in (("RMS", s.angle_rms_deg, least.rms_deg), ("mean", s.angle_mean_deg, least.mean_deg)):
        if figure < bound * spared:
            return f"{what} {figure:.5g} degrees is below the bound of {bound:.5g} degrees"
    for degrees, count in s.within:
        # Each code has its cap: so many directions at most lie that near to any.
        share = SPHERE / area * math.sin(math.radians(degrees) / 2) ** 2
        most = min(codes * share * (RESONANCE if share * s.count < 1 else 1), 1.0) * s.count
        if degrees > RESOLUTION_DEG and count > most + SIGMAS * math.sqrt(most) + SIGMAS:
            return f"{count} angles are below {degrees:.2g} degrees, but only {most:.2g} are possible"
    return ""
