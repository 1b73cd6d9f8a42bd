"""Measurement of the frames table: the errors of encoded tangent frames in normals, tangents and rotations, by JAX
and by GLSL."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from functools import cache
from types import MappingProxyType
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.frame_codec import FrameCodec
from ....encodings.rotation import frame_of
from ....encodings.storages.dither import laid_out
from ....encodings.vec import Vec3, Vec4
from ....gbuffer.codecs.frames.frame_passes import FramePasses
from ....gbuffer.gl.device import device
from ...measures.metrics.code_limits import is_measurable
from ...measures.worst_case.frame_search import worst_frame
from ...shaders.code.twin import NoTwinError
from ..table import Row
from ..unmeasurable import UNMEASURABLE
from .limits import HANDS, frame_effective_bits, frame_limit, frames_broken
from .sets import CHUNK, Frames, FrameSet
from .table import TABLE

WHAT = ("normal", "tangent", "rotation")
WIDTH = 256

Trip = Callable[[Frames], Frames]


@dataclass(frozen=True)
class FrameCase:
    """One row to measure."""

    codec: FrameCodec
    frame_set: FrameSet
    backend: str
    worst_case: bool = False

    @property
    def name(self) -> str:
        return f"{self.codec.name} {self.frame_set.name} {self.backend}"


@cache
def _compiled_trip(codec: FrameCodec) -> Callable[[Any, Any, Any], Any]:
    def trip(normals, tangents, noise):
        given = frame_of(Vec3(*normals[:3]), Vec3(*tangents[:3]), normals[3])
        return codec.round_trip(given, None if noise is None else Vec4(*noise))

    return jax.jit(trip)


@contextmanager
def _trip_by_jax(codec: FrameCodec) -> Iterator[tuple[Trip, dict[str, str]]]:
    noise = np.ascontiguousarray(laid_out(codec.dither.added, WIDTH, CHUNK).T) if codec.is_dithered else None

    def trip(given: Frames) -> Frames:
        normals, tangents = (jnp.asarray(np.ascontiguousarray(a.T)) for a in (given.normals, given.tangents))
        n, t, hand = _compiled_trip(codec)(normals, tangents, noise)
        decoded = (np.stack([np.asarray(c) for c in v], axis=1) for v in ((*n, hand), (*t, 0 * hand)))
        return Frames(*decoded)

    yield trip, {"device": jax.devices()[0].device_kind, "rounded_by": "emulation"}


@contextmanager
def _trip_by_glsl(codec: FrameCodec) -> Iterator[tuple[Trip, dict[str, str]]]:
    gl = device()
    with FramePasses(gl, codec) as passes:

        def trip(given: Frames) -> Frames:
            decoded = passes.round_trip(*(a.reshape(-1, WIDTH, 4) for a in (given.normals, given.tangents)))
            return Frames(*(a.reshape(-1, 4) for a in decoded))

        yield trip, {"device": gl.renderer, "rounded_by": passes.rounded_by}


BACKENDS: Mapping[str, Callable[[FrameCodec], AbstractContextManager[tuple[Trip, dict[str, str]]]]] = MappingProxyType(
    {"jax": _trip_by_jax, "glsl": _trip_by_glsl}
)


@dataclass
class FrameTotal:
    """Totals over chunks: the angles of normals, tangents and rotations in degrees, the number of decodes that are
    not finite, which count as 180 degrees, and the number of inverted hands."""

    count: int = 0
    invalid: int = 0
    hands_lost: int = 0
    sums: np.ndarray = field(default_factory=lambda: np.zeros(3))
    squares: np.ndarray = field(default_factory=lambda: np.zeros(3))
    largest: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def add(self, given: Frames, decoded: Frames) -> None:
        """Add the errors of frames and their decodes."""
        angles = frame_angles(given, decoded)
        valid = np.isfinite(angles).all(axis=0)
        angles = np.where(valid, angles, 180.0)
        self.count += len(given.normals)
        self.invalid += int(np.count_nonzero(~valid))
        self.hands_lost += int(np.count_nonzero(given.normals[:, 3] != decoded.normals[:, 3]))
        self.sums = self.sums + angles.sum(axis=1)
        self.squares = self.squares + (angles**2).sum(axis=1)
        self.largest = np.maximum(self.largest, angles.max(axis=1))


def frame_angles(given: Frames, other: Frames) -> np.ndarray:
    """Return the angles between the normals, between the tangents, and of the rotation from one frame to the other,
    regardless of handedness: float64 degrees of shape (3, count), NaN where a value is not a number.

    A rotation by theta moves the three axes by 8 sin^2(theta / 2) in total, the sum of their squared distances.
    """
    (n, t), (other_n, other_t) = (_unit_axes(frames) for frames in (given, other))
    apart = [n - other_n, t - other_t, np.cross(n, t) - np.cross(other_n, other_t)]
    squares = [np.sum(a * a, axis=1) for a in apart]
    sines = np.sqrt(np.stack([squares[0] / 4, squares[1] / 4, sum(squares) / 8]))
    return np.degrees(2 * np.arcsin(np.minimum(sines, 1.0)))


def _unit_axes(frames: Frames) -> tuple[np.ndarray, np.ndarray]:
    n, t = (a[:, :3].astype(np.float64) for a in (frames.normals, frames.tangents))
    n, t = (a / np.linalg.norm(a, axis=1, keepdims=True) for a in (n, t))
    t = t - n * np.sum(n * t, axis=1, keepdims=True)
    return n, t / np.linalg.norm(t, axis=1, keepdims=True)


def measure(case: FrameCase) -> Row:
    """Return the row with a codec's errors over a set of tangent frames; if the device cannot measure the codec, the
    row has the reason in `skipped` and no figures."""
    row = TABLE.empty() | {
        "encoding": case.codec.encoding.name,
        "storage": case.codec.storage.name,
        "rounding": case.codec.rounding,
        "frame_set": case.frame_set.name,
        "backend": case.backend,
        "bits": case.codec.bits,
        "codes": case.codec.codes,
        "seed": case.frame_set.seed,
    }
    total = FrameTotal()
    try:
        with BACKENDS[case.backend](case.codec) as (trip, how), np.errstate(invalid="ignore", divide="ignore"):
            for given in case.frame_set.chunks():
                count = len(given.normals)
                outcome = trip(_whole_chunk(given))
                total.add(given, Frames(outcome.normals[:count], outcome.tangents[:count]))
    except UNMEASURABLE as error:
        return row | {"skipped": str(error)}
    outcome = _figures(total, case.codec) | (_supremum_columns(case) if case.worst_case else {})
    return row | outcome | _limit_columns(case, total, outcome) | how


def _supremum_columns(case: FrameCase) -> Row:
    """Return the supremum over all tangent frames, found by search. Empty for a mesh, whose frames are all measured,
    and for an encoding that exists only in shaders, because the search uses exact arithmetic in JAX."""
    if not case.frame_set.is_uniform:
        return {}
    try:
        worst = worst_frame(case.codec)
    except NoTwinError:
        return {}
    return {"rotation_sup_deg": worst.angle_deg, "sup_moved_deg": worst.moved_deg}


def _whole_chunk(frames: Frames) -> Frames:
    """Return a chunk padded to CHUNK frames with its last frame, so that code is compiled once and the frames fill a
    rectangle of pixels."""
    missing = CHUNK - len(frames.normals)
    return Frames(*(np.pad(a, ((0, missing), (0, 0)), mode="edge") for a in (frames.normals, frames.tangents)))


def _figures(total: FrameTotal, codec: FrameCodec) -> Row:
    row: Row = {"count": total.count, "invalid": total.invalid}
    row["hands_lost"] = None if codec.encoding.hand_in is None else total.hands_lost
    for i, what in enumerate(WHAT):
        row[f"{what}_mean_deg"] = float(total.sums[i] / total.count)
        row[f"{what}_rms_deg"] = math.sqrt(total.squares[i] / total.count)
        row[f"{what}_max_deg"] = float(total.largest[i])
    return row


def _limit_columns(case: FrameCase, total: FrameTotal, figures: Row) -> Row:
    """Return the theoretical limits and how closely the row approaches them; empty for a set that is not uniform. The
    percentages are left out if errors as small as the limit are lost in float32."""
    if not case.frame_set.is_uniform:
        return {}
    hands = 1 if case.codec.encoding.hand_in is None else HANDS
    least = frame_limit(case.codec.codes, hands)
    mean, rms, met = (figures[f"rotation_{figure}_deg"] for figure in ("mean", "rms", "max"))
    largest = figures.get("rotation_sup_deg", met)
    row: Row = {"limit_mean_deg": least.mean_deg, "limit_rms_deg": least.rms_deg, "limit_max_deg": least.max_deg}
    row["effective_bits"] = frame_effective_bits(rms, hands)
    if not is_measurable(least):
        return row
    return row | {
        "reached_mean_percent": 100 * least.mean_deg / mean,
        "reached_rms_percent": 100 * least.rms_deg / rms,
        "reached_max_percent": 100 * least.max_deg / largest,
        "below_limit": frames_broken(case.codec.codes, total.count, mean, rms, hands),
    }
