"""Charts as files, by matplotlib."""

from __future__ import annotations

import textwrap
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any

from .chart import DASHES, SHAPES, Axis, Chart, Kind, Mark, Names, Row, Scale, Shades
from .labels import label_ends, label_points, write_ends
from .looks import MARKERS, as_text, colour_of, marker_of, places, plain, shade, stroke, stroke_of
from .plots import drawn_off_screen, save

# How many letters an inch of a title holds, and a panel's name a line.
LETTERS, PANEL_LETTERS = 14, 64
# A page's pixels on an inch, and an inch of what stands around a panel.
PIXELS, AROUND = 85, 1.1
ALONE, BESIDE, MOST_ACROSS = 8.2, 4.8, 3
# Inches that names beside a panel take.
ENDS = 1.8
LEGEND = MappingProxyType({"fontsize": 8, "frameon": False})


def write(charts: Sequence[Chart], *files: tuple[Path, str]) -> None:
    """Write charts, one below the other, to each path in the given format, one of plots.FORMATS. Raises OSError."""
    with settings(charts[0].name if charts else ""):
        save(figure(charts), *files)


@contextmanager
def settings(name: str) -> Iterator[None]:
    """Configure matplotlib within a `with` block: text remains text, identifiers in the file are reproducible, and
    letters that a font lacks cause no warning.

    No matplotlibrc is read: a file in the current folder may be a stranger's, and could start LaTeX."""
    import matplotlib

    # Without a height for titles matplotlib lays out all labels anew at each drawing, to see what is in the way.
    chosen: Any = {"svg.fonttype": "none", "svg.hashsalt": name, "axes.titley": 1.0}
    with warnings.catch_warnings(), matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(chosen)
        warnings.filterwarnings("ignore", message=".*missing from.*font")
        warnings.filterwarnings("ignore", message="constrained_layout not applied")
        yield


def figure(charts: Sequence[Chart]) -> Any:
    """Return a matplotlib figure of charts, one below the other."""
    sizes = [_size(chart) for chart in charts] or [(ALONE, AROUND)]
    whole = drawn_off_screen().figure(
        figsize=(max(across for across, _ in sizes), sum(down for _, down in sizes)), layout="constrained"
    )
    panels = whole.subfigures(len(charts), 1, squeeze=False, height_ratios=[h for _, h in sizes]) if charts else []
    drawn = [part for chart, (place,) in zip(charts, panels, strict=True) for part in _draw(place, chart)]
    ends = [write_ends(axes, part) for part, axes in drawn]
    # Labels keep clear of what is drawn, which must stand where it will stand.
    if any(mark.kind in (Kind.LABELS, Kind.ENDS) for chart in charts for mark in chart.marks):
        whole.draw_without_rendering()
    for (part, axes), texts in zip(drawn, ends, strict=True):
        label_ends(axes, part, texts)
        label_points(axes, part)
    return whole


def _column_count(chart: Chart) -> int:
    count = len(chart.still())
    return min(count, 2 if count == 4 else MOST_ACROSS)


