"""A chart as one immutable value, which `draw.py` writes as files and `wire.py` sends to the page.

Rows are mappings of plain values. A row on a codec names it in `codec`, as in tables and pictures.
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

from ..page.verdict import is_number

Row = Mapping[str, Any]
Domain = tuple[float, float]

# Of what has no order, on white and on dark paper; near Okabe and Ito's, moved apart until each two are told apart by
# those who do not see red, green or blue (a test computes how far).
COLOURS = ("#335FA3", "#BB5209", "#28895F", "#CA609E", "#AD8A27", "#0490CE", "#1A1D21", "#656375", "#834D3E")
DARK = ("#5393E6", "#EA8141", "#4DC287", "#BE8EB7", "#ECAA09", "#77CDFE", "#E7E9EC", "#B0BBC5", "#BE796C")
# Of what has an order: viridis from what stands out least from the paper to what stands out most.
ORDERED = ("#21918C", "#2C728E", "#3B528B", "#472D7B", "#440154")
ORDERED_DARK = ("#26828E", "#1F9E89", "#4AC16D", "#A0DA39", "#FDE725")
SHAPES = (
    *("circle", "square", "diamond", "triangle-up", "triangle-down", "cross", "triangle-left", "triangle-right"),
    *("star", "x"),
)
# Lengths of strokes and gaps; an empty one is a solid line.
DASHES: tuple[tuple[float, ...], ...] = ((), (5, 3), (1, 2), (6, 2, 1, 2), (1, 4), (7, 2, 1, 2, 1, 2), (9, 3))
# Colours without a name: of text and axes, of what is beside the point, and of the rest, which others stand out from.
INK, MUTED, FAINT, PAPER = "ink", "muted", "faint", "paper"
# Where counts are marked on their axis, which is logarithmic beyond the first few.
COUNTS, LINEAR_TO = (0, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000), 8
# Pixels of a page that a line of names takes, and that a chart without names is high.
LINE_HEIGHT, HEIGHT = 22, 380
# The share of an axis that is left free at either end.
MARGIN = 0.04
# A switch that shows all rows.
ALL = "all"


class Scale(StrEnum):
    """The way an axis places values."""

    LINEAR = "linear"
    LOG = "log"
    COUNT = "count"  # logarithmic beyond the first few
    NAMES = "names"  # one line for each name, the first on top or left


class Kind(StrEnum):
    """The kinds of mark that can be drawn for rows."""

    POINTS = "points"
    LINES = "lines"
    AREAS = "areas"  # between y and y2
    RULES = "rules"  # from x to x2, or from y to y2
    BARS = "bars"  # from x to x2, at a name of y
    CELLS = "cells"  # at names of x and of y
    TEXTS = "texts"  # where the row says
    LABELS = "labels"  # of points; near them, where there is room
    ENDS = "ends"  # of lines; to the right of their last points, apart from each other


@dataclass(frozen=True, kw_only=True)
class Axis:
    """An axis of a chart.

    Attributes:
        title: what the axis measures, with the unit; empty for self-explanatory names.
        scale: how values are mapped to positions.
        domain: the values at the ends of the axis; None to fit the rows, with a margin.
        ticks: positions and texts of the ticks; empty to let the renderer choose.
        names: all names in order, for a scale of names.
        is_shared: whether all panels have the same domain.
    """

    title: str
    scale: Scale = Scale.LINEAR
    domain: Domain | None = None
    ticks: tuple[tuple[float, str], ...] = ()
    names: tuple[str, ...] = ()
    is_shared: bool = True

    @property
    def counts(self) -> tuple[int, ...]:
        """The ticks for a scale of counts, within its domain; empty for other scales."""
        low, high = self.domain or (0.0, 0.0)
        return tuple(count for count in COUNTS if low <= count <= high) if self.scale == Scale.COUNT else ()

    def along(self, value: float) -> float:
        """Return the position of a value on a uniform scale, such as its logarithm for a logarithmic axis."""
        if self.scale == Scale.LOG:
            return math.log(value)
        return math.copysign(math.log1p(abs(value) / LINEAR_TO), value) if self.scale == Scale.COUNT else value

    def back(self, along: float) -> float:
        """Return the value for a transformed value: the inverse of `along`."""
        if self.scale == Scale.LOG:
            return math.exp(along)
        is_count = self.scale == Scale.COUNT
        return math.copysign(math.expm1(abs(along)) * LINEAR_TO, along) if is_count else along

    def share(self, value: float) -> float:
        """Return the position of a value on the axis: 0 at the first end of the domain, 1 at the other."""
        assert self.domain
        low, high = map(self.along, self.domain)
        return (self.along(value) - low) / (high - low)

    def at(self, share: float) -> float:
        """Return the value at a position on the axis: 0 is the first end of the domain, 1 the other."""
        assert self.domain
        low, high = map(self.along, self.domain)
        return self.back(low + share * (high - low))

    def places(self, value: Any) -> bool:
        """Whether the axis can place a value: a known name, or a finite number, which must be above 0 for a
        logarithmic scale."""
        if self.scale == Scale.NAMES:
            return value in self.names
        return is_number(value) and math.isfinite(value) and (self.scale != Scale.LOG or value > 0)


@dataclass(frozen=True)
class Names:
    """Names that are distinguished by colours, shapes, dashes or panels.

    Attributes:
        field: the field of rows that contains the names.
        values: all names, in order.
        title: what the names are: the heading of the page's legend. In files it follows each name, as a unit does.
        looks: shapes or dashes for the values; empty to use the usual ones in turn.
        is_ordered: whether the values increase, as bits do; their colours then go from light to dark.
    """

    field: str
    values: tuple[Any, ...]
    title: str = ""
    looks: tuple[Any, ...] = ()
    is_ordered: bool = False

    def colours(self, is_dark: bool = False) -> list[str]:
        """Return the colour for each value, on a white or a dark background, as #RRGGBB."""
        if self.is_ordered:
            return _between(ORDERED_DARK if is_dark else ORDERED, len(self.values))
        return self.of(DARK if is_dark else COLOURS)

    def of(self, looks: Sequence[Any]) -> list[Any]:
        """Return the look for each value, taken in turn from the names' own looks or otherwise from `looks`."""
        return [(self.looks or looks)[i % len(self.looks or looks)] for i in range(len(self.values))]


