"""The charts of frame times: the time of each pass, and the frame time by number of objects."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import accumulate
from typing import Any

from ....reports.charts.chart import Axis, Chart, Kind, Mark, Names, Scale, distinct
from ....reports.page.verdict import is_number
from ..charts import having
from ..table import Row

FRAME, EACH, SPREAD = "ms_frame", "ms_frame_each", "_spread"
# A spread beyond this share of the median tells nothing apart.
NOISY = 0.1
# The share of the longest bar that what stands at its end has room for.
ROOM = 0.35
# What tells lines of one pipeline apart where there are several.
MORE = ("layout", "light_buffer", "light_targets")


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield the chart of frame times by number of objects, if there are several numbers, and a chart of passes for
    each number."""
    known = having(rows, FRAME)
    counts = list(dict.fromkeys(row.get("objects") for row in known))
    if len(counts) > 1:
        yield frames_chart(known)
    usable = [row for row in known if passes_of(row)]
    for index, objects in enumerate(dict.fromkeys(row.get("objects") for row in usable)):
        yield passes_chart(index, objects, [row for row in usable if row.get("objects") == objects])


def passes_chart(index: int, objects: object, rows: Sequence[Row]) -> Chart:
    """Return a chart of the time in a frame: a bar for each pipeline, with the medians of its passes in sequence.

    Args:
        index: index of the chart among the charts of the table.
        objects: number of objects.
        rows: rows of a sweep with this number of objects.
    """
    lines = [_line_name(row, rows, (*MORE, "shadow")) for row in rows]
    parts = [part for row, line in zip(rows, lines, strict=True) for part in _pass_rows(row, line)]
    totals = [
        {"pipeline": line, "x": frame_total(row), "said": frame_label(row)}
        for row, line in zip(rows, lines, strict=True)
    ]
    longest = max(total["x"] for total in totals)
    tips = (("pipeline", "pipeline"), ("ms", "ms"), ("pass", "pass"))
    fastest = min(totals, key=lambda total: total["x"])
    return Chart(
        name=f"passes-{index}",
        title=f"{fastest['pipeline']} is the fastest, {fastest['x']:.3g} ms per frame",
        subtitle=f"Time per pass, for a frame of {objects} objects",
        description="A bar for each pipeline, divided by pass: median milliseconds per frame. The figures are in the "
        "table.",
        x=Axis(
            title=f"median milliseconds of a frame's passes ({rows[0].get('clock')})",
            domain=(0.0, (1 + ROOM) * longest),
        ),
        y=Axis(title="", scale=Scale.NAMES, names=distinct(totals, "pipeline")),
        rows=tuple(parts),
        colour=Names("pass", distinct(parts, "pass")),
        height=34 * len(distinct(totals, "pipeline")),
        marks=(
            Mark(kind=Kind.BARS, x="x", x2="x2", y="pipeline", colour="pass", tips=tips),
            Mark(kind=Kind.TEXTS, rows=tuple(totals), y="pipeline", text="said"),
        ),
    )


def _pass_rows(row: Row, line: str) -> list[Row]:
    """Return the passes of a frame as segments of a bar, each starting at the end of the previous pass."""
    passes = passes_of(row)
    ends = [0.0, *accumulate(passes.values())]
    return [
        {"pipeline": line, "pass": name, "ms": passes[name], "x": ends[i], "x2": ends[i + 1]}
        for i, name in enumerate(passes)
    ]


def passes_of(row: Row) -> dict[str, float]:
    """Return the milliseconds of each pass in a frame, without the time of the whole frame."""
    names = [n for n in row if n.startswith("ms_") and not n.endswith(SPREAD) and n not in (FRAME, EACH)]
    return {name.removeprefix("ms_"): row[name] for name in names if is_number(row[name])}


def frame_total(row: Row) -> float:
    """Return the total milliseconds of a frame's passes."""
    return sum(passes_of(row).values())


def frame_label(row: Row) -> str:
    """Return the label at the end of a frame's bar: its duration, with a note if it is too noisy to compare."""
    total, spread = frame_total(row), row.get(f"{FRAME}{SPREAD}")
    is_noisy = is_number(spread) and spread > NOISY * row[FRAME]
    return (f"{total:.0f}" if total >= 100 else f"{total:.3g}") + ", too noisy to compare" * is_noisy


def frames_chart(rows: Sequence[Row]) -> Chart:
    """Return the chart of milliseconds per frame by number of objects, with a line for each pipeline and separate
    panels with and without shadows.

    Args:
        rows: rows of a sweep: pipeline, objects, shadow, ms_frame and its spread, size, lights, clock, device.
    """
    points = [
        {"line": _line_name(row, rows, MORE), "x": row["objects"], "y": row[FRAME], "shadow": _shadow_text(row)}
        | {"low": row[FRAME] - row[f"{FRAME}{SPREAD}"] / 2, "high": row[FRAME] + row[f"{FRAME}{SPREAD}"] / 2}
        for row in sorted(rows, key=lambda row: row["objects"])
    ]
    first, counts = rows[0], sorted({row["objects"] for row in rows})
    most = [point for point in points if point["x"] == counts[-1]]
    fastest = min(most, key=lambda point: point["y"])
    looks: dict[str, Any] = {"by": ("line", "shadow"), "colour": "line"}
    tips = (("line", "pipeline"), ("x", "objects"), ("y", "ms"))
    return Chart(
        name="frames",
        title=f"Fastest at {counts[-1]} objects: {fastest['line']}, {fastest['y']:.3g} ms per frame",
        subtitle=f"{first['size']}, {first['lights']} point lights and a sun; {first['device']}, {first['clock']}",
        description="Milliseconds per frame by the number of objects, with a line for each pipeline.",
        x=Axis(title="objects", scale=Scale.LOG, ticks=tuple((count, str(count)) for count in counts)),
        y=Axis(title="ms per frame (median and quartiles)", scale=Scale.LOG),
        rows=tuple(points),
        colour=Names("line", distinct(points, "line")),
        panels=Names("shadow", tuple(sorted(distinct(points, "shadow")))),
        marks=(
            Mark(kind=Kind.RULES, y="low", y2="high", colour="line"),
            Mark(kind=Kind.LINES, **looks, tips=tips),
            Mark(kind=Kind.POINTS, colour="line", tips=tips),
            Mark(kind=Kind.ENDS, **looks, text="line"),
        ),
    )


def _shadow_text(row: Row) -> str:
    return "with shadow map" if row["shadow"] else "without shadow map"


def _line_name(row: Row, rows: Sequence[Row], more: Sequence[str]) -> str:
    """Return the name of a row's pipeline, followed by the values in which the pipeline's rows differ."""
    same = [other for other in rows if other["pipeline"] == row["pipeline"]]
    varied = [name for name in more if len({str(other.get(name)) for other in same}) > 1]
    texts = (_shadow_text(row) if name == "shadow" else str(row.get(name)) for name in varied)
    return " ".join([str(row["pipeline"]), *texts])
