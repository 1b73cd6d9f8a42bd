"""Rows of the motion table: encoded normals alone, then highlights and images rendered with decoded normals."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS
from ....encodings.codecs.codec import Codec
from ....gbuffer.display import CLIPPED_ALONE, Display
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.render import Keeps, Rendering, rendering
from ....gbuffer.scenes.built_in.gloss import POWERS
from ....gbuffer.scenes.catalogue import SCENES
from ....gbuffer.scenes.scene import Scene, View
from ....gbuffer.scenes.setting import Setting
from ...measures.metrics.totals import psnr_db
from ..quality.measure import UNMEASURABLE
from ..table import Row
from . import highlights, panel, turning
from .code_wobble import Motion, code_wobble
from .highlights import Spots
from .table import TABLE
from .trips import Trip, backend_of, trip_of

# Rendered turns go as far to either side of the scene's own camera, in degrees, so that it stays in the picture.
PICTURE_SWING_DEG = 8.0
SCENE, PIPELINE = "gloss", "deferred"


@dataclass(frozen=True)
class FrameSequence:
    """A sequence of frames to render.

    Attributes:
        axis, turn, frames: axis of the camera's rotation, degrees per frame, and number of frames.
        size: width and height in pixels.
        setting: setting of the scene.
    """

    axis: str
    turn: float
    frames: int
    size: tuple[int, int]
    setting: Setting

    def views(self, view: View) -> Iterator[View]:
        """Yield the camera for each frame: the given camera, rotated by equal amounts to both sides."""
        angles = turning.angles(self.turn, self.frames, PICTURE_SWING_DEG)
        for angle in angles - np.max(angles) / 2:
            yield view.turned(self.axis, float(angle))


@dataclass(frozen=True)
class MotionCase:
    """A row of the motion table to measure.

    Attributes:
        codec: codec to measure.
        motion: rotation to follow.
        count, seed: number of normals to follow, and seed for choosing them.
        pictures: frames to render; None to render no frames.
    """

    codec: Codec
    motion: Motion
    count: int
    seed: int
    pictures: FrameSequence | None = None

    @property
    def name(self) -> str:
        motion = self.motion
        return f"{self.codec.name} {motion.space} {motion.moves} {motion.axis} {motion.turn:g}"


@dataclass
class Filmed:
    """A rendered sequence.

    Attributes:
        shown: the displayed image of each frame, float32 of shape (height, width, 3); only for exact normals.
        covered: mask of the surfaces in each frame, bool of shape (height, width).
        still, still_covered: image and mask from the scene's own camera.
        spheres: the sphere that each pixel shows, see highlights.spheres_of.
        lit: the displayed highlights: one frame for exact normals; for an encoding all frames, if they are kept.
        spots: positions and peaks of the highlights in each frame.
        display: conversion of highlights to displayed values.
        worst: the sphere whose highlights move the most with an encoding, numbered as in `spheres`; 0 for none.
    """

    shown: list[np.ndarray] = field(default_factory=list)
    covered: list[np.ndarray] = field(default_factory=list)
    still: np.ndarray | None = None
    still_covered: np.ndarray = field(default_factory=lambda: np.zeros((1, 1), bool))
    spheres: np.ndarray | None = None
    lit: list[np.ndarray] = field(default_factory=list)
    spots: list[Spots] = field(default_factory=list)
    display: Display = CLIPPED_ALONE
    worst: int = 0


class Bench:
    """A bench that measures cases and renders each reference only once.

    Args:
        device: device that renders frames; None if it is not needed.
        keeps_frames: whether the rendered frames are needed afterwards.
    """

    def __init__(self, device: Device | None, keeps_frames: bool):
        self._device, self._keeps_frames = device, keeps_frames
        self._references: dict[FrameSequence, Filmed] = {}
        self._panels: dict[tuple[str, float, int], panel.Exact] = {}

    def measure(self, case: MotionCase) -> tuple[Row, Filmed | None]:
        """Return the row of a case, and its frames if any were rendered; if the case cannot be measured, the row has
        the reason in `skipped`."""
        row = TABLE.empty([f"{power:g}" for power in POWERS]) | _case_columns(case)
        try:
            with trip_of(case.codec) as trip:
                row |= code_wobble(trip, case.codec.encoding.domain, case.motion, case.count, case.seed)
                if not case.pictures or not self._device:
                    return row, None
                filmed, columns = self._film_and_columns(case, case.pictures, trip)
                if case.motion.moves == turning.MOVES[0]:
                    columns |= self._panel_columns(case.motion, case.pictures.frames, trip)
        except UNMEASURABLE as error:
            return row | {"skipped": str(error)}, None
        return row | columns | {"device": self._device.renderer}, filmed

    def reference(self, case: MotionCase) -> Filmed:
        """Return the frames of exact normals, rendered once. Raises ValueError for a case without frames."""
        if not case.pictures or not self._device:
            raise ValueError(f"{case.name} has no frames")
        pictures = case.pictures
        if pictures not in self._references:
            with _projector(self._device, pictures) as projector:
                self._references[pictures] = _exact_film(projector)
        return self._references[pictures]

    def _panel_columns(self, motion: Motion, frames: int, trip: Trip) -> Row:
        assert self._device
        sums, asked = Differences(), (motion.axis, motion.turn, frames)
        with panel.going_around(self._device, *asked) as around:
            if asked not in self._panels:
                self._panels[asked] = panel.exact(around)
            keeps = partial(in_space, trip, motion.space)
            for difference, covered in panel.differences(around, self._panels[asked], keeps):
                sums.add(difference, covered)
        return {"panel_psnr_db": sums.static_db, "crawl_psnr_db": sums.wobble_db}

    def _film_and_columns(self, case: MotionCase, pictures: FrameSequence, trip: Trip) -> tuple[Filmed, Row]:
        assert self._device
        exact, filmed, sums, fixed = self.reference(case), Filmed(), Differences(), Differences()
        assert exact.spheres is not None and exact.still is not None
        with _projector(self._device, pictures) as projector:
            for index, view in enumerate(projector.views()):
                image = projector.image(view, in_space(trip, case.motion.space, view))
                sums.add(image - exact.shown[index], exact.covered[index])
            for matrices in case.motion.matrices():
                keeps = on_surfaces(trip, *matrices)
                fixed.add(projector.image(projector.scene.view, keeps) - exact.still, exact.still_covered)
                light = projector.highlights(keeps)
                filmed.spots.append(highlights.spots(light, exact.spheres))
                if self._keeps_frames:
                    filmed.lit.append(exact.display.image(light).astype(np.float32))
        row = {"static_psnr_db": sums.static_db, "wobble_psnr_db": sums.wobble_db}
        return filmed, row | {"reprojected_psnr_db": fixed.wobble_db} | _of_highlights(filmed, exact)


@dataclass
class Differences:
    """An encoding's error in the displayed images of a sequence, and its change from one image to the next."""

    static: list[float] = field(default_factory=list)
    moving: list[float] = field(default_factory=list)
    _before: tuple[np.ndarray, np.ndarray] | None = None

    def add(self, difference: np.ndarray, covered: np.ndarray) -> None:
        """Add the difference between a frame's image and the image of exact normals, (height, width, 3), with a mask
        of its surfaces."""
        # What is no number is as far off as can be.
        difference = np.where(np.isfinite(difference), difference, 1.0)
        self.static.append(float(np.mean(difference[covered] ** 2)))
        if self._before:
            both = covered & self._before[1]
            self.moving.append(float(np.mean((difference[both] - self._before[0][both]) ** 2)))
        self._before = difference, covered

    @property
    def static_db(self) -> float:
        """The PSNR of the images in decibels, peak 1."""
        return psnr_db(float(np.mean(self.static)))

    @property
    def wobble_db(self) -> float:
        """The PSNR, in decibels, of the change in the images' errors from frame to frame."""
        return psnr_db(float(np.mean(self.moving)))


