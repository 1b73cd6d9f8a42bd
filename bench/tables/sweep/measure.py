"""Measurement of one point of the sweep: milliseconds and triangles of each pass."""

from __future__ import annotations

from dataclasses import dataclass

from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.pipelines import Pipeline
from ....gbuffer.render import rendering
from ....gbuffer.scenes.catalogue import SCENES
from ....gbuffer.scenes.setting import Setting
from ..shots import STAGES, described, time_columns
from ..table import Row
from .table import TABLE


@dataclass(frozen=True)
class Point:
    """A row of the sweep to measure: a pipeline with a number of objects."""

    pipeline: Pipeline
    plan: Plan
    setting: Setting
    repeats: int
    asked: int

    @property
    def name(self) -> str:
        shadow = "with" if self.plan.shadows else "without"
        return f"{self.pipeline.name}, {self.setting.objects} objects, {shadow} shadow map"

    def key(self, device: Device) -> Row:
        """Return the columns that identify a row: the pipeline, its settings and the device."""
        return described(self.pipeline, self.plan, self.setting, self.asked) | {
            "holds": self.plan.layout.summary if self.pipeline.has_gbuffer else None,
            "scene": "objects",
            "repeats": self.repeats,
            "device": device.renderer,
        }


def measure(device: Device, point: Point) -> Row:
    """Return the row of a point: milliseconds and triangles of each pass."""
    row = TABLE.empty(STAGES) | point.key(device)
    scene = SCENES["objects"].make(point.setting)
    with rendering(device, point.pipeline, scene, point.plan) as rendered:
        timings, clock = rendered.timings(point.repeats)
        triangles = rendered.triangles()
    row |= time_columns(timings, clock) | {f"ms_{name}_spread": timing.spread for name, timing in timings.items()}
    row["ms_frame_each"] = " ".join(f"{sample:.4f}" for sample in timings["frame"].samples)
    row |= {f"triangles_{name}": count for name, count in triangles.items()}
    return row | {"triangles": sum(triangles.values())}
