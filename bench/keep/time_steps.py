"""Steps up or down in a series of times, as opposed to mere fluctuations."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate, pairwise
from statistics import median

from .comparison import CHANCE, is_slower_or_faster, mann_whitney

# What a further step must gain, in variances of ranks and logarithms of how many times there are: the place and the
# height of a step are two numbers, by the Bayesian information criterion.
PENALTY = 2.0
# A step is at least this many standard deviations of the times next to it: times of machines that others use waver for
# days, which a rank test alone takes for steps.
DEVIATIONS = 4.0
# From the median distance to the median to the standard deviation of a normal distribution.
FROM_MEDIAN = 1.4826


def time_steps(times: Sequence[float], tests: int) -> list[int]:
    """Return the indices at which `times` steps up or down, in order; empty if all differences are noise.

    Fit piecewise constant ranks by least squares, as Lung-Yut-Fong, Lévy-Leduc and Cappé (2015) do, and keep the
    steps that a comparison of two runs would count as changes.

    Args:
        tests: the number of places that are tested for a step, in this series and all others.
    """
    begins = _pieces(times)
    while begins and max(doubts := _doubts(times, begins, tests)):
        begins.pop(doubts.index(max(doubts)))
    return _placed(times, begins)


def _placed(times: Sequence[float], begins: Sequence[int]) -> list[int]:
    """Return the start of each piece but the first, moved so that the times deviate least from the medians of the two
    pieces that meet there: ranks do not tell how far apart two times are."""
    placed = [0, *begins, len(times)]
    for index in range(1, len(placed) - 1):
        first, begin, end = placed[index - 1 : index + 2]
        middles = median(times[first:begin]), median(times[begin:end])
        gains = [abs(time - middles[0]) - abs(time - middles[1]) for time in times[first:end]]
        sums = [0.0, *accumulate(gains)]
        inside = range(1, end - first)
        placed[index] = first + min(inside, key=sums.__getitem__)
    return placed[1:-1]


def _pieces(times: Sequence[float]) -> list[int]:
    """Return the index at which each piece but the first begins, in the best piecewise constant fit of the ranks."""
    import numpy as np

    ordered, count = np.sort(times), len(times)
    # Times that are the same share a rank.
    ranks = (np.searchsorted(ordered, times, "left") + np.searchsorted(ordered, times, "right")) / 2
    variance = float(ranks.var()) or 1.0
    sums, squares = (np.concatenate([[0.0], np.cumsum(values)]) for values in (ranks, ranks**2))
    penalty = PENALTY * math.log(count) if count > 1 else 1.0
    best, before = np.zeros(count + 1), [0] * (count + 1)
    for end in range(1, count + 1):
        within = squares[end] - squares[:end] - (sums[end] - sums[:end]) ** 2 / (end - np.arange(end))
        costs = best[:end] + within / variance + penalty
        before[end] = int(costs.argmin())
        best[end] = costs[before[end]]
    begins, end = [], before[count]
    while end:
        begins.insert(0, end)
        end = before[end]
    return begins


def _doubts(times: Sequence[float], begins: Sequence[int], tests: int) -> list[float]:
    """Return how doubtful each step is; 0 for a step that is not noise."""
    pieces = [times[begin:end] for begin, end in pairwise([0, *begins, len(times)])]
    return [_doubt(*pair, tests) for pair in pairwise(pieces)]


def _doubt(earlier: Sequence[float], other: Sequence[float], tests: int) -> float:
    """Return 0 if the times of two pieces differ beyond noise, else 1 or more; the more doubtful, the larger."""
    chance = mann_whitney(earlier, other) * tests
    return 0.0 if chance <= CHANCE and _is_large(earlier, other) else 1.0 + chance


def _is_large(earlier: Sequence[float], other: Sequence[float]) -> bool:
    """Whether two pieces differ by a relevant amount, and by clearly more than the times vary within each piece."""
    before, after = median(earlier), median(other)
    off = [abs(time - middle) for times, middle in ((earlier, before), (other, after)) for time in times]
    return is_slower_or_faster(before, after) and abs(after - before) >= DEVIATIONS * FROM_MEDIAN * median(off)
