"""What `lights` does."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.codecs.light_codec import LightCodec
from ....gbuffer.codecs.light_passes import Resolved
from ....gbuffer.gl.device import Device
from ....gbuffer.pipelines import PIPELINES, Pipeline
from ....gbuffer.render import displayed
from ....reports.charts import pictures, plots
from ...options.command_options import LightsOptions
from ...options.counts import checked_numbers
from ...options.light_names import MOST_LIGHT, light_buffers_named
from ...options.scene_names import scenes_named
from ...output.errors import MissingError, UsageError, pick
from ...output.progress import progress
from ...output.writing import check_folder, check_writable, whole_file, without, write
from ..quality.measure import found_device, require_jax
from ..render.command import TARGETS, checked_setting, checked_target
from . import measure as lights
from .images import Shot

Row = dict[str, Any]
# Lights in one sum, the largest specular power, and samples.
MOST_LIGHTS, MOST_POWER, MOST_SAMPLES = 4096, 2048.0, 64
# What a narrow terminal goes without, the first first.
EXPENDABLE = ("device", "mse", "size", "gl_stored_error", "exact_step", "aliased_psnr_db", "agree_percent", "seed")


@dataclass(frozen=True, kw_only=True)
class LightsRequest(LightsOptions):
    """What to measure, as typed: names and numbers are comma-separated."""

    def experiments(self) -> list[str]:
        """The experiments asked for. Raises UsageError."""
        return pick("experiment", self.experiment, {name: name for name in lights.EXPERIMENTS})

    def encodings(self) -> list[LightCodec]:
        """The light buffers asked for, checked. Raises UsageError."""
        chosen = light_buffers_named(self.light_buffer)
        for encoding in chosen:
            lights.check_light_twin(encoding)
        return chosen

    def added(self) -> lights.Sums:
        """What is added up. Raises UsageError."""
        checked_setting(self.objects, self.lights, self.seed)
        return lights.Sums(
            checked_numbers("--sum", self.sums, float, 1e-6, MOST_LIGHT),
            checked_numbers("--counts", self.counts, int, 1, MOST_LIGHTS),
            checked_numbers("--peak", self.peaks, float, 1e-6, MOST_LIGHT),
            self.seed,
        )

    def pipelines(self) -> list[Pipeline]:
        """The pipelines asked for. Raises UsageError for one without a light buffer."""
        return pick("pipeline", self.pipeline, {name: p for name, p in PIPELINES.items() if p.has_gbuffer})

    def shots(self, gl: Device) -> list[Shot]:
        """The scenes asked for. Raises UsageError."""
        size, _ = checked_target(self.size, max(self.all_samples()), 1, gl)
        setting = checked_setting(self.objects, self.lights, self.seed)
        return [Shot(maker.name, maker.make(setting), size, self.seed) for maker in scenes_named(self.scene)]

    def all_samples(self) -> tuple[int, ...]:
        """The numbers of samples asked for. Raises UsageError."""
        return checked_numbers("--samples", self.samples, int, 1, MOST_SAMPLES)

    def powers(self) -> tuple[float, ...]:
        """The specular powers asked for. Raises UsageError."""
        return checked_numbers("--power", self.power, float, 1.0, MOST_POWER)

    def targets(self) -> list[int]:
        """The numbers of light targets asked for. Raises UsageError."""
        return pick("number of light targets", self.light_targets, TARGETS)

    def given_samples(self, gl: Device) -> dict[int, list[int]]:
        """The numbers of samples that the device has for those asked for, each with what it stands for."""
        given: dict[int, list[int]] = {}
        for asked in self.all_samples():
            given.setdefault(gl.given_samples(asked), []).append(asked)
        return given


def lights_command(
    request: LightsRequest, images: Path | None, plot: Path | None, format: str, output: Path | None
) -> None:
    """Measure, write pictures and plot if asked for, then the rows: for people a table for each experiment."""
    require_jax()
    gl, missing = found_device()
    measuring = _Measuring(request, gl, missing, images)
    for path in filter(None, (plot, output)):
        check_writable(path)
    if plot:
        plots.check_format(plot)
        if not {"equal", "random"} & set(request.experiments()):
            raise UsageError("--plot draws the experiments equal and random; ask for one of them")
    if images:
        check_folder(images)
        if not {"banding", "resolve", "image"} & set(request.experiments()):
            raise UsageError("--images draws the experiments banding, resolve and image; ask for one of them")
    if missing and not measuring.needs_no_device:
        raise MissingError(missing)
    rows = lights.sorted_rows(list(measuring.rows()))
    if not rows:
        raise UsageError("nothing to measure: one light target and chromaticity need a code with a fourth number")
    _say_reasons(rows)
    if plot:
        with whole_file(plot) as partial:
            plots.save(plots.lights_figure(rows), (partial, plot.suffix[1:]))
    if format == "table":
        rows = without(rows, ("skipped", "invalid"))
    write(rows, format, output, EXPENDABLE, by="experiment")


def _say_reasons(rows: list[Row]) -> None:
    """Why rows lack the device's figures, each reason once, to standard error."""
    for reason in dict.fromkeys(row["skipped"] for row in rows if row["skipped"]):
        print(f"normalbench: rows without the GL device's figures: {' '.join(reason.split())}", file=sys.stderr)