@dataclass(frozen=True)
class Projector:
    """A sequence that is ready to render: scene gloss, and the same scene reduced to its highlights."""

    pictures: FrameSequence
    scene: Scene
    of_scene: Rendering
    of_lit: Rendering

    def views(self) -> Iterator[View]:
        """Yield the camera of each frame."""
        return self.pictures.views(self.scene.view)

    def image(self, view: View, keeps: Keeps | None = None) -> np.ndarray:
        """Return a frame as displayed, float32 of shape (height, width, 3); with exact normals without `keeps`."""
        self.of_scene.draw(replace(self.scene, view=view, previous=view), keeps)
        return Display(SCENES[SCENE].exposure or 0.0).image(self.of_scene.image()).astype(np.float32)

    def highlights(self, keeps: Keeps | None = None) -> np.ndarray:
        """Return a frame of highlights in linear light, (height, width, 3), in which each channel shows one light."""
        self.of_lit.draw(keeps=keeps)
        return self.of_lit.image()


@contextmanager
def _projector(device: Device, pictures: FrameSequence) -> Iterator[Projector]:
    scene, pipeline = SCENES[SCENE].make(pictures.setting), PIPELINES[PIPELINE]
    lit = highlights.lit_scene(scene)
    plan = Plan(pictures.size, 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], max(pipeline.light_targets), False, 1.0)
    with rendering(device, pipeline, scene, plan) as scene_drawing, rendering(device, pipeline, lit, plan) as other:
        yield Projector(pictures, scene, scene_drawing, other)


