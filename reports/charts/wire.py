"""Charts as data for the page: charts.js, next to page.css, turns it into SVG with d3.

d3 was chosen because it provides building blocks rather than finished charts: the chart remains a value of this
program, and the page draws exactly what a file shows. Packed, d3 takes 0.1 MB. It is part of the package mpld3, which
is not imported for it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ..page.verdict import is_number
from .chart import (
    ALL,
    DASHES,
    FAINT,
    INK,
    LINEAR_TO,
    MUTED,
    PAPER,
    SHAPES,
    Axis,
    Chart,
    Kind,
    Mark,
    Names,
    Row,
    Scale,
    Shades,
    Switch,
    lines_apart,
)
from .labels import ANGLES, DISTANCES
from .looks import colour_map
from .plots import PlotError

Spec = dict[str, Any]
# The package that carries the library, and where in it.
PACKAGE, LIBRARY = "mpld3", "js/d3.v5.min.js"
# Colours of page.css. Beside a point, a name has to be read: FAINT is for what has none.
ROLES = MappingProxyType({role: f"var(--{role})" for role in (INK, MUTED, FAINT, PAPER)})
STROKES: Mapping[str, Sequence[float]] = MappingProxyType({"solid": (), "dashed": (5, 4), "dotted": (1, 3)})
# Shapes of points as paths, in a square from -1 to 1.
PATHS = MappingProxyType(
    {
        "circle": "M0,-1A1,1,0,1,1,0,1A1,1,0,1,1,0,-1Z",
        "square": "M-.88,-.88h1.76v1.76h-1.76z",
        "diamond": "M0,-1.25L.9,0L0,1.25L-.9,0z",
        "triangle-up": "M0,-1.15L1.1,.85h-2.2z",
        "triangle-down": "M0,1.15L1.1,-.85h-2.2z",
        "triangle-left": "M-1.15,0L.85,1.1v-2.2z",
        "triangle-right": "M1.15,0L-.85,1.1v-2.2z",
        "cross": "M-.38,-1.1h.76v.72h.72v.76h-.72v.72h-.76v-.72h-.72v-.76h.72z",
        "star": "M0,-1.3L.29,-.4L1.24,-.4L.47,.15L.77,1.05L0,.5L-.77,1.05L-.47,.15L-1.24,-.4L-.29,-.4z",
        "x": "M-1,-.7L-.3,0L-1,.7L-.7,1L0,.3L.7,1L1,.7L.3,0L1,-.7L.7,-1L0,-.3L-.7,-1z",
        "tick": "M-.2,-1.3h.4v2.6h-.4z",
    }
)
# Pixels of a line of labels, of a panel's name, and of an axis' marks with and without a title.
LABEL_LINE, NAME_LINE, MARKS, TITLED = 13, 22, 24, 44
# What a letter of a slanted name takes downwards, and the most of them.
DOWN, MOST_DOWN = 3.4, 24
# Colours of a legend of shades.
STOPS = 17


def library() -> str:
    """Return the text of d3's script. Raises PlotError if the package is missing or lacks the script."""
    module_spec = find_spec(PACKAGE)
    path = (
        Path(module_spec.submodule_search_locations[0]) / LIBRARY
        if module_spec and module_spec.submodule_search_locations
        else None
    )
    if path and path.is_file():
        return path.read_text(encoding="utf-8")
    message = f"{PACKAGE} {version(PACKAGE)} has no {LIBRARY}" if module_spec else f"{PACKAGE} is missing"
    raise PlotError(f"{message}, which draws the page's charts; install {PACKAGE} 0.5.12")


