"""Charts as the page draws them: specifications of Vega-Lite.

Vega-Lite was chosen because a chart is data instead of code, its expressions are interpreted so that a page needs no
`eval`, and its marks are SVG with labels that screen readers read. Packed, the bundle that vl-convert carries takes
0.4 MB; Plotly's smallest takes 0.5 MB.

Each has a parameter `picked`, the codec that the page highlights, empty for none. Colours are page.css's, so that they
follow its theme.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from importlib.metadata import version
from types import MappingProxyType
from typing import Any

from ..page.verdict import is_number
from .chart import (
    ALL,
    COLOURS,
    DASHES,
    FAINT,
    INK,
    LINEAR_TO,
    MUTED,
    SHAPES,
    Axis,
    Chart,
    Kind,
    Mark,
    Names,
    Row,
    Scale,
    Shades,
    lines_apart,
)

Spec = dict[str, Any]
# The package that carries the library.
PACKAGE = "vl-convert-python"
PALETTE = ["var(--ink)" if colour == "#000000" else f"var(--chart-{at})" for at, colour in enumerate(COLOURS)]
ROLES = MappingProxyType({role: f"var(--{role})" for role in (INK, MUTED, FAINT)})
STROKES: Mapping[str, list[float]] = MappingProxyType({"solid": [], "dashed": [5, 4], "dotted": [1, 3]})
# Shapes of its own, as paths.
PATHS = MappingProxyType(
    {
        "tick": "M-.15,-1h.3v2h-.3z",
        "x": "M-1,-.7L-.3,0L-1,.7L-.7,1L0,.3L.7,1L1,.7L.3,0L1,-.7L.7,-1L0,-.3L-.7,-1z",
        "star": "M0,-1L.22,-.31L.95,-.31L.36,.12L.59,.81L0,.38L-.59,.81L-.36,.12L-.95,-.31L-.22,-.31z",
    }
)
# Wider than the line that is seen, to be hit by a pointer.
HIDDEN = {"strokeWidth": 9, "opacity": 0.001}
PICKED = {"name": "picked", "value": ""}
# An encoding's name alone stands for each of its codecs.
IS_PICKED = "(datum.codec == picked || indexof(picked, ' ') < 0 && indexof(datum.codec, picked + ' ') == 0)"
IS_LIT = f"picked == '' || {IS_PICKED}"
LINE = "var(--line)"
CONFIG = {
    "background": None,
    "font": "system-ui, sans-serif",
    "view": {"stroke": None},
    "axis": {"labelColor": ROLES[INK], "titleColor": ROLES[MUTED], "gridColor": LINE}
    | {"domainColor": ROLES[MUTED], "tickColor": ROLES[MUTED]}
    | {"titleFontWeight": "normal", "labelLimit": 260, "labelFontSize": 12, "titleFontSize": 12},
    "legend": {"labelColor": ROLES[INK], "titleColor": ROLES[MUTED], "titleFontWeight": "normal", "orient": "top"}
    | {"labelFontSize": 12, "titleFontSize": 12, "symbolOpacity": 1, "symbolStrokeWidth": 2, "labelLimit": 360}
    # On a phone there is no room for two legends beside each other.
    | {"layout": {"top": {"anchor": "start", "direction": "vertical"}}},
}
# How many pixels a chart has across. Names of lines stand beside a panel that is wide enough.
ACROSS = {"name": "across", "expr": "containerSize()[0]"}
LEAST_PANEL = 330
# Pixels that a letter takes, what is beside the letters of a legend and beside the legend, and a line of labels.
LETTER, SYMBOL, SIDE, LABEL_LINE = 6.5, 40, 70, 13
# Labels of points beyond this share of the axis stand to the left of them.
TURNS_AT = 0.55


def library_name() -> str:
    """The library that draws specifications, and its version."""
    return f"{PACKAGE} {version(PACKAGE)}"


def library() -> str:
    """The library as a script that defines `vegaEmbed`. Takes seconds."""
    import vl_convert

    return f"(() => {{{vl_convert.javascript_bundle('window.vegaEmbed=vegaEmbed')}}})();"


def specs(chart: Chart) -> list[Spec]:
    """A chart as specifications, one for each panel."""
    return [_spec(name, part) for name, part in chart.parts()]


def rounded(value: Any) -> float | None:
    """Four digits; None for what is no finite number."""
    return float(f"{value:.4g}") if is_number(value) and math.isfinite(value) else None


def rows_of(spec: Spec) -> Iterator[Row]:
    """The rows that a specification draws."""
    for one in (spec, *spec.get("layer", ())):
        yield from one.get("data", {}).get("values", ())


def _spec(name: str, part: Chart) -> Spec:
    # Axes are there without anything between them, too.
    marks = [mark for mark in part.marks if part.rows_of(mark)] or part.marks[:1]
    layers = [layer for mark in marks for layer in LAYERS[mark.kind](part, mark)]
    layers = [layer | {"name": f"{layer['name']}_{at}"} for at, layer in enumerate(layers)]
    params: list[Spec] = [PICKED, ACROSS]
    said: Spec = {"description": " ".join(filter(None, (part.title, part.description, name)))}
    if part.switch:
        switch = {"param": part.switch.field, "label": part.switch.label, "options": list(part.switch.values)}
        params.append({"name": part.switch.field, "value": part.switch.usual})
        said["usermeta"] = {"switch": switch}
    if title := _title(name, part):
        said["title"] = {"text": title, "color": ROLES[MUTED], "fontWeight": "normal", "anchor": "start"}
    said |= {"width": "container", "height": part.pixels, "config": CONFIG, "params": params}
    return said | {"data": {"values": _plain(part.rows)}, "layer": layers}


def _ends_width(part: Chart) -> int:
    """How many pixels the names of lines take."""
    marks = [mark for mark in part.marks if mark.kind == Kind.ENDS]
    longest = max((len(str(row[mark.text])) for mark in marks for row in part.rows_of(mark)), default=0)
    return 20 + int(LETTER * longest)


def _has_room(part: Chart) -> str:
    """Whether names of lines have room beside a panel, as an expression."""
    return f"across > {LEAST_PANEL + _ends_width(part)}"


def _title(name: str, part: Chart) -> Any:
    """The panel's name, and what a switch has chosen."""
    if not part.switch or part.switch.usual == ALL:
        return name
    return {"expr": f"{json.dumps(f'{name}, ' if name else '')} + {part.switch.field}"}


