"""Charts of how many normals a second are measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .chart import Row
from .plots import COLOURS, MARKERS, drawn_off_screen
from .specs import INK, PALETTE, Spec, if_lit, rounded, spec, tips

# What is drawn of a row: the column, what it is called, and how its line is dashed.
LINES = (("rate", "normalbench", "-"), ("c", "C", "--"), ("reading", "reading", ":"))
DASHES = {"normalbench": [1, 0], "C": [6, 4], "reading": [2, 3]}
TITLE = {"moments": "squared error and its maximum", "row": "a row of the quality table"}


def _names(rows: Sequence[Row], column: str) -> list[str]:
    return list(dict.fromkeys(row[column] for row in rows))


def throughput_chart(rows: Sequence[Row]) -> Any:
    """Million normals a second over their number, a panel for each statistics, a colour for each encoding.

    Args:
        rows: of the throughput table: encoding, statistics, count, rate, c, reading.
    """
    statistics, encodings = _names(rows, "statistics"), _names(rows, "encoding")
    figure, axes = drawn_off_screen().subplots(
        1, len(statistics), figsize=(4.6 * len(statistics) + 1, 4.4), sharey=True, squeeze=False, layout="constrained"
    )
    for axis, name in zip(axes[0], statistics, strict=True):
        part = [row for row in rows if row["statistics"] == name]
        for at, encoding in enumerate(encodings):
            own = sorted((row for row in part if row["encoding"] == encoding), key=lambda row: row["count"])
            for column, _, dash in LINES[:2]:
                _line(axis, own, column, color=COLOURS[at % len(COLOURS)], marker=MARKERS[at % len(MARKERS)], ls=dash)
        # All encodings read the same normals.
        read = {row["count"]: row for row in part}
        _line(axis, [read[count] for count in sorted(read)], "reading", color="#777777", marker="", ls=":")
        axis.set(xscale="log", yscale="log", title=TITLE.get(name, name), xlabel="normals")
        axis.set_xticks([*read], [_power(count) for count in read])
        axis.minorticks_off()
        axis.yaxis.set_major_formatter("{x:g}")
        axis.grid(alpha=0.3)
    axes[0][0].set_ylabel("million normals a second")
    _legend(figure, encodings)
    return figure


def _power(count: int) -> str:
    """A number of normals, short."""
    return f"2^{count.bit_length() - 1}" if count.bit_count() == 1 else f"{count:.3g}"


def _line(axis: Any, rows: Sequence[Row], column: str, **style: Any) -> None:
    known = [row for row in rows if row.get(column)]
    axis.plot([row["count"] for row in known], [row[column] for row in known], markersize=4, **style)


def _legend(figure: Any, encodings: Sequence[str]) -> None:
    from matplotlib.lines import Line2D

    dots = [
        Line2D([], [], color=COLOURS[i % len(COLOURS)], marker=MARKERS[i % len(MARKERS)]) for i in range(len(encodings))
    ]
    dashes = [Line2D([], [], color="#777777", ls=dash) for *_, dash in LINES]
    labels = [*encodings, *(name for _, name, _ in LINES)]
    figure.legend([*dots, *dashes], labels, loc="outside lower center", ncols=4, fontsize=8)


def throughput_specs(rows: Sequence[Row]) -> list[Spec]:
    """The same as charts of a page, one for each statistics.

    Args:
        rows: as `throughput_chart` takes them.
    """
    return [_spec([row for row in rows if row["statistics"] == name], name) for name in _names(rows, "statistics")]


def _spec(rows: Sequence[Row], statistics: str) -> Spec:
    points = [
        {"codec": row["encoding"], "by": by, "count": row["count"], "rate": rounded(row[column])}
        for row in rows
        for column, by, _ in LINES
        if row.get(column)
    ]
    encodings = _names(rows, "encoding")
    colours = {"domain": encodings, "range": [PALETTE[at % len(PALETTE)] for at in range(len(encodings))]}
    encoding = {
        "x": {"field": "count", "type": "quantitative", "scale": {"type": "log"}, "title": "normals"},
        "y": {"field": "rate", "type": "quantitative", "scale": {"type": "log"}, "title": "million normals a second"},
        "color": {"field": "codec", "type": "nominal", "scale": colours, "title": None},
        "detail": {"field": "by"},
        "opacity": if_lit(1, 0.15),
        "tooltip": tips(codec="encoding", by="by", count="normals", rate="million normals a second"),
    }
    dash = {
        "field": "by",
        "type": "nominal",
        "scale": {"domain": [*DASHES], "range": [*DASHES.values()]},
        "title": None,
    }
    lines: Spec = {"mark": {"type": "line"}, "encoding": {"strokeDash": dash}}
    layers = [lines, {"mark": {"type": "point", "filled": True, "size": 40}}]
    title = {"text": TITLE.get(statistics, statistics), "color": INK, "fontSize": 13}
    said = f"Million normals a second over their number: {TITLE.get(statistics, statistics)}."
    return spec(points, said, layer=layers, encoding=encoding, height=300, title=title)
