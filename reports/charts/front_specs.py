"""The interactive chart of cost against error; `pareto.py` draws the same as a file."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

from .pareto import LINEAR_TO, TICKS, Error, Panel, Point, pareto_front
from .specs import INK, IS_PICKED, Row, Spec, by_bits, if_lit, rounded, shape_by_bits, spec, switched, tips, titled

HEIGHT = 420
# Pixels from one label's line to the next's.
LINE_HEIGHT = 13
# Labels of points beyond this share of the axis stand to the left of them.
TURNS_AT = 0.55


def pareto_specs(panels: Sequence[Panel], error: Error) -> list[Spec]:
    """Cost against error: what no other codec beats is named and joined by steps.

    Panels of one kind and several machines are one chart, with a switch between the machines.
    """
    kinds = groupby(sorted(panels, key=lambda panel: panel.kind), lambda panel: panel.kind)
    by_kind = {kind: list(some) for kind, some in kinds}
    return [_chart(by_kind[kind], error) for kind in dict.fromkeys(panel.kind for panel in panels)]


def _chart(panels: Sequence[Panel], error: Error) -> Spec:
    scale = _scale([point for panel in panels for point in panel.points], error)
    rows = [row for panel in panels for row in _rows(panel, error, scale)]
    x = {"field": "cost", "type": "quantitative", "title": panels[0].unit, "scale": {"nice": False, "padding": 12}}
    if panels[0].is_counted:
        x["scale"] |= {"type": "symlog", "constant": LINEAR_TO}
        x["axis"] = {"values": [tick for tick in TICKS if tick <= 1.1 * max(row["cost"] for row in rows)]}
    y = {"field": "error", "type": "quantitative", "title": error.label, "scale": scale}
    machines = list(dict.fromkeys(panel.machine for panel in panels))
    parts: dict[str, Any] = {"encoding": {"x": x, "y": y}, "layer": list(_layers(rows, machines)), "height": HEIGHT}
    if len(machines) > 1:
        usual = next(panel.machine for panel in panels if panel.is_usual)
        parts |= switched(machines, usual)
        parts["title"] = titled("") | {"text": {"expr": f"'{panels[0].kind}, ' + machine"}}
    else:
        parts["title"] = titled(panels[0].title)
    name = panels[0].kind if len(machines) > 1 else panels[0].title
    return spec(rows, f"{name}: each codec's {error.label} over {panels[0].unit}.", **parts)


def _scale(points: Sequence[Point], error: Error) -> Row:
    """The axis of errors, with a margin: labels are placed by it."""
    errors = [point.error for point in points]
    if not error.more_is_better:
        return {"type": "log", "domain": [min(errors) / 1.3, max(errors) * 1.3], "nice": False}
    margin = max(max(errors) - min(errors), 1.0) / 12
    return {"domain": [min(errors) - margin, max(errors) + margin], "nice": False, "zero": False}


def _layers(rows: Sequence[Row], machines: Sequence[str]) -> Iterator[Spec]:
    tooltip = tips(codec="codec", bits="bits", cost="cost", error="error")
    tooltip += tips(machine="GPU") if len(machines) > 1 else []
    best = [{"filter": "datum.best"}]
    line = {"type": "line", "interpolate": "step-after", "strokeWidth": 1, "opacity": 0.5}
    yield {"transform": best, "mark": line, "encoding": {"color": by_bits(rows)}}
    colour = {"condition": {"test": "datum.best", **by_bits(rows)}, "value": "var(--faint)"}
    points = {"color": colour, "shape": shape_by_bits(rows), "opacity": if_lit(1, 0.15), "tooltip": tooltip}
    yield {"mark": {"type": "point", "filled": True, "size": 55}, "encoding": points}
    named = {"filter": "datum.best && picked == '' || picked != '' && " + IS_PICKED}
    leader = {"type": "rule", "color": "var(--faint)", "strokeWidth": 0.6}
    yield {"transform": [named], "mark": leader, "encoding": {"y2": {"field": "label"}}}
    for is_right, align, away in ((True, "left", 6), (False, "right", -6)):
        text = {"type": "text", "align": align, "dx": away, "fontSize": 11, "color": INK, "baseline": "middle"}
        at = {"y": {"field": "label", "type": "quantitative"}, "text": {"field": "name"}}
        yield {
            "transform": [named, {"filter": f"datum.right == {str(is_right).lower()}"}],
            "mark": text,
            "encoding": at,
        }


def _rows(panel: Panel, error: Error, scale: Row) -> Iterator[Row]:
    """A row for each point, with where its label stands."""
    front = pareto_front(panel.points, error)
    points = [*front, *(point for point in panel.points if point not in front)]
    places = {
        **label_places(front, error, scale["domain"]),
        **label_places(points[len(front) :], error, scale["domain"]),
    }
    most = max(point.cost for point in points)
    for point in points:
        name = point.name + "*" * point.is_starred
        about = {"codec": point.codec, "name": name, "cost": rounded(point.cost), "error": rounded(point.error)}
        about |= {"bits": point.bits, "best": point in front, "machine": panel.machine}
        is_right = _share(panel, point.cost, most) <= TURNS_AT
        yield about | {"label": rounded(places[point]), "right": is_right}


def _share(panel: Panel, cost: float, most: float) -> float:
    """How far along the axis of costs that is, from 0 to 1."""
    along = (lambda c: math.log1p(max(c, 0.0) / LINEAR_TO)) if panel.is_counted else float
    return along(cost) / max(along(most), 1e-9)


def label_places(points: Sequence[Point], error: Error, domain: Sequence[float]) -> dict[Point, float]:
    """Where on the axis of errors each point's label stands: each on a line of its own, near its point.

    However wide the chart is drawn, no two labels overlap then. Neighbours that are too near are moved apart together
    (pool adjacent violators, the least squares under an order: Barlow et al. 1972, Statistical Inference under Order
    Restrictions).
    """
    low, high = (error.loss(end) for end in domain)
    pixels = HEIGHT / (high - low)
    ordered = sorted(points, key=lambda point: error.loss(point.error) * pixels)
    wanted = [(error.loss(point.error) - low) * pixels for point in ordered]
    placed = _apart(wanted, LINE_HEIGHT)
    return {point: error.of_loss(low + at / pixels) for point, at in zip(ordered, placed, strict=True)}


def _apart(wanted: Sequence[float], least: float) -> list[float]:
    """The places nearest to some, in their order, no two of which are less than `least` apart."""
    groups: list[tuple[float, int]] = []  # the mean of wanted less what stands before, and of how many
    for at, place in enumerate(wanted):
        groups.append((place - at * least, 1))
        while len(groups) > 1 and groups[-2][0] > groups[-1][0]:
            (a, m), (b, n) = groups.pop(-2), groups.pop()
            groups.append(((a * m + b * n) / (m + n), m + n))
    means = [mean for mean, count in groups for _ in range(count)]
    return [mean + at * least for at, mean in enumerate(means)]
