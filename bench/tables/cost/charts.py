"""The chart of cost against error."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ....reports.charts.chart import INK, Axis, Chart, Kind, Mark, Names, Scale, Switch
from ....reports.charts.pareto import Panel, Point, pareto_front
from ..table import Row

GREY = "grey: another codec costs no more, is no less accurate and takes no more bits"
BRANCHES = "* counts both sides of a branch"
UNIT = "instructions, including packing"
HEIGHT = 420


def front_chart(name: str, label: str, panels: Sequence[Panel]) -> Chart:
    """Return a chart of cost against error. Dominated points are grey; a stepped line joins the other points of the
    same bit count.

    Panels of the same kind for several machines are shown as one panel, with a switch between the machines.

    Args:
        label: the quantity that the decibels measure.
        panels: panels with at least one point each.
    """
    rows = [row for panel in panels for row in _rows(panel)]
    best = tuple(row for row in rows if not row["rest"])
    kinds = tuple(dict.fromkeys(panel.kind for panel in panels))
    is_starred = any(point.is_starred for panel in panels for point in panel.points)
    looks: dict[str, Any] = {"colour": "bits", "shape": "bits"}
    tips = (("codec", "codec"), ("bits", "bits"), ("x", "cost"), ("y", "error"), ("machine", "GPU"))
    bits = Names("bits", tuple(sorted({row["bits"] for row in rows})), "bits", is_ordered=True)
    return Chart(
        name=name,
        title=_finding_sentence(panels),
        subtitle="; ".join([f"Instructions against {label}", GREY, *([BRANCHES] if is_starred else [])]),
        description="Each codec by the cost of encoding or decoding it, including packing, and by its error; grey "
        "if another codec costs no more, is no less accurate and takes no more bits. The figures are "
        "in the tables.",
        x=Axis(title=UNIT, scale=Scale.COUNT, is_shared=False),
        y=Axis(title=f"{label} (dB)", scale=Scale.LINEAR, is_shared=False),
        rows=tuple(rows),
        colour=bits,
        shape=bits,
        panels=Names("panel", kinds),
        switch=_switch(panels),
        height=HEIGHT,
        marks=(
            Mark(kind=Kind.LINES, rows=best, by=("bits", "panel", "machine"), colour="bits", is_stepped=True),
            Mark(kind=Kind.POINTS, **looks, rest="rest", tips=tips),
            Mark(kind=Kind.LABELS, text="name", colour=INK, rest="rest"),
        ),
    )


def _rows(panel: Panel) -> list[Row]:
    """Return a row for each point of a panel: first the Pareto front by cost, then the others, with `rest` set."""
    front = pareto_front(panel.points)
    points = [*front, *(point for point in panel.points if point not in front)]
    return [_point_row(panel, point) | {"rest": point not in front} for point in points]


def _point_row(panel: Panel, point: Point) -> Row:
    about = {"codec": point.codec, "name": point.name + "*" * point.is_starred, "bits": point.bits}
    return about | {"panel": panel.kind, "machine": panel.machine, "x": point.cost, "y": point.psnr}


def _switch(panels: Sequence[Panel]) -> Switch | None:
    """Return a switch between the machines that the panels show; None if there are fewer than two machines."""
    machines = tuple(dict.fromkeys(panel.machine for panel in panels))
    if len(machines) < 2:
        return None
    return Switch("machine", "GPU", machines, next(panel.machine for panel in panels if panel.is_usual))


def _finding_sentence(panels: Sequence[Panel]) -> str:
    """Return a sentence on how many codecs in each panel are Pareto-optimal, on the machine that is shown first."""
    parts = []
    for panel in (panel for panel in panels if panel.is_usual):
        front = pareto_front(panel.points)
        parts.append(f"{len(front)} of {len(panel.points)} codecs to {panel.kind}")
    machine = next((panel.machine for panel in panels if panel.is_usual and panel.machine), "")
    return f"Pareto-optimal: {', '.join(parts)}{f', on {machine}' if machine else ''}"