@dataclass(frozen=True)
class Shades:
    """Colours for numbers from `low` to `high`, on a logarithmic scale; the title includes the unit."""

    field: str
    title: str
    low: float
    high: float


@dataclass(frozen=True)
class Switch:
    """A choice that the reader of the page makes, with one control for all charts of a figure.

    Attributes:
        field: the field of rows by which the reader chooses.
        label: label of the control.
        values: the choices; ALL shows all rows.
        usual: the initial choice, which files show too.
        has_panels: whether files show all choices instead, with a panel for each.
    """

    field: str
    label: str
    values: tuple[str, ...]
    usual: str
    has_panels: bool = False


@dataclass(frozen=True, kw_only=True)
class Mark:
    """A mark that is drawn for rows.

    Attributes:
        kind: points, lines and so on.
        rows: the mark's own rows; None for the chart's rows.
        x, y, x2, y2: the fields that contain its positions.
        text: the field that contains the text of texts, labels and line ends.
        colour: INK, MUTED, FAINT, PAPER (for text on a colour), the field of the chart's colours, or a field that
            contains colours.
        shape: for points, one of SHAPES or the field of the chart's shapes.
        dash: for lines, "solid", "dashed", "dotted" or the field of the chart's dashes.
        by: the fields that distinguish lines, areas and line ends.
        rest: a field that is true in less important rows, whose points and labels are FAINT.
        is_stepped: whether lines and areas are drawn as steps, first horizontally and then vertically.
        tips: fields shown at the pointer, with their labels.
    """

    kind: Kind
    rows: tuple[Row, ...] | None = None
    x: str = "x"
    y: str = "y"
    x2: str = ""
    y2: str = ""
    text: str = ""
    colour: str = INK
    shape: str = SHAPES[0]
    dash: str = "solid"
    by: tuple[str, ...] = ()
    rest: str = ""
    is_stepped: bool = False
    tips: tuple[tuple[str, str], ...] = ()

    @property
    def fields(self) -> set[str]:
        """The fields of rows that the mark reads."""
        named = (self.x, self.y, self.x2, self.y2, self.text, self.colour, self.shape, self.dash, self.rest)
        return {*named, *self.by, *(field for field, _ in self.tips)}

    def groups(self, rows: Sequence[Row]) -> list[list[Row]]:
        """Return the rows grouped by the fields in `by`: a group for each line, area or line end."""
        groups: dict[Hashable, list[Row]] = {}
        for row in rows:
            groups.setdefault(tuple(row.get(name) for name in self.by), []).append(row)
        return list(groups.values())


