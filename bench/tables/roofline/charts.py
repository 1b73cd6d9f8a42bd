"""The chart of bytes against instructions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ....reports.charts.chart import MUTED, Axis, Chart, Kind, Mark, Names, Scale, Switch, distinct
from ..charts import having
from ..table import Row

STEPS = 40
MEMORY, CACHE = "bytes from memory take as long as instructions", "bytes from the cache take as long"


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield the chart of bytes against instructions, if any row has both."""
    usable = having(rows, "instructions", "bytes_per_pixel")
    if usable:
        yield roofline_chart(usable)


def points(rows: Sequence[Row]) -> list[Row]:
    """Return the points of the chart: instructions, and bytes written and read, per pixel and frame, at the fewest
    reads and the first size."""
    reads, size = min(row["reads"] for row in rows), rows[0]["size"]
    names = ("gpu", "encoding", "storage", "size", "reads", "ridge", "in_cache")
    codec_points = {
        (row["gpu"], row["encoding"], row["storage"]): {
            **{name: row[name] for name in names},
            "codec": f"{row['encoding']} {row['storage']}",
            "x": row["instructions"],
            "y": row["bytes_per_pixel"] * (row["overdraw"] + row["reads"]),
        }
        for row in rows
        if (row["reads"], row["size"]) == (reads, size)
    }
    return list(codec_points.values())


def ridge_lines(point_rows: Sequence[Row], gpu: str) -> dict[bool, list[tuple[float, float]]]:
    """Return the lines on which a GPU's bytes take as long as its instructions, as points (instructions, bytes) from
    the lower end of the byte axis: False for codecs in memory, True for codecs in the cache."""
    most, (least, _) = _axis_end(point_rows), _bytes_axis(point_rows)
    ridges = {point["in_cache"]: point["ridge"] for point in point_rows if point["gpu"] == gpu}
    across = [most * (step / STEPS) ** 2 for step in range(1, STEPS + 1)]
    return {cached: [(x, x / ridge) for x in across if x / ridge >= least] for cached, ridge in ridges.items()}


def _axis_end(point_rows: Sequence[Row]) -> float:
    return max(point["x"] for point in point_rows) * 1.3 + 1


def _bytes_axis(point_rows: Sequence[Row]) -> tuple[float, float]:
    """Return the ends of the byte axis, which leaves a margin around the points."""
    return min(point["y"] for point in point_rows) / 1.5, max(point["y"] for point in point_rows) * 1.5


def roofline_chart(rows: Sequence[Row]) -> Chart:
    """Return the chart of bytes against instructions, per pixel and frame, for each GPU: above the line memory takes
    longer, below it arithmetic.

    Args:
        rows: rows of the roofline table: encoding, storage, gpu, reads, overdraw, instructions, bytes_per_pixel,
            ridge.
    """
    drawn_points = [{**point, "where": CACHE if point["in_cache"] else MEMORY} for point in points(rows)]
    gpus, reads = distinct(drawn_points, "gpu"), drawn_points[0]["reads"]
    lines = [
        {"gpu": gpu, "where": CACHE if cached else MEMORY, "x": x, "y": y}
        for gpu in gpus
        for cached, line in ridge_lines(drawn_points, gpu).items()
        for x, y in line
    ]
    tips = (("codec", "codec"), ("x", "instructions"), ("y", "bytes"), ("reads", "reads"))
    return Chart(
        name="roofline",
        title=_finding_sentence(drawn_points),
        subtitle=f"Bytes against instructions, {drawn_points[0]['size']}, {reads} {'read' if reads == 1 else 'reads'}",
        description="Each encoding by its instructions and bytes per pixel and frame, at the fewest reads and the "
        "first size. Above the GPU's line an encoding's bytes take longer than its instructions, below "
        "it the instructions do. The dashed line is for encodings that fit in the cache. The figures are "
        "in the table.",
        x=Axis(title="instructions per pixel and frame", scale=Scale.COUNT, domain=(-1.0, _axis_end(drawn_points))),
        y=Axis(title="bytes written and read per pixel and frame", scale=Scale.LOG, domain=_bytes_axis(drawn_points)),
        rows=tuple(drawn_points),
        colour=Names("encoding", distinct(drawn_points, "encoding")),
        shape=Names("storage", distinct(drawn_points, "storage")),
        dash=Names("where", (MEMORY, CACHE), looks=((), (5, 4))),
        switch=Switch("gpu", "GPU", gpus, gpus[0], has_panels=True),
        marks=(
            Mark(kind=Kind.LINES, rows=tuple(lines), by=("gpu", "where"), colour=MUTED, dash="where"),
            Mark(
                kind=Kind.POINTS,
                colour="encoding",
                shape="storage",
                tips=(*tips, ("where", "line"), ("gpu", "GPU")),
            ),
        ),
    )


def _finding_sentence(point_rows: Sequence[Row]) -> str:
    """Return a sentence on the number of cases in which bytes take longer than instructions."""
    bound = [point for point in point_rows if point["y"] * point["ridge"] > point["x"]]
    gpus, codecs = (len(distinct(point_rows, name)) for name in ("gpu", "codec"))
    shown = f"{codecs} codecs on {gpus} {'GPU' if gpus == 1 else 'GPUs'}"
    return f"Bytes take longer than instructions in {len(bound)} of {len(point_rows)} cases: {shown}"