def _plain(rows: Sequence[Row]) -> list[Spec]:
    """Rows as a browser reads them: four digits, and nothing for what is no finite number."""
    return [{name: _json_value(value) for name, value in row.items()} for row in rows]


def _json_value(value: Any) -> Any:
    return rounded(value) if isinstance(value, float) else value


def _layer(part: Chart, mark: Mark, shown: Spec, encoding: Spec, rows: Sequence[Row] | None = None) -> Spec:
    """A layer of a mark's rows, or of others."""
    shown = {"clip": mark.kind in (Kind.LINES, Kind.AREAS), **shown}
    layer: Spec = {"name": str(mark.kind), "mark": shown, "encoding": encoding}
    drawn = part.rows_of(mark) if rows is None else rows
    if drawn != part.rows:
        kept = {*mark.fields, "codec", "label", "right", *([part.switch.field] if part.switch else [])}
        layer["data"] = {"values": _plain([{k: v for k, v in row.items() if k in kept} for row in drawn])}
    if part.switch:
        field = part.switch.field
        # Rows without the field are shown whatever is chosen.
        test = f"{field} == '{ALL}' || !isValid(datum.{field}) || toString(datum.{field}) == {field}"
        layer["transform"] = [{"filter": test}]
    if any("codec" in row for row in drawn[:1]) and "opacity" not in encoding and "opacity" not in shown:
        encoding["opacity"] = if_lit(1, 0.15)
    if mark.tips:
        encoding.setdefault("tooltip", [{"field": name, "title": title} for name, title in mark.tips])
    return layer


def if_lit(lit: float, other: float) -> Spec:
    """A value for what is highlighted, and one for the rest; where nothing is, everything is."""
    return {"condition": {"test": IS_LIT, "value": lit}, "value": other}


def _places(part: Chart, mark: Mark) -> Spec:
    """Where a mark stands."""
    found = {"x": _place_channel(part.x, mark.x), "y": _place_channel(part.y, mark.y)}
    found |= {name: {"field": field} for name, field in (("x2", mark.x2), ("y2", mark.y2)) if field}
    return found


def _place_channel(axis: Axis, field: str) -> Spec:
    if axis.scale == Scale.NAMES:
        names = list(axis.names)
        return {"field": field, "type": "nominal", "sort": names, "title": axis.title or None} | {
            "scale": {"domain": names}
        }
    scale: Spec = {"domain": list(axis.domain or ()), "nice": False, "zero": False}
    if axis.scale == Scale.LOG:
        scale |= {"type": "log"}
        del scale["zero"]
    if axis.scale == Scale.COUNT:
        scale |= {"type": "symlog", "constant": LINEAR_TO}
        del scale["zero"]
    return {
        "field": field,
        "type": "quantitative",
        "scale": scale,
        "title": axis.title or None,
        "axis": _ticks_spec(axis),
    }


