"""Measurement of the quality table: the errors of each codec on a set of normals, by JAX and by shaders."""

from __future__ import annotations

import ctypes
import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from dataclasses import dataclass, replace
from functools import cache, partial
from types import MappingProxyType
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.dither import laid_out
from ....encodings.storages.rounding import Scale, fixed, shared
from ....encodings.storages.storage import DITHERED, Storage
from ....encodings.vec import Vec3
from ....gbuffer.gl.device import device
from ...ground.machine.cores import on_all_cores
from ...ground.native.elementwise import NotElementwiseError
from ...ground.native.library import NoCompilerError, compiler
from ...ground.output.errors import MissingError, tell
from ...measures.metrics.code_limits import AREAS, effective_bits
from ...measures.metrics.meter import Decoded, Load, Measures, Meter, idle, measure_together
from ...measures.metrics.totals import ErrorTotal, Statistics, Worst, psnr_db, statistics, total_of
from ...measures.native.meter import NativeMeter, decoder
from ...measures.worst_case import exact_figures
from ...shaders.code.twin import has_twin
from ...subjects.normals.normal_sets import CHUNK, CHUNK_WIDTH, Chunk, NormalSet, from_arrays
from ..table import Row
from ..unmeasurable import UNMEASURABLE as BY_BACKEND
from .table import TABLE

# Why a device may not be able to give a row.
UNMEASURABLE = (*BY_BACKEND, MissingError)
# How many cases share a set's chunks: each keeps its own histogram.
TOGETHER = 16
# What the row of a part has in place of figures.
TOTAL = "total"
# What an unused channel is drawn as: -1 is black.
UNUSED = -1.0

Tick = Callable[[], None]


@dataclass(frozen=True)
class QualityCase:
    """A row of the quality table to measure; `worst_case` and `codes` request figures that take seconds each."""

    codec: Codec
    normal_set: NormalSet
    backend: str
    worst_case: bool = False
    codes: bool = False

    @property
    def name(self) -> str:
        return f"{self.codec.name} {self.normal_set.name} {self.backend}"

    def parts(self) -> list[QualityCase]:
        """Return the cases for the parts of the set; empty if the set is measured as a whole."""
        return [replace(self, normal_set=part) for part in self.normal_set.parts]

    @property
    def domain(self) -> str | None:
        """The domain of limits and suprema: "sphere", or "hemisphere" if the set or the encoding covers less; None
        for a set that is not uniform."""
        if self.normal_set.area is None:
            return None
        is_whole = self.normal_set.area == AREAS["sphere"] and self.codec.encoding.domain == "sphere"
        return "sphere" if is_whole else "hemisphere"


@cache
def meter_of(codec: Codec) -> Measures:
    """Return a codec's meter: compiled C, or XLA's program if there is no C compiler or no C for the codec."""
    # Noise is of pixels, and what the C compiler is given is of each normal by itself.
    if not codec.is_dithered:
        like, scales = shared(codec.storage, codec.encoding.components)
        with suppress(NoCompilerError, NotElementwiseError):
            return NativeMeter(_compiled(codec.encoding, like, codec.rounding), scales)
    return meter_by_xla(codec)


@cache
def _compiled(encoding: Encoding, like: Storage, rounding: str) -> ctypes.CDLL:
    # Tracing takes longer than all else, and formats that share a program are many.
    _, scales = shared(like, encoding.components)
    return decoder(_trip(encoding, like, rounding), scales)


def meter_by_xla(codec: Codec) -> Meter:
    """Return the meter for a codec that runs XLA's program."""
    like, scales = shared(codec.storage, codec.encoding.components)
    noise = (_noise_of(codec, CHUNK_WIDTH, CHUNK),) if codec.is_dithered else ()
    return Meter(_program(codec.encoding, like, codec.rounding), (*noise, *scales))


