"""What `depth` does."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ....encodings.catalogue import DEPTH_ENCODINGS, LIGHT_BUFFERS
from ....encodings.codecs.depth_codec import REBUILDS, DepthCodec
from ....encodings.position import Camera
from ....encodings.storages.depth_storage import DEPTH_STORAGES
from ....gbuffer.frame.frame import Plan
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.render import rendering
from ....gbuffer.scenes.catalogue import SCENES
from ....gbuffer.scenes.setting import Setting
from ....reports.charts import pictures, plots
from ...options.command_options import DepthOptions
from ...options.counts import check_seed, checked_numbers, in_range
from ...output.errors import UsageError, pick
from ...output.progress import progress
from ...output.writing import check_folder, check_writable, say_skipped, whole_file, write
from ..quality.measure import require_device, require_jax
from ..render.command import what_is_left
from . import measure as depth

# Nothing nearer or farther; float32 has room on both sides.
NEAREST, FARTHEST = 1e-6, 1e9
# Planes closer to each other than that leave nothing to measure between them.
LEAST_RATIO = 1.01
# Points of one code at all its distances: held at once, at some 200 bytes each.
MAX_POINTS = 2**22
CURVE, CURVE_COUNT = 33, 2**11
SCENE, SIZE = SCENES["room"], (640, 480)
# What a narrow terminal goes without, the first first.
EXPENDABLE = ("device", "rounded_by", "signs_lost", "bits", "mean_even", "rebuilt", "far")


@dataclass(frozen=True, kw_only=True)
class DepthRequest(DepthOptions):
    """What to measure, as typed: names and numbers are comma-separated; None is what is usual."""

    def cases(self) -> list[depth.Case]:
        """One case for each code, way to the position, near and far plane, and back end.

        Raises:
            UsageError: unknown names, or numbers beyond what is possible.
            MissingError: only GLSL is asked for and there is no GL device.
        """
        check_seed(self.seed)
        if not 1 <= self.fov <= 170:
            raise UsageError(f"--fov {self.fov:g}: degrees from 1 to 170")
        cameras = [Camera(near, far, self.fov, depth.ASPECT) for near, far in self._ranges()]
        distances = {camera: self._distances(camera) for camera in cameras}
        self._check_count(max(map(len, distances.values())))
        backends = pick("back end", self.backend, {name: name for name in depth.BACKENDS})
        codecs = self._codecs()
        require_jax()
        if backends == ["glsl"]:
            require_device()
        return [
            depth.Case(codec, way, backend, camera, distances[camera], self.count, self.seed)
            for camera in cameras
            for codec, way in codecs
            for backend in backends
        ]

    def _codecs(self) -> list[tuple[DepthCodec, str]]:
        """Codes with the ways to their positions; those that cannot be are named on standard error."""
        made: list[tuple[DepthCodec, str]] = []
        complaints: list[str] = []
        asked = None if self.rebuild is None else pick("rebuild", self.rebuild, {name: name for name in REBUILDS})
        for encoding in pick("depth", self.depth, DEPTH_ENCODINGS):
            names = ",".join(encoding.storages) if self.storage is None else self.storage
            for storage in pick("depth storage", names, DEPTH_STORAGES):
                codec = DepthCodec(encoding, storage)
                if codec.misfit:
                    complaints.append(f"{codec.name}: {codec.misfit}")
                    continue
                known = depth.ways(codec)
                chosen = known[:1] if asked is None else [way for way in asked if way in known]
                made += [(codec, way) for way in chosen]
                if not chosen:
                    complaints.append(f"{codec.name}: its number is no depth buffer's, which inverse_projection needs")
        return what_is_left(made, complaints)

    def _ranges(self) -> list[tuple[float, float]]:
        """Every near plane with every far plane. Raises UsageError where they do not go together."""
        ranges = [(near, far) for far in _numbers("--far", self.far) for near in _numbers("--near", self.near)]
        for near, far in ranges:
            if far < LEAST_RATIO * near:
                raise UsageError(f"--near {near:g} --far {far:g}: far is at least {LEAST_RATIO:g} times near")
        return ranges

    def _distances(self, camera: Camera) -> tuple[float | None, ...]:
        """What is asked for, or every power of ten; and None, the whole range."""
        if self.distance is None:
            powers = range(math.ceil(math.log10(camera.near) - 1e-9), math.floor(math.log10(camera.far) + 1e-9) + 1)
            return (*(10.0**power for power in powers), None)
        found = _numbers("--distance", self.distance)
        for distance in found:
            if not camera.near <= distance <= camera.far:
                raise UsageError(f"--distance {distance:g}: not between near {camera.near:g} and far {camera.far:g}")
        return (*found, None)

    def _check_count(self, distances: int) -> None:
        in_range("--count", self.count, 2, MAX_POINTS // distances)


def _numbers(option: str, text: str) -> tuple[float, ...]:
    return checked_numbers(option, text, float, NEAREST, FARTHEST)


def depth_command(
    request: DepthRequest, images: Path | None, plot: Path | None, format: str, output: Path | None
) -> None:
    """Measure, write the pictures and the plot if asked for, then the rows."""
    cases = request.cases()
    if plot:
        plots.check_format(plot)
    for path in filter(None, (plot, output)):
        check_writable(path)
    scene = _scene(images, cases) if images else None
    chosen = _for_drawing(cases)
    with progress(len(cases) + len(chosen) * (bool(images) + bool(plot))) as tick:
        rows = list(depth.rows(cases, tick))
        say_skipped(rows)
        if images and scene:
            _write_pictures(chosen, scene, images, tick)
        if plot:
            lines = [row for case in chosen for row in _curve(case, tick)]
            with whole_file(plot) as partial:
                plots.save(plots.depth_figure(lines), (partial, plot.suffix[1:].lower()))
    write(_beside(rows) if format == "table" else rows, format, output, EXPENDABLE)


def _beside(rows: Sequence[depth.Row]) -> list[depth.Row]:
    """A line for each code, camera, way and back end: the worst error at each distance, and of points spread evenly the
    worst and the mean."""
    lines: dict[tuple[object, ...], depth.Row] = {}
    names = ("depth", "storage", "bits", "rebuilt", "backend", "near", "far", "fov")
    for row in rows:
        line = lines.setdefault(tuple(row[name] for name in names), {name: _said(row[name]) for name in names})
        if row["distance"] is not None:
            line[f"max_{row['distance']:g}"] = row["error_max"]
        else:
            line |= {"max_even": row["error_max"], "mean_even": row["error_mean"], "signs_lost": row["signs_lost"]}
            line |= {"count": row["count"], "rounded_by": row["rounded_by"], "device": row["device"]}
    distances = sorted({row["distance"] for row in rows if row["distance"] is not None})
    last = ("max_even", "mean_even", "signs_lost", "count", "rounded_by", "device")
    columns = (*names, *(f"max_{distance:g}" for distance in distances), *last)
    return [{column: line.get(column) for column in columns} for line in lines.values()]


def _said(value: object) -> object:
    """What was asked for as it was typed, where a figure would have its digits."""
    return f"{value:g}" if isinstance(value, float) else value


def _for_drawing(cases: Iterable[depth.Case]) -> list[depth.Case]:
    """One case for each code, camera and way to the position: by GLSL where that was asked for."""
    chosen = {(c.codec, c.camera, c.rebuilt): c for c in sorted(cases, key=lambda c: c.backend, reverse=True)}
    return [case for case in cases if case in chosen.values()]


def _curve(case: depth.Case, tick: Callable[[str], None]) -> list[depth.Row]:
    """A case's rows at many distances, close to each other; by JAX where the device cannot."""
    distances = np.geomspace(case.camera.near, case.camera.far, CURVE).tolist()
    fine = replace(case, distances=tuple(distances), count=CURVE_COUNT)
    rows = depth.measure(fine)
    tick(case.name)
    return depth.measure(replace(fine, backend="jax")) if rows[0]["skipped"] else rows


