"""Hill climbing to a worst case: a place moves to its worst neighbour, in steps that shrink if no neighbour is worse.

A place is a normal or a tangent frame, as a column of numbers. A `Ground` gives the errors of places and their
neighbours.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import Any

import numpy as np

from ...ground.machine.cores import on_all_cores

WAYS = 2**4  # places that are tried around one
STEPS = 80  # of a round
KEPT = 2**8  # of a round, for the next
GROW, SHRINK = 1.5, 0.55
LEAST = 1e-10  # of a step, in the error; then a climb is over
# Rounds from the best alone, until one moves it no more than that, relatively.
LAST_ROUNDS, SETTLED = 12, 1e-8


@dataclass(frozen=True)
class Starts:
    """Places, shape (numbers per place, count), and the squared distances by which a round trip moves them, shape
    (count,)."""

    chords: np.ndarray
    places: np.ndarray

    def best(self, count: int) -> Starts:
        """Return the `count` starts with the largest distances, largest first; all starts if there are fewer."""
        return self[np.argsort(-self.chords, kind="stable")[:count]]

    def filled(self, count: int) -> Starts:
        """Return `count` starts, repeated as needed. Climbs from the same start differ by its index in the block."""
        return self[np.arange(count) % len(self.chords)]

    def __getitem__(self, which: slice | np.ndarray) -> Starts:
        return Starts(self.chords[which], self.places[:, which])

    def __add__(self, other: Starts) -> Starts:
        return Starts(np.concatenate([self.chords, other.chords]), np.concatenate([self.places, other.places], axis=1))


@dataclass(frozen=True)
class Ground:
    """The space in which places climb.

    Attributes:
        chords: a function from places to the squared distances by which a round trip moves them.
        around: (places, sizes, step) -> WAYS places around each place, shape (numbers per place, WAYS, count).
        errors: a function from squared distances to errors, in the unit of sizes.
        degrees: a function from a squared distance to an angle, in degrees.
        lanes: the number of places that climb together.
    """

    chords: Callable[[np.ndarray], np.ndarray]
    around: Callable[[np.ndarray, np.ndarray, int], np.ndarray]
    errors: Callable[[np.ndarray], np.ndarray]
    degrees: Callable[[float], float]
    lanes: int


def highest(ground: Ground, starts: Starts, count: int, first_sizes: tuple[float, ...]) -> tuple[Starts, float]:
    """Return the worst place that climbing finds, as `Starts` with one place, and by how many degrees the last round
    of climbing increased its error.

    Args:
        starts: the places to choose from; the worst `count` of them are climbed from.
        count: a multiple of `ground.lanes`.
        first_sizes: the size of the first step of each round, relative to the error.
    """
    starts = starts.best(count).filled(count)
    for size in first_sizes:
        # A second block with the same starts would climb as the first one does.
        starts = _climb(ground, starts, size).best(KEPT).filled(max(KEPT, ground.lanes))
    angle, moved, last = ground.degrees(starts.chords[0]), math.inf, starts.best(1)
    for _ in range(LAST_ROUNDS):
        last = _climb(ground, last.filled(ground.lanes), np.geomspace(1e-9, 1.0, ground.lanes)).best(1)
        moved, angle = ground.degrees(last.chords[0]) - angle, ground.degrees(last.chords[0])
        if moved <= SETTLED * angle:
            break
    return last, moved


def _climb(ground: Ground, starts: Starts, first: Any) -> Starts:
    """Return starts, each moved to the worst place that a climb from it reaches. `first` is the size of the first
    step, relative to the error: one for all starts, or one for each."""
    sizes = first * ground.errors(starts.chords)
    parts = (slice(begin, begin + ground.lanes) for begin in range(0, len(sizes), ground.lanes))
    return reduce(add, on_all_cores(lambda part: _climb_from(ground, starts[part], sizes[part]), parts))


def _climb_from(ground: Ground, starts: Starts, sizes: np.ndarray) -> Starts:
    """Return at most `ground.lanes` starts after climbs whose first steps have these absolute sizes."""
    chords, places = starts.chords, starts.places
    errors, lane = ground.errors(chords), np.arange(len(chords))
    for step in range(STEPS):
        around = ground.around(places, sizes, step)
        around_chords = ground.chords(around.reshape(len(places), -1)).reshape(WAYS, -1)
        way = around_chords.argmax(axis=0)
        worst = around_chords[way, lane]
        is_worse = worst > chords
        chords = np.where(is_worse, worst, chords)
        places = np.where(is_worse, around[:, way, lane], places)
        sizes = sizes * np.where(is_worse, GROW, SHRINK)
        if (sizes < LEAST * errors).all():
            break
    return Starts(chords, places)
