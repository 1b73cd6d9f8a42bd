"""Interactive charts as Vega-Lite specifications; `charts.py` and `plots.py` draw the same as files.

A row of data that has a codec names it in `codec`, as tables and pictures do. Every specification has a parameter
`picked`, the codec that the page highlights, empty for none. Colours are page.css's, so that they follow its theme.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ..page.codec_key import CodecKey
from ..page.verdict import is_number
from .charts import LEAST_DEG, Row, bins, steps
from .plots import COLOURS

PALETTE = ["var(--ink)" if colour == "#000000" else f"var(--chart-{at})" for at, colour in enumerate(COLOURS)]
SHAPES = ["circle", "square", "diamond", "triangle-up", "triangle-down", "cross", "triangle-left", "triangle-right"]
# Wider than the line that is seen, to be hit by a pointer.
HIDDEN = {"strokeWidth": 9, "opacity": 0.001}
PICKED = {"name": "picked", "value": ""}
# An encoding's name alone stands for each of its codecs.
IS_PICKED = "(datum.codec == picked || indexof(picked, ' ') < 0 && indexof(datum.codec, picked + ' ') == 0)"
IS_LIT = f"picked == '' || {IS_PICKED}"
INK, MUTED, LINE = (f"var(--{name})" for name in ("ink", "muted", "line"))
CONFIG = {
    "background": None,
    "font": "system-ui, sans-serif",
    "view": {"stroke": None},
    "axis": {"labelColor": INK, "titleColor": MUTED, "gridColor": LINE, "domainColor": MUTED, "tickColor": MUTED}
    | {"titleFontWeight": "normal", "labelLimit": 260, "labelFontSize": 12, "titleFontSize": 12},
    "legend": {"labelColor": INK, "titleColor": MUTED, "titleFontWeight": "normal", "orient": "top"}
    | {"labelFontSize": 12, "titleFontSize": 12, "symbolOpacity": 1, "symbolStrokeWidth": 2},
}
Spec = dict[str, Any]
# What may tell rows of one codec apart, in the order of their names.
LINES = ("layout", "light_buffer", "light_targets", "pipeline", "shadow", "exposure")


def spec(rows: Sequence[Row], description: str, **parts: Any) -> Spec:
    common = {"description": description, "width": "container", "config": CONFIG}
    params = [PICKED, *parts.pop("params", ())]
    return common | {"data": {"values": list(rows)}, "params": params} | parts


def switched(machines: Sequence[str], usual: str) -> Spec:
    """A switch between the machines of the rows, of which one is shown at a time: parts of a specification.

    The page makes a control of it, one for all charts of a figure.
    """
    switch = {"param": "machine", "label": "GPU", "options": list(machines)}
    shown = [{"filter": "datum.machine == machine"}]
    return {"params": [{"name": "machine", "value": usual}], "usermeta": {"switch": switch}, "transform": shown}


def if_lit(lit: float, other: float) -> Spec:
    """A value for what is highlighted, and one for the rest; where nothing is, everything is."""
    return {"condition": {"test": IS_LIT, "value": lit}, "value": other}


def by_bits(rows: Sequence[Row]) -> Spec:
    """Colour by the number of bits."""
    all_bits = sorted({row["bits"] for row in rows})
    scale = {"domain": all_bits, "range": [PALETTE[at % len(PALETTE)] for at in range(len(all_bits))]}
    return {"field": "bits", "type": "nominal", "scale": scale, "title": "bits"}


def shape_by_bits(rows: Sequence[Row]) -> Spec:
    """A shape as well, for those who do not see all colours."""
    scale = {"domain": sorted({row["bits"] for row in rows}), "range": SHAPES}
    return {"field": "bits", "type": "nominal", "scale": scale, "title": "bits"}


def _line(**mark: Any) -> Spec:
    return {"mark": {"type": "line", "clip": True, **mark}}


def tips(**fields: str) -> list[Spec]:
    return [{"field": name, "title": title} for name, title in fields.items()]


def histogram_specs(rows: Sequence[Row]) -> list[Spec]:
    """How often which angle: a line for each codec.

    Args:
        rows: as `charts.histogram_chart` takes them.
    """
    lines = [_line_of(row, rows) for row in rows]
    points = [point | {"line": line} for row, line in zip(rows, lines, strict=True) for point in _outline(row)]
    choices = ["all", *map(str, sorted({row["bits"] for row in rows}))]
    bits = {"name": "bits", "value": "all", "bind": {"input": "select", "options": choices, "name": "Bits shown "}}
    x = {
        "field": "x",
        "type": "quantitative",
        "scale": {"type": "log", "domain": [LEAST_DEG, 180], "nice": False},
        "title": "angle, degrees",
    }
    y = {"field": "y", "type": "quantitative", "title": "density, % of normals per octave"}
    encoding = {"x": x | {"axis": {"format": "~g"}}, "y": y, "detail": {"field": "line"}, "color": by_bits(points)}
    tooltip = tips(codec="codec", bits="bits", mean="mean, degrees", largest="largest, degrees")
    layers = [
        _line(interpolate="step-after") | {"encoding": {"opacity": if_lit(1, 0.12), "strokeWidth": if_lit(1.6, 1)}},
        _line(interpolate="step-after", **HIDDEN) | {"encoding": {"tooltip": tooltip}},
    ]
    transform = [{"filter": "bits == 'all' || toString(datum.bits) == bits"}]
    said = "The share of normals over their angle in degrees, a line for each codec."
    parts = {"params": [bits], "transform": transform, "encoding": encoding, "layer": layers, "height": 340}
    return [spec(points, said, **parts)]


def _outline(row: Row) -> list[Row]:
    """A codec's histogram as the points of a line of steps."""
    edges, heights = steps(bins(row["angle_counts"]))
    total = sum(count for *_, count in bins(row["angle_counts"]))
    figures = {"mean": rounded(row["angle_mean_deg"]), "largest": rounded(row.get("angle_max_deg"))}
    about = {"codec": CodecKey.of(row).label, "bits": row["bits"], **figures}
    return [
        {"x": rounded(edge), "y": rounded(100 * height / total), **about}
        for edge, height in zip(edges, [*heights, 0.0], strict=True)
    ]


def rounded(value: Any) -> float | None:
    """Four digits; None for what is no finite number."""
    return float(f"{value:.4g}") if is_number(value) and math.isfinite(value) else None


def titled(text: str) -> Spec:
    return {"text": text, "color": MUTED, "fontWeight": "normal", "anchor": "start"}


def _line_of(row: Row, rows: Sequence[Row]) -> str:
    """What tells a row of a chart apart: its codec, and what else differs between the rows."""
    others = [c for c in LINES if len({str(one.get(c)) for one in rows}) > 1]
    return " ".join([CodecKey.of(row).label, *(str(row.get(column)) for column in others)])


def _named(column: str) -> Spec:
    """One of several names, by its colour or its dashes."""
    scale = {"range": PALETTE} if column != "storage" else {}
    return {"field": column, "type": "nominal", "sort": None, "legend": {"columns": 4}, "scale": scale}
