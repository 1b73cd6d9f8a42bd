"""Measurement of the render table: the effect of a codec, a layout or a light buffer on the final image."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS
from ....gbuffer.display import Display, measured_exposure
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.kept import quantity_of
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES, Pipeline
from ....gbuffer.render import Rendering, bytes_per_pixel, rendering
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.scene import KINDS
from ....gbuffer.scenes.setting import Setting
from ...ground.angles import angles_deg
from ...measures.metrics.images import squared_error
from ...measures.metrics.totals import Worst, psnr_db
from ..shots import STAGES, UNMEASURABLE, Bench, Frame, described, image_figures, require_surface, time_columns
from ..table import Row
from .table import TABLE

# What 8 bits show as 0.
BLACK = 0.5 / 255
# Codecs are ranked among rows that agree in these.
SAME = (
    *("scene", "power", "effects", "environment", "specular_antialiasing", "least_roughness", "pipeline"),
    *("light_buffer", "light_targets", "shadow"),
)


@dataclass(frozen=True)
class RenderCase:
    """A row of the render table to measure.

    Attributes:
        pipeline, plan: the renderer, and the plan with which it renders.
        maker, setting: the scene and its settings.
        frames: number of moments over which figures are averaged.
        asked: requested samples per pixel; `plan.samples` is the number that the device provides.
        power: specular power of all materials; None for each material's own.
        exposure: in stops; None to measure it from the reference.
        tone_mapping: one of TONE_MAPPINGS.
        effects: the effects of the pipeline, in words; None without effects.
        environment: what metallic-roughness materials reflect, as named in a row; None for other materials.
        environment_key: text that distinguishes environments of the same name.
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
        """Whether the scene's materials are metallic-roughness."""
        return self.environment is not None

    @property
    def name(self) -> str:
        scene = self.maker.name if self.power is None else f"{self.maker.name} at power {self.power:g}"
        parts = (scene, self.pipeline.name, self.plan.layout.name, self.plan.layout.codec.name)
        return " ".join(parts if self.pipeline.has_gbuffer else parts[:2])

    def moments(self) -> Iterator[Setting]:
        """Yield the setting of the scene at each moment."""
        for frame in range(self.frames):
            yield replace(self.setting, time=frame / self.frames)

    @property
    def coverage(self) -> RenderCase:
        """The same scene in an fp32 G-buffer with one sample per pixel, which shows the covered pixels."""
        plan = replace(self.reference.plan, samples=1, light_targets=2)
        return replace(self.reference, pipeline=PIPELINES["hybrid"], plan=plan, asked=1, effects=None)

    @property
    def reference(self) -> RenderCase:
        """The same pipeline with everything in fp32, two light targets if supported, and a full-size G-buffer."""
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
class Drawn(Frame):
    """A rendered frame, with the content of its G-buffer.

    Attributes:
        normals, kinds: normals and kinds of material, (height, width, 3) and (height, width); None if there is no
            G-buffer or it has several samples per pixel. The kind is -1 at uncovered pixels.
    """

    normals: np.ndarray | None
    kinds: np.ndarray | None


class RenderBench(Bench[RenderCase, Drawn]):
    """Measures cases, each reference once."""

    def __init__(self, device: Device, repeats: int, with_flip: bool):
        super().__init__(device, repeats, with_flip)
        self._masks: dict[RenderCase, list[np.ndarray]] = {}
        self._reference_columns: dict[RenderCase, Row] = {}

    def about(self, case: RenderCase) -> Row:
        stages = dict.fromkeys((*STAGES, *(stage.name for stage in case.pipeline.stages)))
        return TABLE.empty(stages) | _case_columns(case) | {"device": self.device.renderer}

    def frames(self, case: RenderCase, repeats: int = 0) -> list[Drawn]:
        frames: list[Drawn] = []
        for setting in case.moments():
            scene = self.scene(case.maker, setting)
            lit = scene if case.power is None else scene.with_power(case.power)
            is_last = len(frames) == case.frames - 1
            with rendering(self.device, case.pipeline, lit, case.plan) as rendered:
                frames.append(_drawn_images(rendered, case.pipeline, repeats if is_last else 0))
        return frames

    def display(self, case: RenderCase, frames: list[Drawn]) -> Display:
        exposure = case.exposure
        if exposure is None:
            covered = self._covered_masks(case, frames)
            pixels = [frame.linear[where] for frame, where in zip(frames, covered, strict=True)]
            exposure = measured_exposure(np.concatenate(pixels))
        return Display(exposure, case.tone_mapping)

    def _covered_masks(self, case: RenderCase, exact: list[Drawn]) -> list[np.ndarray]:
        """Return the masks of opaque surfaces in the frames of a reference, each bool of shape (height, width).

        Raises:
            UsageError: no surface is visible; figures over no pixels would make every codec look exact.
        """
        coverage = case.coverage if exact[0].kinds is None else case.reference
        if coverage not in self._masks:
            frames = self.frames(coverage) if exact[0].kinds is None else exact
            self._masks[coverage] = [frame.kinds >= 0 for frame in frames if frame.kinds is not None]
        require_surface(case.maker, any(where.any() for where in self._masks[coverage]))
        return self._masks[coverage]

    def figures(self, case: RenderCase, frames: list[Drawn], exact: list[Drawn]) -> Row:
        covered = self._covered_masks(case, exact)
        if case.reference not in self._reference_columns:
            self._reference_columns[case.reference] = _reference_columns(exact, covered)
        pairs = list(zip(frames, exact, strict=True))
        row = self._reference_columns[case.reference] | image_figures(frames, exact)
        row |= {"exact": row["mse"] == 0, "psnr_covered_db": _psnr_of_covered(pairs, covered)}
        # Where the G-buffer has a size of its own, its pixels are not the reference's.
        if case.pipeline.has_gbuffer and case.plan.scale == 1 and frames[0].normals is not None:
            has_kind = "shading_model" in case.plan.layout.components
            apart = [_normal_error(frame, other, has_kind) for frame, other in pairs]
            row["normal_psnr_db"] = psnr_db(float(np.mean(apart)))
        return row

    def worst(self, case: RenderCase) -> Worst | None:
        """Return the normal with the largest G-buffer error in a case's first frame; None if there are no normals, or
        the case cannot be measured."""
        try:
            return _farthest(self.frames(case)[0], self.reference(case)[0])
        except UNMEASURABLE:
            return None


