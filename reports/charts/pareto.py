"""The cost of codecs against their error, and the Pareto front."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..ties import TIE_DB


@dataclass(frozen=True)
class Point:
    """A codec as a point in a chart.

    Attributes:
        name: label of the point.
        cost: cost in instructions.
        psnr: PSNR in dB.
        bits: bits that the codec uses.
        is_starred: whether the cost counts both sides of a branch.
        codec: the encoding with its storage.
    """

    name: str
    cost: float
    psnr: float
    bits: int
    is_starred: bool = False
    codec: str = ""


@dataclass(frozen=True)
class Panel:
    """Points for one kind of cost on one machine.

    Attributes:
        kind: what the costs are for, such as decoding; panels of the same kind share a panel of the chart.
        points: the points, at least one.
        machine: the machine to which the costs apply; a chart with several machines has a switch between them.
        is_usual: whether the switch shows the machine first.
    """

    kind: str
    points: Sequence[Point]
    machine: str = ""
    is_usual: bool = True


def pareto_front(points: Sequence[Point]) -> list[Point]:
    """Return the points that no other point beats, sorted by cost. A point beats another if it is no worse in any
    respect and better in at least one; PSNR differences of up to TIE_DB do not count."""
    front = [point for point in points if not any(_beats(other, point) for other in points)]
    return sorted(front, key=lambda p: (p.cost, -p.psnr, p.bits))


def _beats(a: Point, b: Point) -> bool:
    worse_by = (
        (a.cost - b.cost, 0),
        (b.psnr - a.psnr, TIE_DB),
        (a.bits - b.bits, 0),
    )
    return all(by <= nothing for by, nothing in worse_by) and any(by < -nothing for by, nothing in worse_by)
