"""Times of works that take turns, and how times grow with a size."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

LONG_ENOUGH_S = 1.0
# Seconds between turns: OpenMP's threads wait awake for a few milliseconds, and would take a core from the next one.
PAUSE_S = 0.01

Row = dict[str, Any]
Task = Callable[[], object]


def least_times(works: Sequence[Task]) -> list[float]:
    """Seconds of works that take turns: the least of three turns or more, for LONG_ENOUGH_S each, after one to warm
    up."""
    for work in works:
        work()
    times: list[list[float]] = [[] for _ in works]
    while len(times[0]) < 3 or sum(map(sum, times)) < LONG_ENOUGH_S * len(works):
        for work, taken in zip(works, times, strict=True):
            time.sleep(PAUSE_S)
            begin = time.perf_counter()
            work()
            taken.append(time.perf_counter() - begin)
    return [min(taken) for taken in times]


def rates(works: Sequence[Task], count: int) -> list[float]:
    """Million normals a second of works on so many, by their least times."""
    return [count / taken / 1e6 for taken in least_times(works)]


def exponent(sizes: Sequence[float], times: Sequence[float]) -> float | None:
    """The e of time = c size^e, by least squares in logarithms; None of fewer than two sizes."""
    if len(set(sizes)) < 2:
        return None
    return float(np.polyfit(np.log(sizes), np.log(times), 1)[0])
