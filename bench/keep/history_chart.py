"""The chart of `history`: figures over runs, and the commits at which they changed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ...reports.charts.chart import MUTED, Axis, Chart, Kind, Mark, Names
from ..tables.table import Row
from .history import Change, Series, is_value
from .past_runs import Past

# How many figures a chart shows.
MOST = 6
MENDED, STILL, BETTER = "mended", "worse", "better"


def chart(runs: Sequence[Past], figures: Sequence[tuple[Series, str]], changes: Sequence[Change]) -> Chart:
    """A panel for each figure, whose line goes from commit to commit."""
    points = [point for one, name in figures for point in _points(one, name)]
    marked = [row for one, name in figures for row in _marked(runs, one, name, changes)]
    tips = (("commit", "commit"), ("y", "value"))
    ends = {0: runs[0], len(runs) - 1: runs[-1]}
    return Chart(
        name="history",
        title=_title(marked),
        subtitle=f"{len(runs)} runs, {runs[0].day} to {runs[-1].day}, and the commits at which figures changed",
        description="A panel for each figure with a line over the runs, and a point at each commit that changed it. "
        "The table of the command has the figures.",
        x=Axis(title="commit", ticks=tuple((at, past.name) for at, past in ends.items())),
        y=Axis(title="", is_shared=False),
        rows=tuple(points),
        colour=Names(
            "said", tuple(said for said in (MENDED, STILL, BETTER) if said in {row["said"] for row in marked})
        ),
        panels=Names("figure", tuple(dict.fromkeys(_called(one, name) for one, name in figures))),
        marks=(
            Mark(kind=Kind.LINES, colour=MUTED, is_stepped=True),
            Mark(kind=Kind.POINTS, rows=tuple(marked), colour="said", tips=tips),
            Mark(kind=Kind.LABELS, rows=tuple(marked), text="commit", colour="said"),
        ),
    )


def _called(series: Series, name: str) -> str:
    column = series.table.column(name)
    unit = f", {column.unit}" if column and column.unit else ""
    return f"{series.table.name} {series.called}: {name}{unit}"


def _points(series: Series, name: str) -> Iterator[Row]:
    for at, value in series.over_all(name):
        if is_value(value):
            yield {"figure": _called(series, name), "x": at, "y": value}


def _marked(runs: Sequence[Past], series: Series, name: str, changes: Sequence[Change]) -> Iterator[Row]:
    """The commits at which a figure changed, and those that mended it."""
    values = dict(series.over_all(name))
    for change in changes:
        if change.series is series and change.line["column"] == name:
            is_better = change.line["verdict"] == "better"
            said = {change.at: BETTER if is_better else STILL}
            said |= {} if change.mended is None else {change.at: STILL, change.mended: MENDED}
            for at, word in said.items():
                if is_value(values.get(at)):
                    yield {
                        "figure": _called(series, name),
                        "x": at,
                        "y": values[at],
                        "commit": runs[at].name,
                        "said": word,
                    }


def _title(marked: Sequence[Row]) -> str:
    worse, mended = (dict.fromkeys(row["commit"] for row in marked if row["said"] == said) for said in (STILL, MENDED))
    if not worse:
        return "No figure got worse"
    return f"Worse at {', '.join(worse)}" + (f", mended at {', '.join(mended)}" if mended else "")
