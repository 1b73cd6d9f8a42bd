"""The sweep: how each pipeline's passes grow with the number of objects (seed 004's comparison)."""

from __future__ import annotations

import fcntl
import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from ..gbuffer.device import Device
from ..gbuffer.frame import Plan
from ..gbuffer.pipelines import Pipeline
from ..gbuffer.render import rendering
from ..gbuffer.scenes.catalogue import SCENES
from ..gbuffer.scenes.setting import Setting
from .errors import UsageError
from .output import is_special
from .rendering import STAGES, Row

KEY = (
    *("pipeline", "layout", "holds", "light_buffer", "light_targets", "scale", "scene", "objects", "lights", "shadow"),
    *("size", "samples", "samples_asked", "repeats", "seed", "device"),
)
COLUMNS = (
    *KEY,
    *("ms_frame", "ms_frame_spread"),
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
        plan, kept = self.plan, self.pipeline.has_gbuffer
        return {
            "pipeline": self.pipeline.name,
            "layout": plan.layout.name if kept else None,
            "holds": plan.layout.summary if kept else None,
            "light_buffer": plan.light_buffer.name if kept else None,
            "light_targets": plan.light_targets if kept else None,
            "scale": plan.scale if self.pipeline.scaled else None,
            "scene": "objects",
            "objects": self.setting.objects,
            "lights": self.setting.lights,
            "shadow": plan.shadows,
            "size": f"{plan.size[0]}x{plan.size[1]}",
            "samples": plan.samples,
            "samples_asked": self.asked,
            "repeats": self.repeats,
            "seed": self.setting.seed,
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
    row |= {f"triangles_{name}": count for name, count in triangles.items()}
    return row | {"triangles": sum(triangles.values()), "clock": clock}


class Journal:
    """Finished rows, kept line by line beside the output until all are there, so that a stopped sweep goes on."""

    def __init__(self, path: Path, file: IO[bytes]):
        self.path, self._file = path, file
        file.seek(0)
        lines = file.read()
        # A line that was cut off in the middle would swallow the next one.
        file.truncate(lines.rfind(b"\n") + 1)
        self.rows = list(_readable(lines.splitlines()))

    def add(self, row: Row) -> None:
        """Keep a row for good."""
        self._file.write(json.dumps(row).encode() + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())
        self.rows.append(row)

    def find(self, key: Row) -> Row | None:
        """The row of a key, if it has been measured."""
        return next((row for row in self.rows if all(row[name] == value for name, value in key.items())), None)


def _readable(lines: list[bytes]) -> Iterator[Row]:
    for line in lines:
        try:
            row: Any = json.loads(line)
        except ValueError:
            continue
        if isinstance(row, dict) and set(row) == set(COLUMNS):
            yield row


@contextmanager
def journal(output: Path | None) -> Iterator[Journal | None]:
    """The journal beside an output file, gone once the block ends well; None where there is no file to keep it beside.

    Raises:
        UsageError: another sweep writes the same output, or it cannot be written.
    """
    if output is None or is_special(output):
        yield None
        return
    output = output.resolve()
    path = output.with_name(f".{output.name}.rows")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        file = path.open("a+b")
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror or error}") from error
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise UsageError(f"another sweep is writing {output}; wait for it, or name another file") from error
        yield Journal(path, file)
        path.unlink(missing_ok=True)


def resumed(kept: Journal | None, points: list[Point], device: Device) -> dict[Point, Row]:
    """The rows that need not be measured again.

    Raises:
        UsageError: rows of another sweep are kept for this output.
    """
    found = {point: kept.find(point.key(device)) for point in points} if kept else {}
    done = {point: row for point, row in found.items() if row}
    if kept and len(done) < len(kept.rows):
        raise UsageError(
            f"{kept.path} keeps {len(kept.rows)} rows of another sweep; run that one, delete it, or name another file"
        )
    if done:
        print(f"normalbench: {len(done)} of {len(points)} rows were measured before", file=sys.stderr)
    return done
