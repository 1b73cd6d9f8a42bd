"""The render table: what a codec, a layout or a light buffer does to the final image of a pipeline."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS
from ....gbuffer.display import CLIPPED_ALONE, Display, measured_exposure
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device, FormatError
from ....gbuffer.gl.shader import ShaderError
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES, Pipeline
from ....gbuffer.render import Rendering, bytes_per_pixel, rendering
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.scene import KINDS, Scene
from ....gbuffer.scenes.setting import Setting
from ...ground.angles import angles_deg
from ...ground.output.errors import UsageError
from ...measures.metrics.images import flip, squared_error
from ...measures.metrics.totals import Worst, psnr_db
from ...subjects.normals.normal_names import SEES_NOTHING
from .table import TABLE

STAGES = tuple(dict.fromkeys(stage.name for pipeline in PIPELINES.values() for stage in pipeline.stages))
# Why a device may not be able to give a row.
UNMEASURABLE = (ShaderError, FormatError)
# What 8 bits show as 0.
BLACK = 0.5 / 255
# A scene that covers less of its picture, in percent, leaves few pixels to judge by.
LEAST_COVERED = 100 / 3
# Codecs are ranked among rows that agree in these.
SAME = (
    *("scene", "power", "effects", "environment", "specular_antialiasing", "least_roughness", "pipeline"),
    *("light_buffer", "light_targets", "shadow"),
)
Row = dict[str, Any]


@dataclass(frozen=True)
class Case:
    """One row to measure.

    Attributes:
        pipeline, plan: what renders, and with what.
        maker, setting: the scene and what it is made with.
        frames: moments that figures are averaged over.
        asked: samples a pixel as asked for; `plan.samples` is what the device gives.
        power: specular power of all materials; None for each material's own.
        exposure: in stops; None to measure it of the reference.
        tone_mapping: one of TONE_MAPPINGS.
        effects: which effects the pipeline has.
        environment: what metal/rough materials reflect, as a row says it; None for other materials.
        environment_key: tells environments of one name apart.
    """

    pipeline: Pipeline
    plan: Plan
    maker: SceneMaker
    setting: Setting
    frames: int
    asked: int
    power: float | None = None
    exposure: float | None = 0.0
    tone_mapping: str = "none"
    effects: str | None = None
    environment: str | None = None
    environment_key: str = ""

    @property
    def is_metal_rough(self) -> bool:
        """Whether its materials are."""
        return self.environment is not None

    @property
    def name(self) -> str:
        scene = self.maker.name if self.power is None else f"{self.maker.name} at power {self.power:g}"
        parts = (scene, self.pipeline.name, self.plan.layout.name, self.plan.layout.codec.name)
        return " ".join(parts if self.pipeline.has_gbuffer else parts[:2])

    def scenes(self) -> Iterator[Scene]:
        """The scene at each moment."""
        for frame in range(self.frames):
            scene = self.maker.make(replace(self.setting, time=frame / self.frames))
            yield scene if self.power is None else scene.with_power(self.power)

    @property
    def coverage(self) -> Case:
        """The same scene in a G-buffer in fp32 with one sample a pixel, which says what is covered."""
        plan = replace(self.reference.plan, samples=1, light_targets=2)
        return replace(self.reference, pipeline=PIPELINES["hybrid"], plan=plan, asked=1, effects=None)

    @property
    def reference(self) -> Case:
        """The same pipeline with everything in fp32, two light targets where it may have them, and full size."""
        targets = max(self.pipeline.light_targets, default=1)
        exact = replace(
            self.plan,
            layout=LAYOUTS["fp32"],
            light_buffer=LIGHT_BUFFERS["rgba32f"],
            light_targets=targets,
            scale=1.0,
        )
        return replace(self, plan=exact)


@dataclass(frozen=True)
class Drawn:
    """One frame.

    Attributes:
        linear: the image, float32 of shape (height, width, 3).
        normals, kinds: what the G-buffer says, (height, width, 3) and (height, width); None where there is no G-buffer
            or it has several samples a pixel. The kind of what is not covered is -1.
        display: how it is shown.
    """

    linear: np.ndarray
    normals: np.ndarray | None
    kinds: np.ndarray | None
    display: Display = CLIPPED_ALONE
    flip: np.ndarray | None = None

    @cached_property
    def shown(self) -> np.ndarray:
        """An image of light as a display shows it, in [0, 1]."""
        return self.display.image(self.linear)


def _drawn_images(made: Rendering, pipeline: Pipeline) -> Drawn:
    made.draw()
    if not pipeline.has_gbuffer or made.frame.plan.surface_samples > 1:
        return Drawn(made.image(), None, None)
    position, direction, *_ = made.gbuffer()
    kinds = np.where(position[..., 2] != 0, direction[..., 3], -1).astype(np.int32)
    return Drawn(made.image(), direction[..., :3], kinds)


def require_surface(maker: SceneMaker, is_seen: bool) -> None:
    """Raises UsageError where no surface of a scene is seen."""
    if not is_seen:
        raise UsageError(f"{maker.name}: {SEES_NOTHING}")


def says_little(scene: str, covered: float) -> Iterator[str]:
    """What is to be said of a scene that covers so many percent of its picture; nothing of one that fills it."""
    if 0 < covered < LEAST_COVERED:
        what = f"{scene}: surfaces cover {covered:.0f} % of the picture"
        yield f"{what}; a camera in the file that comes nearer gives more pixels to judge by"


class Bench:
    """Measures cases, each reference once.

    Args:
        device: where.
        repeats: frames that times are taken over; none are taken for 0.
        with_flip: whether FLIP is wanted.
    """

    def __init__(self, device: Device, repeats: int, with_flip: bool):
        self._device, self._repeats, self._with_flip = device, repeats, with_flip
        self._references: dict[Case, list[Drawn]] = {}
        self._reference_columns: dict[Case, Row] = {}

    def reference(self, case: Case) -> list[Drawn]:
        """The frames of a case's reference."""
        case = case.reference
        if case not in self._references:
            self._keep_reference(case, self._frames(case))
        return self._references[case]

    def _keep_reference(self, case: Case, frames: list[Drawn]) -> None:
        exposure = case.exposure
        if exposure is None:
            covered = self._covered_masks(case, frames)
            pixels = [frame.linear[where] for frame, where in zip(frames, covered, strict=True)]
            exposure = measured_exposure(np.concatenate(pixels))
        display = Display(exposure, case.tone_mapping)
        self._references[case] = [replace(frame, display=display) for frame in frames]

    def _covered_masks(self, case: Case, reference: list[Drawn]) -> list[np.ndarray]:
        """Where there is opaque surface in each frame, bool of shape (height, width).

        Raises:
            UsageError: nowhere; figures of no pixels would say that every code is exact.
        """
        if reference[0].kinds is None and case.coverage not in self._references:
            self._references[case.coverage] = self._frames(case.coverage)
        frames = self._references[case.coverage] if reference[0].kinds is None else reference
        covered = [frame.kinds >= 0 for frame in frames if frame.kinds is not None]
        require_surface(case.maker, any(where.any() for where in covered))
        return covered

    def _frames(self, case: Case, then: Callable[[Rendering], None] = lambda _: None) -> list[Drawn]:
        """A case's frames; `then` is called with the last one, still on the device."""
        frames: list[Drawn] = []
        for number, scene in enumerate(case.scenes(), 1):
            with rendering(self._device, case.pipeline, scene, case.plan) as made:
                frames.append(_drawn_images(made, case.pipeline))
                if number == case.frames:
                    then(made)
        return frames

    def measure(self, case: Case) -> tuple[Row, Drawn | None]:
        """One row of the table, and the first frame; a row that the device cannot give has its reason in `skipped`, and
        no frame.

        Raises:
            UsageError: the scene draws nothing.
        """
        stages = dict.fromkeys((*STAGES, *(stage.name for stage in case.pipeline.stages)))
        row = TABLE.empty(stages) | _case_columns(case) | {"device": self._device.renderer}
        times: Row = {}
        try:
            frames = self._frames(
                case, lambda made: times.update(_time_columns(made, self._repeats)) if self._repeats else None
            )
            if case == case.reference and case not in self._references:
                self._keep_reference(case, frames)
            reference = self.reference(case)
            covered = self._covered_masks(case, reference)
        except UNMEASURABLE as error:
            return row | {"skipped": str(error)}, None
        frames = [replace(frame, display=reference[0].display) for frame in frames]
        if case.reference not in self._reference_columns:
            self._reference_columns[case.reference] = _reference_columns(reference, covered)
        row |= (
            times | self._reference_columns[case.reference] | self._comparison_columns(case, frames, reference, covered)
        )
        maps = self._flip_maps(frames, reference)
        if maps:
            row["flip"] = float(np.mean([np.mean(one) for one in maps]))
        return row, replace(frames[0], flip=maps[0] if maps else None)

    def _flip_maps(self, frames: list[Drawn], reference: list[Drawn]) -> list[np.ndarray]:
        """FLIP of each frame, pixel by pixel; nothing where it is not wanted."""
        pairs = zip(frames, reference, strict=True)
        return [flip(one.shown, other.shown) for one, other in pairs] if self._with_flip else []

    def worst(self, case: Case) -> Worst | None:
        """The normal of a case's first frame that its G-buffer gives back farthest off; None where there is none."""
        try:
            return _farthest(self._frames(case)[0], self.reference(case)[0])
        except UNMEASURABLE:
            return None

    def _comparison_columns(
        self, case: Case, frames: list[Drawn], reference: list[Drawn], covered: list[np.ndarray]
    ) -> Row:
        pairs = list(zip(frames, reference, strict=True))
        errors = [squared_error(one.shown, other.shown) for one, other in pairs]
        mse = float(np.mean([error for error, _ in errors]))
        row: Row = {"mse": mse, "psnr_db": psnr_db(mse), "exact": mse == 0}
        row["invalid"] = sum(broken for _, broken in errors)
        row["psnr_covered_db"] = _psnr_of_covered(pairs, covered)
        # Where the G-buffer has a size of its own, its pixels are not the reference's.
        if case.pipeline.has_gbuffer and case.plan.scale == 1 and frames[0].normals is not None:
            has_kind = "kind" in case.plan.layout.components
            apart = [_normal_error(one, other, has_kind) for one, other in pairs]
            row["normal_psnr_db"] = psnr_db(float(np.mean(apart)))
        return row


