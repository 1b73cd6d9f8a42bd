"""The chart of what codecs take on readers' devices: as a figure, and as a Vega-Lite specification."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .charts import Row
from .plots import COLOURS, MARKERS, drawn_off_screen
from .specs import PALETTE, SHAPES, Spec, if_lit, rounded, spec, tips

TITLE = "milliseconds per megapixel, to encode and to decode"


def _names(rows: Sequence[Row], column: str) -> list[str]:
    return list(dict.fromkeys(str(row[column]) for row in rows))


def devices_chart(rows: Sequence[Row]) -> Any:
    """Milliseconds of each codec, a line for each in the order of the rows, a dot for each device.

    Args:
        rows: `codec`, `device` and `ms`, above 0.

    Returns:
        a figure for `plots.save`.
    """
    codecs, devices = _names(rows, "codec"), _names(rows, "device")
    figure, axis = drawn_off_screen().subplots(figsize=(8.2, 1.8 + 0.2 * len(codecs)), layout="constrained")
    for at, device in enumerate(devices):
        own = [row for row in rows if str(row["device"]) == device]
        style = {"color": COLOURS[at % len(COLOURS)], "marker": MARKERS[at % len(MARKERS)]}
        axis.scatter(
            [row["ms"] for row in own], [codecs.index(str(row["codec"])) for row in own], s=24, label=device, **style
        )
    axis.set_yticks(range(len(codecs)), codecs, size=8)
    axis.invert_yaxis()
    axis.set_xscale("log")
    axis.xaxis.set_major_formatter("{x:g}")
    axis.set_xlabel(TITLE)
    axis.grid(alpha=0.3)
    figure.legend(loc="outside upper center", ncols=2, fontsize=8, frameon=False)
    return figure


def devices_specs(rows: Sequence[Row]) -> list[Spec]:
    """The same for the page.

    Args:
        rows: as `devices_chart` takes them.
    """
    points = [{"codec": str(row["codec"]), "device": str(row["device"]), "ms": rounded(row["ms"])} for row in rows]
    devices = _names(rows, "device")
    colours = [PALETTE[at % len(PALETTE)] for at in range(len(devices))]
    shapes = [SHAPES[at % len(SHAPES)] for at in range(len(devices))]
    device = {"field": "device", "type": "nominal", "title": None, "legend": {"columns": 2, "labelLimit": 360}}
    encoding = {
        "x": {
            "field": "ms",
            "type": "quantitative",
            "scale": {"type": "log"},
            "axis": {"format": "~g"},
            "title": TITLE,
        },
        "y": {"field": "codec", "type": "nominal", "sort": _names(rows, "codec"), "title": None},
        "color": device | {"scale": {"domain": devices, "range": colours}},
        "shape": device | {"scale": {"domain": devices, "range": shapes}},
        "opacity": if_lit(1, 0.2),
        "tooltip": tips(codec="codec", device="device", ms="ms per megapixel"),
    }
    said = "Milliseconds per megapixel to encode and to decode, for each codec on each device."
    mark = {"type": "point", "filled": True, "size": 60}
    return [spec(points, said, mark=mark, encoding=encoding, height=40 + 16 * len(_names(rows, "codec")))]
