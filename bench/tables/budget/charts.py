"""The chart of budgets: the PSNR of the worst class by bytes per pixel, with engines' layouts as points."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ....reports.charts.chart import MUTED, Axis, Chart, Kind, Mark
from ..charts import having
from ..table import Row
from .table import PROPOSAL

# Layouts that are farther below the proposals are not drawn: they would press the others together.
NEAR_DB = 30.0


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield one chart if at least three rows can be compared and at least one of them is a proposal."""
    usable = having(rows, "held_back_db", "contract_bytes")
    if len(usable) > 2 and any(row["kind"] == PROPOSAL for row in usable):
        yield budget_chart(usable)


def budget_chart(rows: Sequence[Row]) -> Chart:
    """Return a chart of the worst class's PSNR by bytes per pixel: a line for proposals, a point per other layout.

    Args:
        rows: rows with figures.
    """
    best = max(row["held_back_db"] for row in rows)
    points = tuple(
        {
            "layout": f"proposed, {row['contract_bytes']} bytes" if row["kind"] == PROPOSAL else row["layout"],
            "x": row["contract_bytes"],
            "y": row["held_back_db"],
            "worst": row["worst_db"],
            "class": row["worst_class"],
            "frame": row["psnr_db"],
        }
        | {"kind": row["kind"]}
        for row in sorted(rows, key=lambda row: row["contract_bytes"])
        if row["held_back_db"] > best - NEAR_DB or row["kind"] == PROPOSAL
    )
    # A larger budget may give the same layout.
    points = tuple({(point["layout"], point["x"], point["y"]): point for point in points}.values())
    ours = tuple(point for point in points if point["kind"] == PROPOSAL)
    others = tuple(point for point in points if point["kind"] != PROPOSAL)
    tips = (
        ("layout", "layout"),
        ("x", "bytes per pixel"),
        ("y", "dB"),
        ("worst", "worst class (dB)"),
        ("class", "worst class"),
        ("frame", "whole frame (dB)"),
    )
    first = rows[0]
    return Chart(
        name="budget",
        title=_finding(ours, others),
        subtitle=f"{_judged(first['scene'])} at {first['size']}",
        description="PSNR of the displayed image over the worst class of surfaces, from the mean error over scenes, "
        "by bytes per pixel of the G-buffer: a line for the proposed layouts, each chosen without the "
        "scene that judges it, and a point for each engine's layout. The figures are in the table.",
        x=Axis(title="bytes per pixel (excluding depth; missing attributes added)", ticks=_ticks(points)),
        y=Axis(title="PSNR of the worst class, in scenes left out of the choice (dB)"),
        rows=points,
        marks=(
            Mark(kind=Kind.LINES, rows=ours, tips=tips),
            Mark(kind=Kind.POINTS, rows=ours, tips=tips),
            Mark(kind=Kind.POINTS, rows=others, colour=MUTED, tips=tips),
            Mark(kind=Kind.LABELS, rows=points, colour=MUTED, text="layout"),
        ),
    )


def _judged(scenes: str) -> str:
    """Return the part of the subtitle that states which class and scenes the figures are for."""
    names = scenes.split(",")
    if len(names) == 1:
        return f"Worst class of surfaces in {scenes}, which also chose the proposals,"
    others = "the other scene" if len(names) == 2 else "the other scenes"
    return f"Worst class of surfaces in each of {', '.join(names)}, proposals chosen on {others},"


def _ticks(points: Sequence[Row]) -> tuple[tuple[float, str], ...]:
    """Return a tick for each even number of bytes in the range of the points."""
    low, high = (bound(point["x"] for point in points) for bound in (min, max))
    return tuple((float(tick), str(tick)) for tick in range(2 * math.ceil(low / 2), math.floor(high) + 1, 2))


def _finding(ours: Sequence[Row], others: Sequence[Row]) -> str:
    """Return the title: the proposals' gain over layouts of the same size or larger, or else their PSNR."""
    gains = [
        max(point["y"] for point in ours if point["x"] <= other["x"]) - other["y"]
        for other in others
        if any(point["x"] <= other["x"] for point in ours)
    ]
    if gains:
        worst = f"{min(gains):.0f}" if min(gains) >= 0 else f"{-min(gains):.0f} dB worse"
        return f"Proposals of at most as many bytes are {worst} to {max(gains):.0f} dB better"
    return f"{ours[0]['y']:.0f} dB with {ours[0]['x']} bytes, {ours[-1]['y']:.0f} dB with {ours[-1]['x']}"