def _reference_columns(reference: list[Drawn], covered: list[np.ndarray]) -> Row:
    """What a row says of what the reference shows."""
    surface = np.concatenate([frame.linear[where] for frame, where in zip(reference, covered, strict=True)])
    display = reference[0].display
    return {
        "exposure": display.exposure,
        "covered_percent": 100.0 * float(np.mean(covered)),
        "clipped_percent": 100.0 * display.clipped(surface),
        "black_percent": 100.0 * float(np.mean(np.all(display.image(surface) < BLACK, axis=-1))),
    }


def _psnr_of_covered(pairs: list[tuple[Drawn, Drawn]], covered: list[np.ndarray]) -> float | None:
    one, other = (
        np.concatenate([frame.shown[where] for frame, where in zip(frames, covered, strict=True)])
        for frames in zip(*pairs, strict=True)
    )
    return psnr_db(squared_error(one, other)[0]) if len(one) else None


def _farthest(one: Drawn, other: Drawn) -> Worst | None:
    """Of two frames, the normal that the one has and that is farthest off in the other."""
    if one.normals is None or other.normals is None or other.kinds is None or one.normals.shape != other.normals.shape:
        return None
    covered = other.kinds >= 0
    right, found = other.normals[covered], one.normals[covered]
    if not len(right):
        return None
    angles = np.nan_to_num(angles_deg(right, found), nan=180.0)
    at = int(np.argmax(angles))
    return Worst(right[at], found[at], float(angles[at]))


