"""A published figure, and what becomes of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

REPRODUCED, SHORT, HOLDS = "reproduced", "short by sampling", "holds"
DIFFERENT, NOT_MEASURED, UNEXPLAINED = "different", "not measured", "unexplained"
# How far a maximum of some million samples may lie below the supremum, as a share of it.
SHORT_BY = 0.02
DEGREES, DECIBELS = "degrees", "dB"


class Measure(Protocol):
    """How our figure is got."""

    @property
    def command(self) -> str:
        """What shows it."""
        ...

    @property
    def scatter(self) -> float:
        """By which share of itself a figure of samples may differ from another set's."""
        ...

    def figure(self) -> float | None:
        """Ours; None where this machine cannot measure it."""
        ...


@dataclass(frozen=True)
class Figure:
    """What a source prints.

    Attributes:
        what, place: what the figure is, and where in the source it stands.
        value: as printed, with so many `digits` after the point, in `unit`.
        ours: how it is measured here.
        why: why ours is another figure; or, of one that is reproduced, what the source leaves unsaid.
        is_maximum: whether it is the largest of samples, and ours the supremum.
        bound: "below" or "above" where the source says only that.
        within: how far ours may be off besides, in `unit`.
        is_comparable: whether ours is the same thing at all; if not, equal numbers are a coincidence.
    """

    what: str
    place: str
    value: float
    digits: int
    unit: str
    ours: Measure
    why: str = ""
    is_maximum: bool = False
    bound: str = ""
    within: float = 0.0
    is_comparable: bool = True

    @property
    def printed(self) -> str:
        """The figure as it stands there."""
        return f"{self.value:.{self.digits}f}"

    def verdict(self, ours: float | None) -> str:
        """What is to be said of our figure."""
        if ours is None:
            return NOT_MEASURED
        if not self.is_comparable:
            return self._other_verdict
        if self.bound:
            is_kept = ours <= self.value if self.bound == "below" else ours >= self.value
            return HOLDS if is_kept else self._other_verdict
        # Half a unit of the last digit, and what the two sets of samples scatter.
        if abs(ours - self.value) <= 0.5001 * 10.0**-self.digits + self.ours.scatter * abs(ours) + self.within:
            return REPRODUCED
        if self.is_maximum and 0 < ours - self.value <= SHORT_BY * ours:
            return SHORT
        return self._other_verdict

    @property
    def _other_verdict(self) -> str:
        return DIFFERENT if self.why else UNEXPLAINED


@dataclass(frozen=True)
class Source:
    """Somebody's figures."""

    name: str
    figures: tuple[Figure, ...]
