"""Steps that render frames: a row of figures against a reference and, on request, pictures."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

from ...gbuffer.display import CLIPPED_ALONE, Display
from ...gbuffer.frame.plan import Plan
from ...gbuffer.gl.device import Device, FormatError
from ...gbuffer.gl.shader import ShaderError
from ...gbuffer.pipelines import PIPELINES, Pipeline
from ...gbuffer.render import Timing
from ...gbuffer.scenes.catalogue import SceneMaker
from ...gbuffer.scenes.scene import Scene
from ...gbuffer.scenes.setting import Setting
from ..ground.machine.devices import require_device, require_jax
from ..ground.machine.memory import give_back_what_is_freed
from ..ground.options.counts import MAX_REPEATS, in_range
from ..ground.output.errors import UsageError
from ..ground.output.writing import check_folder
from ..measures.metrics.flip import Flip
from ..measures.metrics.images import squared_error
from ..measures.metrics.totals import psnr_db
from ..subjects.normals.normal_names import SEES_NOTHING
from .table import Row, Step, Tick

STAGES = tuple(dict.fromkeys(stage.name for pipeline in PIPELINES.values() for stage in pipeline.stages))
# Why a device may not be able to give a row.
UNMEASURABLE = (ShaderError, FormatError)
# A scene that covers less of its picture, in percent, leaves few pixels to judge by.
LEAST_COVERED = 100 / 3


@dataclass(frozen=True)
class Frame:
    """A rendered image.

    Attributes:
        linear: linear light, float32 of shape (height, width, 3).
        display: the exposure and the tone mapping for display.
        times: the columns of the frame's times; empty if it was not timed.
        flip: FLIP against the reference, of shape (height, width); None if it was not requested.
    """

    linear: np.ndarray
    display: Display = field(default=CLIPPED_ALONE, kw_only=True)
    times: Row = field(default_factory=dict, kw_only=True)
    flip: np.ndarray | None = field(default=None, kw_only=True)

    @cached_property
    def shown(self) -> np.ndarray:
        """The displayed image, with values in [0, 1]."""
        return self.display.image(self.linear)

    @cached_property
    def compared(self) -> Flip:
        """The FLIP comparison of other frames with this frame."""
        return Flip(self.shown)


class Measurable(Protocol):
    """A hashable case that a row is measured for, and the reference for its figures."""

    @property
    def reference(self) -> Any: ...


CaseT = TypeVar("CaseT", bound=Measurable)
FrameT = TypeVar("FrameT", bound=Frame)


class Bench(ABC, Generic[CaseT, FrameT]):
    """A bench that measures cases and renders each reference once.

    Args:
        device: the device that renders.
        repeats: number of frames to time; 0 for no times.
        with_flip: whether to compute FLIP.
    """

    def __init__(self, device: Device, repeats: int, with_flip: bool):
        self.device, self._repeats, self._with_flip = device, repeats, with_flip
        self._references: dict[CaseT, list[FrameT]] = {}
        # Cases of one scene follow each other, and a head takes longer to make than to render.
        self.scene = lru_cache(maxsize=1)(_made_scene)

    @abstractmethod
    def about(self, case: CaseT) -> Row:
        """Return a row without figures."""

    @abstractmethod
    def frames(self, case: CaseT, repeats: int = 0) -> list[FrameT]:
        """Render a case at each of its points in time; if `repeats` is not 0, time the last frame."""

    @abstractmethod
    def display(self, case: CaseT, frames: list[FrameT]) -> Display:
        """Return the display settings for a reference and for every image compared with it."""

    @abstractmethod
    def figures(self, case: CaseT, frames: list[FrameT], exact: list[FrameT]) -> Row:
        """Return the figures that compare frames with the reference; at least `skipped` if there are no figures."""

    def reference(self, case: CaseT) -> list[FrameT]:
        """Return the frames of a case's reference."""
        return self._kept(case.reference)

    def _kept(self, case: CaseT, frames: list[FrameT] | None = None) -> list[FrameT]:
        """Return the frames of a case that is a reference, and keep them for later calls.

        Args:
            frames: the frames of the case if they are already rendered; None to render them."""
        if case not in self._references:
            frames = self.frames(case) if frames is None else frames
            display = self.display(case, frames)
            self._references[case] = [replace(frame, display=display) for frame in frames]
        return self._references[case]

    def measure(self, case: CaseT) -> tuple[Row, FrameT | None]:
        """Return the row of a case and its first frame. If the case cannot be measured, `skipped` gives the reason,
        and the frame is None.

        Raises:
            UsageError: no surface of the scene is visible.
        """
        row = self.about(case)
        try:
            frames = self.frames(case, self._repeats)
            exact = self._kept(case, frames) if case == case.reference else self.reference(case)
            frames = [replace(frame, display=exact[0].display) for frame in frames]
            row |= self.figures(case, frames, exact)
        except UNMEASURABLE as error:
            return row | {"skipped": str(error)}, None
        if row["skipped"]:
            return row, None
        row |= frames[-1].times
        if self._with_flip:
            maps = [other.compared.of(frame.shown) for frame, other in zip(frames, exact, strict=True)]
            row["flip"] = float(np.mean([np.mean(pixels) for pixels in maps]))
            return row, replace(frames[0], flip=maps[0])
        return row, frames[0]