@dataclass(frozen=True)
class Seen:
    """A scene's depths.

    Attributes:
        depths: view depth, float32 of shape (height, width), row 0 on top; 0 where there is nothing.
        fov: the camera's vertical field of view in degrees.
    """

    depths: np.ndarray
    fov: float

    def within(self, camera: Camera) -> np.ndarray:
        """Which pixels lie between near and far, bool of shape (height, width)."""
        return (self.depths >= np.float32(camera.near)) & (self.depths <= np.float32(camera.far))

    def points(self, camera: Camera) -> depth.Points:
        """The pixels' middles at the depths of what is seen there; what is not within the range is at its far end."""
        height, width = self.depths.shape
        x, y = (np.arange(width) + 0.5) / width * 2 - 1, 1 - (np.arange(height) + 0.5) / height * 2
        places = np.stack(np.meshgrid(x, y), axis=-1).astype(np.float32).reshape(-1, 2)
        depths = np.where(self.within(camera), self.depths, np.float32(camera.far))
        return depth.Points(places, depths.ravel().astype(np.float32))


def _scene(folder: Path, cases: Iterable[depth.Case]) -> Seen:
    """What the pictures show, rendered in 32-bit floats.

    Raises:
        MissingError: there is no GL device.
        UsageError: the folder cannot be written to, or a range leaves nothing to see.
    """
    device = require_device()
    check_folder(folder)
    plan = Plan(SIZE, 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], 2, False, 1.0)
    scene = SCENE.make(Setting())
    with rendering(device, PIPELINES["prepass"], scene, plan) as made:
        made.draw()
        seen = Seen(-made.gbuffer()[0][..., 2], scene.view.fov)
    there = seen.depths[seen.depths > 0]
    for camera in dict.fromkeys(case.camera for case in cases):
        if not seen.within(camera).any():
            raise UsageError(
                f"--near {camera.near:g} --far {camera.far:g}: nothing of the pictures' scene, {SCENE.name}, lies "
                f"there; its depths are {there.min():.3g} to {there.max():.3g}"
            )
    return seen


