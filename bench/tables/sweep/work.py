"""How the sweep is measured and shown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ....reports.charts import charts, plots, specs
from ....reports.charts.drawings import Drawing
from ...ground.machine.devices import require_device, require_jax
from ...ground.output.writing import check_plot, save_plot, without
from ..charts import drawing, having
from ..table import Measured, Row, Sheet, Step, Tick, Work
from . import measure
from .points import points
from .table import TABLE, SweepOptions, SweepOutputs


def _steps(options: SweepOptions, outputs: SweepOutputs) -> list[Step]:
    require_jax()
    device = require_device()
    made = points(options, device)
    check_plot(outputs.plot)
    return [Step(point.key(device), (device, point), point.name) for point in made]


def _measure(steps: Sequence[Step], tick: Tick) -> Iterator[list[Row]]:
    for step in steps:
        tick(step.name)
        yield [measure.measure(*step.case)]


def _shown(done: Measured) -> Iterator[Sheet]:
    """Of the spreads only the whole frame's; no triangles of passes that draw the screen."""
    rows = TABLE.without_hidden(done.rows)
    hidden = {c for c in rows[0] if c.endswith("_spread") and c != "ms_frame_spread"}
    rows = without(rows, hidden | {"triangles_linear_depth", "triangles_screen"})
    yield Sheet("", rows, TABLE.drops(rows))


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    names = ("pipeline", "layout", "objects", "shadow", "ms_frame", "ms_frame_spread", "triangles")
    shown = [{name: row[name] for name in names} for row in rows]
    yield Sheet(f"a frame of {rows[0]['objects']} objects, milliseconds by {rows[0]['clock']}", shown, ("layout",))


def _write(done: Measured, _: Tick) -> None:
    if done.outputs.plot:
        save_plot(done.outputs.plot, plots.sweep_figure(done.rows))


def _drawings(_: Any, rows: Sequence[Row]) -> Iterator[Drawing]:
    usable = [row for row in having(rows, charts.FRAME) if charts.passes_of(row)]
    for at, objects in enumerate(dict.fromkeys(row.get("objects") for row in usable)):
        part = [row for row in usable if row.get("objects") == objects]
        said = "A bar for each pipeline, divided by pass: milliseconds a frame, medians. The figures are in the table."
        title = f"What the milliseconds of a frame of {objects} objects go into"
        yield drawing(f"passes-{at}", title, said, part, charts.passes_chart, specs.passes_specs)


WORK = Work(steps=_steps, measure=_measure, shown=_shown, summary=_summary, write=_write, drawings=_drawings)
