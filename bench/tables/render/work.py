"""Measurement and display of the render table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from ....encodings.storages.storage import ROUNDINGS_AND_DITHERED
from ....gbuffer.display import MAX_EXPOSURE, TONE_MAPPINGS
from ....gbuffer.environment.prefilter import key_of
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.layout import Layout, engines_space
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.scene import Scene
from ...ground.choose import choose, choose_one
from ...ground.options.counts import MAX_POWER, checked_numbers, in_range
from ...ground.options.targets import SHADOWS, TARGETS, check_scale, checked_setting, checked_target, what_is_left
from ...ground.output.errors import UsageError, tell
from ...ground.output.writing import without
from ...subjects.codecs.kinds.named import light_codecs_named
from ...subjects.codecs.layout_names import layouts_named
from ...subjects.codecs.names import codecs_named
from ...subjects.environments.scenes_under import scenes_under
from ...subjects.names.effects import effects_named, lacking, name_of, pipeline_with
from ...subjects.scenes.scene_names import scene_makers_named
from ..plans import suited, with_codecs
from ..shots import by_shots, checked_device, described, says_little, shot_steps
from ..table import Measured, Row, Sheet, Step, Work
from ..verdicts import codec_name
from . import pictures
from .charts import charts
from .measure import RenderBench, RenderCase, in_order, ranked, shown_scene
from .table import TABLE, RenderOptions, RenderOutputs

MAX_FRAMES = 1000
# Percent of covered pixels beyond which a line says that they are black, or clipped.
MOSTLY_BLACK = 95.0
MUCH_CLIPPED = 5.0
# What `pick` measures of studio: an encoding's figures with each axis up, over many orientations.
ONE_ORIENTATION = " in one orientation, which does not rank encodings; normalbench pick does"


def layouts(options: RenderOptions) -> list[Layout]:
    """Return the requested layouts, each with every requested codec; if no codec is requested, unchanged.

    Raises:
        UsageError: an unknown name, an impossible layout, or nothing left to measure.
    """
    chosen = layouts_named(("fp32",) if options.layout is None else options.layout)
    if options.layout is not None and options.encoding is options.storage is options.rounding is None:
        return chosen
    # Half a codec is completed by what is usual.
    codecs = codecs_named(
        ("all",) if options.encoding is None else options.encoding,
        ("rgba8",) if options.storage is None else options.storage,
        ("nearest",) if options.rounding is None else options.rounding,
        known_roundings=ROUNDINGS_AND_DITHERED,
    )
    complaints: list[str] = []
    return what_is_left(with_codecs(chosen, codecs, complaints), complaints)


def cases(options: RenderOptions, device: Device) -> list[RenderCase]:
    """Return a case for each row; impossible combinations are named on standard error.

    Raises:
        UsageError: unknown names, sizes or counts out of range, or nothing left to measure.
    """
    in_range("--frames", options.frames, 0, MAX_FRAMES)
    size, samples = checked_target(options.size, options.samples, max(options.frames, 1), device)
    setting = checked_setting(options.objects, options.lights, options.seed)
    check_scale(options.scale)
    in_range("--least-roughness", options.least_roughness, 0.0, 1.0)
    plans = [
        Plan(size, samples, layout, light, targets, shadows, options.scale, False, antialiased, options.least_roughness)
        for layout in layouts(options)
        for light in light_codecs_named(options.light_buffer)
        for targets in choose("number of light targets", options.light_targets, TARGETS)
        for shadows in choose("shadow", options.shadow, SHADOWS)
        for antialiased in choose("specular antialiasing", options.specular_antialiasing, SHADOWS)
    ]
    tone_mapping = options.tone_mapping and choose_one("tone mapping", options.tone_mapping, TONE_MAPPINGS)
    all_cases: list[RenderCase] = []
    complaints: list[str] = []
    powers = [None] if options.power is None else checked_numbers("--power", options.power, float, 1, MAX_POWER)
    effects = effects_named(options.effects) if options.effects else []
    pipelines = [pipeline_with(base, effects, complaints) for base in choose("pipeline", options.pipeline, PIPELINES)]
    for maker in scenes_under(options.environment, scene_makers_named(options.scene)):
        scene = maker.make(setting)
        told: Row = {"exposure": _exposure(options.exposure, maker), "tone_mapping": tone_mapping or maker.tone_mapping}
        told |= {"effects": name_of(effects), "environment": _around(scene), "environment_key": _key_around(scene)}
        if why := lacking(effects, maker.name, scene):
            complaints.append(why)
            continue
        sized = [replace(plan, size=maker.within(plan.size)) for plan in plans]
        for pipeline in filter(None, pipelines):
            asked = [_as_engines_keep(plan) for plan in sized] if scene.is_metal_rough else sized
            for plan in suited(device, pipeline, asked, complaints, scene.is_metal_rough):
                case = RenderCase(
                    pipeline, plan, maker, setting, options.frames or maker.frames, options.samples, **told
                )
                all_cases += [replace(case, power=power) for power in ([None] if scene.is_metal_rough else powers)]
        if scene.is_metal_rough and options.power is not None:
            tell(f"{maker.name}: --power is not used, because metallic-roughness materials have their own roughness")
    return what_is_left(all_cases, complaints)


def _as_engines_keep(plan: Plan) -> Plan:
    """Return a plan that measures only an encoding with its normals in world space if engines use the encoding there;
    any other plan is unchanged."""
    layout, exact = plan.layout, LAYOUTS["fp32"]
    if layout.name != exact.name or layout == exact:
        return plan
    return replace(plan, layout=replace(layout, space=engines_space(layout.encoding)))


def _around(scene: Scene) -> str | None:
    """Return text on what metallic-roughness materials reflect; None if the scene has other materials."""
    if not scene.is_metal_rough:
        return None
    if (around := scene.environment) is None:
        return "even"
    height, width, _ = around.radiance.shape
    return ", ".join((f"{around.name} {width}x{height}", *around.changes))


def _key_around(scene: Scene) -> str:
    """Return a key that distinguishes environments of the same name; empty without an environment."""
    return key_of(scene.environment.radiance) if scene.environment else ""


def _exposure(asked: str | None, maker: SceneMaker) -> float | None:
    """Return the exposure in stops, by default the scene's own; None for "auto", to measure it. Raises UsageError."""
    if asked is None:
        return maker.exposure
    if asked.strip().lower() == "auto":
        return None
    try:
        stops = float(asked)
    except ValueError:
        raise UsageError(f"--exposure {asked}: not a number; use stops such as -1.5, or auto") from None
    if not abs(stops) <= MAX_EXPOSURE:
        raise UsageError(f"--exposure {asked}: out of range; use {-MAX_EXPOSURE:g} to {MAX_EXPOSURE:g} stops")
    return stops


