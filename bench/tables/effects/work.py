"""Measurement and display of the effects table."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from ....encodings.catalogue import DEPTH_ENCODINGS, LIGHT_BUFFERS
from ....encodings.codecs.depth_codec import DepthCodec
from ....encodings.storages.depth_storage import DEPTH_STORAGES
from ....encodings.storages.storage import ROUNDINGS_AND_DITHERED
from ....gbuffer.effects.effect import ChosenEffect
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.layout import Layout
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.layouts.words import LayoutError
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.render import check
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.setting import Setting
from ...ground.choose import choose, choose_one
from ...ground.options.counts import in_range
from ...ground.options.targets import checked_setting, checked_target, what_is_left
from ...ground.options.words import Names
from ...ground.output.errors import UsageError
from ...subjects.codecs.layout_names import layouts_named
from ...subjects.codecs.names import codecs_named
from ...subjects.names.effects import effects_named, lacking, pipeline_with
from ...subjects.scenes.scene_names import scene_makers_named
from ..charts import having
from ..plans import attempt, with_codecs
from ..shots import by_shots, checked_device, shot_steps
from ..table import Row, Sheet, Step, Work
from ..verdicts import codec_name
from . import pictures
from .charts import charts
from .measure import DENOISING, EffectsBench, EffectsCase, group_of, in_order
from .table import DEPTHS, EffectsOptions, EffectsOutputs

MAX_RAYS = 2**16
NO_DEPTH = "none"
# The RMS error is half a step of an 8-bit display.
UNSEEN_DB = 20 * math.log10(2 * 255)
NO_GBUFFER = "has no G-buffer for an effect to read"


def contents(options: EffectsOptions) -> list[tuple[Layout, str | None]]:
    """Return a G-buffer layout for each row, with the name of the depth encoding if the row measures one.

    Raises:
        UsageError: unknown names, or nothing left to measure.
    """
    complaints: list[str] = []
    layouts = [(layout, None) for layout in layouts_named(options.layout)] if options.layout else []
    asked = (options.encoding, options.depth)
    if asked[0] is None and asked[1] == (NO_DEPTH,) and not options.layout:
        raise UsageError("--depth none leaves nothing to measure; add --encoding or --layout")
    if options.layout and asked == (None, None):
        return list(layouts)
    normals = _with_normals(options, complaints) if options.encoding or not any(asked) else []
    return what_is_left([*layouts, *normals, *_with_depths(options, complaints)], complaints)


def _with_normals(options: EffectsOptions, complaints: list[str]) -> list[tuple[Layout, str | None]]:
    codecs = codecs_named(
        options.encoding or ("octahedral",), options.storage, options.rounding, known_roundings=ROUNDINGS_AND_DITHERED
    )
    return [(layout, None) for layout in with_codecs([LAYOUTS["fp32"]], codecs, complaints)]


def _with_depths(options: EffectsOptions, complaints: list[str]) -> list[tuple[Layout, str | None]]:
    names = DEPTHS if options.depth is None else options.depth
    if names == (NO_DEPTH,):
        return []
    layouts: list[tuple[Layout, str | None]] = []
    for codec in (_depth_codec(str(name)) for name in names):
        attempt(lambda codec=codec: (LAYOUTS["fp32"].with_depth(codec), codec.name), layouts, complaints)
    return layouts


def _depth_codec(name: str) -> DepthCodec:
    code, is_there, storage = name.partition("/")
    if not is_there:
        raise UsageError(
            f"--depth {name}: not an encoding with its storage; write for example linear/packed16, or none"
        )
    encoding = DEPTH_ENCODINGS[choose_one("depth", code, DEPTH_ENCODINGS)]
    return DepthCodec(encoding, DEPTH_STORAGES[choose_one("depth storage", storage, DEPTH_STORAGES)])


def cases(options: EffectsOptions, device: Device) -> list[EffectsCase]:
    """Return a case for each effect, pipeline, scene and G-buffer content; impossible cases are named on standard
    error.

    Raises:
        UsageError: unknown names, counts or sizes out of range, or nothing left to measure.
    """
    size, _ = checked_target(options.size, 1, 1, device)
    setting = checked_setting(options.objects, options.lights, options.seed)
    effects, pipelines = effects_named(options.effect), choose("pipeline", options.pipeline, PIPELINES)
    exact, inside = Plan(size, 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], 1, True, 1.0), contents(options)
    complaints: list[str] = []
    possible: list[EffectsCase] = []
    complaints += [f"pipeline {p.name} {NO_GBUFFER}" for p in pipelines if not p.has_gbuffer]
    for effect in effects:
        makers = _suitable(effect, options.scene, setting, complaints)
        for pipeline in filter(lambda p: p.has_gbuffer, pipelines) if makers else ():
            if with_effect := pipeline_with(pipeline, [effect], complaints):
                base_plan = replace(exact, light_targets=max(pipeline.light_targets, default=1))
                plans = [(replace(base_plan, layout=layout), depth) for layout, depth in inside]
                sized = [(m, replace(p, size=m.within(p.size)), depth) for m in makers for p, depth in plans]
                chosen = [EffectsCase(effect, with_effect, plan, m, setting, depth) for m, plan, depth in sized]
                possible += [case for case in chosen if _is_possible(device, case, makers[case.maker], complaints)]
    return what_is_left(possible, complaints)


def _suitable(
    effect: ChosenEffect, names: Names | None, setting: Setting, complaints: list[str]
) -> dict[SceneMaker, bool]:
    """Return the requested scenes, by default the effect's own, and whether each has metallic-roughness materials.
    Scenes that lack what the effect needs are left out, with the reason in `complaints`."""
    suitable: dict[SceneMaker, bool] = {}
    for maker in scene_makers_named(names or (effect.effect.scene,)):
        scene = maker.make(setting)
        if why := lacking([effect], maker.name, scene):
            complaints.append(why)
        else:
            suitable[maker] = scene.is_metal_rough
    return suitable


def _is_possible(device: Device, case: EffectsCase, is_metal_rough: bool, complaints: list[str]) -> bool:
    try:
        check(device, case.pipeline, case.plan, is_metal_rough)
    except LayoutError as error:
        complaints.append(str(error))
        return False
    return True


def _steps(options: EffectsOptions, outputs: EffectsOutputs) -> list[Step]:
    device = checked_device(options.repeats)
    in_range("--rays", options.rays, 0, MAX_RAYS)
    bench = EffectsBench(device, options.repeats, options.rays, options.flip)
    return shot_steps(bench, cases(options, device), outputs.images, lambda case: _key(case, options))


def _key(case: EffectsCase, options: EffectsOptions) -> Row:
    key = {"effect": case.effect.name, "pipeline": case.pipeline.name, "scene": case.maker.name, "depth": case.depth}
    key |= {"layout": case.plan.layout.name, "codec": case.plan.layout.codec.name, "size": options.size}
    key |= {"lights": options.lights, "objects": options.objects, "seed": options.seed, "rays": options.rays}
    return key | {"repeats": options.repeats, "flip": options.flip}


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    measured = [row for row in rows if row["effect_psnr_db"] is not None and row["encoding"]]
    phrases = []
    for effect, pipeline, scene in dict.fromkeys(map(group_of, measured)):
        part = [row for row in measured if group_of(row) == (effect, pipeline, scene)]
        # What a ray hits is light of any size: how many hit something else says more than its decibels. Of what is
        # denoised, the displayed image says more.
        moved, shown = having(part, "moved_percent"), having(part, "lost_neighbours_percent", "psnr_db")
        decibels = "psnr_db" if shown else "effect_psnr_db"
        figure, form = ("moved_percent", "{:.2g}%") if moved else (decibels, "{:.1f} dB")
        ranked = sorted(moved or part, key=lambda row: row[figure])
        ends = dict.fromkeys(f"{form.format(row[figure])} ({codec_name(row)})" for row in (ranked[0], ranked[-1]))
        hit = " of the rays hit something else" * bool(moved) + " in the displayed image" * bool(shown)
        is_unseen = not moved and ranked[0][figure] >= UNSEEN_DB
        change = "does not visibly depend on the encoding: at least" if is_unseen else "depends on it:"
        phrases.append(f"{effect} in {scene} {change} {next(iter(ends)) if is_unseen else ' to '.join(ends)}{hit}")
    if phrases:
        yield f"Compared with exact normals, {'; '.join(phrases)}."


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    names = ["encoding", "storage", "depth", "effect_psnr_db", "effect_rms", "moved_percent", "method_rms", "psnr_db"]
    names += [name for name in DENOISING if having(rows, name)]
    for effect, pipeline, scene in dict.fromkeys(group_of(row) for row in rows):
        part = [row for row in rows if group_of(row) == (effect, pipeline, scene)]
        shown = [{name: row[name] for name in names} for row in part if row["effect_rms"] is not None]
        if shown:
            yield Sheet(f"{effect} on {scene} by {pipeline}", shown, keys={"effect": effect, "scene": scene})


WORK = Work(
    steps=_steps,
    measure=by_shots(lambda folder, row, drawn, exact: pictures.write(folder, row, drawn, exact[0])),
    finish=in_order,
    verdict=_verdict,
    summary=_summary,
    charts=charts,
    subjects=pictures.subjects,
)
