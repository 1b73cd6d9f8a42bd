"""Measurement and display of the sweep."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ...ground.output.writing import without
from ..shots import checked_device
from ..table import Measured, Row, Sheet, Step, Tick, Work
from . import measure
from .charts import charts
from .points import points
from .table import TABLE, SweepOptions, SweepOutputs


def _steps(options: SweepOptions, _: SweepOutputs) -> list[Step]:
    device = checked_device(options.repeats, 1)
    all_points = points(options, device)
    return [Step(point.key(device), (device, point), point.name) for point in all_points]


def _measure(steps: Sequence[Step], tick: Tick) -> Iterator[list[Row]]:
    for step in steps:
        tick(step.name)
        yield [measure.measure(*step.case)]


def _shown(done: Measured) -> Iterator[Sheet]:
    """Yield a sheet of rows with only the whole frame's spread, without triangle counts of full-screen passes."""
    rows = TABLE.without_hidden(done.rows)
    hidden = {c for c in rows[0] if c.endswith("_spread") and c != "ms_frame_spread"}
    rows = without(rows, hidden | {"triangles_linear_depth", "triangles_screen"})
    yield Sheet("", rows, TABLE.drops(rows))


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    timed = sorted((row for row in rows if row["ms_frame"] is not None), key=lambda row: row["ms_frame"])
    if timed:
        figures = [f"{row['pipeline']}, {row['ms_frame']:.3g} ms" for row in (timed[0], timed[-1])]
        yield f"Fastest frame: {figures[0]}; slowest: {figures[1]}, by {timed[0]['clock']}."


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    names = ("pipeline", "layout", "objects", "shadow", "ms_frame", "ms_frame_spread", "triangles")
    shown = [{name: row[name] for name in names} for row in rows]
    yield Sheet(f"a frame of {rows[0]['objects']} objects, milliseconds by {rows[0]['clock']}", shown, ("layout",))


WORK = Work(steps=_steps, measure=_measure, shown=_shown, verdict=_verdict, summary=_summary, charts=charts)