def _normal_error(one: Drawn, other: Drawn, has_kind: bool) -> float:
    """Mean squared error over the components of covered normals; hair's strand only where the layout knows hair."""
    assert one.normals is not None and other.normals is not None and other.kinds is not None
    compared = (other.kinds >= 0) & (has_kind | (other.kinds != KINDS.index("hair")))
    return float(np.mean((one.normals[compared].astype(np.float64) - other.normals[compared]) ** 2))


def described(pipeline: Pipeline, plan: Plan, setting: Setting, asked: int) -> Row:
    """What a row says of how it was rendered; what makes no difference to the pipeline is None."""
    kept = pipeline.has_gbuffer
    return {
        "pipeline": pipeline.name,
        "layout": plan.layout.name if kept else None,
        "light_buffer": plan.light_buffer.name if kept else None,
        "light_targets": plan.light_targets if kept else None,
        "scale": plan.scale if pipeline.scaled else None,
        "objects": setting.objects,
        "lights": setting.lights,
        "shadow": plan.shadows,
        "size": f"{plan.size[0]}x{plan.size[1]}",
        "samples": plan.samples,
        "samples_asked": asked,
        "seed": setting.seed,
    }


def _case_columns(case: Case) -> Row:
    plan, pipeline = case.plan, case.pipeline
    row = described(pipeline, plan, case.setting, case.asked)
    row |= {
        "scene": case.maker.name,
        "power": case.power,
        "frames": case.frames,
        "effects": case.effects,
        "tone_mapping": None if case.tone_mapping == "none" else case.tone_mapping,
        "environment": case.environment,
        "specular_antialiasing": plan.antialiased if case.is_metal_rough else None,
        "least_roughness": plan.least_roughness if case.is_metal_rough else None,
        "space": plan.layout.space if pipeline.has_gbuffer else None,
        "not_measured": ", ".join(_unread(case)) or None,
        "bytes_per_pixel": None if _is_exact_but_for_normals(case) else bytes_per_pixel(pipeline, plan),
    }
    if pipeline.has_gbuffer:
        row |= {"encoding": plan.layout.codec.encoding.name, "storage": plan.layout.normal_storage}
        row |= {"rounding": plan.layout.rounding, "normal_bits": plan.layout.normal_bits}
    return row


