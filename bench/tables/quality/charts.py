"""The charts of normal accuracy: histograms of angles."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from ....reports.charts.chart import ALL, INK, Axis, Chart, Kind, Mark, Names, Scale, Switch
from ....reports.page.codec_key import CodecKey
from ....reports.page.verdict import is_number
from ..charts import LEAST_DEG, backends_of, bins, having, lines_of, one_backend
from ..table import Row

# Of a line's pixels, the share that the highest histogram takes, and where its figures are marked.
HIGHEST, MARKED = 0.85, 0.12
FIGURES = (
    ("angle_mean_deg", "mean", "tick"),
    ("angle_p99_deg", "99%", "diamond"),
    ("angle_max_deg", "largest", "circle"),
)
MOST_DEG = 200.0


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield a chart for each set of normals whose rows have histograms."""
    usable = [r for r in having(rows, "bits", "angle_mean_deg") if bins(r.get("angle_counts"))]
    for index, normals in enumerate(dict.fromkeys(str(row.get("normals")) for row in usable)):
        part = one_backend([row for row in usable if str(row.get("normals")) == normals])
        yield histogram_chart(index, sorted(part, key=lambda row: row["angle_mean_deg"]))


def histogram_chart(index: int, rows: Sequence[Row]) -> Chart:
    """Return a histogram of angles for each codec, with the best codec at the top; the mean, the 99th percentile and
    the largest angle are marked.

    Args:
        index: index of the chart among the charts of the table.
        rows: rows of the quality table for one set, the best first: encoding, storage, bits, angle_counts and
            angles.
    """
    lines = lines_of(rows)
    feet = [float(len(rows) - 1 - i) for i in range(len(rows))]
    abouts = [_point_row(row, line) for row, line in zip(rows, lines, strict=True)]
    outlines = [
        {**about, **point}
        for row, about, foot in zip(rows, abouts, feet, strict=True)
        for point in _outline_points(row, foot)
    ]
    figures = [
        {**about, "figure": name, "x": max(row[column], LEAST_DEG), "y": foot + MARKED}
        for row, about, foot in zip(rows, abouts, feet, strict=True)
        for column, name, _ in FIGURES
        if is_number(row.get(column))
    ]
    all_bits = tuple(sorted({row["bits"] for row in rows}))
    tips = (("codec", "codec"), ("bits", "bits"), ("mean", "mean (degrees)"), ("largest", "largest (degrees)"))
    return Chart(
        name=f"angles-{index}",
        title=_finding_sentence(rows),
        subtitle=f"Angles on {rows[0]['normals']}, by {backends_of(rows)}",
        description="The share of normals by angle in degrees, on a logarithmic scale. The figures are in the tables "
        "of normal accuracy.",
        x=Axis(title="angle between normal and decode (degrees)", scale=Scale.LOG, domain=(LEAST_DEG, MOST_DEG)),
        y=Axis(title="", domain=(-0.3, len(rows) + 0.2), ticks=tuple(zip(feet, lines, strict=True))),
        rows=tuple(outlines),
        colour=Names("bits", all_bits, "bits", is_ordered=True),
        shape=Names("figure", tuple(n for _, n, _ in FIGURES), looks=tuple(look for *_, look in FIGURES)),
        switch=Switch("bits", "Bits shown", (ALL, *map(str, all_bits)), ALL),
        marks=(
            Mark(kind=Kind.AREAS, y2="foot", by=("line",), colour="bits", is_stepped=True, tips=tips),
            Mark(kind=Kind.POINTS, rows=tuple(figures), shape="figure", colour=INK, tips=tips),
        ),
    )


def _point_row(row: Row, line: str) -> dict[str, Any]:
    return {"codec": CodecKey.of(row).label, "line": line, "bits": row["bits"]} | {
        "mean": row["angle_mean_deg"],
        "largest": row.get("angle_max_deg"),
    }


def steps(counts: Sequence[tuple[float, float, int]]) -> tuple[list[float], list[float]]:
    """Return a histogram's outline: bin edges from LEAST_DEG up, and the number of normals per octave in each bin."""
    below = sum(count for low, _, count in counts if low < LEAST_DEG)
    edges, heights = [LEAST_DEG, LEAST_DEG * 1.125], [below / math.log2(1.125)]
    for low, high, count in counts:
        if low >= LEAST_DEG:
            if low > edges[-1] * 1.001:  # rows round edges
                edges, heights = [*edges, low], [*heights, 0.0]
            edges, heights = [*edges, high], [*heights, count / math.log2(high / edges[-1])]
    return edges, heights


def _outline_points(row: Row, foot: float) -> list[Row]:
    """Return a codec's histogram as the points of a stepped line above `foot`; the highest step has the same height
    for every codec."""
    edges, heights = steps(bins(row["angle_counts"]))
    highest = max(heights)
    return [
        {"x": edge, "y": foot + HIGHEST * height / highest, "foot": foot}
        for edge, height in zip(edges, [*heights, 0.0], strict=True)
    ]


def _finding_sentence(rows: Sequence[Row]) -> str:
    """Return a sentence on the codec with the smallest mean angle at each bit count that several codecs share."""
    alike: dict[int, list[Row]] = {}
    for row in rows:
        alike.setdefault(row["bits"], []).append(row)
    compared = {bits: part[0] for bits, part in sorted(alike.items()) if len(part) > 1 or len(alike) == 1}
    best = compared or {row["bits"]: row for row in rows[:1]}
    phrases = [f"{CodecKey.of(row).label}, {bits} bits ({row['angle_mean_deg']:.2g})" for bits, row in best.items()]
    return f"Smallest mean angles, in degrees: {', '.join(phrases)}"
