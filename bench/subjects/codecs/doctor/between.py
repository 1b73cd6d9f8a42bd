"""The reason why two functions are not a pair: a missing step between them, or a different choice of axes.

Steps are tried on the codes: a different range, components swapped or negated, the 45° rotation that fills the
square, or the fold of the other function. The simplest step that makes a pair is named.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from ....ground.angles import angles_deg
from .domains import AXES, Domain, guessed
from .probe import Probe, Trip

# Two directions this near are the same one; storages of 8 bits move them by half of it.
SAME_DEG = 1.0
# How many of the directions are tried: the last ones, which are random.
TRIED = 512
MOST = 0.95
# Between two changes of a step; and how far beyond [-1, 1] codes may reach that a storage holds.
THEN, BEYOND = ", then ", 0.01

Change = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Step:
    """A change of codes between encoder and decoder.

    Attributes:
        said: the change as an expression of a code c; empty for no change.
        change: a function that changes codes of shape (count, size).
    """

    said: str
    change: Change


def _unchanged_codes(codes: np.ndarray) -> np.ndarray:
    return codes


NOTHING = Step("", _unchanged_codes)
RANGES = (
    NOTHING,
    Step("c * 0.5 + 0.5", lambda c: c * 0.5 + 0.5),
    Step("c * 2 - 1", lambda c: c * 2 - 1),
    Step("c + 0.5", lambda c: c + 0.5),
    Step("c - 0.5", lambda c: c - 0.5),
)


def _turned_codes(codes: np.ndarray) -> np.ndarray:
    x, y = codes.T
    return np.stack([x + y, x - y], axis=1)


TURNS = (
    NOTHING,
    Step("a rotation by 45 degrees, (c.x + c.y, c.x - c.y)", _turned_codes),
    Step("a rotation by 45 degrees, (c.x + c.y, c.x - c.y) / 2", lambda c: _turned_codes(c) / 2),
)


def _other_fold(codes: np.ndarray) -> np.ndarray:
    """Swap the magnitudes of the two components of codes outside the diamond |x| + |y| <= 1, and keep the signs."""
    swapped = np.copysign(np.abs(codes[:, ::-1]), codes)
    return np.where((np.abs(codes).sum(axis=1) > 1)[:, None], swapped, codes)


FOLDS = (NOTHING, Step("the other fold, with .yx instead of .xy,", _other_fold))


@cache
def _orders(size: int) -> tuple[Step, ...]:
    """Return a Step for every way to swap and negate the components of a code, shortest description first, so that
    the step that changes nothing comes first."""
    orders = []
    for order in itertools.permutations(range(size)):
        for signs in itertools.product((1, -1), repeat=size):
            orders.append(Step(_order_text(order, signs), _order_change(order, signs)))
    return tuple(sorted(orders, key=lambda step: len(step.said)))


def _order_change(order: Sequence[int], signs: Sequence[int]) -> Change:
    return lambda codes: codes[:, list(order)] * np.array(signs, codes.dtype)


def _order_text(order: Sequence[int], signs: Sequence[int]) -> str:
    moved = [i for i in range(len(order)) if order[i] != i]
    names = "its components" if len(order) == len(moved) else f"components {' and '.join(str(i + 1) for i in moved)}"
    swapped = [f"{names} swapped, c.{''.join(AXES[i] for i in order)}"] if moved else []
    negated = [str(i + 1) for i in range(len(signs)) if signs[i] < 0]
    numbers = f"component{'s' * (len(negated) > 1)} {' and '.join(negated)} negated"
    return " and ".join([*swapped, *([numbers] if negated else [])])


@cache
def steps(size: int) -> tuple[Step, ...]:
    """Return every Step to try between an encoder and a decoder of codes with `size` components, simplest first,
    without the step that changes nothing."""
    kinds = (RANGES, _orders(size), TURNS, FOLDS) if size == 2 else (RANGES, _orders(size))
    combined_steps = [_one_after_another(parts) for parts in itertools.product(*kinds)]
    return tuple(sorted(combined_steps, key=lambda step: (step.said.count(THEN), len(step.said))))[1:]


def _one_after_another(parts: Sequence[Step]) -> Step:
    def change(codes: np.ndarray) -> np.ndarray:
        for part in parts:
            codes = part.change(codes)
        return codes

    return Step(THEN.join(part.said for part in parts if part.said), change)


def decoded_after(probe: Probe, codes: np.ndarray, changes: Sequence[Step]) -> np.ndarray:
    """Decode codes after each of several steps; return directions of shape (steps, count, 3)."""
    given = np.concatenate([step.change(codes) for step in changes])
    return probe.decode(given).reshape(len(changes), len(codes), 3)


def step_between(trip: Trip, probe: Probe) -> tuple[Step, Domain] | None:
    """Return the simplest step that makes a pair, and the domain on which it does; None if no step does.

    A decoder that normalises its result accepts codes in several ranges; the widest range that a storage can hold is
    chosen.
    """
    few = trip.of(np.arange(len(trip.n) - TRIED, len(trip.n)))
    tried, candidates = steps(probe.size), []
    for step, decoded in zip(tried, decoded_after(probe, few.codes, tried), strict=True):
        with np.errstate(invalid="ignore"):
            domain = guessed(Trip(few.n, few.view, few.codes, decoded), SAME_DEG)
        if domain.name:
            candidates.append((step, domain))
    return min(candidates, key=lambda candidate: _unlikely(candidate[0], few.codes), default=None)


def _unlikely(step: Step, codes: np.ndarray) -> tuple[int, bool, float]:
    """Return a sort key that is smallest for the likeliest step: few changes, codes within [-1, 1], a wide range."""
    changed = step.change(codes)
    return step.said.count(THEN), bool(np.abs(changed).max() > 1 + BEYOND), -round(float(np.ptp(changed)), 1)


def axes_of(trip: Trip) -> str:
    """Return in words how the axes of decoded directions are swapped or reversed; empty if they are not."""
    for order, signs in turns():
        if (angles_deg(trip.n[:, order] * np.array(signs), trip.decoded) < SAME_DEG).mean() > MOST:
            return axes_said(order, signs)
    return ""


def turns() -> Iterator[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Yield (order, signs) for every permutation of the axes with every choice of signs, except the identity."""
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            if (order, signs) != ((0, 1, 2), (1, 1, 1)):
                yield order, signs


def axes_said(order: Sequence[int], signs: Sequence[int]) -> str:
    """Return in words how axes are swapped or reversed, such as `x and y swapped and z reversed`; may be empty."""
    moved = [AXES[axis] for axis in range(3) if order[axis] != axis]
    reversed_ = [AXES[axis] for axis in range(3) if signs[axis] < 0]
    parts = [f"{' and '.join(moved)} swapped" if len(moved) == 2 else "x, y and z permuted"] if moved else []
    return " and ".join([*parts, *([f"{' and '.join(reversed_)} reversed"] if reversed_ else [])])
