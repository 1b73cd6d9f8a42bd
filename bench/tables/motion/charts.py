"""The chart of wobble: how much each codec's error changes from frame to frame."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ....reports.charts.chart import DASHES, Axis, Chart, Kind, Mark, Names, Scale, distinct
from ....reports.page.codec_key import CodecKey
from ..table import Row

# What may tell lines of one codec apart.
CONDITIONS = ("space", "moves", "axis")


def wobble_chart(rows: Sequence[Row]) -> Chart:
    """Return the chart of the wobble by turn, with a line for each codec and its conditions, coloured by codec.

    Args:
        rows: rows of the motion table; without rows the chart is empty.
    """
    points = [
        {"codec": CodecKey.of(row).label, "line": _line_name(row, rows), "x": row["turn_deg"], "y": row["wobble_deg"]}
        | {"how": _conditions_text(row, rows), "ratio": row.get("ratio")}
        for row in sorted(rows, key=lambda row: row["turn_deg"])
        if row["wobble_deg"] > 0
    ]
    looks: dict[str, Any] = {"by": ("line",), "colour": "codec"}
    tips = (("line", "code"), ("x", "turn (degrees per frame)"), ("y", "wobble (degrees)"), ("ratio", "ratio"))
    ways = distinct(sorted(points, key=lambda point: point["how"]), "how")
    return Chart(
        name="motion",
        title=_finding_sentence(points),
        subtitle="Wobble by speed of the turn",
        description="RMS change of the error from one frame to the next, by the angle that the camera or the object "
        "turns, with a line for each codec. Codecs with a ratio of 0.01 or less are not drawn. The "
        "figures are in the table below.",
        x=Axis(title="turn (degrees per frame)", scale=Scale.LOG),
        y=Axis(title="wobble (degrees)", scale=Scale.LOG),
        rows=tuple(points),
        colour=Names("codec", distinct(sorted(points, key=lambda point: point["codec"]), "codec")),
        dash=Names("how", ways, looks=DASHES) if len(ways) > 1 else None,
        marks=(
            Mark(kind=Kind.LINES, **looks, dash="how" if len(ways) > 1 else "solid", tips=tips),
            Mark(kind=Kind.POINTS, colour="codec", tips=tips),
            Mark(kind=Kind.ENDS, **looks, text="line"),
        ),
    )


def _line_name(row: Row, rows: Sequence[Row]) -> str:
    return " ".join(filter(None, (CodecKey.of(row).label, _conditions_text(row, rows))))


def _conditions_text(row: Row, rows: Sequence[Row]) -> str:
    """Return a row's values of the conditions in which the rows differ, with spaces between them; empty if they do not
    differ."""
    return " ".join(str(row.get(name)) for name in CONDITIONS if len({other.get(name) for other in rows}) > 1)


def _finding_sentence(points: Sequence[Row]) -> str:
    """Return a sentence that names the codec with the largest wobble; "No codec wobbles" without points."""
    if not points:
        return "No codec wobbles"
    worst = max(points, key=lambda point: point["y"])
    return f"Largest wobble: {worst['line']}, {worst['y']:.2g} degrees at {worst['x']:g} degrees per frame"