@dataclass(frozen=True, kw_only=True)
class Chart:
    """A chart.

    Attributes:
        name: name of its files, without an extension.
        title: the finding that the chart shows.
        subtitle: what is plotted, and under what conditions.
        description: text for readers who cannot see the chart.
        x, y: its axes.
        marks: its marks, from back to front.
        rows: rows for marks without rows of their own.
        colour, shape, dash: the names that colours, shapes and dashes distinguish.
        panels: names that each have a panel, with the same marks; rows without the field are in every panel.
        switch: a choice for the reader of the page.
        height: height of a panel on the page, in pixels; 0 for the usual height.
    """

    name: str
    title: str
    subtitle: str
    description: str
    x: Axis
    y: Axis
    marks: tuple[Mark, ...]
    rows: tuple[Row, ...] = ()
    colour: Names | Shades | None = None
    shape: Names | None = None
    dash: Names | None = None
    panels: Names | None = None
    switch: Switch | None = None
    height: int = 0

    @property
    def pixels(self) -> int:
        """The height of a panel on the page, in pixels."""
        return self.height or LINE_HEIGHT * len(self.y.names or self.y.ticks) or HEIGHT

    def named(self, look: str, mark: Mark) -> Names | None:
        """Return the names that a mark's colour, shape or dash distinguishes; None if it distinguishes none.

        Args:
            look: "colour", "shape" or "dash"."""
        names = getattr(self, look)
        return names if isinstance(names, Names) and names.field == getattr(mark, look) else None

    @property
    def legends(self) -> list[dict[str, Names]]:
        """The entries of the legend: for each field that is distinguished, its names by colour, shape and dash."""
        fields: dict[str, dict[str, Names]] = {}
        for name in ("colour", "shape", "dash"):
            if isinstance(names := getattr(self, name), Names):
                fields.setdefault(names.field, {})[name] = names
        return list(fields.values())

    def rows_of(self, mark: Mark) -> tuple[Row, ...]:
        """Return the rows for a mark whose values the axes can place."""
        axes = ((self.x, mark.x), (self.x, mark.x2), (self.y, mark.y), (self.y, mark.y2))
        used = [(axis, name) for axis, name in axes if name]
        rows = self.rows if mark.rows is None else mark.rows
        return tuple(row for row in rows if all(axis.places(row.get(name)) for axis, name in used))

    def lasts(self, mark: Mark) -> list[Row]:
        """Return the last row of each line of a mark, next to which the line's name is written."""
        return [line[-1] for line in mark.groups(self.rows_of(mark))]

    def still(self) -> list[tuple[str, Chart]]:
        """Return the named panels for a file, where there is no switch: with the usual choice, or with a panel for
        each choice."""
        switch = self.switch
        if not switch or switch.usual == ALL:
            return self.parts()
        if switch.has_panels:
            return replace(self, switch=None, panels=Names(switch.field, switch.values)).parts()
        return [(name, part._only(switch.field, switch.usual)) for name, part in self.parts()]

    def parts(self) -> list[tuple[str, Chart]]:
        """Return pairs of a panel's name, empty without panels, and the panel as a chart; its axes have domains."""
        whole = replace(self, x=self._measured("x"), y=self._measured("y"), panels=None)
        if not self.panels:
            return [("", whole)]
        return [(str(value), whole._panel(self, self.panels.field, value)) for value in self.panels.values]

    def _panel(self, whole: Chart, field: str, value: Any) -> Chart:
        part = self._only(field, value)
        own = {name: axis for name in ("x", "y") if not (axis := getattr(whole, name)).is_shared}
        part = replace(part, **own)
        return replace(part, x=part._measured("x"), y=part._measured("y"))

    def _only(self, field: str, value: Any) -> Chart:
        """Return the chart with only the rows that have this value in a field or lack the field."""

        def kept(rows: Sequence[Row]) -> tuple[Row, ...]:
            return tuple(row for row in rows if row.get(field, value) == value)

        marks = (replace(mark, rows=mark.rows and kept(mark.rows)) for mark in self.marks)
        return replace(self, rows=kept(self.rows), marks=tuple(marks))

    def _measured(self, name: str) -> Axis:
        """Return the axis `x` or `y` with a domain that contains the values in its rows."""
        axis: Axis = getattr(self, name)
        if axis.domain or axis.scale == Scale.NAMES:
            return axis
        positions = [axis.along(value) for value in self._values(name)]
        low, high = min(positions, default=0.0), max(positions, default=1.0)
        margin = MARGIN * (high - low) or 0.5
        return replace(axis, domain=(axis.back(low - margin), axis.back(high + margin)))

    def _values(self, name: str) -> Iterator[float]:
        for mark in self.marks:
            fields = [field for field in (getattr(mark, name), getattr(mark, f"{name}2")) if field]
            yield from (row[field] for row in self.rows_of(mark) for field in fields)