def _write_pictures(cases: Iterable[depth.Case], scene: Seen, folder: Path, tick: Callable[[str], None]) -> None:
    """Two pictures of each case, and for each range a sheet of them all."""
    sheets: dict[str, dict[str, dict[str, np.ndarray]]] = {}
    for case in cases:
        camera = replace(case.camera, fov=scene.fov, aspect=SIZE[0] / SIZE[1])
        points, covered = scene.points(camera), scene.within(camera)
        found = _through(replace(case, camera=camera), points)
        errors, positions = found.errors.reshape(covered.shape), found.positions.reshape(*covered.shape, 3)
        two = pictures.depth_pictures(errors, positions, covered)
        where = f"{SCENE.name}-{camera.near:g}-{camera.far:g}"
        for kind, pixels in two.items():
            name = f"{where}-{case.codec.name.replace('/', '-')}-{case.rebuilt}-{kind}.png"
            with whole_file(folder / name) as partial:
                pictures.write_png(partial, pixels)
        caption = f"{case.codec.name} by {case.rebuilt}, {errors[covered].max():.1g}".replace("_", " ")
        sheets.setdefault(where, {})[caption] = two
        tick(case.name)
    for where, rows in sheets.items():
        with whole_file(folder / f"{where}.png") as partial:
            pictures.write_png(partial, pictures.contact_sheet(rows, columns=2))


def _through(case: depth.Case, points: depth.Points) -> depth.Measured:
    try:
        return depth.through(case, points)
    except depth.UNMEASURABLE:
        return depth.through(replace(case, backend="jax"), points)
