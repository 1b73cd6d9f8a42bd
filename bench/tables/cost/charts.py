"""The chart of what codecs cost against what they lose."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ....reports.charts.chart import INK, Axis, Chart, Kind, Mark, Names, Scale, Switch
from ....reports.charts.pareto import Error, Panel, Point, pareto_front
from ..table import Row

GREY = "grey: another is no dearer, no worse and takes no more bits"
BRANCHES = "* counts both sides of a branch"
HEIGHT = 420


def front_chart(name: str, subtitle: str, panels: Sequence[Panel], error: Error) -> Chart:
    """Cost against error. What another beats is grey; the others are joined by steps, those of as many bits.

    Panels of one kind and several machines are one panel, with a switch between the machines.

    Args:
        panels: each with a point at least, all of one unit.
    """
    rows = [row for panel in panels for row in _rows(panel, error)]
    best = tuple(row for row in rows if not row["rest"])
    kinds = tuple(dict.fromkeys(map(_kind_name, panels)))
    is_starred = any(point.is_starred for panel in panels for point in panel.points)
    looks: dict[str, Any] = {"colour": "bits", "shape": "bits"}
    tips = (("codec", "codec"), ("bits", "bits"), ("x", "cost"), ("y", "error"), ("machine", "GPU"))
    bits = Names("bits", tuple(sorted({row["bits"] for row in rows})), "bits", is_ordered=True)
    return Chart(
        name=name,
        title=_finding_sentence(panels, error),
        subtitle="; ".join([subtitle, GREY, *([BRANCHES] if is_starred else [])]),
        description="Each codec by the cost of encoding or decoding it and its storage, and by its error; grey where "
        "another is no dearer, no worse and takes no more bits. The figures are in the tables.",
        x=Axis(title=panels[0].unit, scale=_scale(panels[0]), is_shared=False),
        y=Axis(title=error.label, scale=Scale.LINEAR if error.more_is_better else Scale.LOG, is_shared=False),
        rows=tuple(rows),
        colour=bits,
        shape=bits,
        panels=Names("panel", kinds),
        switch=_switch(panels),
        height=HEIGHT,
        marks=(
            Mark(kind=Kind.RULES, rows=_spreads(rows), x="low", x2="high", colour="bits", rest="rest"),
            Mark(kind=Kind.LINES, rows=best, by=("bits", "panel", "machine"), colour="bits", is_stepped=True),
            Mark(kind=Kind.POINTS, **looks, rest="rest", tips=tips),
            Mark(kind=Kind.LABELS, text="name", colour=INK, rest="rest"),
        ),
    )


def _kind_name(panel: Panel) -> str:
    return panel.kind or panel.title


def _scale(panel: Panel) -> Scale:
    return Scale.COUNT if panel.is_counted else Scale.LINEAR


def _rows(panel: Panel, error: Error) -> list[Row]:
    """A row for each point, those that no other beats first, by their cost."""
    front = pareto_front(panel.points, error)
    points = [*front, *(point for point in panel.points if point not in front)]
    return [_point_row(panel, point) | {"rest": point not in front} for point in points]


def _point_row(panel: Panel, point: Point) -> Row:
    about = {"codec": point.codec, "name": point.name + "*" * point.is_starred, "bits": point.bits}
    about |= {"panel": _kind_name(panel), "machine": panel.machine, "x": point.cost, "y": point.error}
    half = point.spread / 2
    return about | ({"low": point.cost - half, "high": point.cost + half} if half else {})


def _spreads(rows: Sequence[Row]) -> tuple[Row, ...]:
    """How surely the costs are known, where that is not exactly."""
    return tuple(row for row in rows if "low" in row)


def _switch(panels: Sequence[Panel]) -> Switch | None:
    """A switch between machines, where there are several."""
    machines = tuple(dict.fromkeys(panel.machine for panel in panels))
    if len(machines) < 2:
        return None
    return Switch("machine", "GPU", machines, next(panel.machine for panel in panels if panel.is_usual))


def _finding_sentence(panels: Sequence[Panel], error: Error) -> str:
    """How many codecs of each panel are beaten by no other, on the machine that is shown first."""
    said = []
    for panel in (panel for panel in panels if panel.is_usual):
        front, operation = pareto_front(panel.points, error), _kind_name(panel).partition(",")[0]
        said.append(f"{len(front)} of {len(panel.points)} codecs to {operation}")
    machine = next((panel.machine for panel in panels if panel.is_usual and panel.machine), "")
    return f"No other beats {', '.join(said)}{f', on {machine}' if machine else ''}"
