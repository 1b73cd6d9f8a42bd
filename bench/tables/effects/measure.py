"""Measurement of the effects table: how encodings in the G-buffer affect effects that read it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ....gbuffer.display import Display
from ....gbuffer.effects.denoise import EXACT_RAYS, Denoiser
from ....gbuffer.effects.effect import ChosenEffect
from ....gbuffer.effects.occlusion.passes import AmbientOcclusion
from ....gbuffer.frame.plan import Plan
from ....gbuffer.frame.resources import FINAL
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import Pipeline
from ....gbuffer.render import Rendering, rendering
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.scene import Scene
from ....gbuffer.scenes.setting import Setting
from ...ground.angles import angles_deg
from ...ground.output.errors import MissingError, tell
from ...measures.metrics.occlusion_error import method_error
from ...measures.metrics.totals import psnr_db
from ..shots import Bench, Frame, image_figures, time_columns
from ..table import Row
from .table import TABLE

DENOISING = ("lost_neighbours_percent", "gained_neighbours_percent", "lost_histories_percent")
# Of the distance to what the camera looks at: how far it moves to the right between two frames of a denoiser, which is
# a pixel or two.
SIDESTEP = 1 / 200


@dataclass(frozen=True)
class EffectsCase:
    """A row of the effects table to measure.

    Attributes:
        effect: effect that reads the G-buffer.
        pipeline: pipeline with the effect in it.
        plan: plan with which the scene is rendered.
        maker, setting: the scene, and the setting with which it is made.
        depth: name of the depth encoding if the row measures one, otherwise None.
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
    def reference(self) -> EffectsCase:
        """The case of the same effect with a G-buffer of 32-bit floats."""
        return replace(self, plan=replace(self.plan, layout=LAYOUTS["fp32"]), depth=None)


@dataclass(frozen=True)
class Denoising:
    """A denoiser's input in the frames of a case, and its rejections.

    Attributes:
        noisy: its input in each frame, (height, width, 4).
        has_history: which pixels had a history in each frame but the first, bool of shape (height, width).
        weights: weight of each pixel's neighbours in the first pass of the filter, in the last frame, (height, width).
    """

    noisy: Sequence[np.ndarray]
    has_history: Sequence[np.ndarray]
    weights: np.ndarray


@dataclass(frozen=True)
class Drawn(Frame):
    """A rendered frame, with the effect's own image.

    Attributes:
        own: the effect's own image, (height, width, channels).
        normals: the normals decoded from the G-buffer, (height, width, 3).
        covered: mask of the pixels that the effect covers, bool of shape (height, width).
        hits: point that the first ray of each pixel hits, (height, width, 4), as described in `Effect.hits`; None
            for an effect without rays.
        denoising: None for effects that are not denoisers.
    """

    own: np.ndarray
    normals: np.ndarray
    covered: np.ndarray
    hits: np.ndarray | None
    denoising: Denoising | None = None


