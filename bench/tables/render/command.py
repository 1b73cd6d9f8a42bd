"""What `render` does."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from ....encodings.catalogue import LIGHT_BUFFERS
from ....gbuffer.frame.frame import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.layout import Layout, LayoutError, read_layout
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES, Pipeline
from ....gbuffer.render import check
from ....gbuffer.scenes.setting import Setting
from ....reports.charts import pictures
from ...metrics.images import require_flip
from ...options.counts import MAX_REPEATS, check_seed, checked_sides, in_range
from ...options.light_names import light_buffers_named
from ...options.option import RenderOptions
from ...options.scene_names import scenes_named
from ...output.errors import UsageError, pick
from ...output.progress import progress
from ...output.writing import check_folder, check_writable, say_skipped, whole_file, without, write
from ..quality.measure import check_twin, codecs_named, require_device, require_jax
from .measure import Bench, Case, Drawn, Row, ranked

# Every pixel of a frame takes up to a few hundred bytes: one frame of 8K at one sample is the most.
MAX_SAMPLES = 2**25
MAX_OBJECTS, MAX_LIGHTS, MAX_FRAMES = 100_000, 10_000, 1000
TARGETS = {"1": 1, "2": 2}
SHADOWS = {"on": True, "off": False}
# What a narrow terminal goes without, the first first.
EXPENDABLE = (
    *("device", "clock", "exact", "rounding", "ms_transparent", "ms_linear_depth", "ms_screen", "mse", "normal_bits"),
    *("ms_shadow_map", "ms_material", "ms_geometry", "ms_lights", "ms_ambient", "ms_forward", "ms_frame_spread"),
)

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class RenderRequest(RenderOptions):
    """What to render, as typed: names are comma-separated."""

    def layouts(self) -> list[Layout]:
        """The layouts asked for, each with every codec asked for in it; without codecs as they are.

        Raises:
            UsageError: an unknown name, a layout that cannot be, or nothing left.
        """
        chosen = layouts_named("fp32" if self.layout is None else self.layout)
        if self.layout is not None and self.encoding is self.storage is self.rounding is None:
            return chosen
        # Half a codec is completed by what is usual.
        codecs = codecs_named(
            "all" if self.encoding is None else self.encoding,
            "rgba8" if self.storage is None else self.storage,
            "nearest" if self.rounding is None else self.rounding,
        )
        for encoding in {codec.encoding for codec in codecs}:
            check_twin(encoding)
        made: list[Layout] = []
        complaints: list[str] = []
        for layout in chosen:
            for codec in codecs:
                if not codec.fits:
                    complaints.append(f"{codec.name}: {codec.misfit}")
                    continue
                _attempt(lambda layout=layout, codec=codec: layout.with_codec(codec), made, complaints)
        return what_is_left(made, complaints)

    def cases(self, device: Device) -> list[Case]:
        """One case for each row; combinations that cannot be are named on standard error.

        Raises:
            UsageError: unknown names, sizes and counts beyond what is possible, or nothing left.
        """
        in_range("--frames", self.frames, 0, MAX_FRAMES)
        size, samples = checked_target(self.size, self.samples, max(self.frames, 1), device)
        setting = checked_setting(self.objects, self.lights, self.seed)
        in_range("--repeats", self.repeats, 1, MAX_REPEATS)
        check_scale(self.scale)
        plans = [
            Plan(size, samples, layout, light, targets, shadows, self.scale)
            for layout in self.layouts()
            for light in light_buffers_named(self.light_buffer)
            for targets in pick("number of light targets", self.light_targets, TARGETS)
            for shadows in pick("shadow", self.shadow, SHADOWS)
        ]
        cases: list[Case] = []
        complaints: list[str] = []
        for maker in scenes_named(self.scene):
            for pipeline in pick("pipeline", self.pipeline, PIPELINES):
                for plan in suited(device, pipeline, plans, complaints):
                    cases.append(Case(pipeline, plan, maker, setting, self.frames or maker.frames, self.samples))
        return what_is_left(cases, complaints)


def suited(device: Device, pipeline: Pipeline, plans: list[Plan], complaints: list[str]) -> list[Plan]:
    """The plans that make a difference to a pipeline and suit it; why others do not is appended to `complaints`."""
    made: dict[Plan, None] = {}
    for plan in plans:
        own = replace(plan, scale=plan.scale if pipeline.scaled else 1.0)
        if not pipeline.has_gbuffer:
            # Neither layouts nor light buffers reach it: one row for all of them.
            own = replace(own, layout=LAYOUTS["fp32"], light_buffer=LIGHT_BUFFERS["rgba32f"], light_targets=1)
        elif len(pipeline.light_targets) == 1:
            own = replace(own, light_targets=pipeline.light_targets[0])
        try:
            check(device, pipeline, own)
        except LayoutError as error:
            complaints.append(str(error))
        else:
            made[own] = None
    return list(made)


def layouts_named(names: str) -> list[Layout]:
    """The layouts that comma-separated names stand for: presets, or TOML files.

    Raises:
        UsageError: an unknown name, or a file that is no layout.
    """
    words = dict.fromkeys(name.strip() for name in names.split(","))
    known = {**LAYOUTS, **{name: _read(Path(name)) for name in words if name.endswith(".toml")}}
    chosen = pick("layout", names, known) if "all" not in words else list(known.values())
    called = [layout.name for layout in chosen]
    for name in called:
        if called.count(name) > 1:
            raise UsageError(f"two layouts are called {name}, which is a file's name without .toml; rename one")
    return chosen


def _read(path: Path) -> Layout:
    try:
        return read_layout(path)
    except LayoutError as error:
        raise UsageError(str(error)) from error


def _attempt(make: Callable[[], T], made: list[T], complaints: list[str]) -> None:
    try:
        made.append(make())
    except LayoutError as error:
        complaints.append(str(error))


def what_is_left(made: list[T], complaints: list[str]) -> list[T]:
    """What could be made, the rest named on standard error. Raises UsageError where nothing is left."""
    reasons = list(dict.fromkeys(complaints))
    if not made:
        raise UsageError(reasons[0] if reasons else "nothing to render")
    for reason in reasons:
        print(f"normalbench: left out: {reason}", file=sys.stderr)
    return made


def check_scale(scale: float) -> None:
    """Raises UsageError for what is no share of a size."""
    if not 0.05 <= scale <= 1:
        raise UsageError(f"--scale {scale}: a scale is 0.05 to 1")


def checked_setting(objects: int, lights: int, seed: int) -> Setting:
    """The scenes' setting. Raises UsageError for counts that no scene has."""
    in_range("--objects", objects, 1, MAX_OBJECTS)
    in_range("--lights", lights, 0, MAX_LIGHTS)
    check_seed(seed)
    return Setting(objects, lights, seed)


