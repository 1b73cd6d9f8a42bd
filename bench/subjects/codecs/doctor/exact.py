"""Mistakes in a pair that round-trips, for some directions or in a storage: seams, poles, lengths, unused ranges."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from ....ground.angles import angles_deg
from . import folds
from .domains import AXES, Domain
from .probe import Probe, Trip, vector

# Two directions this near are the same one; storages of 8 bits move them by half of it.
SAME_DEG = 1.0
# So few directions a singular point may lose.
FEW = 0.002
# Of [-1, 1]: how much a number must use, and how far it may reach beyond.
USED, BEYOND = 0.8, 1e-3
# How much of [0, 1] the codes of some thousand directions fill at least, how far half a step or a wrong scale leads
# beyond, the share that roundings next to a pole may lead farther, and how far.
NEARLY_FULL, ROUNDED, NEXT_TO_A_POLE, FARTHER = 0.9, 5e-3, 0.01, 0.1
# And those of a half, which a code with room for more gives less: they lie around the middle of [0, 1].
OF_A_HALF = 0.5
# How far a decode's length may be from 1.
LENGTH = 0.01
# Of a direction's distance from a pole: how far off it may come back. Beside the pole by this angle.
POLE_SHARE, POLE_DEG = 0.5, 0.06
# How much farther off than usual a direction is at a seam or a pole: encodings of few codes are never exact.
UNUSUAL = 30.0
# How far beside a direction that comes back elsewhere others are tried, and how many of them.
BESIDE, TRIES = 1e-4, 4
CLIPPED, UNUSED = "storages clip values outside", "% of its range is unused"
# Below it a float32 holds every whole number.
WHOLE_FLOATS = 2**24
# A number of at most so many values tells them apart however much of its range it uses.
FEW_VALUES = 16


def is_unit(codes: np.ndarray, share: float = NEARLY_FULL) -> bool:
    """Whether all components of some codes are in [0, 1], and each component that takes more than a few values fills
    a share of that range.

    Many components of codes in [-1, 1] are negative, so the few values that rounding pushes out of [0, 1] make no
    difference.
    """
    low, high = codes.min(axis=0), codes.max(axis=0)
    beyond = (codes < -ROUNDED) | (codes > 1 + ROUNDED)
    is_in = (beyond.mean(axis=0) < NEXT_TO_A_POLE) & (low > -FARTHER) & (high < 1 + FARTHER)
    fills = high - low > share
    return bool(is_in.all() and fills.any() and all(fills[i] or len(values(codes, i)) for i in range(len(fills))))


def values(codes: np.ndarray, number: int) -> np.ndarray:
    """Return the distinct values of component `number` of the codes in ascending order, such as a cube's faces; empty
    if there are many values."""
    levels = np.unique(np.round(codes[:, number], 4))
    return levels if len(levels) <= FEW_VALUES else levels[:0]


def lost(trip: Trip, within: float = SAME_DEG) -> str:
    """Return in words how many directions are off by more than an angle in degrees, and the largest error."""
    angles = trip.angles()
    count = int((angles > within).sum())
    return f"{count} of {len(angles)} are off by more than {within:g} degree, up to {angles.max():.3g} degrees"


def unusual(trip: Trip) -> float:
    """Return the error in degrees above which a direction counts as lost: more than rounding to few codes causes."""
    return max(SAME_DEG, UNUSUAL * float(np.median(trip.angles())))


def seam(trip: Trip, probe: Probe) -> Iterator[str]:
    """Yield one line if more than a few directions are lost: at a single pole, only where components are 0 or equal,
    or at a seam."""
    off = trip.angles() > unusual(trip)
    at_a_pole = np.abs(trip.n).max(axis=1) > np.cos(np.radians(2 * POLE_DEG))
    if off.mean() <= FEW:
        return
    gone = trip.of(off)
    if at_a_pole[off].all() and len(np.unique(np.round(gone.n), axis=0)) == 1:
        yield f"a pole is lost: {trip.worst}"
    elif _is_only_there(gone, probe):
        is_fold = probe.size == 2 and "" in folds.found(probe).encoder
        yield f"{_where(gone, is_fold)}: {off.sum()} of the directions tested; {trip.worst}"
    else:
        tried = f"{off.sum()} of {len(off)} tested directions"
        yield f"a seam: {tried} are off by more than {SAME_DEG:g} degree; {trip.worst}"


def _is_only_there(gone: Trip, probe: Probe) -> bool:
    """Whether all random directions next to the lost directions round-trip."""
    random = np.random.default_rng(2).normal(size=(TRIES, *gone.n.shape)) * BESIDE
    beside = (gone.n + random).reshape(-1, 3).astype(np.float32)
    back = probe.decode(np.clip(probe.encode(beside), -1, 1))
    return bool((angles_deg(beside, back) < SAME_DEG).all())


def _where(gone: Trip, is_fold: bool) -> str:
    """Return in words what the lost directions have in common: that sign() returns 0, for an octahedral fold or if
    each direction has a component of 0; otherwise that components are equal or 0."""
    if is_fold or (gone.n == 0).any(axis=1).all():
        return "sign() returns 0 for 0: only directions with a component of 0 are lost, not their neighbours"
    return "only directions with equal components or a 0 are lost, not their neighbours: check comparisons and sign()"


def poles(trip: Trip) -> Iterator[str]:
    """Yield a line for each pole near which directions are off by a large part of their distance from the pole."""
    for axis, side in itertools.product(range(3), (1.0, -1.0)):
        pole = side * np.eye(3)[axis]
        beside = angles_deg(trip.n, np.broadcast_to(pole, trip.n.shape))
        near = (beside > POLE_DEG / 2) & (beside < 2 * POLE_DEG)
        if not near.any():
            continue
        around = trip.of(near)
        lost = around.angles() / beside[near]
        is_unusual = np.median(around.angles()) > UNUSUAL * np.median(trip.angles())
        if is_unusual and np.median(lost) > POLE_SHARE and around.angles().max() < SAME_DEG:
            sign = "+" if side > 0 else "-"
            worst = int(np.argmax(lost))
            near_deg, off_deg = beside[near][worst], around.angles()[worst]
            loss = f"directions {near_deg:.2g} degrees from the pole are off by {off_deg:.2g} degrees"
            yield f"large errors around the pole {sign}{AXES[axis]}: {loss}; {around.example(worst)}"


def lengths(trip: Trip) -> Iterator[str]:
    norms = np.linalg.norm(trip.decoded.astype(np.float64), axis=1)
    if np.abs(norms - 1).max() > LENGTH:
        worst = int(np.argmax(np.abs(norms - 1)))
        message = f"decoded lengths range from {norms.min():.3g} to {norms.max():.3g}; normalize() is missing"
        yield f"{message}: {trip.example(worst)}"


def ranges(trip: Trip, domain: Domain, probe: Probe) -> Iterator[str]:
    """Yield a line for each component that is constant, that uses too little of the range of a storage, or that
    exceeds the range for directions that the encoding is made for. Nothing is yielded for packed codes."""
    if probe.is_packed:
        return
    held = domain.held(trip)
    clipped = np.clip(trip.codes, -1, 1)
    low, high = clipped.min(axis=0), clipped.max(axis=0)
    size = trip.codes.shape[1]
    constant = [i for i in range(size) if high[i] - low[i] < 1e-4]
    for number in constant:
        yield f"component {number + 1} of the code is unused: it is always {probe.own(low[number]):.3g}"
    others = [i for i in range(size) if i not in constant]
    for number in others:
        if (np.abs(held.codes[:, number]) > 1 + BEYOND).mean() > FEW:
            worst = int(np.argmax(np.abs(held.codes[:, number])))
            reached = probe.own(float(held.codes[worst, number]))
            reach = f"component {number + 1} of the code is {reached:.4g} for {vector(held.n[worst])}"
            yield f"{reach}: {CLIPPED} {probe.range}"
        elif (used := (high[number] - low[number]) / 2) < USED and not len(values(trip.codes, number)):
            between = f"{probe.own(low[number]):.3g} to {probe.own(high[number]):.3g}"
            yield f"component {number + 1} of the code ranges from {between}: {100 * (1 - used):.0f}{UNUSED}"


def bits_used(codes: np.ndarray) -> int:
    """Return how many bits of 32-bit integers differ among the integers, which are given as two halves in [-1, 1].

    If the integers are the bits of floats with whole values, count the bits of these values.
    """
    halves = np.rint((codes.astype(np.float64) * 0.5 + 0.5) * (2**16 - 1)).astype(np.uint32)
    whole = halves[:, 0] | halves[:, 1] << 16
    as_floats = whole.view(np.float32)
    with np.errstate(invalid="ignore"):
        is_counted = bool(((as_floats == np.rint(as_floats)) & (np.abs(as_floats) < WHOLE_FLOATS)).all())
    whole = as_floats.astype(np.int64) if is_counted else whole
    return int(np.bitwise_or.reduce(whole ^ whole[0])).bit_count()


def spared(trip: Trip, probe: Probe) -> Iterator[str]:
    """Yield a line for each component with few values that do not reach both ends of the range, or for packed codes
    that do not use all 32 bits. This is a waste only if bits are scarce."""
    if probe.is_packed:
        used = bits_used(trip.codes)
        yield from [f"only {used} of the code's 32 bits are used"] if used < 32 else ()
        return
    for number in range(probe.size):
        levels = values(trip.codes, number)
        if len(levels) > 1 and (levels[-1] - levels[0]) / 2 < USED:
            some = f"{len(levels)} values from {probe.own(levels[0]):.3g} to {probe.own(levels[-1]):.3g}"
            yield f"component {number + 1} of the code takes {some}; the rest of {probe.range} is unused"
