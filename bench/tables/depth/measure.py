"""The depth table: the error of positions rebuilt from stored depth, by JAX and by GLSL."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.depth_codec import REBUILDS, DepthCodec
from ....encodings.shared.position import Camera
from ....encodings.storages.dither import laid_out
from ....encodings.vec import Vec2
from ....gbuffer.codecs.depth.depth_passes import DepthPasses, Rebuilt
from ....gbuffer.gl.device import device
from ...shaders.code.twin import NoTwinError
from ...subjects.depths.depth_images import DepthImage
from ..table import Row
from ..unmeasurable import UNMEASURABLE
from .frames import seen
from .points import Points
from .table import TABLE

# A distance stands for depths that are up to this share of it nearer or farther.
BAND = 1 / 16
ASPECT = 16 / 9
BLOCK = 2**14


def points(camera: Camera, distance: float | None, count: int, seed: int) -> Points:
    """Return points anywhere on the screen, with depths spread evenly over a band around a distance, or over the
    camera's whole range if the distance is None. Both ends and two corners of the screen are included."""
    low, high = (camera.near, camera.far) if distance is None else (distance * (1 - BAND), distance * (1 + BAND))
    low, high = np.float32(max(low, camera.near)), np.float32(min(high, camera.far))
    random = np.random.default_rng([seed, 0 if distance is None else 1])
    share = (np.arange(count) + random.random(count)) / count
    depths = np.clip((low + (np.float64(high) - low) * share).astype(np.float32), low, high)
    depths[0], depths[-1] = low, high
    places = random.uniform(-1, 1, (count, 2)).astype(np.float32)
    places[0], places[-1] = 1, -1
    return Points(places, depths)


@lru_cache(maxsize=4)
def all_points(camera: Camera, distances: tuple[float | None, ...], count: int, seed: int) -> Points:
    """Return the points that `points` gives for each distance, joined in the order of the distances. Cached."""
    parts = [points(camera, distance, count, seed) for distance in distances]
    return Points(np.concatenate([p.places for p in parts]), np.concatenate([p.depths for p in parts]))


@dataclass(frozen=True)
class DepthCase:
    """A measurement of depth, with one row for each distance; a distance of None stands for the whole range.

    Attributes:
        codec: encoding and storage of the depth.
        rebuilt: way to rebuild positions, a key of REBUILDS.
        backend: "jax" or "glsl".
        camera: near, far and field of view.
        distances: distances in the unit of near and far.
        count: number of points in each row.
        seed: seed for the points.
        frame: frame whose depths are measured in one row, if any; `distances` is then (None,) and `count` is not
            used.
    """

    codec: DepthCodec
    rebuilt: str
    backend: str
    camera: Camera
    distances: tuple[float | None, ...]
    count: int
    seed: int
    frame: DepthImage | None = None

    @property
    def name(self) -> str:
        of = f" {self.frame.name}" if self.frame else ""
        return f"{self.codec.name}{of} {self.camera.near:g} to {self.camera.far:g} {self.backend}"

    @property
    def points(self) -> Points:
        """The points to measure: the frame's points, or otherwise the points at all distances, in order."""
        if self.frame:
            return seen(self.frame, self.camera).points
        return all_points(self.camera, self.distances, self.count, self.seed)


def ways(codec: DepthCodec) -> list[str]:
    """Return the names of all ways to rebuild positions from a codec's numbers."""
    return [name for name, way in REBUILDS.items() if codec.is_window or not way.by_projection]


def usual_ways(codec: DepthCodec) -> list[str]:
    """Return the names of the ways in which renderers rebuild positions from a codec's numbers: by the projection if
    the codec stores depth-buffer values, otherwise directly."""
    return [name for name, way in REBUILDS.items() if way.by_projection == codec.is_window]


def _in_blocks(function: Callable[..., Sequence[Any]], *arrays: np.ndarray) -> list[np.ndarray]:
    """Return the arrays that a function computes from the rows of other arrays. The function is called with BLOCK
    rows at a time, because JAX compiles every operation for every shape."""
    count, blocks = len(arrays[0]), []
    for start in range(0, count, BLOCK):
        parts = [array[start : start + BLOCK] for array in arrays]
        missing = BLOCK - len(parts[0])
        blocks.append(function(*(np.concatenate([p, np.repeat(p[-1:], missing, axis=0)]) for p in parts)))
    return [np.concatenate([np.asarray(part) for part in parts])[:count] for parts in zip(*blocks, strict=True)]


def _rebuilt_by_jax(case: DepthCase, signed: np.ndarray, on: Points) -> tuple[Rebuilt, dict[str, str]]:
    codec, seen = case.codec, case.camera.seen(case.codec.encoding.projection)
    noise = [laid_out(codec.dither.added, on.width, len(signed))[:, 0]] if codec.is_dithered else []

    # Not compiled as a whole: for so few points that would take longer than all else.
    def rebuilt(depths: np.ndarray, right: np.ndarray, up: np.ndarray, *added: np.ndarray):
        number = codec.stored(jnp.asarray(depths), seen.near, seen.far, *map(jnp.asarray, added))
        position = REBUILDS[case.rebuilt].position(codec, number, Vec2(jnp.asarray(right), jnp.asarray(up)), seen)
        return np.stack([np.asarray(c) for c in position], axis=-1), number, codec.depths(number, seen.near, seen.far)

    how = {"device": jax.devices()[0].device_kind, "rounded_by": "emulation"}
    return Rebuilt(*_in_blocks(rebuilt, signed, *on.places.T, *noise)), how


