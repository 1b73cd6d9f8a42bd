"""Interactive charts as Vega-Lite specifications; `charts.py` and `plots.py` draw the same as files.

A row of data that has a codec names it in `codec`, as tables and pictures do. Every specification has a parameter
`picked`, the codec that the page highlights, empty for none. Colours are page.css's, so that they follow its theme.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ..page.verdict import is_number
from .charts import Row
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


def tips(**fields: str) -> list[Spec]:
    return [{"field": name, "title": title} for name, title in fields.items()]


def rounded(value: Any) -> float | None:
    """Four digits; None for what is no finite number."""
    return float(f"{value:.4g}") if is_number(value) and math.isfinite(value) else None


def titled(text: str) -> Spec:
    return {"text": text, "color": MUTED, "fontWeight": "normal", "anchor": "start"}