def _drawn_images(rendered: Rendering, pipeline: Pipeline, repeats: int) -> Drawn:
    rendered.draw()
    normals = kinds = None
    if pipeline.has_gbuffer and rendered.frame.plan.surface_samples == 1:
        position, direction, *_ = rendered.gbuffer()
        normals, kinds = direction[..., :3], np.where(position[..., 2] != 0, direction[..., 3], -1).astype(np.int32)
    image = rendered.image()
    return Drawn(image, normals, kinds, times=time_columns(*rendered.timings(repeats)) if repeats else {})


def _reference_columns(reference: list[Drawn], covered: list[np.ndarray]) -> Row:
    """Return columns on the reference: its exposure, and the share of covered, clipped and black pixels."""
    surface = np.concatenate([frame.linear[where] for frame, where in zip(reference, covered, strict=True)])
    display = reference[0].display
    return {
        "exposure": display.exposure,
        "covered_percent": 100.0 * float(np.mean(covered)),
        "clipped_percent": 100.0 * display.clipped(surface),
        "black_percent": 100.0 * float(np.mean(np.all(display.image(surface) < BLACK, axis=-1))),
    }


def _psnr_of_covered(pairs: list[tuple[Drawn, Drawn]], covered: list[np.ndarray]) -> float | None:
    pixels, other = (
        np.concatenate([frame.shown[where] for frame, where in zip(frames, covered, strict=True)])
        for frames in zip(*pairs, strict=True)
    )
    return psnr_db(squared_error(pixels, other)[0]) if len(pixels) else None


def _farthest(own: Drawn, other: Drawn) -> Worst | None:
    """Return the normal that differs most between a frame and its exact frame; None if they cannot be compared."""
    if own.normals is None or other.normals is None or other.kinds is None or own.normals.shape != other.normals.shape:
        return None
    covered = other.kinds >= 0
    right, normals = other.normals[covered], own.normals[covered]
    if not len(right):
        return None
    angles = np.nan_to_num(angles_deg(right, normals), nan=180.0)
    index = int(np.argmax(angles))
    return Worst(right[index], normals[index], float(angles[index]))


def _normal_error(own: Drawn, other: Drawn, has_kind: bool) -> float:
    """Return the mean squared error over the components of covered normals. Hair pixels, whose normal is the
    direction of a strand, count only if `has_kind`."""
    assert own.normals is not None and other.normals is not None and other.kinds is not None
    compared = (other.kinds >= 0) & (has_kind | (other.kinds != KINDS.index("hair")))
    return float(np.mean((own.normals[compared].astype(np.float64) - other.normals[compared]) ** 2))


def _case_columns(case: RenderCase) -> Row:
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


def _unread(case: RenderCase) -> list[str]:
    """Return the names of the quantities that a layout stores but no pass reads."""
    if not case.pipeline.has_gbuffer:
        return []
    kept = [quantity_of(word.component) for word in case.plan.layout.words]
    read = {"normal", "depth", "base_color", "ao", "emissive", "roughness" if "roughness" in kept else "power"}
    read |= {"metallic", "f0"} if case.is_metal_rough and "metallic" in kept else {"f0.rgb"}
    # Kinds tell special materials apart, instances what a filter may mix.
    read |= (set() if case.is_metal_rough else {"shading_model"}) | ({"instance"} if case.pipeline.scaled else set())
    return list(dict.fromkeys(name for name in kept if name not in read))


def _is_exact_but_for_normals(case: RenderCase) -> bool:
    """Whether a case stores a codec in the otherwise exact layout, so that the layout's bytes do not matter."""
    layout, exact = case.plan.layout, LAYOUTS["fp32"]
    return case.pipeline.has_gbuffer and layout.name == exact.name and layout != exact


def shown_scene(row: Row) -> str:
    """Return the name of a row's scene for sentences, with the specular power if there is one."""
    return str(row["scene"]) + ("" if row["power"] is None else f" at power {row['power']:g}")


def in_order(rows: list[Row]) -> list[Row]:
    """Return the rows by render settings in the given order, then by bits of the normal's code, the best first."""
    groups = list(dict.fromkeys(_group_key(row) for row in rows))
    return sorted(rows, key=lambda row: (groups.index(_group_key(row)), row["normal_bits"] or 0, *_error_key(row)))


def _group_key(row: Row) -> tuple[Any, ...]:
    return (*(row.get(c) for c in SAME), row["layout"])


def _error_key(row: Row) -> tuple[bool, float]:
    """Return the sort key of a row by its image error: exact images come first, rows without figures last."""
    return row["mse"] is None, row["mse"] or 0.0


def ranked(given: Sequence[Row]) -> list[Row]:
    """Return the rows with the codec's `rank` by its image and `normal_rank` by its normals, among rows with the same
    render settings; rows without others to compare with are unchanged."""
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
