"""What `sweep` does."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

from ....gbuffer.frame.frame import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.pipelines import PIPELINES
from ....reports.charts import plots
from ...options.command_options import SweepOptions
from ...options.counts import MAX_REPEATS, checked_numbers, in_range
from ...options.light_names import light_buffers_named
from ...output.errors import pick
from ...output.journal import Journal
from ...output.progress import progress
from ...output.writing import check_writable, whole_file, without, write
from ..quality.measure import require_device, require_jax
from ..render.command import (
    MAX_OBJECTS,
    SHADOWS,
    TARGETS,
    check_scale,
    checked_setting,
    checked_target,
    layouts_named,
    suited,
    what_is_left,
)
from ..render.measure import Row
from . import measure as sweep

# What a narrow terminal goes without, the first first.
EXPENDABLE = (
    *("device", "clock", "holds", "light_targets", "light_buffer", "layout", "seed", "repeats", "ms_transparent"),
    *("ms_linear_depth", "ms_screen", "triangles_shadow_map", "triangles_lights", "ms_shadow_map", "ms_ambient"),
)


@dataclass(frozen=True, kw_only=True)
class SweepRequest(SweepOptions):
    """What to sweep over, as typed: names and counts are comma-separated."""

    def points(self, device: Device) -> list[sweep.Point]:
        """One point for each row; what does not suit a pipeline is named on standard error.

        Raises:
            UsageError: unknown names, sizes and counts beyond what is possible, or nothing left.
        """
        size, samples = checked_target(self.size, self.samples, 1, device)
        check_scale(self.scale)
        in_range("--repeats", self.repeats, 1, MAX_REPEATS)
        points: list[sweep.Point] = []
        complaints: list[str] = []
        for shadows in pick("shadow", self.shadow, SHADOWS):
            for count in checked_numbers("--objects", self.objects, int, 1, MAX_OBJECTS):
                setting = checked_setting(count, self.lights, self.seed)
                for pipeline in pick("pipeline", self.pipeline, PIPELINES):
                    plans = [
                        Plan(size, samples, layout, light, targets, shadows, self.scale)
                        for layout in layouts_named(pipeline.usual_layout if self.layout is None else self.layout)
                        for light in light_buffers_named(self.light_buffer)
                        for targets in pick("number of light targets", self.light_targets, TARGETS)
                    ]
                    for plan in suited(device, pipeline, plans, complaints):
                        points.append(sweep.Point(pipeline, plan, setting, self.repeats, self.samples))
        return what_is_left(points, complaints)


def sweep_command(request: SweepRequest, plot: Path | None, format: str, output: Path | None) -> None:
    """Measure each point that has not been measured before, then write the rows, and the plot if asked for."""
    require_jax()
    device = require_device()
    points = request.points(device)
    for path in filter(None, (plot, output)):
        check_writable(path)
    if plot:
        plots.check_format(plot)
    with sweep.journal_beside(output) as kept:
        try:
            rows = _measured(device, points, kept)
        except (KeyboardInterrupt, SystemExit):
            _say_how_to_go_on(kept, len(points))
            raise
        if plot:
            with whole_file(plot) as partial:
                plots.save(plots.sweep_figure(rows), (partial, plot.suffix[1:]))
        write(_shown(rows) if format == "table" else rows, format, output, EXPENDABLE)


def _measured(device: Device, points: list[sweep.Point], kept: Journal | None) -> list[Row]:
    done = sweep.resumed(kept, points, device)
    with progress(len(points)) as tick:
        for point in points:
            tick(point.name)
            if point not in done:
                done[point] = sweep.measure(device, point)
                if kept:
                    kept.add(done[point])
    return [done[point] for point in points]


def _say_how_to_go_on(kept: Journal | None, total: int) -> None:
    if kept:
        print(f"normalbench: {len(kept.lines)} of {total} rows are kept; the same command goes on", file=sys.stderr)
    else:
        print("normalbench: nothing is kept; with -o FILE a stopped sweep goes on", file=sys.stderr)


def _shown(rows: list[Row]) -> list[Row]:
    """The rows for a terminal: of the spreads only the whole frame's, no triangles of passes that draw the screen."""
    hidden = {c for c in rows[0] if c.endswith("_spread") and c != "ms_frame_spread"}
    hidden |= {"triangles_linear_depth", "triangles_screen", "ms_frame_each"}
    return without(rows, hidden)
