"""Charts of compressed normal maps: as a figure, and as a Vega-Lite specification."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .charts import LEAST_DEG, Row
from .plots import COLOURS, drawn_off_screen
from .specs import PALETTE, Spec, if_lit, rounded, spec, tips

# What is marked of each line: the column, what it is called, and its shape by Vega and by matplotlib.
MARKED = (
    ("angle_mean_deg", "mean", "circle", "o"),
    ("angle_p99_deg", "99 %", "diamond", "d"),
    ("angle_max_deg", "largest", "square", "s"),
)
TITLE = "angle between normal and decode, degrees"


def label(row: Row) -> str:
    """What a line is called: the code, the format, its swizzle, and its bits."""
    return f"{row['encoding']} {row['block']} {row['swizzle']}, {row['bits_per_texel']} bits"


def maps_chart(rows: Sequence[Row]) -> Any:
    """Angles of each code in each format, a line for each, in the order of the rows, the first on top.

    Args:
        rows: of the maps table: encoding, block, swizzle, bits_per_texel, angles.

    Returns:
        a figure for `plots.save`.
    """
    figure, axis = drawn_off_screen().subplots(figsize=(8.2, 1.4 + 0.3 * len(rows)), layout="constrained")
    from matplotlib.ticker import LogLocator

    places = range(len(rows))
    found = {column: [max(row[column], LEAST_DEG) for row in rows] for column, *_ in MARKED}
    axis.hlines(places, found["angle_mean_deg"], found["angle_max_deg"], color="#AAAAAA", linewidth=1.2, zorder=1)
    for colour, (column, name, _, marker) in zip(COLOURS, MARKED, strict=False):
        axis.scatter(found[column], places, color=colour, marker=marker, s=30, label=name)
    axis.set_yticks(places, [label(row) for row in rows], size=8)
    axis.invert_yaxis()
    axis.set_xscale("log")
    # Few of these ranges hold several powers of ten.
    axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.xaxis.set_major_formatter("{x:g}")
    axis.xaxis.set_minor_formatter("")
    axis.set_xlabel(TITLE)
    axis.grid(axis="x", alpha=0.3)
    figure.legend(loc="outside upper center", ncols=3, fontsize=8, frameon=False)
    return figure


def maps_specs(rows: Sequence[Row]) -> list[Spec]:
    """The same for the page.

    Args:
        rows: as `maps_chart` takes them.
    """
    found = [
        {"codec": f"{row['encoding']} {row['block']}", "line": label(row), "what": name}
        | {"x": rounded(max(row[column], LEAST_DEG))}
        for row in rows
        for column, name, *_ in MARKED
    ]
    names = [name for _, name, *_ in MARKED]
    scale = {"domain": names, "range": PALETTE[: len(names)]}
    shapes = {"domain": names, "range": [shape for _, _, shape, _ in MARKED]}
    y = {"field": "line", "type": "nominal", "sort": list(dict.fromkeys(one["line"] for one in found)), "title": None}
    x = {"field": "x", "type": "quantitative", "scale": {"type": "log"}, "axis": {"format": "~g"}, "title": TITLE}
    what = {"field": "what", "type": "nominal", "title": None}
    points: Spec = {"mark": {"type": "point", "filled": True, "size": 60}}
    points["encoding"] = {"color": what | {"scale": scale}, "shape": what | {"scale": shapes}}
    points["encoding"] |= {"opacity": if_lit(1, 0.2), "tooltip": tips(line="code", what="angle", x="degrees")}
    line: Spec = {"mark": {"type": "line", "color": "var(--faint)", "strokeWidth": 1}}
    line["encoding"] = {"detail": {"field": "line"}, "opacity": if_lit(1, 0.2)}
    said = "The mean angle, the angle that 99 % are below, and the largest, for each code in each format."
    encoding = {"x": x, "y": y}
    return [spec(found, said, encoding=encoding, layer=[line, points], height=22 * len(y["sort"]))]
