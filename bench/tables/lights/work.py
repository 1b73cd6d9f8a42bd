"""How the lights table is measured and shown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.codecs.light_codec import LightCodec
from ....gbuffer.codecs.light.light_passes import Resolved
from ....gbuffer.display import displayed
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.words import LayoutError
from ....gbuffer.pipelines import PIPELINES, Pipeline
from ....gbuffer.render import check_metal_rough
from ....reports.charts import pictures
from ...ground.choose import choose
from ...ground.machine.devices import found_device, require_jax
from ...ground.options.counts import checked_numbers
from ...ground.options.light_names import MOST_LIGHT
from ...ground.options.targets import TARGETS, checked_setting, checked_target
from ...ground.output.errors import MissingError, UsageError
from ...ground.output.writing import check_folder, whole_file
from ...subjects.codecs.kinds.named import light_codecs_named
from ...subjects.scenes.scene_names import scene_makers_named
from ..table import Row, Sheet, Step, Work, each
from . import measure
from .charts import charts
from .images import Shot
from .table import TABLE, LightsOptions, LightsOutputs

# Lights in one sum, the largest specular power, and samples.
MOST_LIGHTS, MOST_POWER, MOST_SAMPLES = 4096, 2048.0, 64
PLOTTED, PICTURED = {"equal", "random"}, {"banding", "resolve", "image"}


def experiments(options: LightsOptions) -> list[str]:
    """The experiments asked for. Raises UsageError."""
    return choose("experiment", options.experiment, {name: name for name in measure.EXPERIMENTS})


def encodings(options: LightsOptions) -> list[LightCodec]:
    """The light buffers asked for, checked. Raises UsageError."""
    chosen = light_codecs_named(options.light_buffer)
    for encoding in chosen:
        measure.check_light_twin(encoding)
    return chosen


def added(options: LightsOptions) -> measure.Sums:
    """What is added up. Raises UsageError."""
    checked_setting(options.objects, options.lights, options.seed)
    return measure.Sums(
        checked_numbers("--sum", options.sums, float, 1e-6, MOST_LIGHT),
        checked_numbers("--counts", options.counts, int, 1, MOST_LIGHTS),
        checked_numbers("--peak", options.peaks, float, 1e-6, MOST_LIGHT),
        options.seed,
    )


def all_samples(options: LightsOptions) -> tuple[int, ...]:
    """The numbers of samples asked for. Raises UsageError."""
    return checked_numbers("--samples", options.samples, int, 1, MOST_SAMPLES)


def shots(options: LightsOptions, gl: Device) -> list[Shot]:
    """The scenes asked for. Raises UsageError."""
    size, _ = checked_target(options.size, max(all_samples(options)), 1, gl)
    setting = checked_setting(options.objects, options.lights, options.seed)
    makers = scene_makers_named(options.scene)
    return [Shot(maker.name, maker.make(setting), maker.within(size), options.seed) for maker in makers]


def given_samples(options: LightsOptions, gl: Device) -> dict[int, list[int]]:
    """The numbers of samples that the device has for those asked for, each with what it stands for."""
    given: dict[int, list[int]] = {}
    for asked in all_samples(options):
        given.setdefault(gl.given_samples(asked), []).append(asked)
    return given


def _pipelines(options: LightsOptions) -> list[Pipeline]:
    """The pipelines asked for. Raises UsageError for one without a light buffer."""
    return choose("pipeline", options.pipeline, {name: p for name, p in PIPELINES.items() if p.has_gbuffer})


@dataclass(frozen=True)
class Album:
    """Where pictures go; nowhere where none were asked for."""

    folder: Path | None

    def add(self, *words: Any) -> None:
        """A picture, named by the words before it."""
        if self.folder:
            *names, pixels = words
            with whole_file(self.folder / f"{'-'.join(names)}.png") as partial:
                pictures.write_png(partial, pixels)


def _check(outputs: LightsOutputs, names: Sequence[str]) -> None:
    """Raises UsageError for what cannot be written."""
    if outputs.plot and not PLOTTED & set(names):
        raise UsageError("--plot draws the experiments equal and random; ask for one of them")
    if outputs.images:
        check_folder(outputs.images)
        if not PICTURED & set(names):
            raise UsageError("--images draws the experiments banding, resolve and image; ask for one of them")


def _steps(options: LightsOptions, outputs: LightsOutputs) -> list[Step]:
    require_jax()
    gl, missing = found_device()
    names, chosen, sums = experiments(options), encodings(options), added(options)
    pipelines, powers, _ = _pipelines(options), _powers(options), all_samples(options)
    targets = choose("number of light targets", options.light_targets, TARGETS)
    seen = shots(options, gl) if gl and set(measure.IMAGE_EXPERIMENTS) & set(names) else []
    if "image" in names:
        _check_materials(seen, pipelines)
    _check(outputs, names)
    album = Album(outputs.images)
    summed = [name for name in measure.SUM_EXPERIMENTS if name in names]
    if not gl and not summed:
        raise MissingError(missing)
    made = [_sum_step(summed, encoding, sums, gl, missing, album) for encoding in chosen if summed]
    for shot in seen:
        if "resolve" in names:
            made.append(_resolve_step(options, gl, shot, chosen, album))
        if "image" in names:
            made += [_image_step(gl, p, shot, power, chosen, targets, album) for p in pipelines for power in powers]
    lacking = [name for name in measure.IMAGE_EXPERIMENTS if name in names and not gl]
    return made + [Step({"experiment": name}, partial(_lacking, name, missing), name) for name in lacking]


def _check_materials(seen: Sequence[Shot], pipelines: Sequence[Pipeline]) -> None:
    """Raises UsageError where a pipeline cannot draw a scene's materials."""
    for shot in seen:
        for pipeline in pipelines if shot.scene.is_metal_rough else ():
            try:
                check_metal_rough(pipeline)
            except LayoutError as error:
                raise UsageError(f"{shot.name}: {error}; name one by --pipeline") from error


