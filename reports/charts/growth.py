"""Charts of how the time grows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .chart import Row
from .plots import COLOURS, MARKERS, drawn_off_screen
from .specs import PALETTE, Spec, rounded, spec, tips


def _kinds(rows: Sequence[Row]) -> list[str]:
    return list(dict.fromkeys(row["over"] for row in rows))


def growth_chart(rows: Sequence[Row]) -> Any:
    """Seconds over the size, a line for each kind.

    Args:
        rows: of the growth table: over, size, seconds.
    """
    figure, axis = drawn_off_screen().subplots(figsize=(6.4, 4.8), layout="constrained")
    for at, kind in enumerate(_kinds(rows)):
        own = sorted((row for row in rows if row["over"] == kind), key=lambda row: row["size"])
        sizes, seconds = ([row[name] for row in own] for name in ("size", "seconds"))
        style = {"color": COLOURS[at % len(COLOURS)], "marker": MARKERS[at % len(MARKERS)]}
        axis.plot(sizes, seconds, label=kind, **style)
    axis.set(xscale="log", yscale="log", xlabel="size", ylabel="seconds")
    axis.yaxis.set_major_formatter("{x:g}")
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)
    return figure


def growth_specs(rows: Sequence[Row]) -> list[Spec]:
    """The same as a chart of a page."""
    points = [{"over": row["over"], "size": row["size"], "seconds": rounded(row["seconds"])} for row in rows]
    kinds = _kinds(rows)
    colours = {"domain": kinds, "range": [PALETTE[at % len(PALETTE)] for at in range(len(kinds))]}
    log = {"type": "quantitative", "scale": {"type": "log"}}
    encoding = {
        "x": {"field": "size", "title": "size", **log},
        "y": {"field": "seconds", "title": "seconds", **log},
        "color": {"field": "over", "type": "nominal", "scale": colours, "title": None},
        "tooltip": tips(over="over", size="size", seconds="seconds"),
    }
    layers: list[Spec] = [{"mark": {"type": "line"}}, {"mark": {"type": "point", "filled": True, "size": 40}}]
    return [spec(points, "Seconds over the size, a line for each kind.", layer=layers, encoding=encoding, height=300)]
