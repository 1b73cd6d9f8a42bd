"""The charts of budgets: the bits of each proposed layout, and the PSNR of the worst class by bytes per pixel."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ....gbuffer.layouts.words import LayoutError, all_placed, targets_of
from ....reports.charts.chart import MUTED, PAPER, Axis, Chart, Kind, Mark, Names, Scale, distinct
from ..charts import having
from ..table import Row
from .table import PROPOSAL

# Layouts that are farther below the proposals are not drawn: they would press the others together.
NEAR_DB = 30.0
# Bits at which the axis of a target has ticks, and pixels that a target takes.
BIT_TICKS, TARGET_HEIGHT = (0, 8, 16, 24, 32, 48, 64, 96, 128), 34
TIPS = (("attribute", "attribute"), ("bits", "bits"))


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield a chart of the bits of each proposal, and the chart of `plotted`."""
    proposals = {row["targets"]: row for row in rows if row["kind"] == PROPOSAL and row["targets"]}
    fields = {text: _fields(row) for text, row in proposals.items()}
    # An attribute has the same colour in each chart.
    names = distinct([field for of in fields.values() for field in of], "attribute")
    for text, row in proposals.items():
        if fields[text]:
            yield bit_chart(row, fields[text], names)
    yield from plotted(rows)


def _fields(row: Row) -> list[Row]:
    """Return the fields of a proposal's targets with their bits; none if its text is not that of a layout."""
    fields = []
    try:
        for index, target in enumerate(targets_of(row["targets"])):
            for word in all_placed(row["layout"], index, target):
                start = word.first if word.bits else sum(target.storage.bits[: word.first])
                bits = word.bits_in(target.storage)
                field = {"target": f"{index}: {target.format}", "bits": bits, "x": start, "x2": start + bits}
                fields.append(field | {"attribute": word.label or word.component.partition(".")[0]})
    except LayoutError:
        return []
    return fields


def bit_chart(row: Row, fields: Sequence[Row], names: tuple[str, ...]) -> Chart:
    """Return the chart of a proposal's bits, with a bar for each target.

    Args:
        row: the proposal.
        fields: its fields.
        names: attributes, in the order of their colours.
    """
    totals = {name: sum(field["bits"] for field in fields if field["attribute"] == name) for name in names}
    largest = sorted(filter(totals.get, totals), key=totals.__getitem__, reverse=True)
    wide, lines = max(field["x2"] for field in fields), distinct(fields, "target")
    return Chart(
        name=f"layout-{row['contract_bytes']:g}",
        title=f"{row['contract_bytes']:g} bytes: {', '.join(f'{name} {totals[name]} bits' for name in largest)}",
        subtitle="Bits of each render target, the most significant first",
        description="A bar for each render target, divided by attribute, with the number of bits. The encodings are in "
        "the table.",
        x=Axis(title="bit", domain=(0.0, float(wide)), ticks=tuple((float(t), str(t)) for t in BIT_TICKS if t <= wide)),
        y=Axis(title="", scale=Scale.NAMES, names=lines),
        rows=tuple(fields),
        colour=Names("attribute", names),
        height=TARGET_HEIGHT * len(lines),
        marks=(
            Mark(kind=Kind.BARS, x="x", x2="x2", y="target", colour="attribute", tips=TIPS),
            Mark(kind=Kind.TEXTS, y="target", text="bits", colour=PAPER),
        ),
    )


def plotted(rows: Sequence[Row]) -> Iterator[Chart]:
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
