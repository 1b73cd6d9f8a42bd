"""The effects table: what a code of the G-buffer does to effects that read it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from ....gbuffer.display import Display
from ....gbuffer.effects.effect import ChosenEffect
from ....gbuffer.effects.occlusion.passes import AmbientOcclusion
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import Pipeline
from ....gbuffer.render import Rendering, rendering
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.scene import Scene
from ....gbuffer.scenes.setting import Setting
from ...ground.angles import angles_deg
from ...ground.output.errors import MissingError, tell
from ...measures.metrics.images import flip, squared_error
from ...measures.metrics.occlusion_error import method_error
from ...measures.metrics.totals import psnr_db
from ..render.measure import UNMEASURABLE
from .table import TABLE

Row = dict[str, Any]


@dataclass(frozen=True)
class Case:
    """One row to measure.

    Attributes:
        effect: what reads the G-buffer.
        pipeline: with the effect in it.
        plan: what renders it.
        maker, setting: the scene and what it is made with.
        depth: the depth code by name, where it is what the row is about.
    """

    effect: ChosenEffect
    pipeline: Pipeline
    plan: Plan
    maker: SceneMaker
    setting: Setting
    depth: str | None = None

    @property
    def name(self) -> str:
        code = self.depth or self.plan.layout.codec.name
        return f"{self.effect.name} {self.maker.name} {self.plan.layout.name} {code}"

    @property
    def reference(self) -> Case:
        """The same effect from a G-buffer in 32-bit floats."""
        return replace(self, plan=replace(self.plan, layout=LAYOUTS["fp32"]), depth=None)


@dataclass(frozen=True)
class Drawn:
    """A frame.

    Attributes:
        linear: the image in linear light, (height, width, 3).
        own: the effect's own image, (height, width, channels).
        normals: what the G-buffer gives back, (height, width, 3).
        covered: where the effect is; bool of shape (height, width).
        hits: where the first ray of each pixel meets something, (height, width, 4), as `Effect.hits` says; None of an
            effect without rays.
        display: how the image is shown.
        times: milliseconds by pass, and the clock.
    """

    linear: np.ndarray
    own: np.ndarray
    normals: np.ndarray
    covered: np.ndarray
    hits: np.ndarray | None
    display: Display
    times: Row

    @property
    def shown(self) -> np.ndarray:
        """An image of light as a display shows it, in [0, 1]."""
        return self.display.image(self.linear)


class Bench:
    """Measures cases, each reference once.

    Args:
        device: where.
        repeats: frames that times are taken over; none are taken for 0.
        rays: rays a point of the method's own error; 0 for none.
        with_flip: whether FLIP is wanted.
    """

    def __init__(self, device: Device, repeats: int, rays: int, with_flip: bool):
        self._device, self._repeats, self._rays, self._with_flip = device, repeats, rays, with_flip
        self._references: dict[Case, Drawn] = {}
        self._methods: dict[Case, Row] = {}
        # Cases of one scene follow each other, and a head takes longer to make than to render.
        self._scene = lru_cache(maxsize=1)(_made_scene)

    def reference(self, case: Case) -> Drawn:
        """The frame of a case's reference."""
        case = case.reference
        if case not in self._references:
            drawn = self._drawn_case(case)
            self._references[case] = replace(drawn, display=case.maker.display(drawn.linear[drawn.covered]))
        return self._references[case]

    def measure(self, case: Case) -> tuple[Row, Drawn | None]:
        """One row of the table, and the frame; a row that the device cannot give has its reason in `skipped`."""
        row = TABLE.empty(stage.name for stage in case.effect.passes()) | _case_columns(case)
        row["device"] = self._device.renderer
        try:
            exact, drawn = self.reference(case), self._drawn_case(case)
        except UNMEASURABLE as error:
            return row | {"skipped": str(error)}, None
        if not np.any(exact.covered):
            return row | {"skipped": f"{case.effect.effect.name} shows nothing in this picture"}, None
        drawn = replace(drawn, display=exact.display)
        row |= (
            _distance_columns(drawn, exact) | _image_columns(drawn, exact) | drawn.times | self._method(case.reference)
        )
        if self._with_flip:
            row["flip"] = float(np.mean(flip(drawn.shown, exact.shown)))
        return row, drawn

    def _drawn_case(self, case: Case) -> Drawn:
        scene = self._scene(case.maker, case.setting)
        with rendering(self._device, case.pipeline, scene, case.plan) as made:
            made.draw()
            position, direction, *_ = made.gbuffer()
            effect = case.effect.effect
            own, hits = made.read(effect.result)[0], made.read(effect.hits)[0] if effect.hits else None
            covered = drawn_at(own, position[..., 2] != 0)
            times = self._time_columns(case, made) if self._repeats else {}
            return Drawn(made.image(), own[..., :3], direction[..., :3], covered, hits, Display(0.0), times)

    def _time_columns(self, case: Case, made: Rendering) -> Row:
        timings, clock = made.timings(self._repeats)
        names = [stage.name for stage in case.effect.passes()]
        row: Row = {f"ms_{name}": timings[name].median for name in (*names, "frame")}
        return row | {"ms_effect": sum(timings[name].median for name in names), "clock": clock}

    def _method(self, case: Case) -> Row:
        """How far the effect from exact normals is from rays; nothing where there is no oracle or no ray caster."""
        if not self._rays or not isinstance(case.effect.effect, AmbientOcclusion):
            return {}
        if case not in self._methods:
            self._methods[case] = self._method_columns(case)
        return self._methods[case]

    def _method_columns(self, case: Case) -> Row:
        scene = self._scene(case.maker, case.setting)
        try:
            found = method_error(self._device, case.effect, scene, case.plan.size, rays=self._rays)
        except MissingError as error:
            tell(f"method_rms stays empty: {error}")
            return {}
        return {"method_rms": found.rms, "method_mean": found.mean}


