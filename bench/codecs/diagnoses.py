"""What is likely wrong with an encoder, from what its round trip does to directions before any storage.

Arrays are float of shape (count, ...), a row for each direction: `n` the direction, `codes` its numbers, `decoded` what
comes back. Each diagnosis is a line with its figure and a direction that shows it.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..metrics.angles import angles_deg

# Two directions this near are the same one; storages of 8 bits move them by half of it.
SAME_DEG = 1.0
# And this near nearly so: a scale that is a few hundredths off.
NEARLY_DEG = 10.0
# Shares of directions: nearly all, and so few that a singular point may lose them.
MOST, FEW = 0.95, 0.002
# Of [-1, 1]: how much a number must use, and how far it may reach beyond.
USED, BEYOND = 0.8, 1e-3
# How much of [0, 1] the codes of some thousand directions fill at least, how far roundings lead beyond, the share that
# roundings next to a pole may lead farther, and how far.
NEARLY_FULL, ROUNDED, NEXT_TO_A_POLE, FARTHER = 0.9, 1e-6, 0.01, 0.1
# How far a decode's length may be from 1.
LENGTH = 0.01
# Of a direction's distance from a pole: how far off it may come back. Beside the pole by this angle.
POLE_SHARE, POLE_DEG = 0.5, 0.06
# How much farther off than usual a direction is at a seam or a pole: encodings of few codes are never exact.
UNUSUAL = 30.0
# By what the angles of z < 0 are larger than those of z >= 0 where an encoding is made for these alone.
FAR_BETTER = 2.0
AXES = "xyz"
CLIPPED = "storages clip what is beyond [-1, 1]"


@dataclass(frozen=True)
class Trip:
    """Directions, where they are seen from, their codes, and what comes back of these as storages clip them."""

    n: np.ndarray
    view: np.ndarray
    codes: np.ndarray
    decoded: np.ndarray

    def of(self, which: np.ndarray) -> Trip:
        """Some of them."""
        return Trip(self.n[which], self.view[which], self.codes[which], self.decoded[which])

    def in_domain(self, domain: str) -> Trip:
        """Those that an encoding of a domain is made for."""
        return self.of(DOMAINS[domain](self)) if domain else self

    def angles(self) -> np.ndarray:
        """How far each comes back, in degrees."""
        return angles_deg(self.n, self.decoded)

    def example(self, at: int) -> str:
        """A direction and what it becomes."""
        return f"{vector(self.n[at])} becomes {vector(self.decoded[at])}"

    @property
    def worst(self) -> str:
        """The direction that comes back farthest, and what it becomes."""
        return self.example(int(np.argmax(self.angles())))


# In this order: what comes back of z >= 0 does so of much that faces the viewer.
DOMAINS: Mapping[str, Callable[[Trip], np.ndarray]] = MappingProxyType(
    {
        "sphere": lambda trip: np.full(len(trip.n), True),
        "hemisphere": lambda trip: trip.n[:, 2] >= 0,
        "view": lambda trip: np.sum(trip.n * trip.view, axis=1) < 0,
    }
)


def vector(values: np.ndarray) -> str:
    return "(" + ", ".join(f"{value + 0.0:.3g}" for value in values) + ")"


def diagnoses(trip: Trip, domain: str) -> list[str]:
    """What is likely wrong.

    Args:
        domain: one of DOMAINS; empty where directions of none come back.
    """
    likely = domain or _likely(trip)
    held = trip.in_domain(likely)
    ranges = list(_ranges(trip, held))
    if domain:
        return [*_other_half(trip, domain), *_seam(held), *_poles(held), *_lengths(held), *ranges]
    # What is clipped comes back elsewhere, whatever else is right.
    turned = [] if any(CLIPPED in said for said in ranges) else list(_turned(trip)) or [_no_pair(held, likely)]
    return [*turned, *_lengths(held), *ranges]


def guessed(trip: Trip, within: float = SAME_DEG) -> str:
    """The domain: where the decoder undoes the encoder within so many degrees, seams and poles apart; empty where
    nowhere."""
    is_same = trip.angles() < within
    return next((name for name, which in DOMAINS.items() if is_same[which(trip)].mean() > MOST), "")


def _likely(trip: Trip) -> str:
    """The domain where nothing comes back well: where it nearly does, or else those that come back far better than the
    rest."""
    nearly = guessed(trip, NEARLY_DEG)
    if nearly:
        return nearly
    behind, angles = trip.n[:, 2] < 0, trip.angles()
    return "hemisphere" if FAR_BETTER * angles[~behind].mean() < angles[behind].mean() else "sphere"


def is_unit(codes: np.ndarray) -> bool:
    """Whether every number of some codes lies in [0, 1] and, unless it is always the same, fills it.

    Of numbers in [-1, 1] a large share is negative, so that the few that roundings lead beyond make no difference.
    """
    low, high = codes.min(axis=0), codes.max(axis=0)
    beyond = (codes < -ROUNDED) | (codes > 1 + ROUNDED)
    is_in = (beyond.mean(axis=0) < NEXT_TO_A_POLE) & (low > -FARTHER) & (high < 1 + FARTHER)
    fills = (high - low > NEARLY_FULL) | (high == low)
    return bool(is_in.all() and fills.all() and (high > low).any())


def _other_half(trip: Trip, domain: str) -> Iterator[str]:
    """What is behind, where it comes back with axes swapped: an encoding of z >= 0 that knows no better mirrors z."""
    if domain != "hemisphere":
        return
    behind = trip.of(trip.n[:, 2] < -0.02)
    what = _axes_of(behind)
    if what and what != _said((0, 1, 2), (1, 1, -1)):
        yield f"directions with z < 0 come back with {what}: {behind.worst}"
    # A fold that keeps signs and swaps the rest.
    sizes = np.abs(behind.n)[:, (1, 0, 2)]
    if (angles_deg(sizes, np.abs(behind.decoded)) < SAME_DEG).mean() > MOST:
        yield f"directions with z < 0 come back with |x| and |y| swapped: is .yx missing? {behind.worst}"


def _turned(trip: Trip) -> Iterator[str]:
    """Directions that come back with axes swapped or reversed: all of them, or those of a half."""
    found = _axes_of(trip)
    if found:
        yield f"every direction comes back with {found}: {trip.worst}"
        return
    for axis, side in itertools.product(range(3), (1, -1)):
        half = trip.n[:, axis] * side > 0.02
        if (trip.of(~half & (trip.n[:, axis] * side < -0.02)).angles() < SAME_DEG).mean() > MOST:
            what = _axes_of(trip.of(half))
            sign = ">" if side > 0 else "<"
            lost = f"with {what}" if what else f"{np.median(trip.of(half).angles()):.3g} degrees off"
            yield f"directions with {AXES[axis]} {sign} 0 come back {lost}: {trip.of(half).worst}"
            return
    # Of an encoding of a hemisphere the rest comes back anywhere.
    front = trip.in_domain("hemisphere")
    if what := _axes_of(front):
        yield f"directions with z >= 0 come back with {what}: {front.worst}"


def _axes_of(trip: Trip) -> str:
    """Which axes are swapped or reversed in what comes back; empty where none are."""
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            if order == (0, 1, 2) and signs == (1, 1, 1):
                continue
            if (angles_deg(trip.n[:, order] * np.array(signs), trip.decoded) < SAME_DEG).mean() > MOST:
                return _said(order, signs)
    return ""


def _said(order: Sequence[int], signs: Sequence[int]) -> str:
    moved = [AXES[at] for at in range(3) if order[at] != at]
    reversed_ = [AXES[at] for at in range(3) if signs[at] < 0]
    said = [f"{' and '.join(moved)} swapped" if len(moved) == 2 else "x, y and z in another order"] if moved else []
    return " and ".join([*said, *([f"{' and '.join(reversed_)} reversed"] if reversed_ else [])])


def _no_pair(held: Trip, domain: str) -> str:
    where = {"hemisphere": " of directions with z >= 0", "view": " of directions that face the viewer"}.get(domain, "")
    apart = f"{held.angles().mean():.3g} degrees apart on average{where} without any storage"
    return f"encode and decode are not a pair: {apart}; {held.worst}"


def _seam(trip: Trip) -> Iterator[str]:
    off = trip.angles() > max(SAME_DEG, UNUSUAL * float(np.median(trip.angles())))
    at_a_pole = np.abs(trip.n).max(axis=1) > np.cos(np.radians(2 * POLE_DEG))
    if off.mean() > FEW and at_a_pole[off].all() and len(np.unique(np.round(trip.n[off]), axis=0)) == 1:
        yield f"a pole is lost: {trip.worst}"
    elif off.mean() > FEW:
        tried = f"{off.sum()} of {len(off)} directions that were tried"
        yield f"a seam: {tried} come back more than {SAME_DEG:g} degree off; {trip.worst}"


def _poles(trip: Trip) -> Iterator[str]:
    """Directions beside an axis that come back elsewhere, by a large part of their distance from it."""
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
            at = int(np.argmax(lost))
            said = f"directions {beside[near][at]:.2g} degrees from it come back {around.angles()[at]:.2g} degrees off"
            yield f"the pole {sign}{AXES[axis]} loses its neighbourhood: {said}; {around.example(at)}"


def _lengths(trip: Trip) -> Iterator[str]:
    lengths = np.linalg.norm(trip.decoded.astype(np.float64), axis=1)
    if np.abs(lengths - 1).max() > LENGTH:
        at = int(np.argmax(np.abs(lengths - 1)))
        said = f"decode gives lengths from {lengths.min():.3g} to {lengths.max():.3g}; normalize() is missing"
        yield f"{said}: {trip.example(at)}"


def _ranges(trip: Trip, held: Trip) -> Iterator[str]:
    """Numbers that use less than a storage has, of all directions, or more, of those that the encoding is made for."""
    clipped = np.clip(trip.codes, -1, 1)
    low, high = clipped.min(axis=0), clipped.max(axis=0)
    size = trip.codes.shape[1]
    constant = [at for at in range(size) if high[at] - low[at] < 1e-4]
    for at in constant:
        yield f"number {at + 1} of the code carries nothing: it is always {low[at]:.3g}"
    others = [at for at in range(size) if at not in constant]
    for at in others:
        if (np.abs(held.codes[:, at]) > 1 + BEYOND).mean() > FEW:
            worst = int(np.argmax(np.abs(held.codes[:, at])))
            reach = f"number {at + 1} of the code is {held.codes[worst, at]:.4g} for {vector(held.n[worst])}"
            yield f"{reach}: {CLIPPED}"
        elif (used := (high[at] - low[at]) / 2) < USED:
            yield f"number {at + 1} of the code is {low[at]:.3g} to {high[at]:.3g}: {100 * (1 - used):.0f} % is unused"