def checked_target(size: str, samples: int, frames: int, device: Device) -> tuple[tuple[int, int], int]:
    """The size, and the samples a pixel that the device gives. Raises UsageError for what is beyond it."""
    in_range("--samples", samples, 1, 64)
    sides, given = checked_sides(size, device.max_size, f"on {device.renderer}"), device.given_samples(samples)
    _check_budget(sides, given * frames)
    return sides, given


def _check_budget(size: tuple[int, int], samples: int) -> None:
    """Raises UsageError where frames of this size, with all their samples, are too large to be held."""
    if math.prod(size) * samples > MAX_SAMPLES:
        raise UsageError(
            f"--size {size[0]}x{size[1]}: with samples and frames {math.prod(size) * samples} in all; "
            f"the most is {MAX_SAMPLES} (2^25)"
        )


def render_command(request: RenderRequest, images: Path | None, format: str, output: Path | None) -> None:
    """Render, measure, write the pictures if asked for, then the rows."""
    require_jax()
    device = require_device()
    if request.flip:
        require_flip()
    cases = request.cases(device)
    if images:
        check_folder(images)
    if output:
        check_writable(output)
    bench, rows = Bench(device, request.repeats, request.flip), []
    with progress(len(cases)) as tick:
        for case in cases:
            row, drawn = bench.measure(case)
            rows.append(row)
            if images and drawn:
                _write_pictures(images, case, drawn, bench.reference(case)[0])
            tick(case.name)
    _say_what_went_wrong(rows)
    rows = ranked(rows)
    if format == "table":
        hidden = ("exact", "skipped", "invalid", "samples_asked" if request.samples == cases[0].plan.samples else "")
        rows = without(rows, hidden)
    write(rows, format, output, EXPENDABLE)


def _say_what_went_wrong(rows: list[Row]) -> None:
    say_skipped(rows)
    for row in rows:
        if row["invalid"]:
            what = " ".join(filter(None, (row["pipeline"], row["layout"], row["encoding"], row["storage"])))
            print(f"normalbench: {what} on {row['scene']}: {row['invalid']} pixels are no number", file=sys.stderr)


def _write_pictures(folder: Path, case: Case, drawn: Drawn, reference: Drawn) -> None:
    """The first frame, its reference and 16 times their difference."""
    plan = case.plan
    words = [case.maker.name, case.pipeline.name]
    if case.pipeline.has_gbuffer:
        words += [plan.layout.name, plan.layout.codec.name.replace("/", "-")]
        words += [f"{plan.light_buffer.name}x{plan.light_targets}"]
    words += [] if plan.shadows else ["unshadowed"]
    for kind, pixels in pictures.render_pictures(drawn.shown, reference.shown).items():
        with whole_file(folder / f"{'-'.join([*words, kind])}.png") as partial:
            pictures.write_png(partial, pixels)
