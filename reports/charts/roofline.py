"""Charts of bytes against instructions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .charts import Row, codec_label
from .pareto import LINEAR_TO, TICKS, count_axis
from .plots import COLOURS, MARKERS, drawn_off_screen
from .specs import CONFIG, INK, PALETTE, SHAPES, Spec, if_lit, rounded, spec, switched, tips, titled

STEPS = 40
DASHES: Spec = {"field": "where", "type": "nominal", "legend": None}
DASHES["scale"] = {"domain": ["memory", "cache"], "range": [[1, 0], [5, 4]]}
LINE = "where bytes take as long as instructions"


def points(rows: Sequence[Row]) -> list[Row]:
    """What charts draw of rows: instructions, and bytes written and read, of a pixel and frame, of the fewest reads and
    the first size."""
    reads, size = min(row["reads"] for row in rows), rows[0]["size"]
    found = {
        (row["gpu"], codec_label(row)): {
            **{name: row[name] for name in ("gpu", "encoding", "storage", "size", "reads", "ridge", "in_cache")},
            "codec": codec_label(row),
            "x": row["instructions"],
            "y": row["bytes_per_pixel"] * (row["overdraw"] + row["reads"]),
        }
        for row in rows
        if (row["reads"], row["size"]) == (reads, size)
    }
    return list(found.values())


def ridge_lines(found: Sequence[Row], gpu: str) -> dict[bool, list[tuple[float, float]]]:
    """Instructions, and the bytes that take as long, from the fewest bytes that are drawn on: a line for codes in
    memory, and one, under True, for those that the cache holds."""
    most, (least, _) = max(point["x"] for point in found) * 1.3 + 1, _bytes(found)
    ridges = {point["in_cache"]: point["ridge"] for point in found if point["gpu"] == gpu}
    across = [most * (step / STEPS) ** 2 for step in range(1, STEPS + 1)]
    return {cached: [(x, x / ridge) for x in across if x / ridge >= least] for cached, ridge in ridges.items()}


def _bytes(found: Sequence[Row]) -> tuple[float, float]:
    """The axis of bytes, which has room for the points alone."""
    return min(point["y"] for point in found) / 1.5, max(point["y"] for point in found) * 1.5


def _names(found: Sequence[Row], column: str) -> list[str]:
    return list(dict.fromkeys(point[column] for point in found))


def roofline_chart(rows: Sequence[Row]) -> Any:
    """Bytes over instructions of a pixel and frame, a panel for each GPU: above the line memory takes longer, below it
    arithmetic.

    Args:
        rows: of the roofline table: encoding, storage, gpu, reads, overdraw, instructions, bytes_per_pixel, ridge.
    """
    found = points(rows)
    gpus, encodings, storages = (_names(found, name) for name in ("gpu", "encoding", "storage"))
    across = min(len(gpus), 2 if len(gpus) <= 4 else 3)
    down = -(-len(gpus) // across)
    figure, axes = drawn_off_screen().subplots(
        down, across, figsize=(4.6 * across, 3.6 * down + 1), squeeze=False, layout="constrained"
    )
    for axis, gpu in zip(axes.flat, gpus, strict=False):
        part = [point for point in found if point["gpu"] == gpu]
        for point in part:
            colour = COLOURS[encodings.index(point["encoding"]) % len(COLOURS)]
            mark = MARKERS[storages.index(point["storage"]) % len(MARKERS)]
            axis.scatter(point["x"], point["y"], color=colour, marker=mark, s=36, zorder=3)
        for cached, line in ridge_lines(found, gpu).items():
            style = "--" if cached else "-"
            axis.plot([x for x, _ in line], [y for _, y in line], style, color="#777777", linewidth=1)
        _axes(axis, found, gpu)
    for axis in axes.flat[len(gpus) :]:
        axis.remove()
    _legend(figure, encodings, storages)
    return figure


def _axes(axis: Any, found: Sequence[Row], gpu: str) -> None:
    reads = found[0]["reads"]
    axis.set(yscale="log", title=gpu, ylim=_bytes(found), ylabel="bytes written and read")
    axis.set_xlabel(
        f"instructions of a pixel and frame, {found[0]['size']}, {reads} {'read' if reads == 1 else 'reads'}"
    )
    most = max(point["x"] for point in found)
    count_axis(axis, most)
    axis.set_xlim(-1, 1.3 * most + 1)
    for which in (axis.yaxis.set_major_formatter, axis.yaxis.set_minor_formatter):
        which("{x:g}")
    axis.tick_params(axis="y", which="both", labelsize=7)
    axis.grid(alpha=0.3)


def _legend(figure: Any, encodings: Sequence[str], storages: Sequence[str]) -> None:
    from matplotlib.lines import Line2D

    dots = [Line2D([], [], linestyle="", marker="o", color=COLOURS[i % len(COLOURS)]) for i in range(len(encodings))]
    marks = [
        Line2D([], [], linestyle="", marker=MARKERS[i % len(MARKERS)], color="#555555") for i in range(len(storages))
    ]
    lines = [Line2D([], [], linestyle=style, color="#777777", linewidth=1) for style in ("-", "--")]
    labels = [*encodings, *storages, LINE, "the same in the cache"]
    figure.legend([*dots, *marks, *lines], labels, loc="outside lower center", ncols=4, fontsize=7)


def roofline_specs(rows: Sequence[Row]) -> list[Spec]:
    """The same as one chart with a switch between the GPUs.

    Args:
        rows: as `roofline_chart` takes them.
    """
    found = points(rows)
    gpus = _names(found, "gpu")
    lines = [
        {"machine": gpu, "where": "cache" if cached else "memory", "x": rounded(x), "y": rounded(y)}
        for gpu in gpus
        for cached, line in ridge_lines(found, gpu).items()
        for x, y in line
    ]
    data = [
        point
        | {"machine": point["gpu"], "where": "cache" if point["in_cache"] else "memory"}
        | {"x": rounded(point["x"]), "y": rounded(point["y"])}
        for point in found
    ]
    switch = switched(gpus, gpus[0])
    layers = [
        {
            "data": {"values": lines},
            "transform": switch["transform"],
            "mark": {"type": "line", "clip": True, "color": INK, "strokeWidth": 1, "opacity": 0.6},
            "encoding": {**_places(found), "strokeDash": DASHES},
        },
        {
            "transform": switch["transform"],
            "mark": {"type": "point", "filled": True, "size": 70},
            "encoding": {**_places(found), **_looks(found), "opacity": if_lit(1, 0.2)},
        },
    ]
    title = titled("") | {"text": {"expr": f"machine + ', {found[0]['size']}; line: {LINE}'"}}
    said = "Bytes over instructions of a pixel and frame. Above the line memory takes longer, below it arithmetic."
    # On a phone there is no room for two legends beside each other.
    legends = CONFIG["legend"] | {"layout": {"top": {"anchor": "start", "direction": "vertical"}}}
    parts = {"layer": layers, "height": 380, "title": title, "config": CONFIG | {"legend": legends}}
    return [spec(data, said, params=switch["params"], usermeta=switch["usermeta"], **parts)]


def _places(found: Sequence[Row]) -> Spec:
    x: Spec = {"field": "x", "type": "quantitative", "title": "instructions of a pixel and frame"}
    x["scale"] = {"type": "symlog", "constant": LINEAR_TO, "nice": False, "padding": 12}
    x["axis"] = {"values": [tick for tick in TICKS if tick <= 1.3 * max(point["x"] for point in found)]}
    y: Spec = {"field": "y", "type": "quantitative", "title": "bytes written and read", "axis": {"format": "~g"}}
    y["scale"] = {"type": "log", "domain": list(_bytes(found)), "nice": False}
    return {"x": x, "y": y}


def _looks(found: Sequence[Row]) -> Spec:
    encodings, storages = (_names(found, name) for name in ("encoding", "storage"))
    colours = [PALETTE[i % len(PALETTE)] for i in range(len(encodings))]
    colour: Spec = {
        "field": "encoding",
        "type": "nominal",
        "scale": {"domain": encodings, "range": colours},
        "title": None,
    }
    colour["legend"] = {"columns": 2}
    shape: Spec = {"field": "storage", "type": "nominal", "scale": {"domain": storages, "range": SHAPES}, "title": None}
    shape["legend"] = {"columns": 3, "symbolFillColor": INK, "symbolStrokeColor": INK}
    tooltip = tips(codec="codec", x="instructions", y="bytes", reads="reads", where="moved from", machine="GPU")
    return {"color": colour, "shape": shape, "tooltip": tooltip}
