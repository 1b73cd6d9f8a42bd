"""The plot of what codecs cost against what they lose."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from types import MappingProxyType
from typing import Any

import numpy as np

from ..ties import TIE_DB, TIE_SHARE
from .plots import COLOURS, MARKERS, drawn_off_screen

# Where a label may stand around its point, the nearest first: in points, at so many angles.
DISTANCES, ANGLES = (7, 12, 18, 26, 36, 48, 62, 78, 96, 116), 24
# Where instructions are marked on their axis, which is logarithmic beyond the first few.
TICKS, LINEAR_TO = (0, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000), 8
# A figure of more panels nobody reads.
MOST_PANELS = 12
GREY = "grey: another is no dearer, no worse and takes no more bits"


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

    def of_loss(self, loss: float) -> float:
        """The error of a loss."""
        return -loss if self.more_is_better else math.exp(loss)

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


def pareto_figure(panels: Sequence[Panel], error: Error) -> Any:
    """Cost against error. What another beats is grey; the others are joined by steps, those of as many bits.

    Args:
        panels: each with a point at least.

    Returns:
        a figure for `plots.save`.
    """
    pyplot = drawn_off_screen()
    across = min(len(panels), 2 if len(panels) <= 4 else 3)
    down = -(-len(panels) // across)
    figure, axes = pyplot.subplots(
        down, across, figsize=(6.4 * across, 5.2 * down), squeeze=False, layout="constrained"
    )
    styles = _styles(panels)
    for axis, panel in zip(axes.flat, panels, strict=False):
        _draw(axis, panel, error, styles)
    for axis in axes.flat[len(panels) :]:
        axis.remove()
    is_starred = any(point.is_starred for panel in panels for point in panel.points)
    figure.suptitle(GREY + "\n* counts both sides of a branch" * is_starred, size=9)
    _legend(figure)
    # Labels keep clear of what is drawn, which must stand where it will stand.
    figure.draw_without_rendering()
    for axis, panel in zip(axes.flat, panels, strict=False):
        _label(axis, panel.points, error)
    return figure


def _legend(figure: Any) -> None:
    """One for all panels, below them."""
    known = [axis.get_legend_handles_labels() for axis in figure.axes]
    shown = {label: handle for handles, labels in known for handle, label in zip(handles, labels, strict=True)}
    labels = sorted(shown, key=lambda label: int(label.split()[0]))
    handles = [shown[label] for label in labels]
    figure.legend(handles, labels, loc="outside lower center", ncols=len(shown), fontsize=8)


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


def _styles(panels: Sequence[Panel]) -> dict[int, dict[str, str]]:
    """A colour and a marker for each number of bits, the same in every panel."""
    bits = sorted({point.bits for panel in panels for point in panel.points})
    return {b: {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)]} for i, b in enumerate(bits)}


def _draw(axis: Any, panel: Panel, error: Error, styles: dict[int, dict[str, str]]) -> None:
    front = pareto_front(panel.points, error)
    for bits, style in styles.items():
        best = [p for p in front if p.bits == bits]
        beaten = [p for p in panel.points if p.bits == bits and p not in front]
        colour = style["color"]
        for points, size, shown in ((beaten, 24, "#AAAAAA"), (best, 34, colour)):
            if points:
                label = f"{bits} bits" if points is (best or beaten) else None
                where = [p.cost for p in points], [p.error for p in points]
                axis.scatter(*where, s=size, color=shown, marker=style["marker"], label=label, zorder=3)
                _bars(axis, points, shown)
        axis.plot(*_steps(best), color=colour, linewidth=1, alpha=0.5)
    axis.margins(0.12, 0.1)
    axis.set(xlabel=panel.unit, ylabel=error.label)
    axis.set_title(panel.title, size=9)
    if not error.more_is_better:
        axis.set_yscale("log")
    if panel.is_counted:
        count_axis(axis, max(point.cost for point in panel.points))
    axis.grid(alpha=0.3)


def count_axis(axis: Any, most: float) -> None:
    """Makes an axis across one of instructions up to a count: logarithmic beyond the first few."""
    axis.set_xscale("symlog", linthresh=LINEAR_TO)
    ticks = [tick for tick in TICKS if tick <= 1.3 * most]
    axis.set_xticks(ticks, list(map(str, ticks)), minor=False)
    axis.set_xticks([], minor=True)


def _bars(axis: Any, points: Sequence[Point], colour: str) -> None:
    """How surely the costs are known, where that is not exactly."""
    half = [p.spread / 2 for p in points]
    if any(half):
        where = [p.cost for p in points], [p.error for p in points]
        axis.errorbar(*where, xerr=half, fmt="none", ecolor=colour, elinewidth=0.8, capsize=2)


def _steps(best: Sequence[Point]) -> tuple[list[float], list[float]]:
    """The corners of steps through points: across to the next one's cost, then to its error."""
    corners = [(p.cost, p.error) for p in best[:1]]
    for a, b in pairwise(best):
        corners += [(b.cost, a.error), (b.cost, b.error)]
    return [x for x, _ in corners], [y for _, y in corners]