class EffectsBench(Bench[EffectsCase, Drawn]):
    """The bench of the effects table, which renders each reference once.

    Args:
        device, repeats, with_flip: as for every bench.
        rays: rays per point for measuring the method's own error; 0 to leave it out.
    """

    def __init__(self, device: Device, repeats: int, rays: int, with_flip: bool):
        super().__init__(device, repeats, with_flip)
        self._rays = rays
        self._methods: dict[EffectsCase, Row] = {}

    def about(self, case: EffectsCase) -> Row:
        row = TABLE.empty(stage.name for stage in case.effect.passes()) | _case_columns(case)
        return row | {"device": self.device.renderer}

    def frames(self, case: EffectsCase, repeats: int = 0) -> list[Drawn]:
        effect, scene = case.effect.effect, self.scene(case.maker, case.setting)
        # Rendered first: its rays are given to this case.
        given = self._rays_of_reference(case)
        with rendering(self.device, case.pipeline, scene, case.plan) as drawing:
            denoising = _denoised(drawing, case.effect, scene, given) if isinstance(effect, Denoiser) else None
            if not denoising:
                drawing.draw()
            position, direction, *_ = drawing.gbuffer()
            own, hits = drawing.read(effect.result)[0], drawing.read(effect.hits)[0] if effect.hits else None
            covered = drawn_at(own, position[..., 2] != 0)
            times = _effect_times(case, drawing, repeats) if repeats else {}
            return [Drawn(drawing.image(), own[..., :3], direction[..., :3], covered, hits, denoising, times=times)]

    def _rays_of_reference(self, case: EffectsCase) -> Sequence[np.ndarray]:
        """Return the denoiser's input in each frame of the reference, if the case is to have the same; else nothing."""
        if case == case.reference or dict(case.effect.values).get("rays") != EXACT_RAYS:
            return ()
        (exact,) = self.reference(case)
        return exact.denoising.noisy if exact.denoising else ()

    def display(self, case: EffectsCase, frames: list[Drawn]) -> Display:
        (frame,) = frames
        return case.maker.display(frame.linear[frame.covered])

    def figures(self, case: EffectsCase, frames: list[Drawn], exact: list[Drawn]) -> Row:
        (drawn,), (other,) = frames, exact
        if not np.any(other.covered):
            return {"skipped": f"{case.effect.effect.name} shows nothing in this image"}
        image = image_figures(frames, exact)
        lost = np.count_nonzero(~np.isfinite(drawn.own[other.covered]).all(axis=-1))
        row = _distance_columns(drawn, other)
        if any(FINAL in stage.writes or stage.tells for stage in case.effect.passes()):
            row["psnr_db"] = image["psnr_db"]
        return row | {"invalid": max(image["invalid"], int(lost))} | self._method(case.reference)

    def _method(self, case: EffectsCase) -> Row:
        """Return columns with the effect's error against ray casting, from exact normals; empty without a ray caster,
        or if the effect is not ambient occlusion."""
        if not self._rays or not isinstance(case.effect.effect, AmbientOcclusion):
            return {}
        if case not in self._methods:
            self._methods[case] = self._method_columns(case)
        return self._methods[case]

    def _method_columns(self, case: EffectsCase) -> Row:
        scene = self.scene(case.maker, case.setting)
        try:
            errors = method_error(self.device, case.effect, scene, case.plan.size, rays=self._rays)
        except MissingError as error:
            tell(f"method_rms is empty: {error}")
            return {}
        return {"method_rms": errors.rms, "method_mean": errors.mean}


def moved_cameras(scene: Scene, frames: int) -> Iterator[Scene]:
    """Yield a scene with its camera moving to the right, SIDESTEP further in each frame."""
    view = previous = scene.view
    right = scene.view.matrix()[0, :3] * SIDESTEP * np.linalg.norm(np.subtract(view.target, view.eye))
    for frame in range(frames):
        eye, target = (tuple(np.add(place, frame * right).tolist()) for place in (scene.view.eye, scene.view.target))
        previous, view = view, replace(scene.view, eye=eye, target=target)
        yield replace(scene, view=view, previous=previous)


def _denoised(drawing: Rendering, effect: ChosenEffect, scene: Scene, given: Sequence[np.ndarray]) -> Denoising:
    """Draw the frames of a denoiser, with the input `given` for each frame unless it is empty."""
    denoiser, frames = effect.effect, int(dict(effect.values)["frames"])
    assert isinstance(denoiser, Denoiser)
    noisy, has_history = [], []
    for frame, shown in enumerate(moved_cameras(scene, frames)):
        is_last = frame == frames - 1
        rays = (denoiser.noisy, given[frame]) if given else None
        drawing.draw(shown, given=rays, only=None if is_last else denoiser.history)
        noisy.append(drawing.read(denoiser.noisy)[0])
        if frame:
            has_history.append(drawing.read(denoiser.history)[0][..., 3] > 1)
    return Denoising(noisy, has_history, drawing.read(denoiser.weights)[0][..., 0])


def _effect_times(case: EffectsCase, rendered: Rendering, repeats: int) -> Row:
    """Return the milliseconds of each pass of the effect, of all its passes and of the frame, and the clock."""
    columns = time_columns(*rendered.timings(repeats))
    names = [f"ms_{stage.name}" for stage in case.effect.passes()]
    row: Row = {name: columns[name] for name in (*names, "ms_frame", "clock")}
    return row | {"ms_effect": sum(row[name] for name in names)}


