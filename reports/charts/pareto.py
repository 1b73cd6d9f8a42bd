"""What codecs cost against what they lose: which of them no other beats."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType

from ..ties import TIE_DB, TIE_SHARE

# A figure of more panels nobody reads.
MOST_PANELS = 12


@dataclass(frozen=True)
class Point:
    """A codec.

    Attributes:
        name: its label.
        cost, error: where it stands.
        bits: what it occupies.
        spread: how wide the interval is that the cost is known to lie in.
        is_starred: whether the cost counts both sides of a branch.
        codec: the encoding with its storage.
    """

    name: str
    cost: float
    error: float
    bits: int
    spread: float = 0.0
    is_starred: bool = False
    codec: str = ""


@dataclass(frozen=True)
class Panel:
    """Points of one kind and machine.

    Attributes:
        title: what stands above it.
        unit: what the cost is.
        points: one at least.
        kind, machine: what the costs are of, and on what; an interactive chart has a switch between machines.
        is_counted: whether the cost is a count, whose axis is logarithmic beyond the first few.
        is_usual: whether a switch shows it first.
    """

    title: str
    unit: str
    points: Sequence[Point]
    kind: str = ""
    machine: str = ""
    is_counted: bool = False
    is_usual: bool = True


@dataclass(frozen=True)
class Error:
    """What codecs lose.

    Attributes:
        label: what a reader calls it, with its unit.
        more_is_better: of decibels; angles are better small, and stand on an axis of logarithms.
        tolerance: what is no difference: so many decibels, such a share of an angle.
    """

    label: str
    more_is_better: bool
    tolerance: float

    def loss(self, error: float) -> float:
        """Less is better, and `step` is no difference."""
        return -error if self.more_is_better else math.log(error)

    @property
    def step(self) -> float:
        """The tolerance in `loss`."""
        return self.tolerance if self.more_is_better else math.log1p(self.tolerance)


def decibels(label: str) -> Error:
    """Decibels of what a label says."""
    return Error(f"{label}, dB", True, TIE_DB)


# The columns of quality that codecs are compared by.
ERRORS = MappingProxyType(
    {
        "psnr": ("psnr_db", decibels("PSNR")),
        "mean": ("angle_mean_deg", Error("mean angle, degrees", False, TIE_SHARE)),
        "max": ("angle_max_deg", Error("largest angle, degrees", False, TIE_SHARE)),
    }
)


def pareto_front(points: Sequence[Point], error: Error) -> list[Point]:
    """The points that no other beats, by cost: another does that is in no respect worse, and better in one, both by
    more than is no difference."""
    front = [point for point in points if not any(_beats(other, point, error) for other in points)]
    return sorted(front, key=lambda p: (p.cost, error.loss(p.error), p.bits))


def _beats(a: Point, b: Point, error: Error) -> bool:
    worse_by = (
        (a.cost - b.cost, (a.spread + b.spread) / 2),
        (error.loss(a.error) - error.loss(b.error), error.step),
        (a.bits - b.bits, 0),
    )
    return all(by <= nothing for by, nothing in worse_by) and any(by < -nothing for by, nothing in worse_by)