def _made_scene(maker: SceneMaker, setting: Setting) -> Scene:
    return maker.make(setting)


def image_figures(frames: Sequence[Frame], exact: Sequence[Frame]) -> Row:
    """Return columns that compare displayed images: `mse`, the mean over frames; its `psnr_db`; and `invalid`, the
    number of pixels in all frames that are not finite."""
    errors = [squared_error(frame.shown, other.shown) for frame, other in zip(frames, exact, strict=True)]
    mse = float(np.mean([error for error, _ in errors]))
    return {"mse": mse, "psnr_db": psnr_db(mse), "invalid": sum(broken for _, broken in errors)}


def time_columns(timings: Mapping[str, Timing], clock: str) -> Row:
    """Return columns of times in milliseconds: the medians for each pass and for the frame, prefixed with `ms_`;
    `ms_frame_spread`, the interquartile range for the frame; and `clock`."""
    row: Row = {f"ms_{name}": timing.median for name, timing in timings.items()}
    return row | {"ms_frame_spread": timings["frame"].spread, "clock": clock}


def described(pipeline: Pipeline, plan: Plan, setting: Setting, asked: int) -> Row:
    """Return the columns that describe how a row was rendered; settings that do not affect the pipeline are None.

    Args:
        asked: requested samples per pixel; `plan.samples` is the number that the device provides.
    """
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


def require_surface(maker: SceneMaker, is_seen: bool) -> None:
    """Raise UsageError if no surface in a scene is visible."""
    if not is_seen:
        raise UsageError(f"{maker.name}: {SEES_NOTHING}")


def says_little(scene: str, covered: float) -> Iterator[str]:
    """Yield a remark on a scene whose surfaces cover only a few percent of its image, but more than 0.

    Args:
        covered: the part of the image that surfaces cover, in percent."""
    if 0 < covered < LEAST_COVERED:
        what = f"{scene}: surfaces cover only {covered:.0f}% of the image"
        yield f"{what}; move the camera in the file closer for more pixels to compare"


def checked_device(repeats: int, least: int = 0) -> Device:
    """Return the device that renders frames.

    Raises:
        UsageError: `repeats` is out of range.
        MissingError: no device is available, or JAX is missing.
    """
    require_jax()
    device = require_device()
    in_range("--repeats", repeats, least, MAX_REPEATS)
    return device


@dataclass(frozen=True)
class Shot:
    """A case, the bench that measures it, and the folder for its pictures, if any.

    Attributes:
        bench: an object with the methods `reference`, and `measure`, which returns a case's row and frame (None if
            the case was not drawn).
        case: the case to measure.
        images: the folder for pictures; None for no pictures.
    """

    bench: Any
    case: Any
    images: Path | None


def shot_steps(bench: Any, cases: Sequence[Any], images: Path | None, key: Callable[[Any], Row]) -> list[Step]:
    """Return a step for each case. Raises UsageError if pictures cannot be written.

    Args:
        images: the folder for pictures; None for no pictures.
        key: a function from a case to the key columns of its step."""
    if images:
        check_folder(images)
    return [Step(key(case), Shot(bench, case, images), case.name) for case in cases]


def by_shots(write: Callable[[Path, Row, Any, Any], None]) -> Callable[[Sequence[Step], Tick], Iterator[list[Row]]]:
    """Return the `measure` function of a Work whose steps have shots as cases.

    Args:
        write: a function that writes the pictures, given the folder, the row, the frame and its reference.
    """

    def measure(steps: Sequence[Step], tick: Tick) -> Iterator[list[Row]]:
        writing: Future[list[Row]] | None = None
        # The pictures of one step are written while the next is rendered, which leaves much of a core idle.
        with ThreadPoolExecutor(1) as pool:
            for step in steps:
                shot: Shot = step.case
                row, drawn = shot.bench.measure(shot.case)
                pictures = (drawn, shot.bench.reference(shot.case)) if shot.images and drawn else None
                if writing:
                    yield writing.result()
                writing = pool.submit(written, shot.images, row, pictures)
                del drawn, pictures
                give_back_what_is_freed()
                tick(step.name)
            if writing:
                yield writing.result()

    def written(images: Path | None, row: Row, pictures: tuple[Any, Any] | None) -> list[Row]:
        if images and pictures:
            write(images, row, *pictures)
        return [row]

    return measure


def name_of_file(effects: str) -> str:
    """Return effects for use in a file name: each run of characters other than letters, digits, `_` and `.` is
    replaced by `_`."""
    return re.sub(r"[^\w.]+", "_", effects)