def drawn_at(own: np.ndarray, surfaces: np.ndarray) -> np.ndarray:
    """Return a mask of the pixels that an effect covers, bool of shape (height, width): pixels with alpha above 0, or
    all surfaces if the image has no alpha."""
    return own[..., 3] > 0 if own.shape[-1] == 4 else surfaces


def _distance_columns(drawn: Drawn, exact: Drawn) -> Row:
    """Return the errors of the effect's own image and of the normals, compared with the exact frame."""
    covered = exact.covered
    own, other = (frame.own[covered].astype(np.float64) for frame in (drawn, exact))
    peak = float(np.max(np.abs(np.nan_to_num(other))))
    # What is no number is as far off as the brightest pixel is from none.
    apart = np.where(np.isfinite(own - other), np.abs(own - other), peak)
    mse, angles = float(np.mean(apart**2)), _angles(drawn, exact)
    row: Row = {"effect_rms": mse**0.5, "effect_mean": float(np.mean(apart)), "effect_max": float(np.max(apart))}
    row["effect_psnr_db"] = psnr_db(mse)
    if drawn.hits is not None and exact.hits is not None:
        row["moved_percent"] = moved_percent(drawn.hits, exact.hits)
    if drawn.denoising and exact.denoising:
        row |= _denoising_columns(drawn.denoising, exact.denoising)
    row |= {"normal_mean_deg": float(np.mean(angles)), "normal_max_deg": float(np.max(angles))}
    if row["normal_mean_deg"] > 0:
        row["slope"] = row["effect_mean"] / row["normal_mean_deg"]
    return row | {"exact": mse == 0}


def _denoising_columns(drawn: Denoising, exact: Denoising) -> Row:
    """Return what a denoiser rejects with a code and keeps with exact normals, and the reverse."""
    change, pairs = (
        drawn.weights.astype(np.float64) - exact.weights,
        zip(drawn.has_history, exact.has_history, strict=True),
    )
    weight = float(np.sum(exact.weights, dtype=np.float64))
    kept = sum(int(np.count_nonzero(has)) for has in exact.has_history)
    shares = (
        (float(np.sum(np.maximum(-change, 0))), weight),
        (float(np.sum(np.maximum(change, 0))), weight),
        (sum(int(np.count_nonzero(b & ~a)) for a, b in pairs), kept),
    )
    return {name: 100 * part / whole for name, (part, whole) in zip(DENOISING, shares, strict=True) if whole}


def moved_percent(hits: np.ndarray, exact: np.ndarray) -> float | None:
    """Return the percentage of pixels whose ray misses, or hits a point more than a pixel away from the exact hit,
    among pixels whose ray hits something in the exact frame; None if no exact ray hits anything.

    Args:
        hits, exact: arrays of shape (height, width, 4), as described in `Effect.hits`.
    """
    there = exact[..., 3] > 0
    if not np.any(there):
        return None
    is_near = np.linalg.norm(hits[..., :2] - exact[..., :2], axis=-1) <= 1
    return 100 * float(np.mean(~(is_near & (hits[..., 3] > 0))[there]))


def _angles(drawn: Drawn, exact: Drawn) -> np.ndarray:
    """Return the angles in degrees between the normals of two frames, at covered pixels where the exact frame has a
    normal; 180 for a normal that is not a number. A single 0 if there are no such pixels."""
    normals, other = drawn.normals[exact.covered], exact.normals[exact.covered]
    there = np.any(other != 0, axis=-1)
    return np.nan_to_num(angles_deg(other[there], normals[there]), nan=180.0) if np.any(there) else np.zeros(1)


def _case_columns(case: EffectsCase) -> Row:
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
    """Return the rows grouped by effect, pipeline and scene, in the order in which these first occur. In each group,
    encodings of normals come first, by bits and then by error, followed by encodings of depth."""
    groups = list(dict.fromkeys(group_of(row) for row in rows))

    def place(row: Row) -> tuple[int, bool, int, bool, float]:
        apart = row["effect_rms"]
        bits = row.get("normal_bits") or 0
        return groups.index(group_of(row)), row["depth"] is not None, bits, apart is None, apart or 0.0

    return sorted(rows, key=place)


def group_of(row: Row) -> tuple[str, ...]:
    """Return the effect, pipeline and scene of a row: rows that share all three are compared with each other."""
    return row["effect"], row["pipeline"], row["scene"]
