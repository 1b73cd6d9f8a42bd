"""Times of tasks that take turns, and the growth of times with a size."""

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
    """Return the lowest time of each task in seconds. The tasks take turns: one turn to warm up and then at least
    three, for LONG_ENOUGH_S per task."""
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
    """Return million normals per second of tasks on `count` normals, by their lowest times."""
    return [count / taken / 1e6 for taken in least_times(works)]


def exponent(sizes: Sequence[float], times: Sequence[float]) -> float | None:
    """Return the e of time = c size^e, by least squares in logarithms, or None for fewer than two sizes."""
    if len(set(sizes)) < 2:
        return None
    return float(np.polyfit(np.log(sizes), np.log(times), 1)[0])