def _size(chart: Chart) -> tuple[float, float]:
    """Return the width and height of a chart in inches."""
    across, panels = _column_count(chart), len(chart.still())
    down = -(-panels // across)
    beside = ENDS if any(mark.kind == Kind.ENDS for mark in chart.marks) else 0.0
    return ALONE if across == 1 else (BESIDE + beside) * across, down * (chart.pixels / PIXELS + AROUND) + 0.6


def _draw(place: Any, chart: Chart) -> list[tuple[Chart, Any]]:
    """Draw a chart into a figure or a subfigure, and return its panels with their axes."""
    parts, across = chart.still(), _column_count(chart)
    grid = place.subplots(-(-len(parts) // across), across, squeeze=False)
    drawn = [(part, axes) for (_, part), axes in zip(parts, grid.flat, strict=False)]
    for (name, part), axes in zip(parts, grid.flat, strict=False):
        _panel(axes, part)
        axes.set_title(plain("\n".join(textwrap.fill(line, PANEL_LETTERS) for line in name.splitlines())), size=9)
    for axes in grid.flat[len(parts) :]:
        axes.remove()
    _title(place, chart)
    _legend(place, chart)
    if isinstance(chart.colour, Shades):
        _colour_bar(place, [axes for _, axes in drawn], chart.colour)
    return drawn


def _title(place: Any, chart: Chart) -> None:
    width = int(_size(chart)[0] * LETTERS)
    lines = [line for text in (chart.title, chart.subtitle) for line in textwrap.wrap(text, width)]
    place.suptitle(plain("\n".join(lines)), size=9, x=0.01, ha="left")


def _panel(axes: Any, part: Chart) -> None:
    _axis(axes.xaxis, axes.set_xlim, part.x)
    _axis(axes.yaxis, axes.set_ylim, part.y)
    if part.x.scale == Scale.NAMES:
        axes.tick_params(axis="x", rotation=30)
    axes.set_axisbelow(True)
    for name, axis in (("x", part.x), ("y", part.y)):
        # Names have lines of their own, and what is in a place of its own needs none.
        if axis.scale != Scale.NAMES and not (name == "y" and axis.ticks):
            axes.grid(axis=name, alpha=0.3)
    for mark in part.marks:
        rows = part.rows_of(mark)
        # Labels are written when all else is drawn.
        if rows and mark.kind in DRAWN:
            DRAWN[mark.kind](axes, part, mark, rows)


def _axis(axis: Any, limit: Any, chart_axis: Axis) -> None:
    """Configure a matplotlib axis as `chart_axis` describes.

    Args:
        axis: the matplotlib axis.
        limit: function that sets its limits."""
    axis.set_label_text(plain(chart_axis.title), size=9)
    if chart_axis.scale == Scale.NAMES:
        axis.set_ticks(range(len(chart_axis.names)), [as_text(name) for name in chart_axis.names], size=8)
        last = len(chart_axis.names) - 0.5
        limit(*((last, -0.5) if axis.axis_name == "y" else (-0.5, last)))
        return
    if chart_axis.scale == Scale.LOG:
        axis._set_axes_scale("log")
    elif chart_axis.scale == Scale.COUNT:
        axis._set_axes_scale("function", functions=_functions(chart_axis))
    assert chart_axis.domain
    limit(*chart_axis.domain)
    _ticks(axis, chart_axis)


def _functions(chart_axis: Axis) -> tuple[Any, Any]:
    """Return an axis's scale and the inverse, as functions of arrays for matplotlib."""
    import numpy as np

    return np.vectorize(chart_axis.along, otypes=[float]), np.vectorize(chart_axis.back, otypes=[float])


def _ticks(axis: Any, chart_axis: Axis) -> None:
    from matplotlib.ticker import LogLocator

    assert chart_axis.domain
    ticks = chart_axis.ticks or tuple((float(count), str(count)) for count in chart_axis.counts)
    if ticks:
        axis.set_ticks([position for position, _ in ticks], [as_text(name) for _, name in ticks], size=8)
        axis.set_ticks([], minor=True)
        return
    if chart_axis.scale == Scale.LOG and chart_axis.domain[1] < 3000 * chart_axis.domain[0]:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    # As plain text, which matplotlib lays out much faster than powers of ten.
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter("")
    axis.set_tick_params(labelsize=8)


def _points(axes: Any, part: Chart, mark: Mark, rows: Sequence[Row]) -> None:
    looks: dict[tuple[str, str], list[Row]] = {}
    # What is beside the point lies below.
    for row in sorted(rows, key=lambda row: not (mark.rest and row.get(mark.rest))):
        looks.setdefault((colour_of(part, mark, row), marker_of(part, mark, row)), []).append(row)
    for (colour, marker), alike in looks.items():
        axes.scatter(*places(part, mark, alike), color=colour, marker=marker, s=30, linewidths=1, zorder=3)


def _lines(axes: Any, part: Chart, mark: Mark, rows: Sequence[Row]) -> None:
    step = "steps-post" if mark.is_stepped else "default"
    for line in mark.groups(rows):
        style = {"color": colour_of(part, mark, line[0]), "linestyle": stroke_of(part, mark, line[0])}
        # What is dotted is beside the point.
        width = {"linewidth": 0.9, "alpha": 0.6} if mark.dash == "dotted" else {"linewidth": 1.4}
        axes.plot(*places(part, mark, line), drawstyle=step, **style, **width)


def _areas(axes: Any, part: Chart, mark: Mark, rows: Sequence[Row]) -> None:
    for area in mark.groups(rows):
        x, y = places(part, mark, area)
        style = {"color": colour_of(part, mark, area[0]), "alpha": 0.5, "linewidth": 0}
        axes.fill_between(x, [row[mark.y2] for row in area], y, step="post" if mark.is_stepped else None, **style)


def _rules(axes: Any, part: Chart, mark: Mark, rows: Sequence[Row]) -> None:
    x, y = places(part, mark, rows)
    style = {"color": [colour_of(part, mark, row) for row in rows], "linewidth": 1.2, "zorder": 1.5}
    if mark.x2:
        axes.hlines(y, x, [row[mark.x2] for row in rows], **style)
    else:
        axes.vlines(x, y, [row[mark.y2] for row in rows], **style)


def _bars(axes: Any, part: Chart, mark: Mark, rows: Sequence[Row]) -> None:
    x, y = places(part, mark, rows)
    width = [row[mark.x2] - start for row, start in zip(rows, x, strict=True)]
    axes.barh(y, width, 0.7, x, color=[colour_of(part, mark, row) for row in rows])


def _cells(axes: Any, part: Chart, mark: Mark, rows: Sequence[Row]) -> None:
    assert isinstance(part.colour, Shades)
    x, y = places(part, mark, rows)
    colours_of = shade(part.colour)
    colours = [colours_of.to_rgba(row[mark.colour]) for row in rows]
    axes.barh(y, 1, 1, [centre - 0.5 for centre in x], color=colours)


def _texts(axes: Any, part: Chart, mark: Mark, rows: Sequence[Row]) -> None:
    is_cell = part.x.scale == Scale.NAMES
    style = {"ha": "center", "size": 7} if is_cell else {"ha": "left", "size": 8}
    for row, x, y in zip(rows, *places(part, mark, rows), strict=True):
        offset = (0 if is_cell else 4, 0)
        colour = colour_of(part, mark, row)
        text = as_text(str(row[mark.text]))
        axes.annotate(text, (x, y), offset, textcoords="offset points", va="center", color=colour, **style)


DRAWN = MappingProxyType(
    {
        Kind.POINTS: _points,
        Kind.LINES: _lines,
        Kind.AREAS: _areas,
        Kind.RULES: _rules,
        Kind.BARS: _bars,
        Kind.CELLS: _cells,
        Kind.TEXTS: _texts,
    }
)


def _legend(place: Any, chart: Chart) -> None:
    """Draw the legend of colours, shapes and dashes, with one entry per name for each field; draw none if line ends
    are labelled."""
    from matplotlib.lines import Line2D

    if any(mark.kind == Kind.ENDS for mark in chart.marks):
        return
    handles = [
        Line2D([], [], label=as_text(f"{value} {names.title}".strip()), **_look(chart, named, i))
        for named in chart.legends
        for names in [next(iter(named.values()))]
        for i, value in enumerate(names.values)
    ]
    if handles:
        longest = max(len(str(handle.get_label())) for handle in handles)
        columns = max(1, int(_size(chart)[0] * LETTERS / (longest + 8)))
        place.legend(handles=handles, loc="outside lower center", ncols=min(columns, len(handles)), **LEGEND)


def _look(chart: Chart, named: Mapping[str, Names], index: int) -> dict[str, Any]:
    """Return matplotlib's properties for a legend entry: its colour, with a marker or a line style if needed."""
    kinds = {mark.kind for mark in chart.marks if mark.colour in {names.field for names in named.values()}}
    colour = named["colour"].colours()[index] if "colour" in named else "#555555"
    if "shape" in named:
        return {"color": colour, "marker": MARKERS[named["shape"].of(SHAPES)[index]], "linestyle": "", "markersize": 5}
    if "dash" in named:
        return {"color": colour, "linestyle": stroke(named["dash"].of(DASHES)[index])}
    if Kind.LINES in kinds:
        return {"color": colour}
    return {"color": colour, "marker": "s" if kinds & {Kind.BARS, Kind.AREAS} else "o", "linestyle": ""}


def _colour_bar(place: Any, axes: Sequence[Any], shades: Shades) -> None:
    bar = place.colorbar(shade(shades), ax=axes, label=shades.title, format="{x:g}")
    bar.minorticks_off()
