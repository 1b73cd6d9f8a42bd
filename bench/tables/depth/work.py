"""Measurement and display of the depth table."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS
from ....encodings.codecs.depth_codec import REBUILDS, DepthCodec
from ....encodings.kinds import DEPTH
from ....encodings.shared.position import Camera
from ....encodings.storages.depth_storage import DEPTH_STORAGES
from ....encodings.storages.storage import ROUNDINGS_AND_DITHERED
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.render import rendering
from ....gbuffer.scenes.catalogue import SCENES
from ....gbuffer.scenes.setting import Setting
from ....reports.charts import pictures
from ....reports.charts.chart import Chart
from ...ground.choose import choose
from ...ground.machine.devices import require_device
from ...ground.options.counts import check_seed, checked_numbers, in_range
from ...ground.options.targets import what_is_left
from ...ground.options.words import Names
from ...ground.output.errors import UsageError
from ...ground.output.writing import check_folder, whole_file
from ...subjects.codecs.kinds.codecs import codecs_of_kind
from ...subjects.names.backends import backends_here
from ...subjects.names.storages import roundings_named
from ..charts import but_without_twins, having
from ..table import Measured, Row, Sheet, Step, Tick, Work, each
from ..unmeasurable import UNMEASURABLE
from ..verdicts import by_bits
from . import measure
from .charts import charts, depth_chart
from .frames import check_and_say, frames_named
from .table import TABLE, DepthOptions, DepthOutputs

# Nothing nearer or farther; float32 has room on both sides.
NEAREST, FARTHEST = 1e-6, 1e9
# Planes closer to each other than that leave nothing to measure between them.
LEAST_RATIO = 1.01
# Points of one code at all its distances: held at once, at some 200 bytes each.
MAX_POINTS = 2**22
BUFFERS = [name for name, storage in DEPTH_STORAGES.items() if storage.home == "attachment"]
CURVE, CURVE_COUNT = 33, 2**11
SCENE, SIZE = SCENES["room"], (640, 480)
USUAL_FOV = 60.0


def cases(options: DepthOptions) -> list[measure.DepthCase]:
    """Return one case for each backend, each encoding with a way to rebuild positions, and each camera or depth
    image.

    Raises:
        UsageError: unknown names, or numbers out of range.
        MissingError: only GLSL is requested and there is no OpenGL device.
    """
    check_seed(options.seed)
    fov = USUAL_FOV if options.fov is None else options.fov
    if not 1 <= fov <= 170:
        raise UsageError(f"--fov {fov:g}: out of range; use 1 to 170 degrees")
    cameras = [Camera(near, far, fov, measure.ASPECT) for near, far in _ranges(options)]
    distances = {camera: _distances(options, camera) for camera in cameras}
    in_range("--count", options.count, 2, MAX_POINTS // max(map(len, distances.values())))
    chosen = codecs(options)
    backends = backends_here(options.backend, measure.BACKENDS)
    views = [(camera, distances[camera], None) for camera in cameras]
    if frames := frames_named(options):
        check_and_say(frames, cameras)
        views = [
            (replace(camera, aspect=depth_image.aspect), (None,), depth_image)
            for depth_image in frames
            for camera in cameras
        ]
    return [
        measure.DepthCase(codec, way, backend, camera, case_distances, options.count, options.seed, frame)
        for camera, case_distances, frame in views
        for codec, way in chosen
        for backend in backends
    ]


def codecs(options: DepthOptions) -> list[tuple[DepthCodec, str]]:
    """Return pairs of a codec and a way to rebuild positions; impossible pairs are named on standard error."""
    pairs: list[tuple[DepthCodec, str]] = []
    complaints: list[str] = []
    roundings = roundings_named(options.rounding, ROUNDINGS_AND_DITHERED)
    asked = None if options.rebuild is None else choose("rebuild", options.rebuild, {name: name for name in REBUILDS})
    for codec in codecs_of_kind(DEPTH, options.depth, options.storage, roundings):
        if codec.misfit:
            complaints.append(f"{codec.name}: {codec.misfit}")
            continue
        known = measure.ways(codec)
        chosen = measure.usual_ways(codec) if asked is None else [way for way in asked if way in known]
        pairs += [(codec, way) for way in chosen]
        if not chosen:
            ways = ", ".join(asked or ())
            complaints.append(f"{codec.name}: {ways}: only for encodings stored in a depth buffer")
    return what_is_left(pairs, complaints)


def _ranges(options: DepthOptions) -> list[tuple[float, float]]:
    """Return all pairs of a near and a far plane. Raises UsageError if a far plane is too close to a near plane."""
    nears, fars = _numbers("--near", options.near), _numbers("--far", options.far)
    for far in fars:
        for near in nears:
            if far < LEAST_RATIO * near:
                raise UsageError(f"--near {near:g} --far {far:g}: far must be at least {LEAST_RATIO:g} times near")
    return [(near, far) for far in fars for near in nears]


def _distances(options: DepthOptions, camera: Camera) -> tuple[float | None, ...]:
    """Return the requested distances; by default every power of ten in the camera's range, then None for the whole
    range. Raises UsageError for a distance outside the range."""
    if options.distance is None:
        powers = range(math.ceil(math.log10(camera.near) - 1e-9), math.floor(math.log10(camera.far) + 1e-9) + 1)
        return (*(10.0**power for power in powers), None)
    distances = _numbers("--distance", options.distance)
    for distance in distances:
        if not camera.near <= distance <= camera.far:
            raise UsageError(f"--distance {distance:g}: not between near {camera.near:g} and far {camera.far:g}")
    return (*distances, None)


def _numbers(option: str, words: Names) -> tuple[float, ...]:
    return checked_numbers(option, words, float, NEAREST, FARTHEST)


def _steps(options: DepthOptions, outputs: DepthOutputs) -> list[Step]:
    if options.depths is not None and outputs.plot:
        raise UsageError(
            "--plot cannot be used with --depths, because depth images have no distances to plot; leave one out"
        )
    if options.depths is not None and outputs.images and options.fov is None:
        raise UsageError("--images requires --fov for depth images, to compute the slope of surfaces")
    chosen = cases(options)
    if outputs.images:
        _pictured(outputs.images, chosen)
    return [Step(_key(case), case, case.name) for case in chosen]


def _key(case: measure.DepthCase) -> Row:
    if frame := case.frame:
        key = {"codec": case.codec.name, "rebuilt": case.rebuilt, "backend": case.backend, "depths": frame.name}
        key |= {"depths_are": frame.code, "depth_unit": frame.unit, "channel": frame.channel, "fov": frame.fov}
        return key | {"near": case.camera.near, "far": case.camera.far}
    key: Row = {"codec": case.codec.name, "rebuilt": case.rebuilt, "backend": case.backend, "seed": case.seed}
    key |= {"near": case.camera.near, "far": case.camera.far, "fov": case.camera.fov, "count": case.count}
    return key | {"distances": list(case.distances)}


def _write(done: Measured, tick: Tick) -> None:
    """Write the images of the cases, if a folder for images was given."""
    chosen, folder = [step.case for step in done.steps], done.outputs.images
    if folder:
        _write_pictures(_for_drawing(chosen), _pictured(folder, chosen), folder, tick)


def _plotted(done: Measured) -> list[Chart]:
    """Return the chart of errors at many distances, in a list; empty if no case of generated points has figures."""
    chosen = [step.case for step in done.steps if not step.case.frame]
    rows = [row for case in _for_drawing(chosen) for row in _curve(case)]
    return [depth_chart(usable)] if (usable := having(rows, "distance", "error_max")) else []


def _shown(done: Measured) -> Iterator[Sheet]:
    kept = but_without_twins(done.rows)
    rows = _of_frames(kept) if any(step.case.frame for step in done.steps) else _beside(kept)
    yield Sheet("", rows, TABLE.drops(rows))


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    """Yield up to two sentences for each pair of near and far planes, for depth buffers and for other targets: the
    best encodings by their largest error relative to the distance."""
    ranges = dict.fromkeys((row["near"], row["far"]) for row in rows)
    for near, far in ranges:
        worst: dict[tuple[Any, ...], Row] = {}
        for row in rows:
            if _is_at(row, near, far):
                key = row["depth"], row["storage"], row["rounding"], row["rebuilt"]
                relative = max(row["error_max"] / row["distance"], worst.get(key, {}).get("relative", 0.0))
                worst[key] = row | {"relative": relative}
        for kind, is_buffer in {"in depth buffers": True, "in other targets": False}.items():
            part = [row for row in worst.values() if (row["storage"] in BUFFERS) is is_buffer]
            if part:
                best = by_bits(part, "relative", lambda row: f"{row['relative']:.2g}")
                yield f"Most accurate {kind} from {near:g} to {far:g}, by error relative to the distance: {best}."


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    ranges = list(dict.fromkeys((row["near"], row["far"]) for row in rows))
    for near, far in ranges:
        lines: dict[tuple[Any, ...], Row] = {}
        for row in rows:
            if _is_at(row, near, far) and row["backend"] == rows[0]["backend"]:
                line = {name: row[name] for name in ("depth", "storage", "rounding", "rebuilt")}
                entry = lines.setdefault(tuple(line.values()), line)
                entry[f"at_{row['distance']:g}"] = row["error_max"]
        if lines:
            yield Sheet(f"largest position error, near {near:g}, far {far:g}", list(lines.values()))


def _is_at(row: Row, near: float, far: float) -> bool:
    return (row["near"], row["far"]) == (near, far) and row["distance"] is not None and row["error_max"] is not None


def _beside(rows: Sequence[Row]) -> list[Row]:
    """Return a row for each codec, camera, way to rebuild positions and backend: the largest error at each distance,
    and the largest and mean error of points spread evenly over the range."""
    lines: dict[tuple[object, ...], Row] = {}
    names = ("depth", "storage", "rounding", "bits", "rebuilt", "backend", "near", "far", "fov")
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


def _of_frames(rows: Sequence[Row]) -> list[Row]:
    """Return the rows of depth images with only the columns to show."""
    names = ("depth", "storage", "rounding", "bits", "rebuilt", "backend", "depths", "near", "far", "fov")
    figures = ("relative_mean", "relative_max", "error_mean", "error_max", "signs_lost")
    how = ("count", "background", "not_finite", "rounded_by", "device")
    return [{name: _said(row[name]) for name in names} | {name: row[name] for name in (*figures, *how)} for row in rows]


def _said(value: object) -> object:
    """Return a float as text of up to six digits, such as `0.1`; any other value is unchanged."""
    return f"{value:g}" if isinstance(value, float) else value


def _for_drawing(cases: Iterable[measure.DepthCase]) -> list[measure.DepthCase]:
    """Return one case for each codec, camera, rebuild and frame: the GLSL case if it was requested."""
    chosen = {(c.codec, c.camera, c.rebuilt, c.frame): c for c in sorted(cases, key=lambda c: c.backend, reverse=True)}
    return [case for case in cases if case in chosen.values()]


def _curve(case: measure.DepthCase) -> list[Row]:
    """Return the rows of a case at many closely spaced distances, measured by JAX if the device cannot do so."""
    distances = np.geomspace(case.camera.near, case.camera.far, CURVE).tolist()
    fine = replace(case, distances=tuple(distances), count=CURVE_COUNT)
    rows = measure.measure(fine)
    return measure.measure(replace(fine, backend="jax")) if rows[0]["skipped"] else rows


@dataclass(frozen=True)
class Surface:
    """The depths of a scene or of a frame, as an image.

    Attributes:
        name: name in the file names of pictures.
        depths: view depth, float32 of shape (height, width), row 0 at the top; 0 where there is no surface.
        fov: the camera's vertical field of view in degrees.
    """

    name: str
    depths: np.ndarray
    fov: float

    @property
    def aspect(self) -> float:
        """Width over height."""
        height, width = self.depths.shape
        return width / height

    def within(self, camera: Camera) -> np.ndarray:
        """Return a mask of the pixels between near and far, bool of shape (height, width)."""
        return (self.depths >= np.float32(camera.near)) & (self.depths <= np.float32(camera.far))

    def points(self, camera: Camera) -> measure.Points:
        """Return the centres of all pixels at their visible depths; at the far plane if outside the range."""
        height, width = self.depths.shape
        x, y = (np.arange(width) + 0.5) / width * 2 - 1, 1 - (np.arange(height) + 0.5) / height * 2
        places = np.stack(np.meshgrid(x, y), axis=-1).astype(np.float32).reshape(-1, 2)
        depths = np.where(self.within(camera), self.depths, np.float32(camera.far))
        return measure.Points(places, depths.ravel().astype(np.float32), width)


@cache
def _seen(device: Device) -> Surface:
    """Return the surface of the scene in the images, rendered once for the checks and for the images."""
    plan = Plan(SIZE, 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], 2, False, 1.0)
    scene = SCENE.make(Setting())
    with rendering(device, PIPELINES["prepass"], scene, plan) as drawing:
        drawing.draw()
        return Surface(SCENE.name, -drawing.gbuffer()[0][..., 2], scene.view.fov)


def _pictured(folder: Path, cases: Iterable[measure.DepthCase]) -> Surface | None:
    """Return the scene that the images show; None if cases have frames of their own. Raises as `_scene` does."""
    if not any(case.frame for case in cases):
        return _scene(folder, cases)
    check_folder(folder)
    return None


def _seen_by(case: measure.DepthCase, scene: Surface | None) -> Surface:
    """Return the surface that the images of a case show."""
    if case.frame:
        return Surface(case.frame.name, case.frame.surface(case.camera), case.camera.fov)
    assert scene
    return scene


def _scene(folder: Path, cases: Iterable[measure.DepthCase]) -> Surface:
    """Return the scene that the images show, rendered in 32-bit floats.

    Raises:
        MissingError: there is no OpenGL device.
        UsageError: the folder cannot be written to, or a camera's range contains nothing of the scene.
    """
    device = require_device()
    check_folder(folder)
    seen = _seen(device)
    there = seen.depths[seen.depths > 0]
    for camera in dict.fromkeys(case.camera for case in cases):
        if not seen.within(camera).any():
            raise UsageError(
                f"--near {camera.near:g} --far {camera.far:g}: nothing in the scene of the images, {SCENE.name}, is "
                f"in this range; its depths are {there.min():.3g} to {there.max():.3g}"
            )
    return seen


def _write_pictures(
    cases: Iterable[measure.DepthCase], pictured: Surface | None, folder: Path, tick: Callable[[str], None]
) -> None:
    """Write two images for each case: the position errors in colour, and the rebuilt surface, shaded."""
    for case in cases:
        scene = _seen_by(case, pictured)
        camera = replace(case.camera, fov=scene.fov, aspect=scene.aspect)
        points, covered = scene.points(camera), scene.within(camera)
        measured = _through(replace(case, camera=camera), points)
        errors, positions = measured.errors.reshape(covered.shape), measured.positions.reshape(*covered.shape, 3)
        where = f"{scene.name}-{camera.near:g}-{camera.far:g}"
        for kind, pixels in pictures.depth_pictures(errors, positions, covered).items():
            name = f"{where}-{case.codec.name.replace('/', '-')}-{case.rebuilt}-{kind}.png"
            with whole_file(folder / name) as partial:
                pictures.write_png(partial, pixels)
        tick(case.name)


def _through(case: measure.DepthCase, points: measure.Points) -> measure.Measured:
    try:
        return measure.through(case, points)
    except UNMEASURABLE:
        return measure.through(replace(case, backend="jax"), points)


WORK = Work(
    steps=_steps,
    measure=each(measure.measure),
    shown=_shown,
    verdict=_verdict,
    summary=_summary,
    write=_write,
    charts=charts,
    plotted=_plotted,
)