def _noise_of(codec: Codec, width: int, count: int) -> tuple[np.ndarray, ...]:
    """Return noise for the three numbers in each of `count` codes, arranged by `laid_out`: float32 planes."""
    return tuple(np.ascontiguousarray(laid_out(codec.dither(0).added, width, count).T[:3]))


def _trip(encoding: Encoding, like: Storage, rounding: str) -> Callable[..., Vec3]:
    """Return a round trip with a format's scales as arguments, so that fixed-point formats share a compilation."""

    def round_trip(n: Vec3, view: Vec3, *scales: Scale) -> Vec3:
        return Codec(encoding, fixed(like, scales), rounding).round_trip(n, view)

    return round_trip


@cache
def _program(encoding: Encoding, like: Storage, rounding: str) -> Callable[..., Vec3]:
    if rounding == DITHERED:
        return jax.jit(_noisy_trip(encoding, like))
    trip = _trip(encoding, like, rounding)
    return jax.jit(lambda chunk, *scales: trip(chunk.n, chunk.view, *scales))


def _noisy_trip(encoding: Encoding, like: Storage) -> Callable[..., Vec3]:
    def round_trip(chunk: Chunk, noise: Sequence[Any], *scales: Scale) -> Vec3:
        planes = [plane.reshape(chunk.n.z.shape) for plane in noise]
        return Codec(encoding, fixed(like, scales), DITHERED).round_trip(chunk.n, chunk.view, planes)

    return round_trip


def round_trip(codec: Codec, n: np.ndarray, view: np.ndarray) -> np.ndarray:
    """Return the decodes of unit normals, (count, 3), not renormalised, computed by the program that measures rows.

    Args:
        n, view: unit normals and view positions, float32 of shape (count, 3).
    """
    meter, decoded = meter_of(codec), []
    with jax.enable_x64(True):
        for load in from_arrays("", "", n, view, np.ones(len(n), bool)).loads():
            decoded.append(np.stack([np.asarray(plane).ravel() for plane in meter.decoded(load())], axis=1))
    return np.concatenate(decoded)[: len(n)]


@cache
def _decoded_meter() -> Meter:
    return Meter(jax.jit(lambda chunk: chunk.decoded))


def rgba(planes: Vec3, height: int, width: int) -> np.ndarray:
    """Return three planes as the pixels of an image, float32 of shape (height, width, 4); the fourth channel is 0."""
    pixels = np.zeros((height * width, 4), np.float32)
    for channel, plane in enumerate(planes):
        pixels[:, channel] = np.asarray(plane).ravel()
    return pixels.reshape(height, width, 4)


@dataclass(frozen=True)
class Decoding:
    """A case that is ready to measure: its meter, its chunks, and columns on the device and the rounding."""

    meter: Measures
    loads: Iterable[Load]
    how: Mapping[str, str]

    def total(self, tick: Tick = idle) -> ErrorTotal:
        """Return the total over all chunks."""
        return measure_together([self.meter], self.loads, lambda _: tick())[0]


@contextmanager
def _decodings_by_jax(case: QualityCase) -> Iterator[Decoding]:
    yield Decoding(meter_of(case.codec), case.normal_set.loads(), _how_by_jax())


def _how_by_jax() -> dict[str, str]:
    return {"device": jax.devices()[0].device_kind, "rounded_by": "emulation"}