def _steps(options: RenderOptions, outputs: RenderOutputs) -> list[Step]:
    device = checked_device(options.repeats)
    bench = RenderBench(device, options.repeats, options.flip)
    return shot_steps(bench, cases(options, device), outputs.images, lambda case: _key(case, options))


def _key(case: RenderCase, options: RenderOptions) -> Row:
    key = described(case.pipeline, case.plan, case.setting, case.asked)
    key |= {"scene": case.maker.name, "power": case.power, "codec": case.plan.layout.codec.name, "frames": case.frames}
    key |= {"effects": case.effects, "exposure": case.exposure, "tone_mapping": case.tone_mapping}
    key |= {"environment": case.environment_key, "specular_antialiasing": case.plan.antialiased}
    key |= {"least_roughness": case.plan.least_roughness, "space": case.plan.layout.space}
    return key | {"repeats": options.repeats, "flip": options.flip}


def _warnings(rows: Sequence[Row]) -> Iterator[str]:
    for scene, covered in _most(rows, "covered_percent").items():
        yield from says_little(scene, covered)
    for scene, black in _most(rows, "black_percent").items():
        if black > MOSTLY_BLACK:
            remedy = "use --exposure auto, or add light that reaches the visible surfaces"
            yield f"{scene}: {black:.0f}% of the covered pixels are black; errors there are not visible; {remedy}"
    for scene, clipped in _most(rows, "clipped_percent").items():
        if clipped > MUCH_CLIPPED:
            remedy = "--exposure auto or --tone-mapping reinhard makes them visible"
            yield f"{scene}: {clipped:.0f}% of the covered pixels are clipped; errors there are not visible; {remedy}"


