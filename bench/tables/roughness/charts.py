"""The curve of bits over roughness."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ....reports.charts.chart import MUTED, Axis, Chart, Kind, Mark, Names, Scale
from ....reports.page.codec_key import CodecKey
from ..charts import having
from ..table import Row
from .frames import NONE

# What FLIP cannot be below, so that it has a place on an axis of logarithms.
LEAST = 1e-4
# How many codes have points on their lines: those of more hide each other.
MOST_WITH_POINTS = 40


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield the chart of FLIP by roughness, if any row has FLIP."""
    usable = [r for r in having(rows, "flip_p99", "roughness") if r.get("threshold") is None or r.get("decides")]
    if usable:
        yield roughness_chart(usable, sorted({row["threshold"] for row in rows if row.get("threshold") is not None}))


def roughness_chart(rows: Sequence[Row], thresholds: Sequence[float]) -> Chart:
    """Return the chart of FLIP's 99th percentile by roughness, for the worst object and environment, with a line for
    each codec.

    Args:
        rows: rows of the roughness table with FLIP: single images, and deciding crossings of a threshold.
        thresholds: values to draw as dotted lines.
    """
    worst: dict[tuple[str, float], Row] = {}
    for row in rows:
        key = _called(row), row["roughness"]
        if key not in worst or row["flip_p99"] > worst[key]["flip_p99"]:
            worst[key] = row
    points = tuple(
        {"codec": codec, "x": roughness, "y": max(row["flip_p99"], LEAST)}
        | {"what": f"{row['object']} in {row['environment']}"}
        for (codec, roughness), row in sorted(worst.items())
    )
    ends = (min(point["x"] for point in points), max(point["x"] for point in points))
    lines = tuple({"line": f"{threshold:g}", "x": x, "y": threshold} for threshold in thresholds for x in ends)
    codecs = tuple(dict.fromkeys(map(_called, rows)))
    tips = (("codec", "codec"), ("x", "roughness"), ("y", "FLIP (99th percentile)"), ("what", "worst on"))
    return Chart(
        name="roughness",
        title="A mirror shows each step between codes; a rough surface hides it",
        subtitle="FLIP (99th percentile) by roughness, for the worst object and environment",
        description="FLIP (99th percentile) over the pixels of an object that reflects its environment, on a "
        "logarithmic scale, by perceptual roughness: a line for each encoding, for the worst object and "
        "environment. Dotted lines are the thresholds. The figures are in the table.",
        x=Axis(title="perceptual roughness"),
        y=Axis(title="FLIP (99th percentile)", scale=Scale.LOG),
        rows=points,
        colour=Names("codec", codecs),
        marks=(
            Mark(kind=Kind.LINES, rows=lines, by=("line",), colour=MUTED, dash="dotted"),
            Mark(kind=Kind.LINES, by=("codec",), colour="codec", tips=tips),
            *((Mark(kind=Kind.POINTS, colour="codec", tips=tips),) if len(codecs) <= MOST_WITH_POINTS else ()),
            Mark(kind=Kind.ENDS, rows=lines, by=("line",), colour=MUTED, text="line"),
            Mark(kind=Kind.ENDS, by=("codec",), colour="codec", text="codec"),
        ),
    )


def _called(row: Row) -> str:
    """Return the name of a codec, with its noise and its number of frames unless there is no noise and one frame."""
    noise = "" if row["dither"] == NONE else f", {row['dither']} noise"
    return CodecKey.of(row).label + noise + ("" if row["frames"] == 1 else f", {row['frames']} frames")