@contextmanager
def _decodings_by_glsl(case: QualityCase) -> Iterator[Decoding]:
    if case.codec.encoding.is_half:
        yield _by_half_device(case)
        return
    from ....gbuffer.codecs.codec_passes import CodecPasses

    gl = device()
    with CodecPasses(gl, case.codec) as passes:

        def decoded(chunk: Chunk) -> Decoded:
            pixels = (rgba(planes, CHUNK // CHUNK_WIDTH, CHUNK_WIDTH) for planes in (chunk.n, chunk.view))
            n = passes.round_trip(*pixels).normals.reshape(-1, 3)
            return Decoded(chunk.n, Vec3(*np.ascontiguousarray(n.T)), chunk.covered)

        loads = (partial(identity, decoded(load())) for load in case.normal_set.loads())
        yield Decoding(_decoded_meter(), loads, {"device": gl.renderer, "rounded_by": passes.rounded_by})


def _by_half_device(case: QualityCase) -> Decoding:
    from ...subjects.codecs.half import compute as half_compute
    from ...subjects.codecs.half.round_trip import HalfPasses

    passes = HalfPasses(case.codec)
    how = {"device": half_compute.name(), "rounded_by": "emulation"}

    def decoded(chunk: Chunk) -> Decoded:
        rows = (rgba(planes, 1, len(np.ravel(planes.z)))[0] for planes in (chunk.n, chunk.view))
        normals = np.ascontiguousarray(passes.round_trip(*rows).T).reshape(3, *np.shape(chunk.n.z))
        return Decoded(chunk.n, Vec3(*normals), chunk.covered)

    loads = (partial(identity, decoded(load())) for load in case.normal_set.loads())
    return Decoding(_decoded_meter(), loads, how)


@contextmanager
def _decodings_by_wgsl(case: QualityCase) -> Iterator[Decoding]:
    from ...shaders.code import trip as wgsl_trip

    with wgsl_trip.by_wgsl(case.codec) as trip:

        def decoded(chunk: Chunk) -> Decoded:
            rows = (np.stack([np.ravel(plane) for plane in planes], axis=1) for planes in (chunk.n, chunk.view))
            normals = np.ascontiguousarray(trip(*rows).decoded.T).reshape(3, *np.shape(chunk.n.z))
            return Decoded(chunk.n, Vec3(*normals), chunk.covered)

        loads = (partial(identity, decoded(load())) for load in case.normal_set.loads())
        yield Decoding(_decoded_meter(), loads, {"device": wgsl_trip.device_name(), "rounded_by": "shader"})


def identity(value: Any) -> Any:
    """Return the value unchanged; used to load a chunk that is already in memory."""
    return value


BACKENDS: Mapping[str, Callable[[QualityCase], AbstractContextManager[Decoding]]] = MappingProxyType(
    {"jax": _decodings_by_jax, "glsl": _decodings_by_glsl, "wgsl": _decodings_by_wgsl}
)


def cases(
    codecs: Iterable[Codec], normal_sets: Iterable[NormalSet], backends: Iterable[str], *exact: bool
) -> list[QualityCase]:
    """Return a case for every codec on every set with every backend; cases that differ only in the backend are
    adjacent.

    Args:
        exact: whether to find the worst case, and whether to count codes: the last fields of the cases."""
    normal_sets, backends = list(normal_sets), list(backends)
    return [
        QualityCase(codec, chosen, backend, *exact)
        for chosen in normal_sets
        for codec in codecs
        for backend in backends
    ]


def measure(case: QualityCase, tick: Tick = idle) -> Row:
    """Return one row of the quality table; `tick` is called after each chunk of the set.

    If the device cannot measure a row, the row has the reason in `skipped` and no figures.
    """
    try:
        with BACKENDS[case.backend](case) as decoding:
            total = decoding.total(tick)
    except UNMEASURABLE as error:
        return _case_columns(case) | {"skipped": str(error)}
    return _row(case, total, decoding.how)


def _row(case: QualityCase, total: ErrorTotal, how: Mapping[str, str | None]) -> Row:
    """Return a row of the table; for a part of a set, a row with totals, which `merged` combines."""
    if case.normal_set.of:
        return {TOTAL: total.as_text(), **how}
    return _case_columns(case) | _measured_columns(case, statistics(case.normal_set.count, total)) | dict(how)


def merged(case: QualityCase, rows: Sequence[Row]) -> Row:
    """Return the row of a set that was measured in parts, given the rows of the parts in order."""
    if reason := next((row["skipped"] for row in rows if row.get("skipped")), None):
        return _case_columns(case) | {"skipped": reason}
    total = ErrorTotal()
    for row in rows:
        total.add_total(total_of(row[TOTAL]))
    return _row(case, total, {name: value for name, value in rows[0].items() if name != TOTAL})


def _case_columns(case: QualityCase) -> Row:
    return TABLE.empty() | {
        "encoding": case.codec.encoding.name,
        "storage": case.codec.storage.name,
        "rounding": case.codec.rounding,
        "normals": case.normal_set.name,
        "backend": case.backend,
        "bits": case.codec.bits,
        "background": case.normal_set.background,
        "own_error_deg": case.normal_set.own_error_deg,
        "not_finite": case.normal_set.not_finite,
        "code_space": case.normal_set.code_space,
        "domain": case.domain,
        "codes": case.codec.codes,
        "code_range": "[0, 1]" if case.codec.encoding.is_unit else None,
        "seed": case.normal_set.seed,
    }


def _measured_columns(case: QualityCase, measured: Statistics) -> Row:
    row = _figures(measured, case.normal_set.area)
    if case.worst_case:
        row |= exact_figures.supremum(case.codec, case.domain, case.normal_set.area or 0.0, measured)
    if case.codes:
        row |= exact_figures.odd(case.codec, case.domain)
    return row | exact_figures.held(case.codec, case.domain, measured, row.get("angle_sup_deg"))


def worst(case: QualityCase) -> Worst | None:
    """Return the measured normal with the largest error in a case; None if the device cannot measure it."""
    try:
        with BACKENDS[case.backend](case) as decoding:
            return decoding.total().worst
    except UNMEASURABLE:
        return None


def _figures(s: Statistics, area: float | None) -> Row:
    return {
        "count": s.count,
        "invalid": s.invalid,
        "mse": s.mse,
        "psnr_db": psnr_db(s.mse),
        "psnr_article_db": psnr_db(s.article_mse),
        "angle_mean_deg": s.angle_mean_deg,
        "angle_rms_deg": s.angle_rms_deg,
        "angle_p99_deg": s.angle_p99_deg,
        "angle_max_deg": s.angle_max_deg,
        "worst_normal": _components_text(s.worst.normal) if s.worst else None,
        "worst_decode": _components_text(s.worst.decoded) if s.worst else None,
        "angle_counts": " ".join(f"{edge:.6g}:{count}" for edge, count in s.angle_counts),
        "effective_bits": effective_bits(s.angle_rms_deg, area),
        "exact": s.mse == 0,
    }


def _components_text(vector: np.ndarray) -> str:
    """Return a vector as text in parentheses, with all digits of its three float32 components."""
    return f"({', '.join(map(str, vector))})"


def rows(chosen: Iterable[QualityCase], tick: Callable[[QualityCase], None]) -> Iterator[Row]:
    """Yield the row of each case, in the order of the cases."""
    # By JAX the codecs on one set are measured together, so that it is made once; a few dozens, for memory's sake.
    for _, cases_of_a_set in itertools.groupby(chosen, lambda case: id(case.normal_set)):
        group = list(cases_of_a_set)
        for start in range(0, len(group), TOGETHER):
            yield from _rows_together(group[start : start + TOGETHER], tick)


def _rows_together(group: list[QualityCase], tick: Callable[[QualityCase], None]) -> Iterator[Row]:
    """Yield a row for each case; cases that JAX can measure share the normals of their set."""
    shared = [case for case in group if _is_shared(case)]
    measured: dict[int, ErrorTotal] = {}
    if shared:
        meters = [*on_all_cores(lambda case: meter_of(case.codec), shared)]
        totals = measure_together(meters, shared[0].normal_set.loads(), lambda index: tick(shared[index]))
        measured = {id(case): total for case, total in zip(shared, totals, strict=True)}
    for case in group:
        if id(case) in measured:
            yield _row(case, measured[id(case)], _how_by_jax())
        else:
            yield measure(case, lambda case=case: tick(case))


def _is_shared(case: QualityCase) -> bool:
    return case.backend == "jax" and has_twin(case.codec.encoding)


def tell_by_xla(chosen: Iterable[QualityCase]) -> None:
    """Print which encodings are computed by XLA instead of compiled C, from which their last digits may differ."""
    shared = [case.codec for case in chosen if _is_shared(case) and not case.codec.is_dithered]
    if shared and not compiler():
        tell("no C compiler found (cc): XLA computes the rows, which is slower, and the last digits may differ")
    elif names := dict.fromkeys(codec.encoding.name for codec in shared if isinstance(meter_of(codec), Meter)):
        tell(f"computed by XLA, not by compiled C like the other rows: {', '.join(names)}")


@dataclass(frozen=True)
class RoundTrip:
    """The round trip of an image through a codec: float32 arrays of shape (height, width, 3), where `encoded` are the
    stored numbers, and the mask `covered`, (height, width)."""

    normals: np.ndarray
    encoded: np.ndarray
    decoded: np.ndarray
    covered: np.ndarray


def planes_of(normals: NormalSet) -> tuple[Vec3, Vec3, np.ndarray]:
    """Return the normals and view positions of an image set as Vec3 of planes (count,), and the mask of covered
    pixels, (count,), in pixel order."""
    assert normals.shape
    count, chunks = math.prod(normals.shape), [load() for load in normals.loads()]
    return jax.tree.map(lambda *parts: np.concatenate(parts)[:count], *chunks)


def seen(normals: NormalSet) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the normals and view positions of an image set, each of shape (height, width, 3), and the mask of
    covered pixels, (height, width)."""
    assert normals.shape
    n, view, covered = planes_of(normals)
    images = [np.stack([np.asarray(p) for p in planes], axis=-1).reshape(*normals.shape, 3) for planes in (n, view)]
    return images[0], images[1], covered.reshape(normals.shape)


def image_of(normals: NormalSet) -> tuple[np.ndarray, np.ndarray]:
    """Return the normals of an image set, (height, width, 3), and the mask of covered pixels, (height, width)."""
    n, _, covered = seen(normals)
    return n, covered


def image_round_trip(case: QualityCase) -> RoundTrip:
    """Return the round trip of an image set through a codec. Raises one of UNMEASURABLE if the backend does not
    support the codec."""
    height, width = case.normal_set.shape or (0, 0)
    n, view, covered = planes_of(case.normal_set)

    def image(planes) -> np.ndarray:
        return np.stack([np.asarray(p) for p in planes], axis=-1).reshape(height, width, -1)

    if case.backend == "glsl":
        from ....gbuffer.codecs.codec_passes import CodecPasses

        with CodecPasses(device(), case.codec) as passes:
            result = passes.round_trip(rgba(n, height, width), rgba(view, height, width))
        encoded, decoded = result.codes[..., :3].copy(), result.normals
    elif case.backend == "wgsl":
        from ...shaders.code import trip as wgsl_trip

        with wgsl_trip.by_wgsl(case.codec) as trip:
            ran = trip(*(np.stack([np.ravel(plane) for plane in planes], axis=1) for planes in (n, view)))
        decoded, code = ran.decoded.reshape(height, width, 3), ran.unpacked.T
        encoded = image([*code, *[np.zeros_like(code[0])] * (3 - len(code))])
    else:
        n, view = (Vec3(*map(jnp.asarray, planes)) for planes in (n, view))
        noise = _noise_of(case.codec, width, height * width) if case.codec.is_dithered else None
        code = case.codec.stored(n, view, noise)
        decoded = image(case.codec.encoding.decode(code, view))
        encoded = image([*code, *[np.zeros_like(code.x)] * (3 - len(code))])
    encoded[..., case.codec.encoding.components + case.codec.encoding.sign_bits :] = UNUSED
    return RoundTrip(image(n), encoded, decoded, covered.reshape(height, width))
