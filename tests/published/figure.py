"""A published figure and the verdict on it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

REPRODUCED, SHORT, HOLDS = "reproduced", "short by sampling", "holds"
DIFFERENT, NOT_MEASURED, UNEXPLAINED = "different", "not measured", "unexplained"
# How far a maximum of some million samples may lie below the supremum, as a share of it.
SHORT_BY = 0.02
DEGREES, DECIBELS = "degrees", "dB"


class Measure(Protocol):
    """A way to obtain our figure."""

    @property
    def command(self) -> str:
        """The command that shows the figure."""
        ...

    @property
    def scatter(self) -> float:
        """The share by which a sampled figure may differ between sets of samples."""
        ...

    def figure(self) -> float | None:
        """Return our figure, or None if this machine cannot measure it."""
        ...


@dataclass(frozen=True)
class Figure:
    """A figure that a source prints.

    Attributes:
        what, place: description of the figure, and its place in the source.
        value: the printed value, with `digits` digits after the point, in `unit`.
        ours: how it is measured here.
        why: the reason why ours differs; or, if it is reproduced, a detail that the source leaves out.
        is_maximum: whether it is the largest of samples, and ours the supremum.
        bound: "below" or "above" if the source gives only a bound.
        within: additional difference allowed for ours, in `unit`.
        is_comparable: whether ours is the same quantity at all; if not, equal numbers are a coincidence.
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
        """The figure as the source prints it."""
        return f"{self.value:.{self.digits}f}"

    def verdict(self, ours: float | None) -> str:
        """Return the verdict on our figure."""
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
    """The figures of one source."""

    name: str
    figures: tuple[Figure, ...]
