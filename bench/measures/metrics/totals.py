"""Totals over the chunks of a set, and the figures of a row that are computed from them."""

from __future__ import annotations

import base64
import json
import math
import operator
import zlib
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .histogram import BINS, counts_below, counts_by_angle, percentile

if TYPE_CHECKING:
    from jaxtyping import Float


class Figures(NamedTuple):
    """Figures for the covered normals in a chunk: the sums of the squared error, of the squared error as in the
    article (for 8-bit values from 0 to 255), of the angle and of its square (degrees), the number of decoded normals
    that are not finite, and the largest angle."""

    squared: Any
    article_squared: Any
    angle: Any
    angle_squared: Any
    invalid: Any
    largest: Any


@dataclass(frozen=True)
class Statistics:
    """The errors of a codec on a set of normals.

    Attributes:
        count: the number of normals that count, without the background.
        pixels: the number of all pixels, background included.
        invalid: the number of decoded normals that are not finite; each counts as the opposite direction.
        mse: mean squared error over the three components of covered normals, not renormalised.
        article_mse: mean squared error as in the article: |n - n'| rounded to 8 bits, over every pixel.
        angle_mean_deg, angle_rms_deg, angle_p99_deg, angle_max_deg: figures for the angle between a normal and its
            decoded normal.
        angle_counts: the number of angles in each non-empty eighth of an octave, by its lower edge in degrees; the
            first eighth includes 0.
        within: for each power of two in degrees, ascending, the number of angles below it.
        worst: the normal with the largest error.
    """

    count: int
    pixels: int
    invalid: int
    mse: float
    article_mse: float
    angle_mean_deg: float
    angle_rms_deg: float
    angle_p99_deg: float
    angle_max_deg: float
    angle_counts: tuple[tuple[float, int], ...]
    within: tuple[tuple[float, int], ...]
    worst: Worst | None


@dataclass(frozen=True)
class Worst:
    """The normal with the largest error, its decoded normal, both float32, and the angle between them in degrees."""

    normal: Float[np.ndarray, " 3"]
    decoded: Float[np.ndarray, " 3"]
    angle_deg: float

    def __str__(self) -> str:
        normal, decoded = (", ".join(str(c) for c in v) for v in (self.normal, self.decoded))
        return f"({normal}) decodes to ({decoded}), {self.angle_deg:.6g} degrees off"


def psnr_db(mse: float) -> float:
    """Return the peak signal-to-noise ratio in dB for a peak of 1; infinite for an error of 0."""
    return 10 * math.log10(1 / mse) if mse > 0 else math.inf


# Figures, how many normals lie in each bin of the histogram, and the normal with the largest angle.
ChunkTotal = tuple[Figures, np.ndarray, "Worst | None"]


class ErrorTotal:
    """A total over chunks. Sums are exact, so that parts of a set add up to the same figures as the whole set."""

    def __init__(self):
        self.figures, self.histogram = Figures(*[Fraction()] * len(Figures._fields)), np.zeros(BINS + 1, np.int64)
        self.worst: Worst | None = None

    @property
    def met_deg(self) -> float:
        """The largest angle of the chunks so far, in degrees; 0 if no normal counts. Other threads may read it."""
        return self.worst.angle_deg if self.worst else 0.0

    def add(self, part: ChunkTotal) -> None:
        """Add one chunk's figures, histogram and worst normal."""
        figures, counts, worst = part
        exact = Figures(*map(Fraction, figures))
        sums = Figures(*map(operator.add, self.figures, exact))
        self.figures = sums._replace(largest=max(self.figures.largest, exact.largest))
        self.histogram += counts
        if worst and (self.worst is None or worst.angle_deg > self.worst.angle_deg):
            self.worst = worst

    def add_total(self, other: ErrorTotal) -> None:
        """Add the total of other chunks."""
        self.add((other.figures, other.histogram, other.worst))

    def as_text(self) -> str:
        """Return all numbers of the total as JSON text, from which `total_of` restores the same total."""
        bins = np.flatnonzero(self.histogram)
        counted = np.stack([np.diff(bins, prepend=0), self.histogram[bins]]).astype("<i8")
        worst = self.worst and [*map(float, (*self.worst.normal, *self.worst.decoded, self.worst.angle_deg))]
        packed = base64.b64encode(zlib.compress(counted.tobytes())).decode()
        return json.dumps({"sums": [*map(str, self.figures)], "counts": packed, "worst": worst})


def total_of(text: str) -> ErrorTotal:
    """Return the total whose JSON text `ErrorTotal.as_text` returned."""
    record, total = json.loads(text), ErrorTotal()
    steps, counts = np.frombuffer(zlib.decompress(base64.b64decode(record["counts"])), "<i8").reshape(2, -1)
    total.figures = Figures(*map(Fraction, record["sums"]))
    total.histogram[np.cumsum(steps)] = counts
    if worst := record["worst"]:
        normal, decoded = np.array(worst[:6], np.float32).reshape(2, 3)
        total.worst = Worst(normal, decoded, worst[6])
    return total


def statistics(pixels: int, total: ErrorTotal) -> Statistics:
    """Return the statistics of a set of `pixels` pixels, background included."""
    figures, histogram = Figures(*map(float, total.figures)), total.histogram
    count = int(histogram[:BINS].sum())
    return Statistics(
        count=count,
        pixels=pixels,
        invalid=int(figures.invalid),
        mse=figures.squared / (3 * count),
        article_mse=figures.article_squared / 255**2 / (3 * pixels),
        angle_mean_deg=figures.angle / count,
        angle_rms_deg=math.sqrt(figures.angle_squared / count),
        angle_p99_deg=percentile(histogram, figures.largest, 0.99),
        angle_max_deg=figures.largest,
        angle_counts=counts_by_angle(histogram),
        within=counts_below(histogram),
        worst=total.worst,
    )