def _most(rows: Sequence[Row], column: str) -> dict[str, float]:
    """Return the largest value in a column for each scene; scenes without a value are left out."""
    largest: dict[str, float] = {}
    for row in rows:
        scene = shown_scene(row)
        if row[column] is not None:
            largest[scene] = max(largest.get(scene, 0.0), row[column])
    return largest


def _shown(done: Measured) -> Iterator[Sheet]:
    rows = without(TABLE.without_hidden(done.rows), _usual_columns(done.rows))
    yield Sheet("", rows, TABLE.drops(rows))


def _usual_columns(rows: Sequence[Row]) -> tuple[str, ...]:
    """Return the names of the columns to hide because all their values are the usual ones."""
    usual = {
        ("samples_asked",): all(row["samples"] == row["samples_asked"] for row in rows),
        ("exposure",): not any(row["exposure"] for row in rows),
        ("psnr_covered_db", "covered_percent"): all(row["covered_percent"] in (None, 100.0) for row in rows),
    }
    return tuple(name for names, is_usual in usual.items() if is_usual for name in names)


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    measured = [row for row in rows if row["psnr_db"] is not None]
    for scene, pipeline in dict.fromkeys((shown_scene(row), row["pipeline"]) for row in measured):
        part = [row for row in measured if (shown_scene(row), row["pipeline"]) == (scene, pipeline)]
        worst, best = (chosen(part, key=lambda row: row["psnr_db"]) for chosen in (min, max))
        figures = [f"{row['psnr_db']:.1f} dB ({_called(row)})" for row in (worst, best)]
        caution = ONE_ORIENTATION if len({row["encoding"] for row in part}) > 1 else ""
        yield f"Image of {scene} by {pipeline}: {' to '.join(dict.fromkeys(figures))}{caution}."


def _called(row: Row) -> str:
    return codec_name(row) if row["encoding"] else row["layout"]


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    names = ("encoding", "storage", "psnr_db", "normal_psnr_db")
    groups: dict[tuple, list[Row]] = {}
    for row in rows:
        if row["psnr_db"] is not None:
            groups.setdefault((shown_scene(row), row["pipeline"], row["layout"]), []).append(row)
    for (scene, pipeline, layout), part in groups.items():
        # One orientation ranks nothing.
        order = sorted(part, key=lambda row: str(row["encoding"]))
        where = f"{scene} by {pipeline}" + (f" in layout {layout}" if layout not in (None, "fp32") else "")
        shown = [{name: row[name] for name in names} for row in order]
        yield Sheet(f"the image: {where}, dB as displayed", shown, is_ranked=False)


def _finish(rows: Sequence[Row]) -> list[Row]:
    return in_order(ranked(rows))


def _worst(step: Step) -> Any:
    return step.case.bench.worst(step.case.case)


WORK = Work(
    steps=_steps,
    measure=by_shots(lambda folder, row, drawn, reference: pictures.write(folder, row, drawn, reference[0])),
    finish=_finish,
    shown=_shown,
    verdict=_verdict,
    summary=_summary,
    warnings=_warnings,
    charts=charts,
    subjects=pictures.subjects,
    worst=_worst,
)
