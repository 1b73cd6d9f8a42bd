"""The points of a sweep: each pipeline with each number of objects."""

from __future__ import annotations

from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.pipelines import PIPELINES
from ...ground.choose import choose
from ...ground.options.counts import MAX_OBJECTS, checked_numbers
from ...ground.options.targets import (
    SHADOWS,
    TARGETS,
    check_scale,
    checked_setting,
    checked_target,
    what_is_left,
)
from ...subjects.codecs.kinds.named import light_codecs_named
from ...subjects.codecs.layout_names import layouts_named
from ..plans import suited
from .measure import Point
from .table import SweepOptions

SIZE, SOFTWARE_SIZE = "640x480", "320x240"


def points(options: SweepOptions, device: Device) -> list[Point]:
    """Return a point for each row; plans that do not suit a pipeline are named on standard error.

    Raises:
        UsageError: unknown names, sizes or counts out of range, or nothing left to measure.
    """
    auto = SOFTWARE_SIZE if device.is_software else SIZE
    size, samples = checked_target(auto if options.size == "auto" else options.size, options.samples, 1, device)
    check_scale(options.scale)
    pipelines = choose("pipeline", options.pipeline, PIPELINES)
    # Read once: a layout's own encoder is looked at, which takes seconds.
    asked = None if options.layout is None else layouts_named(options.layout)
    all_points: list[Point] = []
    complaints: list[str] = []
    for shadows in choose("shadow", options.shadow, SHADOWS):
        for count in checked_numbers("--objects", options.objects, int, 1, MAX_OBJECTS):
            setting = checked_setting(count, options.lights, options.seed)
            for pipeline in pipelines:
                plans = [
                    Plan(size, samples, layout, light, targets, shadows, options.scale)
                    for layout in asked or layouts_named((pipeline.usual_layout,))
                    for light in light_codecs_named(options.light_buffer)
                    for targets in choose("number of light targets", options.light_targets, TARGETS)
                ]
                for plan in suited(device, pipeline, plans, complaints):
                    all_points.append(Point(pipeline, plan, setting, options.repeats, options.samples))
    return what_is_left(all_points, complaints)