def apart(wanted: Sequence[float], least: float) -> list[float]:
    """Return the positions closest to the wanted ones, in the same order, with at least `least` between neighbours.

    Neighbours that are too close are moved apart together (pool adjacent violators, the least-squares solution under
    an order: Barlow et al. 1972, Statistical Inference under Order Restrictions).
    """
    groups: list[tuple[float, int]] = []  # the mean of wanted less what stands before, and of how many
    for index, place in enumerate(wanted):
        groups.append((place - index * least, 1))
        while len(groups) > 1 and groups[-2][0] > groups[-1][0]:
            (a, m), (b, n) = groups.pop(-2), groups.pop()
            groups.append(((a * m + b * n) / (m + n), m + n))
    means = [mean for mean, count in groups for _ in range(count)]
    return [mean + i * least for i, mean in enumerate(means)]


def lines_apart(axis: Axis, values: Sequence[float], height: float, least: float) -> list[float]:
    """Return the positions of the labels for values on a vertical axis, each on its own line and near its value.

    Args:
        axis: an axis with a domain.
        values: the values to label.
        height: height of the axis.
        least: smallest distance between the lines of two labels, in the unit of `height`.

    Returns:
        positions as shares of the axis, in the order of the values.
    """
    order = sorted(range(len(values)), key=lambda index: axis.share(values[index]))
    placed = apart([axis.share(values[i]) * height for i in order], least)
    shares = dict(zip(order, placed, strict=True))
    return [shares[i] / height for i in range(len(values))]


def distinct(rows: Sequence[Row], field: str) -> tuple[Any, ...]:
    """Return the distinct values of a field, in order of first occurrence."""
    return tuple(dict.fromkeys(row[field] for row in rows))


def _between(colours: Sequence[str], count: int) -> list[str]:
    """Return this many colours, evenly spaced along a gradient; a single colour is the middle one."""
    last = len(colours) - 1
    return [_mixed(colours, i / (count - 1) * last if count > 1 else last / 2) for i in range(count)]


def _mixed(colours: Sequence[str], place: float) -> str:
    """Return the colour at a position in a gradient: 2.5 is midway between the third and the fourth colour."""
    index = min(int(place), len(colours) - 2)
    pairs = ((int(colour[i : i + 2], 16) for colour in colours[index : index + 2]) for i in (1, 3, 5))
    return "#" + "".join(f"{round(a + (b - a) * (place - index)):02X}" for a, b in pairs)
