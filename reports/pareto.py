"""The plot of what codecs cost against what they lose."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from .plots import COLOURS, MARKERS, drawn_off_screen

# A name, what it costs, its error, and the bits it takes.
Point = tuple[str, float, float, int]
# Where a label may stand around its point, the nearest first: in points, at so many angles.
DISTANCES, ANGLES = (7, 12, 18, 26, 36, 48, 62), 16


def pareto_figure(panels: Sequence[tuple[str, str, Sequence[Point]]], error: str) -> Any:
    """Cost against error. What another beats is grey; the others are joined by steps, those of as many bits.

    Args:
        panels: a title, what the cost is, and points.
        error: the error's name; of decibels more are better, of all others less.

    Returns:
        a figure for `plots.save`.
    """
    pyplot = drawn_off_screen()
    more_is_better, across = "psnr" in error.lower(), min(len(panels), 2)
    down = -(-len(panels) // across)
    figure, axes = pyplot.subplots(
        down, across, figsize=(6.4 * across, 5.2 * down), squeeze=False, layout="constrained"
    )
    for axis, (title, unit, points) in zip(axes.flat, panels, strict=False):
        _draw_fronts(axis, points, more_is_better)
        axis.set_title(title, size=9)
        axis.set_xlabel(unit)
        axis.set_ylabel(error.replace("_", " "))
        axis.grid(alpha=0.3)
    for axis in axes.flat[len(panels) :]:
        axis.remove()
    figure.suptitle("grey: another is no dearer, no worse and takes no more bits", size=9)
    # Labels keep clear of what is drawn, which must stand where it will stand.
    figure.canvas.draw()
    for axis, (_, _, points) in zip(axes.flat, panels, strict=False):
        _label(axis, points, more_is_better)
    return figure


def pareto_front(points: Sequence[Point], more_is_better: bool) -> list[Point]:
    """The points that no other beats, by cost: none is as cheap, as good and as small, and better in one of them."""
    sign = -1 if more_is_better else 1
    rated = [((cost, sign * error, bits), (name, cost, error, bits)) for name, cost, error, bits in points]

    def beaten(rating: tuple[float, float, int]) -> bool:
        return any(o != rating and all(a <= b for a, b in zip(o, rating, strict=True)) for o, _ in rated)

    return [point for rating, point in sorted(rated, key=lambda r: r[0]) if not beaten(rating)]


def _draw_fronts(axis: Any, points: Sequence[Point], more_is_better: bool) -> None:
    front = pareto_front(points, more_is_better)
    for at, bits in enumerate(sorted({point[3] for point in points})):
        best, style = [p for p in front if p[3] == bits], {"marker": MARKERS[at % len(MARKERS)], "zorder": 3}
        beaten = [p for p in points if p[3] == bits and p not in front]
        colour = COLOURS[at % len(COLOURS)]
        axis.step([p[1] for p in best], [p[2] for p in best], where="post", color=colour, linewidth=1, alpha=0.5)
        axis.scatter([p[1] for p in beaten], [p[2] for p in beaten], color="#AAAAAA", s=24, **style)
        axis.scatter([p[1] for p in best], [p[2] for p in best], color=colour, s=34, label=f"{bits} bits", **style)
    axis.margins(0.12, 0.1)
    axis.legend(loc="lower right", fontsize=8)


def _label(axis: Any, points: Sequence[Point], more_is_better: bool) -> None:
    """Each point's name where it lies over no other point or name, as far as there is such a place."""
    from matplotlib.transforms import Bbox

    front, pixels = pareto_front(points, more_is_better), axis.figure.dpi / 72
    taken = [axis.get_legend().get_window_extent()]
    for x, y in axis.transData.transform([point[1:3] for point in points]):
        taken.append(Bbox.from_bounds(x - 4 * pixels, y - 4 * pixels, 8 * pixels, 8 * pixels))
    for point in (*front, *(p for p in points if p not in front)):
        colour = "black" if point in front else "#777777"
        leader = {"arrowstyle": "-", "color": "#BBBBBB", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 3}
        written = axis.annotate(
            point[0], point[1:3], (0, 0), textcoords="offset points", size=7, color=colour, arrowprops=leader
        )
        # The layout is done, and is not to be done again around labels.
        written.set_in_layout(False)
        taken.append(_placed(written, taken, axis.bbox))


def _placed(written: Any, taken: Sequence[Any], within: Any) -> Any:
    """Moves a label to the nearest place that is free, or else to the one that is taken least; gives its box."""
    found = []
    for x, y in _places():
        side = "left" if x > 1 else "right" if x < -1 else "center"
        height = "center" if abs(x) > abs(y) else "bottom" if y > 0 else "top"
        written.set(position=(x, y), ha=side, va=height)
        box = _extent(written)
        outside = not (within.x0 <= box.x0 and box.x1 <= within.x1 and within.y0 <= box.y0 and box.y1 <= within.y1)
        found.append((sum(box.overlaps(other) for other in taken) + 2 * outside, (x, y, side, height)))
        if not found[-1][0]:
            break
    x, y, side, height = min(found, key=lambda f: f[0])[1]
    written.set(position=(x, y), ha=side, va=height)
    return _extent(written)


def _extent(written: Any) -> Any:
    """The box of an annotation's text alone, without the line that leads to it."""
    from matplotlib.text import Text

    written.update_positions(written.figure.canvas.get_renderer())
    return Text.get_window_extent(written).padded(2)


def _places() -> list[tuple[float, float]]:
    turns = [2 * math.pi * step / ANGLES for step in range(ANGLES)]
    return [(far * math.cos(turn), far * math.sin(turn)) for far in DISTANCES for turn in turns]