def _label(axis: Any, points: Sequence[Point], error: Error) -> None:
    """Each point's name where it lies over no point, line or other name, as far as there is such a place."""
    front, pixels = pareto_front(points, error), axis.figure.dpi / 72
    taken = list(_boxes(axis, points, 4 * pixels))
    for bits in {p.bits for p in front}:
        line = axis.transData.transform(list(zip(*_steps([p for p in front if p.bits == bits]), strict=True)))
        taken += [box for a, b in pairwise(line) for box in _along(a, b, pixels)]
    for point in (*front, *(p for p in points if p not in front)):
        colour = "black" if point in front else "#777777"
        leader = {"arrowstyle": "-", "color": "#BBBBBB", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 3}
        at = (point.cost, point.error)
        written = axis.annotate(
            point.name + "*" * point.is_starred,
            at,
            (0, 0),
            textcoords="offset points",
            size=7,
            color=colour,
            arrowprops=leader,
        )
        # The layout is done, and is not to be done again around labels.
        written.set_in_layout(False)
        taken.append(_placed(written, taken, axis.bbox))


def _boxes(axis: Any, points: Sequence[Point], half: float) -> Iterator[Any]:
    """What points and their bars cover, in pixels."""
    from matplotlib.transforms import Bbox

    for p in points:
        ends = [(p.cost - p.spread / 2, p.error), (p.cost + p.spread / 2, p.error)]
        (left, y), (right, _) = axis.transData.transform(ends)
        yield Bbox.from_extents(left - half, y - half, right + half, y + half)


def _along(a: Any, b: Any, pixels: float) -> Iterator[Any]:
    """The box of a line that goes up or across, in pixels."""
    from matplotlib.transforms import Bbox

    yield Bbox.from_extents(min(a[0], b[0]), min(a[1], b[1]), max(a[0], b[0]), max(a[1], b[1])).padded(pixels)


def _placed(written: Any, taken: Sequence[Any], within: Any) -> Any:
    """Moves a label to the nearest place that is free, or else to the one that is taken least; gives its box."""
    found, pixels, boxes = [], written.figure.dpi / 72, np.array([box.extents for box in taken])
    # Laying text out takes a hundred times as long as moving its box.
    at_point: dict[tuple[str, str], Any] = {}
    for x, y in _places():
        side = "left" if x > 1 else "right" if x < -1 else "center"
        height = "center" if abs(x) > abs(y) else "bottom" if y > 0 else "top"
        if (side, height) not in at_point:
            written.set(position=(0, 0), ha=side, va=height)
            at_point[side, height] = _extent(written)
        box = at_point[side, height].translated(x * pixels, y * pixels)
        outside = not (within.x0 <= box.x0 and box.x1 <= within.x1 and within.y0 <= box.y0 and box.y1 <= within.y1)
        found.append((_overlaps(box, boxes) + 2 * outside, (x, y, side, height)))
        if not found[-1][0]:
            break
    x, y, side, height = min(found, key=lambda f: f[0])[1]
    written.set(position=(x, y), ha=side, va=height)
    return _extent(written)


def _overlaps(box: Any, others: np.ndarray) -> int:
    """How many boxes, (count, 4) of left, bottom, right and top, a box meets."""
    left, bottom, right, top = others.T
    return int(np.count_nonzero((left <= box.x1) & (box.x0 <= right) & (bottom <= box.y1) & (box.y0 <= top)))


def _extent(written: Any) -> Any:
    """The box of an annotation's text alone, without the line that leads to it."""
    from matplotlib.text import Text

    written.update_positions(written.figure.canvas.get_renderer())
    return Text.get_window_extent(written).padded(2)


def _places() -> list[tuple[float, float]]:
    turns = [2 * math.pi * step / ANGLES for step in range(ANGLES)]
    return [(far * math.cos(turn), far * math.sin(turn)) for far in DISTANCES for turn in turns]