def _ticks_spec(axis: Axis) -> Spec:
    if axis.ticks:
        names = {f"{at:g}": name for at, name in axis.ticks}
        said = f"{json.dumps(names)}[toString(datum.value)]" if any(_is_word(tick) for tick in axis.ticks) else ""
        shown: Spec = {"values": [at for at, _ in axis.ticks], "grid": not said, "domain": not said, "ticks": not said}
        # "~g" writes 10 as 1e+1 beside 9.
        is_whole = all(float(at).is_integer() for at, _ in axis.ticks)
        return shown | ({"labelExpr": said} if said else {"format": "d" if is_whole else "~g"})
    if axis.scale == Scale.COUNT:
        return {"values": list(axis.counts), "format": "d"}
    # Thousands on a linear axis are no powers of ten.
    return {"format": "~g"} if axis.scale == Scale.LOG else {}


def _is_word(tick: tuple[float, str]) -> bool:
    return f"{tick[0]:g}" != tick[1]


def _colour(part: Chart, mark: Mark) -> Spec:
    """The colour of a mark."""
    if mark.colour in ROLES:
        found: Spec = {"value": ROLES[mark.colour]}
    elif names := part.named("colour", mark):
        found = _names_channel(names, PALETTE)
    else:
        found = {"value": {"expr": f"datum.{mark.colour}"}}
    if not mark.rest:
        return found
    faint = {"test": f"datum.{mark.rest}", "value": ROLES[FAINT]}
    return {"condition": faint, **found}


def _names_channel(names: Names, looks: Sequence[Any]) -> Spec:
    """Names by what they look like."""
    longest = max((len(str(value)) for value in names.values), default=1)
    columns = f"max(1, min({len(names.values)}, floor((across - {SIDE}) / {SYMBOL + LETTER * longest})))"
    scale = {"domain": list(names.values), "range": names.of(looks)}
    legend = {"columns": {"expr": columns}}
    return {
        "field": names.field,
        "type": "nominal",
        "sort": None,
        "scale": scale,
        "title": names.title or None,
        "legend": legend,
    }


def _shape_channel(part: Chart, mark: Mark) -> Spec:
    names = part.named("shape", mark)
    if not names:
        return {"value": PATHS.get(mark.shape, mark.shape)}
    shown = _names_channel(names, SHAPES)
    shown["scale"]["range"] = [PATHS.get(name, name) for name in shown["scale"]["range"]]
    if not (isinstance(part.colour, Names) and part.colour.field == names.field):
        shown["legend"] |= {"symbolFillColor": ROLES[INK], "symbolStrokeColor": ROLES[INK]}
    return shown


def _dash_channel(part: Chart, mark: Mark) -> Spec:
    names = part.named("dash", mark)
    if not names:
        return {"value": STROKES[mark.dash] or [1, 0]}
    shown = _names_channel(names, DASHES)
    shown["scale"]["range"] = [list(dash) or [1, 0] for dash in shown["scale"]["range"]]
    shown["legend"] |= {"symbolType": "stroke", "symbolStrokeColor": ROLES[INK], "symbolSize": 400}
    return shown


def _detail_channel(mark: Mark) -> list[Spec]:
    return [{"field": field} for field in mark.by]


def _point_layers(part: Chart, mark: Mark) -> Iterator[Spec]:
    shown = {"type": "point", "filled": True, "size": 60}
    yield _layer(
        part, mark, shown, {**_places(part, mark), "color": _colour(part, mark), "shape": _shape_channel(part, mark)}
    )


def _line_layers(part: Chart, mark: Mark) -> Iterator[Spec]:
    across = {"interpolate": "step-after"} if mark.is_stepped else {}
    looks = {"color": _colour(part, mark), "strokeDash": _dash_channel(part, mark), "detail": _detail_channel(mark)}
    # What is dotted is beside the point.
    width = {"strokeWidth": 1, "strokeOpacity": 0.6} if mark.dash == "dotted" else {"strokeWidth": 1.6}
    yield _layer(part, mark, {"type": "line", **width, **across}, {**_places(part, mark), **looks})
    if mark.tips:
        looks.pop("strokeDash")
        hits = _layer(part, mark, {"type": "line", **across, **HIDDEN}, {**_places(part, mark), **looks})
        yield hits | {"name": "hits"}


def _area_layers(part: Chart, mark: Mark) -> Iterator[Spec]:
    shown = {"type": "area", "fillOpacity": 0.55, "line": False}
    shown |= {"interpolate": "step-after"} if mark.is_stepped else {}
    yield _layer(
        part, mark, shown, {**_places(part, mark), "color": _colour(part, mark), "detail": _detail_channel(mark)}
    )


def _rule_layers(part: Chart, mark: Mark) -> Iterator[Spec]:
    yield _layer(part, mark, {"type": "rule"}, {**_places(part, mark), "color": _colour(part, mark)})


def _bar_layers(part: Chart, mark: Mark) -> Iterator[Spec]:
    places = _places(part, mark)
    places["x"]["stack"] = None
    yield _layer(part, mark, {"type": "bar"}, {**places, "color": _colour(part, mark)})


