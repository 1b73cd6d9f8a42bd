"""The directions that an encoding is made for: the directions that round-trip, unless the user states a domain."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from .....encodings.codecs.encoding import Encoding
from .....reports.page.verdict import MADE_FOR
from .probe import Trip

# The axes of a half, z first: engines have octahedra with y up, and view space whose visible half has z < 0.
AXES = "xyz"
HEMISPHERE = "hemisphere"


@dataclass(frozen=True)
class Domain:
    """The directions that an encoding is made for.

    Attributes:
        name: the domain's name in rows: "sphere", "hemisphere" or "view"; empty if no directions round-trip.
        axis: for a hemisphere, the index of the component that is at least 0 (at most 0 if `side` is -1).
        side: 1 or -1.
    """

    name: str
    axis: int = 2
    side: int = 1

    def holds(self, trip: Trip) -> np.ndarray:
        """Return whether each direction of a trip is in the domain, bool of shape (count,)."""
        if self.name == HEMISPHERE:
            return trip.n[:, self.axis] * self.side >= 0
        return np.sum(trip.n * trip.view, axis=1) < 0 if self.name == "view" else np.full(len(trip.n), True)

    def held(self, trip: Trip) -> Trip:
        """Return the part of a trip whose directions are in the domain."""
        return trip.of(self.holds(trip))

    def lost(self, trip: Trip) -> Trip:
        """Return the part of a trip in the opposite half of a hemisphere, away from the rim."""
        return trip.of(trip.n[:, self.axis] * self.side < -RIM)

    @property
    def text(self) -> str:
        """The condition for a hemisphere, such as z >= 0."""
        return f"{AXES[self.axis]} {'>=' if self.side > 0 else '<='} 0"

    @property
    def lost_text(self) -> str:
        """The condition for the opposite half of a hemisphere, such as z < 0."""
        return f"{AXES[self.axis]} {'<' if self.side > 0 else '>'} 0"

    @property
    def made_for(self) -> str:
        """The domain's description in notes, such as `normals with z >= 0`; empty for the sphere."""
        return f"normals with {self.text}" if self.name == HEMISPHERE else MADE_FOR.get(self.name, "")

    @property
    def is_turned(self) -> bool:
        """Whether the axis or side differs from that of the hemisphere z >= 0."""
        return (self.axis, self.side) != (2, 1)

    def measured(self, encoding: Encoding) -> Encoding:
        """Return an encoding with this domain. If `is_turned`, the result is rotated so that the hemisphere's axis is
        z, and the unrotated encoding is its `own`."""
        unturned = replace(encoding, domain=self.name or SPHERE.name)
        # Where z becomes its y, components move one place back: by the turn whose pole is x.
        turn = {0: "y", 1: "x", 2: "z"}[self.axis]
        return replace(unturned.turned(turn, self.side), own=unturned) if self.is_turned else unturned


# How far from the rim of a hemisphere its other half begins.
RIM = 0.02
SPHERE, VIEWED, NONE = Domain("sphere"), Domain("view"), Domain("")
HALVES = tuple(Domain(HEMISPHERE, axis, side) for axis in (2, 1, 0) for side in (1, -1))
# Of two that are as likely the first is meant.
IN_TURN = (SPHERE, HALVES[0], VIEWED, *HALVES[1:])
# Nearly all.
MOST = 0.95
# A half comes back as well as another one up to this factor; below this angle, in degrees, all are as exact as float32.
AS_WELL, EXACT_DEG = 1.1, 5e-5


def guessed(trip: Trip, within: float) -> Domain:
    """Return the domain that round-trips to within an angle in degrees, except at seams and poles; may be NONE."""
    is_same = trip.angles() < within
    shares = {domain: is_same[domain.holds(trip)].mean() for domain in IN_TURN}
    # A code of the sphere undoes seams of a half a little better; z >= 0 and what faces the viewer share most.
    likely = SPHERE if shares[SPHERE] > MOST else max(IN_TURN, key=shares.__getitem__)
    return likely if shares[likely] > MOST else NONE


def finite(trip: Trip) -> list[Domain]:
    """Return the domains in which encode and decode are finite for every tested direction; may be empty."""
    return [domain for domain in IN_TURN if trip.is_finite[domain.holds(trip)].all()]


def asked(name: str, trip: Trip, among: Collection[Domain] = IN_TURN) -> Domain:
    """Return the domain that a user names; for a hemisphere, the first half that is about as accurate as the best.

    Args:
        among: the domains where the code is finite. If they include any half, only these halves are considered.
    """
    if name != HEMISPHERE:
        return SPHERE if name == SPHERE.name else VIEWED
    angles = trip.angles()
    halves = [half for half in HALVES if half in among] or HALVES
    means = [float(np.mean(angles[half.holds(trip)])) for half in halves]
    return next(half for half, mean in zip(halves, means, strict=True) if mean <= min(means) * AS_WELL + EXACT_DEG)