def _powers(options: LightsOptions) -> tuple[float, ...]:
    return checked_numbers("--power", options.power, float, 1.0, MOST_POWER)


def _lacking(name: str, missing: str) -> list[Row]:
    return [TABLE.empty() | {"experiment": name, "skipped": missing}]


def _sum_step(
    names: list[str], encoding: LightCodec, sums: measure.Sums, gl: Device | None, missing: str, album: Album
) -> Step:
    def rows() -> list[Row]:
        if "banding" in names:
            album.add("banding", encoding.name, _bands(encoding, sums.peaks, gl) if album.folder else None)
        found = list(measure.sum_rows(names, encoding, sums, gl))
        return found if gl else [row | {"skipped": missing} for row in found]

    key: Row = {"experiments": names, "light_buffer": encoding.name, "seed": sums.seed}
    key |= {"sums": list(sums.sums), "counts": list(sums.counts), "peaks": list(sums.peaks)}
    return Step(key | {"device": gl.renderer if gl else None}, rows, encoding.name)


def _resolve_step(options: LightsOptions, gl: Any, shot: Shot, chosen: list[LightCodec], album: Album) -> Step:
    def seen(encoding: LightCodec, samples: int, found: Resolved, aliased: Resolved, right: np.ndarray) -> None:
        words = ("resolve", shot.name, encoding.name, f"{samples}x")
        album.add(*words, "code", pictures.picture(found.by_code))
        album.add(*words, "light", pictures.picture(found.by_light))
        album.add(*words, "difference", pictures.difference(found.by_code, right))
        album.add(*words, "change", pictures.difference(found.by_code, aliased.by_code))

    given = given_samples(options, gl)
    key = _frame_key("resolve", shot, chosen, gl) | {"samples": sorted(given), "samples_asked": options.samples}
    rows = partial(_listed, measure.resolve_rows, gl, shot, chosen, given, seen)
    return Step(key, rows, f"resolve {shot.name}")


def _image_step(
    gl: Any,
    pipeline: Pipeline,
    shot: Shot,
    power: float,
    chosen: list[LightCodec],
    targets: list[int],
    album: Album,
) -> Step:
    def seen(encoding: LightCodec, targets: int, image: np.ndarray, reference: np.ndarray) -> None:
        words = ("image", shot.name, pipeline.name, f"power{power:g}", f"{encoding.name}x{targets}")
        album.add(*words, "final", pictures.picture(image))
        album.add(*words, "difference", pictures.difference(image, reference))

    key = _frame_key("image", shot, chosen, gl) | {"pipeline": pipeline.name, "power": power, "targets": targets}
    rows = partial(_listed, measure.image_rows, gl, pipeline, shot, power, chosen, targets, seen)
    return Step(key, rows, f"{shot.name} {pipeline.name} {power:g}")


def _listed(rows: Any, *arguments: Any) -> list[Row]:
    return list(rows(*arguments))


def _frame_key(experiment: str, shot: Shot, chosen: list[LightCodec], gl: Device) -> Row:
    key: Row = {"experiment": experiment, "scene": shot.name, "size": f"{shot.size[0]}x{shot.size[1]}"}
    key |= {"lights": len(shot.scene.lights), "seed": shot.seed, "device": gl.renderer}
    return key | {"light_buffers": [encoding.name for encoding in chosen]}


def _bands(encoding: LightCodec, peaks: tuple[float, ...], gl: Device | None) -> np.ndarray:
    """A lamp's falloff for each peak, a strip each, as displayed."""
    strips = [displayed(measure.banded(encoding, peak, gl) / max(peak, 1.0)) for peak in peaks]
    return pictures.strips([strip[::2] for strip in strips], 64)


def _finish(rows: Sequence[Row]) -> list[Row]:
    if not rows:
        raise UsageError("nothing to measure: one light target and chromaticity need a code with a fourth number")
    return measure.sorted_rows(list(rows))


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    equal: dict[tuple[str, str], Row] = {}
    for row in rows:
        if row["experiment"] == "equal" and row["sum"] == 1:
            line = {"light_buffer": row["light_buffer"], "channel": row["channel"]}
            equal.setdefault((row["light_buffer"], row["channel"]), line)[f"{row['lights']}_lights"] = row["model"]
    if equal:
        yield Sheet("lights that sum to 1, what is left of it by the model", list(equal.values()))
    names = ("light_buffer", "light_targets", "psnr_db", "held_psnr_db", "beyond_percent")
    frames: dict[tuple, list[Row]] = {}
    for row in rows:
        if row["experiment"] == "image" and row["psnr_db"] is not None:
            frames.setdefault((row["scene"], row["pipeline"], row["power"]), []).append(row)
    for (scene, pipeline, power), part in frames.items():
        title = (
            f"{scene} by {pipeline}, specular power {power:g}: dB as displayed; held: where the code can hold the light"
        )
        yield Sheet(title, [{name: row[name] for name in names} for row in part])


WORK = Work(
    steps=_steps,
    measure=each(lambda rows: rows()),
    finish=_finish,
    summary=_summary,
    charts=charts,
)