def _made_scene(maker: SceneMaker, setting: Setting) -> Scene:
    return maker.make(setting)


def drawn_at(own: np.ndarray, surfaces: np.ndarray) -> np.ndarray:
    """Where an effect is, bool of shape (height, width): where its alpha says so; of one without, on all surfaces."""
    return own[..., 3] > 0 if own.shape[-1] == 4 else surfaces


def _distance_columns(drawn: Drawn, exact: Drawn) -> Row:
    """How far the effect's own image is from the exact one's, and the normals from the exact ones."""
    covered = exact.covered
    one, other = (frame.own[covered].astype(np.float64) for frame in (drawn, exact))
    peak = float(np.max(np.abs(np.nan_to_num(other))))
    # What is no number is as far off as the brightest pixel is from none.
    apart = np.where(np.isfinite(one - other), np.abs(one - other), peak)
    mse, angles = float(np.mean(apart**2)), _angles(drawn, exact)
    row: Row = {"effect_rms": mse**0.5, "effect_mean": float(np.mean(apart)), "effect_max": float(np.max(apart))}
    row["effect_psnr_db"] = psnr_db(mse)
    if drawn.hits is not None and exact.hits is not None:
        row["moved_percent"] = moved_percent(drawn.hits, exact.hits)
    row |= {"normal_mean_deg": float(np.mean(angles)), "normal_max_deg": float(np.max(angles))}
    if row["normal_mean_deg"] > 0:
        row["slope"] = row["effect_mean"] / row["normal_mean_deg"]
    return row | {"exact": mse == 0}


def moved_percent(hits: np.ndarray, exact: np.ndarray) -> float | None:
    """Of the pixels whose ray meets something in the exact frame, the share whose ray meets nothing, or something more
    than a pixel away; None where no ray meets anything.

    Args:
        hits, exact: (height, width, 4), as `Effect.hits` says.
    """
    there = exact[..., 3] > 0
    if not np.any(there):
        return None
    is_near = np.linalg.norm(hits[..., :2] - exact[..., :2], axis=-1) <= 1
    return 100 * float(np.mean(~(is_near & (hits[..., 3] > 0))[there]))


def _angles(drawn: Drawn, exact: Drawn) -> np.ndarray:
    """Degrees between the normals of two frames, where both have one."""
    one, other = drawn.normals[exact.covered], exact.normals[exact.covered]
    there = np.any(other != 0, axis=-1)
    return np.nan_to_num(angles_deg(other[there], one[there]), nan=180.0) if np.any(there) else np.zeros(1)


def _image_columns(drawn: Drawn, exact: Drawn) -> Row:
    mse, broken = squared_error(drawn.shown, exact.shown)
    lost = np.count_nonzero(~np.isfinite(drawn.own[exact.covered]).all(axis=-1))
    return {"psnr_db": psnr_db(mse), "invalid": max(broken, int(lost))}


def _case_columns(case: Case) -> Row:
    layout, setting, size = case.plan.layout, case.setting, case.plan.size
    row: Row = {"effect": case.effect.name, "pipeline": case.pipeline.name, "scene": case.maker.name}
    row |= {"size": f"{size[0]}x{size[1]}", "lights": setting.lights, "objects": setting.objects, "seed": setting.seed}
    row |= {"layout": layout.name, "depth": case.depth, "normal_bits": None if case.depth else layout.normal_bits}
    if case.depth:
        return row
    return row | {
        "encoding": layout.codec.encoding.name,
        "storage": layout.normal_storage,
        "rounding": layout.rounding,
    }


def in_order(rows: Sequence[Row]) -> list[Row]:
    """Rows by effect, pipeline and scene as they come; normal codes by their bits, the best first, then depth codes."""
    groups = list(dict.fromkeys(group_of(row) for row in rows))

    def place(row: Row) -> tuple[int, bool, int, bool, float]:
        apart = row["effect_rms"]
        bits = row.get("normal_bits") or 0
        return groups.index(group_of(row)), row["depth"] is not None, bits, apart is None, apart or 0.0

    return sorted(rows, key=place)


def group_of(row: Row) -> tuple[str, ...]:
    """What rows are of that are compared with each other."""
    return row["effect"], row["pipeline"], row["scene"]
