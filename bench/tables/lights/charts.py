"""The chart of light buffers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ....encodings.catalogue import LIGHT_BUFFERS
from ....reports.charts.chart import Axis, Chart, Kind, Mark, Names, Scale, distinct
from ..charts import having
from ..table import Row

# A logarithmic axis has no zero: what is exact is drawn at its foot.
LEAST_ERROR = 1e-6
# The ways to add lights, in the order of the charts.
WAYS = ("blended", "read first")
RANDOM = "random lights, worst pixel"


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield a chart of the error in accumulated light by the number of lights, for light buffers that blend and for
    those that are read first, so that each has its own colour; nothing without rows."""
    equal = [r for r in having(rows, "sum", "lights", "error", "bound") if r.get("experiment") == "equal"]
    random = [r for r in having(rows, "lights", "model_max", "bound") if r.get("experiment") == "random"]
    points = [*_equal_rows(equal), *_random_rows(random)]
    for way in WAYS:
        if own := [point for point in points if way_of(point["light_buffer"]) == way]:
            yield lights_chart(own, way)


def way_of(light_buffer: str) -> str:
    """Return how lights are added in a light buffer: blended, or read first, which adds them in the shader."""
    known = LIGHT_BUFFERS.get(light_buffer)
    return "read first" if known and known.blend == "read" else "blended"


def lights_chart(points: Sequence[Row], way: str) -> Chart:
    """Return the chart of one way to add lights, with a line for each light buffer, a dotted line for the bound on its
    error, and panels for equal and for coloured lights."""
    looks: dict[str, Any] = {"by": ("light_buffer", "panel"), "colour": "light_buffer"}
    tips = (("light_buffer", "light buffer"), ("x", "lights"), ("error", "error"), ("bound", "bound"))
    counts = sorted({point["x"] for point in points})
    return Chart(
        name=f"lights-{way.replace(' ', '-')}",
        title=f"Light buffers, {way}: {_finding_sentence(points)}",
        subtitle="Error by number of lights; dotted: number of blends times half a step; errors below 1e-6 are drawn "
        "at 1e-6",
        description="Error of the sum, from the model, by the number of lights, with a line for each light buffer; "
        "dotted: the bound on the error. The figures are in the rows of the experiments equal and random.",
        x=Axis(title="lights", scale=Scale.LOG, ticks=tuple((count, str(count)) for count in counts)),
        y=Axis(title="error in light (model)", scale=Scale.LOG),
        rows=tuple(points),
        colour=Names("light_buffer", distinct(points, "light_buffer")),
        panels=Names("panel", distinct(points, "panel")),
        marks=(
            Mark(kind=Kind.LINES, **looks, y="bound", dash="dotted"),
            Mark(kind=Kind.LINES, **looks, tips=tips),
            Mark(kind=Kind.POINTS, colour="light_buffer", tips=tips),
            Mark(kind=Kind.ENDS, **looks, text="light_buffer"),
        ),
    )


def _equal_rows(rows: Sequence[Row]) -> list[Row]:
    """Return the points for equal lights with the smallest sum: the error in each buffer's worst channel."""
    total = min((row["sum"] for row in rows), default=0.0)
    panel = f"equal lights, sum {total:g}"
    return _worst(panel, [(row, abs(row["error"])) for row in rows if row["sum"] == total])


def _random_rows(rows: Sequence[Row]) -> list[Row]:
    """Return the points for coloured lights: the largest error of each buffer, in its worst order of lights."""
    return _worst(RANDOM, [(row, row["model_max"]) for row in rows])


def _worst(panel: str, errors: Sequence[tuple[Row, float]]) -> list[Row]:
    """Return a point with the largest error for each buffer and number of lights, sorted by the number of lights."""
    largest: dict[tuple[str, int], tuple[float, float]] = {}
    for row, error in errors:
        key = (row["light_buffer"], row["lights"])
        largest[key] = max(largest.get(key, (0.0, 0.0)), (error, row["bound"]))
    return [
        {"light_buffer": name, "panel": panel, "x": count, "y": max(error, LEAST_ERROR), "error": error, "bound": bound}
        for (name, count), (error, bound) in sorted(largest.items(), key=lambda item: item[0][1])
    ]


def _finding_sentence(points: Sequence[Row]) -> str:
    """Return a sentence that names the buffers with the smallest and the largest error for the most lights, in the
    last panel."""
    panel, most = points[-1]["panel"], max(point["x"] for point in points)
    last = sorted((p for p in points if (p["panel"], p["x"]) == (panel, most)), key=lambda p: p["y"])
    best, worst = last[0], last[-1]
    sentence = f"smallest error with {most} lights: {best['light_buffer']}, {best['error']:.2g}"
    return f"{sentence}; largest: {worst['light_buffer']}, {worst['error']:.2g}"