def _cell_layers(part: Chart, mark: Mark) -> Iterator[Spec]:
    assert isinstance(part.colour, Shades)
    shades = part.colour
    scale = {"type": "log", "domain": [shades.low, shades.high], "scheme": "viridis", "clamp": True}
    colour = {"field": shades.field, "type": "quantitative", "scale": scale, "title": shades.title}
    places = _places(part, mark)
    places["x"]["axis"] = {"labelAngle": -30}
    yield _layer(part, mark, {"type": "rect"}, {**places, "color": colour})


def _text_layers(part: Chart, mark: Mark) -> Iterator[Spec]:
    is_cell = part.x.scale == Scale.NAMES
    shown = {"type": "text", "fontSize": 11} | ({} if is_cell else {"align": "left", "dx": 4})
    encoding = {**_places(part, mark), "text": {"field": mark.text}, "color": _colour(part, mark)}
    if is_cell:
        encoding["x"]["axis"] = {"labelAngle": -30}
    yield _layer(part, mark, shown, encoding)


def _labels(part: Chart, mark: Mark) -> Iterator[Spec]:
    """The names of points, those of the rest where they are picked; each on a line of its own, near its point."""
    rows = _labelled(part, mark)
    is_rest = f"datum.{mark.rest}" if mark.rest else "false"
    named = {"filter": f"!{is_rest} && picked == '' || picked != '' && {IS_PICKED}"}
    at = _places(part, mark) | {"opacity": {"value": 1}}
    faint = {"color": {"value": ROLES[FAINT]}}
    leader = _leader(part, mark, {**at, "y2": {"field": "label"}, **faint}, rows)
    text = {**at, "y": at["y"] | {"field": "label"}, "text": {"field": mark.text}, "color": {"value": ROLES[INK]}}
    sides = [
        _layer(
            part, mark, {"type": "text", "align": align, "dx": away, "fontSize": 11, "baseline": "middle"}, text, rows
        )
        for align, away in (("left", 6), ("right", -6))
    ]
    for layer, side in zip((leader, *sides), ("true", "datum.right", "!datum.right"), strict=True):
        yield layer | {"transform": [*layer.get("transform", ()), named, {"filter": side}]}


def _leader(part: Chart, mark: Mark, encoding: Spec, rows: Sequence[Row]) -> Spec:
    """Lines from what is labelled to its label."""
    return _layer(part, mark, {"type": "rule", "strokeWidth": 0.6}, encoding, rows) | {"name": "leaders"}


def _labelled(part: Chart, mark: Mark) -> list[Row]:
    """The rows of labels, with where each stands; apart from others that are shown with it."""
    alike: dict[tuple[Any, ...], list[Row]] = {}
    for row in part.rows_of(mark):
        alike.setdefault((row.get(part.switch.field) if part.switch else "", bool(row.get(mark.rest))), []).append(row)
    made: list[Row] = []
    for rows in alike.values():
        shares = lines_apart(part.y, [row[mark.y] for row in rows], part.pixels, LABEL_LINE)
        for row, share in zip(rows, shares, strict=True):
            made.append({**row, "label": part.y.at(share), "right": part.x.share(row[mark.x]) <= TURNS_AT})
    return made


def _ends(part: Chart, mark: Mark) -> Iterator[Spec]:
    """The names of lines to the right of the panel, with a line from the last point to each."""
    lasts = part.lasts(mark)
    shares = lines_apart(part.y, [row[mark.y] for row in lasts], part.pixels, LABEL_LINE)
    rows = [{**row, "label": part.y.at(share)} for row, share in zip(lasts, shares, strict=True)]
    colour = _colour(part, mark)
    colour.pop("legend", None)
    # A name that is there and not seen would take room from the panel.
    room = {"filter": _has_room(part)}
    at = _places(part, mark)
    leader = {**at, "x2": {"value": {"expr": "width + 12"}}, "y2": {"field": "label"}, "color": colour}
    text = {"x": {"value": {"expr": "width + 15"}}, "y": at["y"] | {"field": "label"}, "text": {"field": mark.text}}
    shown = {"type": "text", "align": "left", "fontSize": 11}
    for layer in (_leader(part, mark, leader, rows), _layer(part, mark, shown, {**text, "color": colour}, rows)):
        yield layer | {"transform": [*layer.get("transform", ()), room]}


LAYERS = MappingProxyType(
    {
        Kind.POINTS: _point_layers,
        Kind.LINES: _line_layers,
        Kind.AREAS: _area_layers,
        Kind.RULES: _rule_layers,
        Kind.BARS: _bar_layers,
        Kind.CELLS: _cell_layers,
        Kind.TEXTS: _text_layers,
        Kind.LABELS: _labels,
        Kind.ENDS: _ends,
    }
)