def spec(chart: Chart) -> Spec:
    """Return a chart as JSON data: the properties that its panels share, and each panel with its marks and rows."""
    parts = chart.parts()
    has_names = any(name for name, _ in parts) or (chart.switch is not None and chart.switch.usual != ALL)
    chart_spec: Spec = {"label": f"{chart.title}. {chart.description}", "height": chart.pixels}
    chart_spec |= {"top": NAME_LINE if has_names else 8, "bottom": max(_bottom(part.x) for _, part in parts)}
    chart_spec |= {"zooms": _zooms(chart), "legends": [_legend(chart, legend) for legend in chart.legends]}
    chart_spec["shades"] = _shades(chart.colour) if isinstance(chart.colour, Shades) else None
    chart_spec["switch"] = _switch(chart.switch) if chart.switch else None
    for look in LOOKS:
        if isinstance(names := getattr(chart, look), Names):
            chart_spec[look] = {
                "field": names.field,
                "looks": dict(zip(map(str, names.values), LOOKS[look](names), strict=True)),
            }
    if any(mark.kind == Kind.LABELS for mark in chart.marks):
        chart_spec["around"] = {"distances": list(DISTANCES), "angles": ANGLES}
    return chart_spec | {"panels": [_panel(name, part) for name, part in parts]}


def rounded(value: Any) -> float | None:
    """Return a number rounded to four digits; None if it is not a finite number."""
    return float(f"{value:.4g}") if is_number(value) and math.isfinite(value) else None


def _switch(switch: Switch) -> Spec:
    about = {"field": switch.field, "label": switch.label, "all": ALL}
    return about | {"values": list(switch.values), "usual": switch.usual}


def _zooms(chart: Chart) -> bool:
    """Whether a reader may zoom in: the chart has points, no labels at line ends and numbers on both axes."""
    kinds = {mark.kind for mark in chart.marks}
    return Kind.POINTS in kinds and Kind.ENDS not in kinds and not any(map(_has_words, (chart.x, chart.y)))


def _has_words(axis: Axis) -> bool:
    return axis.scale == Scale.NAMES or any(f"{position:g}" != name for position, name in axis.ticks)


def _bottom(axis: Axis) -> int:
    """Return the height of the margin below a panel in pixels: tick labels or slanted names, and the title."""
    longest = min(MOST_DOWN, max(map(len, axis.names), default=0))
    marks = MARKS + int(DOWN * longest) if axis.scale == Scale.NAMES else MARKS
    return marks + (TITLED - MARKS if axis.title else 0)


def _colours(names: Names) -> list[str]:
    """Return CSS colours for names, each for a light and a dark page."""
    return [f"light-dark({light}, {other})" for light, other in zip(names.colours(), names.colours(True), strict=True)]


def _paths(names: Names) -> list[str]:
    return [PATHS[name] for name in names.of(SHAPES)]


def _dashes(names: Names) -> list[str]:
    return [_dash(lengths) for lengths in names.of(DASHES)]


def _dash(lengths: Sequence[float]) -> str:
    return " ".join(f"{length:g}" for length in lengths)


LOOKS = MappingProxyType({"colour": _colours, "shape": _paths, "dash": _dashes})


def _legend(chart: Chart, named: Mapping[str, Names]) -> Spec:
    """Return the legend for a field: its title, and an entry for each name with its colour, shape and dash."""
    names = next(iter(named.values()))
    kinds = {mark.kind for mark in chart.marks if mark.colour in {look_names.field for look_names in named.values()}}
    looks = {look: LOOKS[look](look_names) for look, look_names in named.items()}
    usual = {
        "colour": ROLES[INK],
        "shape": PATHS["square" if kinds & {Kind.BARS, Kind.AREAS} else "circle"],
        "dash": "",
    }
    is_line = "shape" not in named and ("dash" in named or Kind.LINES in kinds)
    entries = [
        {"text": str(value), "is_line": is_line}
        | {look: looks.get(look, {i: default})[i] for look, default in usual.items()}
        for i, value in enumerate(names.values)
    ]
    return {"title": names.title, "entries": entries}


def _shades(shades: Shades) -> Spec:
    """Return the colours for numbers, and the ticks of their legend: texts and positions in percent of its length."""
    low, high = math.log10(shades.low), math.log10(shades.high)
    values = [shades.low, *(10.0**power for power in range(math.floor(low) + 1, math.ceil(high))), shades.high]
    ticks = [(round(100 * (math.log10(v) - low) / (high - low), 2), f"{v:g}") for v in values]
    # The end needs room of its own.
    ticks = [tick for tick in ticks[:-1] if tick[0] < 92] + ticks[-1:]
    about = {"field": shades.field, "title": shades.title, "low": shades.low, "high": shades.high}
    return about | {"ticks": ticks, "stops": colour_map(STOPS)}