def _unread(case: Case) -> list[str]:
    """What a layout keeps and no pass reads, by the names of its quantities."""
    if not case.pipeline.has_gbuffer:
        return []
    kept = [word.component.partition(".")[0] for word in case.plan.layout.words]
    read = {"normal", "depth", "albedo", "occlusion", "emission", "roughness" if "roughness" in kept else "power"}
    read |= {"metalness", "reflectance"} if case.is_metal_rough and "metalness" in kept else {"specular"}
    # Kinds tell special materials apart, instances what a filter may mix.
    read |= (set() if case.is_metal_rough else {"kind"}) | ({"instance"} if case.pipeline.scaled else set())
    return list(dict.fromkeys(name for name in kept if name not in read))


def _is_exact_but_for_normals(case: Case) -> bool:
    """Whether a code lies in the exact layout, whose bytes nobody asked about."""
    layout, exact = case.plan.layout, LAYOUTS["fp32"]
    return case.pipeline.has_gbuffer and layout.name == exact.name and layout != exact


def _time_columns(made: Rendering, repeats: int) -> Row:
    if not repeats:
        return {}
    timings, clock = made.timings(repeats)
    row: Row = {f"ms_{name}": timing.median for name, timing in timings.items()}
    return row | {"ms_frame_spread": timings["frame"].spread, "clock": clock}


def shown_scene(row: Row) -> str:
    """What a row was rendered of, as a sentence names it."""
    return str(row["scene"]) + ("" if row["power"] is None else f" at power {row['power']:g}")


def in_order(rows: list[Row]) -> list[Row]:
    """Rows by what was rendered, as it comes, then by the bits of the normal's code, then the best image first."""
    groups = list(dict.fromkeys(_group_key(row) for row in rows))
    return sorted(rows, key=lambda row: (groups.index(_group_key(row)), row["normal_bits"] or 0, *_error_key(row)))


def _group_key(row: Row) -> tuple[Any, ...]:
    return (*(row.get(c) for c in SAME), row["layout"])


def _error_key(row: Row) -> tuple[bool, float]:
    """Images that are exact first, rows without figures last."""
    return row["mse"] is None, row["mse"] or 0.0


def ranked(given: Sequence[Row]) -> list[Row]:
    """The rows with each codec's place by its image and by its normals, among the rows that differ in nothing else."""
    rows = [dict(row) for row in given]
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        if row["normal_psnr_db"] is not None:
            groups.setdefault(tuple(row.get(c) for c in SAME), []).append(row)
    for group in groups.values():
        if len(group) > 1:
            for place, figure in (("rank", "psnr_db"), ("normal_rank", "normal_psnr_db")):
                figures = sorted((row[figure] for row in group), reverse=True)
                for row in group:
                    row[place] = figures.index(row[figure]) + 1
    return rows
