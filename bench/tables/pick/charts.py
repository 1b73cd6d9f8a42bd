"""The charts of an answer: cost against error, and the distribution of angles."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from itertools import accumulate

from ....reports.charts.chart import FAINT, INK, Axis, Chart, Kind, Mark, Scale
from ....reports.page.codec_key import CodecKey
from ..charts import LEAST_DEG, bins
from ..table import Row
from .answer import groups, mean, why_unfit
from .sentences import called, question

HEIGHT = 300
# What the title of a chart finds; the page's script fills it in for a reader's own constraints.
FOUND = "{where}: {front} of {all} eligible encodings are Pareto-optimal in slots and mean error"
# The angles of a spread begin where so many percent of some code's normals are below, and are at most so many.
LOWEST_SHARE, MOST_ANGLES = 1.0, 96


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield the charts for each question with at least two encodings of known cost: cost against error, and the
    distribution of angles."""
    for index, group in enumerate(groups(rows).values()):
        able = [row for row in group if _has_place(row)]
        if len(able) > 1:
            yield _chart(chart_name(index), group, [_point(row) for row in able])
        counted = [(row, angle_bins) for row in able if (angle_bins := bins(row.get("angle_counts")))]
        if len(counted) > 1:
            yield _spread(spread_name(index), counted)


def chart_name(index: int) -> str:
    """Return the name of the cost chart for the question with this index."""
    return f"choose-{index}"


def spread_name(index: int) -> str:
    """Return the name of the chart of angles for the question with this index."""
    return f"spread-{index}"


def _has_place(row: Row) -> bool:
    """Whether an encoding belongs in the charts: it qualifies under some constraints that a reader may choose, and
    its mean error and its issue slots are known."""
    is_known = bool(mean(row)) and row["slots_once"] is not None
    return is_known and not row["beside"] and not why_unfit({**row, "accept_lengths": True})


def _point(row: Row) -> Row:
    about = {"codec": CodecKey.of(row).label, "name": called(row), "why": row["left_out"] or ""}
    return about | {"x": row["slots_once"], "y": mean(row), "rest": bool(row["left_out"])}


def _front(points: Sequence[Row]) -> list[Row]:
    """Return the Pareto front in cost and error of the points that are not excluded (`rest`), the cheapest first."""
    kept: list[Row] = []
    for point in sorted(
        (candidate for candidate in points if not candidate["rest"]), key=lambda row: (row["x"], row["y"])
    ):
        if not kept or point["y"] < kept[-1]["y"]:
            kept.append(point)
    return kept


def _chart(name: str, group: Sequence[Row], points: Sequence[Row]) -> Chart:
    asked, front, left = question(group[0]), tuple(_front(points)), [point for point in points if not point["rest"]]
    tips = (("codec", "codec"), ("x", "issue slots"), ("y", "mean error (degrees)"), ("why", "excluded because"))
    return Chart(
        name=name,
        title=FOUND.format(where=asked, front=len(front), all=len(left)),
        subtitle="Line: Pareto front; grey: excluded by a constraint",
        description="Each encoding by the issue slots to encode and decode once, and by its mean error. The figures "
        "are in the table.",
        x=Axis(title=f"issue slots to encode and decode once ({group[0]['family']})", scale=Scale.COUNT),
        y=Axis(title="mean error (degrees)", scale=Scale.LOG),
        rows=tuple(points),
        height=HEIGHT,
        marks=(
            Mark(kind=Kind.LINES, rows=front, colour=INK, is_stepped=True),
            Mark(kind=Kind.POINTS, rest="rest", tips=tips),
            Mark(kind=Kind.LABELS, text="name", colour=INK, rest="rest"),
        ),
    )


Bins = Sequence[tuple[float, float, int]]


def _spread(name: str, counted: Sequence[tuple[Row, Bins]]) -> Chart:
    """Return the chart of the share of normals below each angle: a line for each codec, and an area around all."""
    shares = {CodecKey.of(row).label: _shares_below(angle_bins) for row, angle_bins in counted}
    angles = _angles(shares.values())
    lines = {codec: [_share_at(angle, *curve) for angle in angles] for codec, curve in shares.items()}
    points = tuple(
        {"codec": codec, "x": x, "y": y} for codec, line in lines.items() for x, y in zip(angles, line, strict=True)
    )
    around = tuple(
        {"x": x, "y": max(percents), "low": min(percents)}
        for x, percents in zip(angles, zip(*lines.values(), strict=True), strict=True)
    )
    first = counted[0][0]
    tips = (("codec", "codec"), ("x", "angle (degrees)"), ("y", "normals below this angle (%)"))
    return Chart(
        name=name,
        title=f"{question(first)}: {_median_sentence(first, *next(iter(shares.values())))}",
        subtitle="Share of normals with an error below a given angle; shaded: range of all eligible encodings",
        description="The share of normals with an error below a given angle, on a logarithmic scale. The shaded area "
        "covers all encodings that could be the answer; each is a thin line in it.",
        x=Axis(title="angle between normal and decode (degrees)", scale=Scale.LOG),
        y=Axis(title="share of normals (%)", domain=(0.0, 100.0)),
        rows=points,
        height=HEIGHT,
        marks=(
            Mark(kind=Kind.AREAS, rows=around, y2="low", colour=FAINT),
            Mark(kind=Kind.LINES, by=("codec",), colour=FAINT, tips=tips),
        ),
    )


def _shares_below(counts: Bins) -> tuple[list[float], list[float]]:
    """Return the upper edges of a histogram's bins, and the percentage of all angles below each edge."""
    total = sum(count for *_, count in counts)
    return [max(high, LEAST_DEG) for _, high, _ in counts], [100 * n / total for n in accumulate(c for *_, c in counts)]


def _share_at(angle: float, edges: Sequence[float], below: Sequence[float]) -> float:
    """Return the percentage of angles below a bin edge, with a tolerance because edges are rounded in rows."""
    index = bisect_right(edges, angle * 1.001)
    return round(below[index - 1], 1) if index else 0.0


def _angles(shares: Iterable[tuple[Sequence[float], Sequence[float]]]) -> list[float]:
    """Return at most MOST_ANGLES bin edges in ascending order, from the lowest edge below which a codec has
    LOWEST_SHARE percent of its normals to the highest edge."""
    pairs = [pair for edges, below in shares for pair in zip(edges, below, strict=True)]
    low = min(edge for edge, share in pairs if share >= LOWEST_SHARE)
    every = sorted({edge for edge, _ in pairs if edge >= low}, reverse=True)
    return every[:: -(-len(every) // MOST_ANGLES)][::-1]


def _median_sentence(row: Row, edges: Sequence[float], below: Sequence[float]) -> str:
    half, most = (next(edge for edge, share in zip(edges, below, strict=True) if share >= part) for part in (50, 99))
    return (
        f"{called(row)} has errors below {half:.2g} degrees for half of the normals, below {most:.2g} degrees for 99%"
    )