def _rebuilt_by_glsl(case: DepthCase, signed: np.ndarray, on: Points) -> tuple[Rebuilt, dict[str, str]]:
    gl, count = device(), len(signed)
    height = -(-count // on.width)
    pixels = np.ones((height * on.width, 3), np.float32)
    pixels[:count] = np.concatenate([on.places, signed[:, None]], axis=1)
    with DepthPasses(gl, case.codec) as passes:
        got = passes.round_trip(pixels.reshape(height, on.width, 3), case.camera, REBUILDS[case.rebuilt].way)
        how = {"device": gl.renderer, "rounded_by": passes.rounded_by}
    flat = Rebuilt(got.positions.reshape(-1, 3)[:count], got.numbers.ravel()[:count], got.depths.ravel()[:count])
    return flat, how


BACKENDS: Mapping[str, Callable[[DepthCase, np.ndarray, Points], tuple[Rebuilt, dict[str, str]]]] = MappingProxyType(
    {"jax": _rebuilt_by_jax, "glsl": _rebuilt_by_glsl}
)


@dataclass(frozen=True)
class Measured:
    """The results for points after a codec's round trip: float64 arrays of shape (count,).

    Attributes:
        errors: distance between the true and the rebuilt position; infinite if the rebuilt position is not finite.
        half_steps: how far rounding may move the position: half a step for rounding to nearest, otherwise a step.
        bounds: the same with float32 arithmetic.
        relative: error of the depth along the axis, relative to the depth; infinite if the position is not finite.
        lost: bool, whether the depth's sign came back inverted; false if the encoding keeps no sign.
        positions: rebuilt positions, of shape (count, 3).
        how: the device, and what did the rounding.
    """

    errors: np.ndarray
    half_steps: np.ndarray
    bounds: np.ndarray
    relative: np.ndarray
    lost: np.ndarray
    positions: np.ndarray
    how: dict[str, str]


@lru_cache(maxsize=1)
def _limits(codec: DepthCodec, camera: Camera, on: Points) -> tuple[np.ndarray, np.ndarray]:
    """Return how far each position may move, without and with float32 arithmetic; the same for every backend. NaN for
    an encoding that exists only in shaders, because the exact maps are computed by JAX."""
    if codec.storage.code:
        unknown = np.full(len(on.depths), np.nan)
        return unknown, unknown
    rays, depths = np.linalg.norm(on.rays(camera), axis=1), on.depths.astype(np.float64)
    try:
        half_steps, bounds = _in_blocks(
            lambda part: [codec.furthest(part, camera, with_arithmetic) for with_arithmetic in (False, True)], depths
        )
    except NoTwinError:
        return (np.full_like(rays, np.nan),) * 2
    return rays * half_steps, rays * bounds


def through(case: DepthCase, on: Points) -> Measured:
    """Return the errors and the rebuilt positions of points after a case's round trip. Every second normal faces away
    from the viewer, if the encoding stores that.

    Raises:
        NoDeviceError, ShaderError, FormatError: the device does not support the codec.
    """
    away = (np.arange(len(on.depths)) % 2 == 1) & case.codec.encoding.signed
    rebuilt, how = BACKENDS[case.backend](case, np.where(away, -on.depths, on.depths), on)
    apart = np.linalg.norm(rebuilt.positions - on.positions(case.camera), axis=1)
    half_steps, bounds = _limits(case.codec, case.camera, on)
    lost = (np.signbit(rebuilt.depths) != away) & case.codec.encoding.signed
    errors = np.where(np.isfinite(apart), apart, np.inf)
    depths = on.depths.astype(np.float64)
    relative = np.where(np.isfinite(apart), np.abs(-rebuilt.positions[:, 2] - depths) / depths, np.inf)
    return Measured(errors, half_steps, bounds, relative, lost, rebuilt.positions, how)


def measure(case: DepthCase) -> list[Row]:
    """Return a row for each distance of a case. If the device cannot measure the case, the rows have the reason in
    `skipped` and no figures."""
    camera, codec = case.camera, case.codec
    shared = TABLE.empty() | {
        "depth": codec.encoding.name,
        "storage": codec.storage.name,
        "rounding": codec.rounding,
        "bits": codec.storage.bits,
        "rebuilt": case.rebuilt,
        "backend": case.backend,
        "near": camera.near,
        "far": camera.far,
        "ratio": camera.far / camera.near,
        "fov": camera.fov,
        "count": case.count,
        "seed": case.seed,
    }
    on, count = case.points, case.count
    if case.frame:
        count = len(on.depths)
        shared |= _frame_columns(case.frame, camera) | {"count": count}
    try:
        measured = through(case, on)
    except UNMEASURABLE as error:
        return [shared | {"distance": distance, "skipped": str(error)} for distance in case.distances]
    parts = [slice(i * count, (i + 1) * count) for i in range(len(case.distances))]
    return [
        shared | measured.how | {"distance": distance} | _figures(case, measured, part)
        for distance, part in zip(case.distances, parts, strict=True)
    ]


def _frame_columns(frame: DepthImage, camera: Camera) -> Row:
    """Return the columns that describe a frame instead of generated points."""
    background = seen(frame, camera).background
    return {
        "depths": frame.name,
        "fov": frame.fov,
        "background": background,
        "not_finite": frame.not_finite,
        "seed": None,
    }


def _figures(case: DepthCase, measured: Measured, part: slice) -> Row:
    return {
        "relative_mean": float(measured.relative[part].mean()),
        "relative_max": float(measured.relative[part].max()),
        "error_mean": float(measured.errors[part].mean()),
        "error_max": float(measured.errors[part].max()),
        "half_step": _known(measured.half_steps[part].max()),
        "bound": _known(measured.bounds[part].max()),
        "signs_lost": int(measured.lost[part].sum()) if case.codec.encoding.signed else None,
    }


def _known(figure: float) -> float | None:
    """Return a figure as a float; None if it is NaN."""
    return None if np.isnan(figure) else float(figure)