class _Measuring:
    """Everything asked for, checked, and then measured one after the other."""

    def __init__(self, request: LightsRequest, gl: Device | None, missing: str, images: Path | None):
        self._gl, self._missing, self._images = gl, missing, images
        names = request.experiments()
        self._sums = [name for name in lights.SUM_EXPERIMENTS if name in names]
        self._pictured = [name for name in lights.IMAGE_EXPERIMENTS if name in names]
        self._encodings, self._added, self._targets = request.encodings(), request.added(), request.targets()
        self._pipelines, self._powers, asked = request.pipelines(), request.powers(), request.all_samples()
        self._given = request.given_samples(gl) if gl else {samples: [samples] for samples in asked}
        self._shots = request.shots(gl) if gl and self._pictured else []

    @property
    def needs_no_device(self) -> bool:
        """Whether there is something that the model alone has figures of."""
        return bool(self._sums)

    def rows(self) -> Iterator[Row]:
        """Every row, as it is measured."""
        steps = list(self._steps())
        with progress(len(steps)) as tick:
            for name, step in steps:
                yield from step()
                tick(name)
        for experiment in self._pictured if not self._gl else ():
            yield dict.fromkeys(lights.COLUMNS) | {"experiment": experiment, "skipped": self._missing}

    def _steps(self) -> Iterator[tuple[str, Callable[[], Iterator[Row]]]]:
        for encoding in self._encodings if self._sums else ():
            yield encoding.name, partial(self._sum_rows, encoding)
        for shot in self._shots:
            if "resolve" in self._pictured:
                yield f"resolve {shot.name}", partial(self._resolve_rows, shot)
            for pipeline in self._pipelines if "image" in self._pictured else ():
                for power in self._powers:
                    name = f"{shot.name} {pipeline.name} {power:g}"
                    yield (
                        name,
                        lambda shot=shot, pipeline=pipeline, power=power: self._image_rows(pipeline, shot, power),
                    )

    def _sum_rows(self, encoding: LightCodec) -> Iterator[Row]:
        if self._images and "banding" in self._sums:
            self._write("banding", encoding.name, _bands(encoding, self._added.peaks))
        for row in lights.sum_rows(self._sums, encoding, self._added, self._gl):
            yield row if self._gl else row | {"skipped": self._missing}

    def _resolve_rows(self, shot: Shot) -> Iterator[Row]:
        def seen(encoding: LightCodec, samples: int, found: Resolved, aliased: Resolved, right: np.ndarray) -> None:
            words = ("resolve", shot.name, encoding.name, f"{samples}x")
            self._write(*words, "code", pictures.picture(found.by_code))
            self._write(*words, "light", pictures.picture(found.by_light))
            self._write(*words, "difference", pictures.difference(found.by_code, right))
            self._write(*words, "change", pictures.difference(found.by_code, aliased.by_code))

        assert self._gl
        yield from lights.resolve_rows(self._gl, shot, self._encodings, self._given, seen)

    def _image_rows(self, pipeline: Pipeline, shot: Shot, power: float) -> Iterator[Row]:
        def seen(encoding: LightCodec, targets: int, image: np.ndarray, reference: np.ndarray) -> None:
            words = ("image", shot.name, pipeline.name, f"power{power:g}", f"{encoding.name}x{targets}")
            self._write(*words, "final", pictures.picture(image))
            self._write(*words, "difference", pictures.difference(image, reference))

        assert self._gl
        yield from lights.image_rows(self._gl, pipeline, shot, power, self._encodings, self._targets, seen)

    def _write(self, *words: Any) -> None:
        """A picture, named by the words before it; nothing where no pictures were asked for."""
        if self._images:
            *names, pixels = words
            with whole_file(self._images / f"{'-'.join(names)}.png") as partial:
                pictures.write_png(partial, pixels)


def _bands(encoding: LightCodec, peaks: tuple[float, ...]) -> np.ndarray:
    """A lamp's falloff for each peak, a strip each, as displayed."""
    strips = [displayed(lights.banded(encoding, peak) / max(peak, 1.0)) for peak in peaks]
    return pictures.strips([strip[::2] for strip in strips], 64)
