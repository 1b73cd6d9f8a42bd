"""The sweep: how each pipeline's passes grow with the number of objects (seed 004's comparison)."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ....gbuffer.frame.frame import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.pipelines import Pipeline
from ....gbuffer.render import rendering
from ....gbuffer.scenes.catalogue import SCENES
from ....gbuffer.scenes.setting import Setting
from ...output.errors import UsageError
from ...output.journal import Journal, journal
from ...output.writing import is_special
from ..render.measure import STAGES, Row, described

KEY = (
    *("pipeline", "layout", "holds", "light_buffer", "light_targets", "scale", "scene", "objects", "lights", "shadow"),
    *("size", "samples", "samples_asked", "repeats", "seed", "device"),
)
COLUMNS = (
    *KEY,
    *("ms_frame", "ms_frame_spread", "ms_frame_each"),
    *(f"ms_{stage}" for stage in STAGES),
    *(f"ms_{stage}_spread" for stage in STAGES),
    *("triangles", *(f"triangles_{stage}" for stage in STAGES)),
    "clock",
)


@dataclass(frozen=True)
class Point:
    """One row to measure: a pipeline over so many objects."""

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
        """Everything that determines the row."""
        return described(self.pipeline, self.plan, self.setting, self.asked) | {
            "holds": self.plan.layout.summary if self.pipeline.has_gbuffer else None,
            "scene": "objects",
            "repeats": self.repeats,
            "device": device.renderer,
        }


def measure(device: Device, point: Point) -> Row:
    """One row: milliseconds and triangles of each pass."""
    row = dict.fromkeys(COLUMNS) | point.key(device)
    scene = SCENES["objects"].make(point.setting)
    with rendering(device, point.pipeline, scene, point.plan) as made:
        timings, clock = made.timings(point.repeats)
        triangles = made.triangles()
    for name, timing in timings.items():
        row |= {f"ms_{name}": timing.median, f"ms_{name}_spread": timing.spread}
    row["ms_frame_each"] = " ".join(f"{sample:.4f}" for sample in timings["frame"].samples)
    row |= {f"triangles_{name}": count for name, count in triangles.items()}
    return row | {"triangles": sum(triangles.values()), "clock": clock}


@contextmanager
def journal_beside(output: Path | None) -> Iterator[Journal | None]:
    """The rows that are finished, beside an output file, gone once the block ends well; None where there is no file to
    keep them beside.

    Raises:
        UsageError: another sweep writes the same output, or it cannot be written.
    """
    if output is None or is_special(output):
        yield None
        return
    output = output.resolve()
    with journal(output.with_name(f".{output.name}.rows")) as kept:
        yield kept
        kept.path.unlink(missing_ok=True)


def _find(kept: Journal, key: Row) -> Row | None:
    """The row of a key, if it has been measured."""
    rows = (line for line in kept.lines if set(line) == set(COLUMNS))
    return next((row for row in rows if all(row[name] == value for name, value in key.items())), None)


def resumed(kept: Journal | None, points: list[Point], device: Device) -> dict[Point, Row]:
    """The rows that need not be measured again.

    Raises:
        UsageError: rows of another sweep are kept for this output.
    """
    found = {point: _find(kept, point.key(device)) for point in points} if kept else {}
    done = {point: row for point, row in found.items() if row}
    if kept and len(done) < len(kept.lines):
        raise UsageError(
            f"{kept.path} keeps {len(kept.lines)} rows of another sweep; run that one, delete it, or name another file"
        )
    if done:
        print(f"normalbench: {len(done)} of {len(points)} rows were measured before", file=sys.stderr)
    return done
