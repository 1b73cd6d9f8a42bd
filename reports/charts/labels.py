"""Labels for charts in files, placed so that they cover nothing if possible."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from .chart import Chart, Kind, Mark, Row, lines_apart
from .looks import as_text, colour_of, places

# Where a label may stand around its point, the nearest first: in points, at so many angles.
DISTANCES, ANGLES = (7, 12, 18, 26, 36, 48, 62, 78, 96, 116), 24
SIZE, END_SIZE = 7, 8
# From one line of labels at ends to the next, and from the panel to the labels, in points.
LINE, AWAY = 9.5, 14
LEADER = {"arrowstyle": "-", "linewidth": 0.6}


def write_ends(axes: Any, part: Chart) -> list[Any]:
    """Write the names of lines to the right of a panel, so that the layout reserves room; return the text objects."""
    texts = []
    for mark, row in _lasts(part):
        name, colour, (x, y) = as_text(str(row[mark.text])), colour_of(part, mark, row), (row[mark.x], row[mark.y])
        leader = LEADER | {"color": colour, "relpos": (0, 0.5), "shrinkA": 0, "shrinkB": 0}
        shown = {"textcoords": axes.transAxes, "va": "center", "annotation_clip": False, "arrowprops": leader}
        texts.append(axes.annotate(name, (x, y), (1.05, part.y.share(y)), size=END_SIZE, color=colour, **shown))
    return texts


def _lasts(part: Chart) -> list[tuple[Mark, Row]]:
    """Return the last row of each line that is named at its end, paired with its mark."""
    ends = [mark for mark in part.marks if mark.kind == Kind.ENDS]
    return [(mark, row) for mark in ends for row in part.lasts(mark)]


def label_ends(axes: Any, part: Chart, texts: Sequence[Any]) -> None:
    """Move the names of lines apart, in a panel at its final position.

    Args:
        texts: the texts that `write_ends` returned.
    """
    box, points = axes.get_window_extent(), 72 / axes.figure.dpi
    values = [row[mark.y] for mark, row in _lasts(part)]
    for text, share in zip(texts, lines_apart(part.y, values, box.height * points, LINE), strict=True):
        text.set_position((1 + AWAY / (box.width * points), share))


def label_points(axes: Any, part: Chart) -> None:
    """Write a label for each point where it covers no point, line or other label, if possible."""
    marks = [mark for mark in part.marks if mark.kind == Kind.LABELS]
    taken = list(_covered(axes, part, axes.figure.dpi / 72)) if marks else []
    for mark in marks:
        rows = sorted(part.rows_of(mark), key=lambda row: bool(mark.rest and row.get(mark.rest)))
        for row, x, y in zip(rows, *places(part, mark, rows), strict=True):
            text = _written_label(axes, as_text(str(row[mark.text])), (x, y), colour_of(part, mark, row))
            taken.append(_placed(text, taken, axes.bbox))


def _written_label(axes: Any, label: str, point: tuple[float, float], colour: str) -> Any:
    leader = LEADER | {"color": "#BBBBBB", "shrinkA": 0, "shrinkB": 3}
    text = axes.annotate(
        label, point, (0, 0), textcoords="offset points", size=SIZE, color=colour, arrowprops=leader, zorder=4
    )
    # The layout is done, and is not to be done again around labels.
    text.set_in_layout(False)
    return text


def _covered(axes: Any, part: Chart, pixels: float) -> Iterator[Any]:
    """Yield the boxes that points, lines and rules cover, in pixels."""
    for mark in part.marks:
        rows = part.rows_of(mark)
        if mark.kind == Kind.POINTS and rows:
            for x, y in axes.transData.transform(list(zip(*places(part, mark, rows), strict=True))):
                yield _box(x, y, x, y, 4 * pixels)
        if mark.kind == Kind.LINES:
            for line in mark.groups(rows):
                corners = axes.transData.transform(_corners(mark, list(zip(*places(part, mark, line), strict=True))))
                yield from (box for a, b in pairwise(corners) for box in along(a, b, pixels))
        if mark.kind == Kind.RULES:
            for row in rows:
                ends = [(row[mark.x], row[mark.y]), (row[mark.x2 or mark.x], row[mark.y2 or mark.y])]
                start, end = axes.transData.transform(ends)
                yield from along(start, end, pixels)


def _corners(mark: Mark, line: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the corners of a stepped line, which runs across and then up or down; the points of any other line."""
    if not mark.is_stepped:
        return list(line)
    return [line[0], *(corner for (_, y), b in pairwise(line) for corner in ((b[0], y), b))]


def along(a: Any, b: Any, pixels: float) -> Iterator[Any]:
    """Yield boxes that cover a straight line, in pixels: one if the line is vertical or horizontal, otherwise many
    small boxes."""
    steps = 1 if min(abs(b[0] - a[0]), abs(b[1] - a[1])) < 1 else int(max(abs(b[0] - a[0]), abs(b[1] - a[1])) / 8) + 1
    for (x0, y0), (x1, y1) in pairwise(np.linspace(a, b, steps + 1).tolist()):
        yield _box(x0, y0, x1, y1, pixels)


def _box(x0: float, y0: float, x1: float, y1: float, padding: float) -> Any:
    from matplotlib.transforms import Bbox

    return Bbox.from_extents(min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)).padded(padding)


def _placed(written: Any, taken: Sequence[Any], within: Any) -> Any:
    """Move a label to the nearest free position, otherwise to the least crowded one, and return its box."""
    candidates, pixels, boxes = [], written.figure.dpi / 72, np.array([box.extents for box in taken])
    # Laying text out takes a hundred times as long as moving its box.
    at_point: dict[tuple[str, str], Any] = {}
    for x, y in _label_offsets():
        side = "left" if x > 1 else "right" if x < -1 else "center"
        height = "center" if abs(x) > abs(y) else "bottom" if y > 0 else "top"
        if (side, height) not in at_point:
            written.set(position=(0, 0), ha=side, va=height)
            at_point[side, height] = extent(written)
        box = at_point[side, height].translated(x * pixels, y * pixels)
        outside = not (within.x0 <= box.x0 and box.x1 <= within.x1 and within.y0 <= box.y0 and box.y1 <= within.y1)
        candidates.append((_overlaps(box, boxes) + 2 * outside, (x, y, side, height)))
        if not candidates[-1][0]:
            break
    x, y, side, height = min(candidates, key=lambda f: f[0])[1]
    written.set(position=(x, y), ha=side, va=height)
    return extent(written)


def _overlaps(box: Any, others: np.ndarray) -> int:
    """Return the number of boxes that a box overlaps.

    Args:
        others: boxes as left, bottom, right and top, (count, 4)."""
    left, bottom, right, top = others.T
    return int(np.count_nonzero((left <= box.x1) & (box.x0 <= right) & (bottom <= box.y1) & (box.y0 <= top)))


def extent(written: Any) -> Any:
    """Return the box of an annotation's text, in pixels, without its leader line."""
    from matplotlib.text import Text

    written.update_positions(written.figure.canvas.get_renderer())
    return Text.get_window_extent(written).padded(2)


def _label_offsets() -> list[tuple[float, float]]:
    turns = [2 * math.pi * step / ANGLES for step in range(ANGLES)]
    return [(far * math.cos(turn), far * math.sin(turn)) for far in DISTANCES for turn in turns]
