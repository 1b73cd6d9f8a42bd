"""The effect of an encoding's orientation on image errors: the best pole, the mean over yaws and its accuracy.

Errors are the mean squared errors of displayed images, by image and by pole, in the order of the yaws:
{"studio": {"x": [...], ...}}. An encoding in view space has one orientation, whose pole is "".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..metrics.totals import psnr_db
from .orientations import jackknife

# Yaws of every encoding, of those near the best, and of those whose figure is not exact enough.
FIRST, ALL, MOST = 4, 16, 64
# How near, and how exact, in decibels.
NEAR_DB, EXACT_DB = 1.5, 0.25
# Images above it are equal.
INDISTINGUISHABLE_DB = 70.0
VIEW_SPACE = ""

Errors = Mapping[str, Mapping[str, Sequence[float]]]


def best_pole(errors: Errors) -> str:
    """Return the pole at which the lowest PSNR of all images is highest, over at most ALL yaws that they share."""
    poles = next(iter(errors.values()))
    return max(poles, key=lambda pole: worst_db(errors, pole, range(min(ALL, count_of(errors, pole)))))


def count_of(errors: Errors, pole: str) -> int:
    """Return the number of yaws at a pole that all images have."""
    return min(len(by_pole[pole]) for by_pole in errors.values())


def image_db(errors: Sequence[float] | np.ndarray) -> float:
    """Return the PSNR, in dB, of the mean of an image's squared errors over yaws."""
    return psnr_db(float(np.mean(errors)))


def worst_db(errors: Errors, pole: str, yaws: Sequence[int] | np.ndarray) -> float:
    """Return the lowest PSNR of all images at a pole, in dB. An image's PSNR is computed from the mean of its squared
    errors at the yaws with these indices."""
    kept = np.asarray(yaws)
    return min(image_db(np.asarray(by_pole[pole])[kept]) for by_pole in errors.values())


def error_db(errors: Errors, pole: str) -> float | None:
    """Return the standard error of the lowest PSNR of all images at a pole, in dB; None with fewer than two yaws."""
    yaws = range(count_of(errors, pole))
    return jackknife(lambda kept: worst_db(errors, pole, kept), yaws) if len(yaws) > 1 else None


def two_worst_db(errors: Sequence[float]) -> float:
    """Return the PSNR, in dB, of the mean of the two largest squared errors over yaws."""
    return image_db(sorted(errors)[-2:])


def gap_db(errors: Errors, other: Errors) -> tuple[float, float]:
    """Return how far the lowest PSNR of an encoding is above that of another, in dB, and the gap's standard error.

    Each encoding uses its best pole; only the yaws that both have are compared. PSNRs are capped at
    INDISTINGUISHABLE_DB. The standard error for a single orientation is 0.
    """
    poles = best_pole(errors), best_pole(other)
    yaws = range(min(count_of(errors, poles[0]), count_of(other, poles[1])))

    def gap(kept: Sequence[int] | np.ndarray) -> float:
        psnrs = (min(worst_db(*part, kept), INDISTINGUISHABLE_DB) for part in zip((errors, other), poles, strict=True))
        return next(psnrs) - next(psnrs)

    return gap(yaws), jackknife(gap, yaws) if len(yaws) > 1 else 0.0
