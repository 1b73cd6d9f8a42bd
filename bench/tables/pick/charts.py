"""The chart of an answer: what the codes of a question cost against what they lose."""

from __future__ import annotations

from collections.abc import Sequence

from ....reports.charts.chart import INK, Axis, Chart, Kind, Mark, Scale
from ....reports.page.codec_key import CodecKey
from ..table import Row
from .answer import groups, mean, why_unfit
from .sentences import called, question

HEIGHT = 300
# What the title of a chart finds; the page's script fills it in for a reader's own constraints.
FOUND = "{where}: no other code beats {front} of {all} in both slots and mean error"


def charts(rows: Sequence[Row]) -> list[Chart]:
    """A chart for each question of which two codes have a price."""
    asked = [(group, [_point(row) for row in group if _has_place(row)]) for group in groups(rows).values()]
    return [_chart(chart_name(at), group, points) for at, (group, points) in enumerate(asked) if len(points) > 1]


def chart_name(at: int) -> str:
    """The name of the chart of a question, by its place among those of the rows."""
    return f"choose-{at}"


def _has_place(row: Row) -> bool:
    """Whether some reader's constraints may let a code in, and it has both figures."""
    is_known = bool(mean(row)) and row["slots_once"] is not None
    return is_known and not row["beside"] and not why_unfit({**row, "accept_lengths": True})


def _point(row: Row) -> Row:
    about = {"codec": CodecKey.of(row).label, "name": called(row), "why": row["left_out"] or ""}
    return about | {"x": row["slots_once"], "y": mean(row), "rest": bool(row["left_out"])}


def _front(points: Sequence[Row]) -> list[Row]:
    """The points that no other one beats in both, the cheapest first."""
    kept: list[Row] = []
    for point in sorted((one for one in points if not one["rest"]), key=lambda one: (one["x"], one["y"])):
        if not kept or point["y"] < kept[-1]["y"]:
            kept.append(point)
    return kept


def _chart(name: str, group: Sequence[Row], points: Sequence[Row]) -> Chart:
    asked, front, left = question(group[0]), tuple(_front(points)), [point for point in points if not point["rest"]]
    tips = (("codec", "codec"), ("x", "issue slots"), ("y", "mean error, degrees"), ("why", "left out"))
    return Chart(
        name=name,
        title=FOUND.format(where=asked, front=len(front), all=len(left)),
        subtitle="The line joins these; grey: left out",
        description="Each code by the issue slots that it takes to encode and to decode once, and by its mean error. "
        "The figures are in the table.",
        x=Axis(title=f"issue slots to encode and decode once, {group[0]['family']}", scale=Scale.COUNT),
        y=Axis(title="mean error, degrees", scale=Scale.LOG),
        rows=tuple(points),
        height=HEIGHT,
        marks=(
            Mark(kind=Kind.LINES, rows=front, colour=INK, is_stepped=True),
            Mark(kind=Kind.POINTS, rest="rest", tips=tips),
            Mark(kind=Kind.LABELS, text="name", colour=INK, rest="rest"),
        ),
    )