def _panel(name: str, part: Chart) -> Spec:
    """Return a panel as data. Rows that several marks share are stored once, as columns."""
    tables: list[tuple[Sequence[Row], set[str]]] = []
    marks = []
    for mark in part.marks:
        rows = _drawn(part, mark)
        if rows:
            index = next((i for i, (kept, _) in enumerate(tables) if kept == rows), len(tables))
            tables[index:] = tables[index:] or [(rows, set())]
            tables[index][1].update(_fields(part, mark))
            marks.append(_mark(part, mark) | {"table": index})
    panel_spec: Spec = {"name": name, "x": _axis(part.x), "y": _axis(part.y), "marks": marks}
    return panel_spec | {"tables": [_columns(rows, fields) for rows, fields in tables]}


def _drawn(part: Chart, mark: Mark) -> Sequence[Row]:
    """Return the rows that a mark draws; for line ends the last rows, with positions as shares of the height."""
    if mark.kind != Kind.ENDS:
        return part.rows_of(mark)
    all_ends = [row for other in part.marks if other.kind == Kind.ENDS for row in part.lasts(other)]
    shares = lines_apart(part.y, [row[mark.y] for row in all_ends], part.pixels, LABEL_LINE)
    places = {id(row): share for row, share in zip(all_ends, shares, strict=True)}
    return [{**row, "end": places[id(row)]} for row in part.lasts(mark)]


def _fields(part: Chart, mark: Mark) -> set[str]:
    shown = {"codec", *([part.switch.field] if part.switch else []), *(["end"] if mark.kind == Kind.ENDS else [])}
    return mark.fields | shown


def _mark(part: Chart, mark: Mark) -> Spec:
    """Return a mark as data without default values; `named` lists the looks with which it distinguishes names."""
    mark_spec = {name: value for name in ("x", "y", "x2", "y2", "text", "rest") if (value := getattr(mark, name))}
    mark_spec |= {"kind": mark.kind, "colour": mark.colour} | (
        {"css": ROLES[mark.colour]} if mark.colour in ROLES else {}
    )
    mark_spec["named"] = [look for look in LOOKS if part.named(look, mark)]
    if mark.kind == Kind.POINTS:
        mark_spec["shape"] = PATHS.get(mark.shape, "")
    if mark.kind == Kind.LINES:
        mark_spec["dash"] = _dash(STROKES.get(mark.dash, ()))
        # What is dotted is beside the point.
        mark_spec["is_faint"] = mark.dash == "dotted"
    if mark.by:
        mark_spec["by"] = list(mark.by)
    return mark_spec | ({"is_stepped": True} if mark.is_stepped else {}) | ({"tips": mark.tips} if mark.tips else {})


def _axis(axis: Axis) -> Spec:
    axis_spec: Spec = {"title": axis.title, "scale": axis.scale}
    if axis.scale == Scale.NAMES:
        return axis_spec | {"names": list(axis.names)}
    ticks = axis.ticks or tuple((count, str(count)) for count in axis.counts)
    axis_spec |= {"domain": list(axis.domain or ()), "ticks": ticks, "has_words": _has_words(axis)}
    return axis_spec | ({"linear_to": LINEAR_TO} if axis.scale == Scale.COUNT else {})


def _columns(rows: Sequence[Row], fields: set[str]) -> Spec:
    """Return rows as columns, without empty columns; a column of text stores each text once, with indices."""
    columns = {name: [_plain(row.get(name)) for row in rows] for name in sorted(fields)}
    return {name: _words(values) for name, values in columns.items() if any(value is not None for value in values)}


def _words(values: list[Any]) -> Any:
    names = list(dict.fromkeys(values))
    if not all(isinstance(name, str) for name in names):
        return values
    places = {name: i for i, name in enumerate(names)}
    return {"names": names, "places": [places[value] for value in values]}


def _plain(value: Any) -> Any:
    """Return a value for a browser: floats rounded to four digits, and None for floats that are not finite."""
    return rounded(value) if isinstance(value, float) else value