def _exact_film(projector: Projector) -> Filmed:
    filmed = Filmed()
    for view in projector.views():
        filmed.shown.append(projector.image(view))
        filmed.covered.append(projector.of_scene.gbuffer()[0][..., 2] != 0)
    filmed.still = projector.image(projector.scene.view)
    filmed.still_covered = projector.of_scene.gbuffer()[0][..., 2] != 0
    light = projector.highlights()
    position, _, albedo, _ = projector.of_lit.gbuffer()
    covered = position[..., 2] != 0
    filmed.spheres = highlights.spheres_of(albedo[..., 3], covered)
    # The brightest highlight is just not clipped.
    filmed.display = Display(-math.log2(peak)) if (peak := float(light.max())) > 0 else CLIPPED_ALONE
    filmed.spots.append(highlights.spots(light, filmed.spheres))
    filmed.lit.append(filmed.display.image(light).astype(np.float32))
    return filmed


def in_space(trip: Trip, space: str, view: View) -> Keeps:
    """Return a function that applies the round trip in `space` to the normals in a rotated camera's G-buffer; normals
    enter and leave it in view space."""
    to_view = view.matrix()[:3, :3] if space == turning.SPACES[1] else np.eye(3)

    def keeps(position: np.ndarray, n: np.ndarray) -> np.ndarray:
        return turned(trip(turned(n, to_view.T), position)[1], to_view)

    return keeps


def on_surfaces(trip: Trip, of_normals: np.ndarray, of_positions: np.ndarray) -> Keeps:
    """Return a function that applies the round trip to the normals in a still camera's G-buffer, encoded as a rotated
    camera would encode them.

    The frame looks as if the image rotated with the camera, so every surface stays at its pixel: changes come from
    the encoding, not from the raster of pixels.

    Args:
        trip: round trip of the codec.
        of_normals, of_positions: matrices from code_wobble.Motion.
    """

    def keeps(position: np.ndarray, n: np.ndarray) -> np.ndarray:
        return turned(trip(turned(n, of_normals), turned(position, of_positions))[1], of_normals.T)

    return keeps


def turned(rows: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Return vectors, (count, 3), multiplied by a matrix, as float32."""
    return (rows.astype(np.float64) @ matrix.T).astype(np.float32)


def _of_highlights(filmed: Filmed, exact: Filmed) -> Row:
    """Return the columns on highlights, and set `filmed.worst` to the number, from 1, of the sphere whose highlights
    move the most; empty if no highlight can be followed."""
    moved, flickered = highlights.wobble(filmed.spots, exact.spots[0])
    if not np.isfinite(moved).any():
        return {}
    filmed.worst = int(np.nanargmax(moved)) + 1
    row: Row = {"highlight_px": _root_mean(moved), "peak_percent": _root_mean(flickered)}
    for power, pixels, percent in zip(POWERS, moved, flickered, strict=True):
        row |= {f"highlight_px_{power:g}": _root_mean([pixels]), f"peak_percent_{power:g}": _root_mean([percent])}
    return row


def _root_mean(squares: Sequence[float] | np.ndarray) -> float | None:
    """Return the root of the mean of the finite values in `squares`; None if no value is finite."""
    finite = np.asarray(squares)[np.isfinite(squares)]
    return float(np.sqrt(np.mean(finite))) if len(finite) else None


def _case_columns(case: MotionCase) -> Row:
    codec, motion, pictures = case.codec, case.motion, case.pictures
    row: Row = {"encoding": codec.encoding.name, "storage": codec.storage.name, "rounding": codec.rounding}
    row |= {"space": motion.space, "moves": motion.moves, "axis": motion.axis, "turn_deg": motion.turn}
    row |= {"bits": codec.bits, "frames": motion.frames, "count": case.count, "seed": case.seed}
    row |= {"backend": backend_of(codec)}
    if pictures:
        row |= {"size": f"{pictures.size[0]}x{pictures.size[1]}", "lights": pictures.setting.lights}
    return row
