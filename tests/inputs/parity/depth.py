"""Depth encodings at both planes and near and beyond them, compared in both languages and with the exact maps."""

from functools import cache
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from neighbours import around

from normalbench.encodings.catalogue import DEPTH_ENCODINGS
from normalbench.encodings.codecs.depth_codec import REBUILDS, DepthCodec, DepthEncoding
from normalbench.encodings.shared.position import (
    Camera,
    position_from_linear_depth,
    position_from_projection_terms,
    position_from_window_depth,
)
from normalbench.encodings.storages.depth_storage import DEPTH_STORAGES
from normalbench.encodings.vec import Vec2, depth_or_far
from normalbench.gbuffer.codecs.depth.depth_passes import DepthPasses, exact_values

from .comparison import ULP, Comparison, Parity, planes, rows

CODECS = [DepthCodec(encoding, storage) for encoding in DEPTH_ENCODINGS.values() for storage in DEPTH_STORAGES.values()]
CODECS = [codec for codec in CODECS if codec.fits]
CAMERAS = [Camera(0.1, 1000.0, 60.0, 16 / 9), Camera(1.0, 10.0, 30.0, 1.0), Camera(1e-3, 1e6, 120.0, 2.0)]
EYE_RAY = REBUILDS["eye_ray"].way
# At a far plane of 1 a linear depth is its own number.
UNIT = Camera(0.1, 1.0, 60.0, 1.0)
POSITION_ULPS = (3, 3, 1)


class Case(NamedTuple):
    encoding: DepthEncoding
    camera: Camera


def hard_depths(camera: Camera, is_signed: bool, count: int = 2**14) -> np.ndarray:
    """Return both planes with three ulps around each, every power of two between, random depths with evenly spread
    logarithms, and depths beyond the planes; with signs, every second depth is negative; float32."""
    powers = 2.0 ** np.arange(np.ceil(np.log2(camera.near)), np.log2(camera.far))
    random = np.exp(np.random.default_rng(0).uniform(np.log(camera.near), np.log(camera.far), count))
    beyond = np.repeat([2 * camera.far, 100 * camera.far], 2)
    ends = around(np.array([camera.near, camera.far]))
    return alternating(np.concatenate([ends, powers, random, beyond]).astype(np.float32), is_signed)


def hard_numbers(is_signed: bool, count: int) -> np.ndarray:
    """Return 0, 1/4, 1/2, 1, the smallest steps of each storage from both ends, and random numbers; float32."""
    steps = np.array([1 / storage.scale for storage in DEPTH_STORAGES.values()] + [2.0**-24])
    chosen = np.concatenate([[0, 0.25, 0.5, 1], steps, 1 - steps, np.random.default_rng(1).uniform(0, 1, count)])
    return alternating(np.resize(chosen, count).astype(np.float32), is_signed)


def alternating(numbers: np.ndarray, is_signed: bool) -> np.ndarray:
    return np.where(np.arange(len(numbers)) % 2 == 1, -numbers, numbers) if is_signed else numbers


def exact_and_units(function, inputs: np.ndarray, camera: Camera):
    """Return the exact map of inputs in float64, and for each a unit: 2^-23 of the result plus the change of the
    result for 2^-23 of the input."""
    with jax.enable_x64(True):
        wide = jnp.asarray(inputs, jnp.float64)
        near, far = (jnp.float64(np.float32(plane)) for plane in (camera.near, camera.far))
        exact = np.asarray(function(wide, near, far))
        moved = np.maximum(*(abs(np.asarray(function(wide * (1 + s), near, far)) - exact) for s in (ULP, -ULP)))
    return exact, ULP * abs(exact) + moved


@cache
def expected(case: Case):
    """Return points for a shader, and the results of encoder and decoder, by JAX and exactly."""
    encoding, camera = case
    depths = hard_depths(camera, encoding.signed)
    numbers = hard_numbers(encoding.signed, len(depths))
    places = np.random.default_rng(2).uniform(-1, 1, (len(depths), 2)).astype(np.float32)
    places[:5] = [(0, 0), (1, 1), (-1, -1), (1, -1), (-1, 1)]
    near, far = jnp.float32(camera.near), jnp.float32(camera.far)
    by_jax = [
        np.asarray(encoding.encode(depth_or_far(jnp.asarray(depths), far), near, far)),
        np.asarray(encoding.decode(jnp.asarray(numbers), near, far)),
    ]
    known = np.minimum(abs(depths.astype(np.float64)), np.float32(camera.far))
    exact = [
        exact_and_units(encoding.encode, np.copysign(known, depths), camera),
        exact_and_units(encoding.decode, numbers, camera),
    ]
    return np.concatenate([places, depths[:, None], numbers[:, None]], axis=1), by_jax, exact


def compared(gl, case: Case) -> list[Comparison]:
    """Compare encoder and decoder, and also positions if the number is that of a depth buffer."""
    points, by_jax, exact = expected(case)
    values, *positions = exact_values(gl, case.encoding, case.camera, points)
    sides = [one_side(case, side, points[:, 2 + side], by_jax[side], values[:, side], *exact[side]) for side in (0, 1)]
    return sides + (positions_compared(case, points, positions) if case.encoding.projection else [])


def one_side(case: Case, side: int, given, by_jax, by_gl, exact, units) -> Comparison:
    """Compare each language with the exact map, and the two languages with each other, in units."""
    with np.errstate(invalid="ignore"):
        off = [abs(by_gl - exact), abs(by_jax - exact), abs(by_gl.astype(np.float64) - by_jax)]
        apart = np.max(off, axis=0) / np.maximum(units, 2.0**-126)
    apart = np.where(np.isfinite(apart), apart, np.inf)
    encoding, camera = case
    what = f"{encoding.name}_{('encode', 'decode')[side]}, {camera.near:g} to {camera.far:g},"
    allowed, reason = encoding.ulps[side], encoding.ulps_reason
    return Comparison(what, given, by_jax, by_gl, apart, allowed, reason, details={"exactly": exact})


def positions_by_jax(case: Case, points: np.ndarray) -> list[np.ndarray]:
    seen, place = case.camera.seen(case.encoding.projection), planes(Vec2, points[:, :2])
    positions = (
        position_from_window_depth(place, jnp.asarray(points[:, 3]), seen.clip, seen.clip_to_view),
        position_from_projection_terms(place, jnp.asarray(points[:, 3]), seen.clip, seen.terms, seen.rays),
        position_from_linear_depth(place, jnp.asarray(points[:, 2]), seen.rays),
    )
    return [rows(position) for position in positions]


def positions_compared(case: Case, points: np.ndarray, by_gl) -> list[Comparison]:
    """Compare positions by the inverse projection, its two terms and the ray, in units in the last place of the
    position, for the projection times the cancellation of its sum."""
    encoding, camera = case
    row, (scale, offset) = camera.clip_to_view(encoding.projection)[3], encoding.projection.clip
    ndc = scale * points[:, 3].astype(np.float64) + offset
    sums = [(row[2] * ndc, np.full(len(ndc), row[3])), (ndc, np.full(len(ndc), camera.terms(encoding.projection)[0]))]
    cancels = [(abs(a) + abs(b)) / np.maximum(abs(a + b), 1e-300) for a, b in sums] + [np.ones(len(ndc))]
    names = ("inverse projection", "projection terms", "eye ray")
    ways = zip(names, positions_by_jax(case, points), by_gl, cancels, strict=True)
    comparisons = []
    for (what, ours, theirs, times), allowed in zip(ways, POSITION_ULPS, strict=True):
        with np.errstate(invalid="ignore"):
            off = np.linalg.norm(ours.astype(np.float64) - theirs, axis=1) / np.linalg.norm(ours, axis=1) / times / ULP
        # Where the sum cancels to nothing that float32 keeps, neither language says anything.
        off = np.where(times * POSITION_ULPS[0] * ULP < 0.5, np.where(np.isfinite(off), off, np.inf), 0)
        comparisons.append(Comparison(f"{encoding.name} by {what}", points, ours, theirs, off, allowed))
    return comparisons


def hard_codes(storage) -> np.ndarray:
    """Return numbers in [0, 1] with their neighbours. For 16 bits: every code and every tie; for 24 bits: codes
    around each carry, and random codes; for floats: random numbers of every exponent, and each half float with the
    tie after it."""
    random = np.random.default_rng(3)
    if storage.format.kind == "float":
        halves = np.arange(2**16, dtype=np.uint16).view(np.float16).astype(np.float32)
        halves = np.sort(halves[(halves >= 0) & (halves <= 1)])
        ties = (halves[1:] + halves[:-1]) / 2
        return np.concatenate([around(halves, 1), around(ties, 1), 2.0 ** random.uniform(-30, 0, 2**14)]).astype("f")
    codes = np.arange(2.0**16)
    if storage.bits > 16:
        carries = np.arange(0, 2.0**storage.bits, 2**8)
        codes = np.concatenate([carries - 1, carries, carries + 1, random.integers(0, storage.scale, 2**12)])
    codes = np.clip(np.concatenate([codes, codes + 0.5]), 0, storage.scale)
    return np.clip(around(codes / storage.scale), 0, 1)


def numbers_by_gl(gl, codec: DepthCodec, camera: Camera, depths: np.ndarray, width: int = 1024) -> np.ndarray:
    points = np.zeros((-(-len(depths) // width) * width, 3), np.float32)
    points[: len(depths), 2] = depths
    with DepthPasses(gl, codec) as passes:
        return passes.round_trip(points.reshape(-1, width, 3), camera, EYE_RAY).numbers.ravel()[: len(depths)].copy()


def numbers_by_jax(codec: DepthCodec, camera: Camera, depths: np.ndarray) -> np.ndarray:
    near, far, size = jnp.float32(camera.near), jnp.float32(camera.far), 2**13
    # Always so many at once: JAX compiles each operation for each shape.
    parts = np.pad(depths, (0, -len(depths) % size)).reshape(-1, size)
    return np.concatenate([np.asarray(codec.stored(jnp.asarray(part), near, far)) for part in parts])[: len(depths)]


def same_bits(what: str, given, by_jax, by_gl) -> Comparison:
    # Either side may flush what is below the smallest normal float32, and does or does not by what ran before.
    ours, other = (np.where(np.abs(a) < 2.0**-126, np.copysign(np.float32(0), a), a) for a in (by_jax, by_gl))
    different = ours.view(np.uint32) != other.view(np.uint32)
    return Comparison(what, given, by_jax, by_gl, np.where(different, np.inf, 0.0), 0.0, "bit for bit")


def handed_on(gl, codec: DepthCodec, given, by_jax, by_gl) -> Comparison:
    """Compare numbers that a storage keeps unchanged: bit for bit in software. A GPU stores the nearest whole number,
    either of the two in a tie, and returns it to within two units in the last place."""
    if gl.is_software or codec.storage.format.kind == "float":
        return same_bits(codec.name, given, by_jax, by_gl)
    step, exact = step_of(codec, by_jax), np.clip(abs(given.astype(np.float64)), 0, 1)
    apart = (abs(abs(by_gl.astype(np.float64)) - exact) - 2 * ULP * exact) / step
    return Comparison(codec.name, given, by_jax, by_gl, apart, 0.5 + 1e-6, "the nearest whole number")


def stored(gl, codec: DepthCodec, is_slow: bool) -> list[Comparison]:
    """Compare codes of 16 bits: 99.9% of the hard depths have the same code (99.8% with a GPU's quotients), and no
    two are more than a step apart. The slow test compares numbers that linear depth with a far plane of 1 keeps
    unchanged."""
    if is_slow:
        depths = hard_codes(codec.storage)
        depths = np.concatenate([depths, -depths]) if codec.encoding.signed else depths
        return [handed_on(gl, codec, depths, *(numbers(codec, UNIT, depths) for numbers in both(gl)))]
    depths = hard_depths(CAMERAS[0], codec.encoding.signed)
    by_jax, by_gl = (numbers(codec, CAMERAS[0], depths) for numbers in both(gl))
    apart = abs(by_jax.astype(np.float64) - by_gl) / step_of(codec, by_jax)
    share = 0.999 if gl.is_software else 0.998
    return [Comparison(codec.name, depths, by_jax, by_gl, apart, 1.0, same=apart < 0.5, share=share)]


def both(gl):
    """Return the functions, in JAX and in GLSL, that give the numbers of a codec, a camera and depths."""
    return numbers_by_jax, lambda *asked: numbers_by_gl(gl, *asked)


def step_of(codec: DepthCodec, numbers: np.ndarray):
    """Return the distance between neighbouring codes of 16 bits."""
    if codec.storage.format.kind == "float":
        return np.spacing(abs(numbers).astype(np.float16)).astype(np.float64)
    return 1 / (codec.storage.scale // 2 if codec.encoding.signed else codec.storage.scale)


PARITY = Parity(
    compared,
    cases=lambda encoding: [Case(encoding, camera) for camera in CAMERAS],
    codecs=[codec for codec in CODECS if codec.storage.bits == 16],
    more_codecs=[codec for codec in CODECS if codec.encoding.name in ("linear", "linear_sign")],
    stored=stored,
    shared={"window": ["shared/position.glsl"], "linear_sign": ["sign.glsl", "vec.glsl:float depth_or_far"]},
    # A product of the two that change places: these are not other functions.
    same=frozenset(
        {
            "linear_decode_depth(float far, float near, float number)",
            "linear_sign_decode_depth(float far, float near, float number)",
            "position_from_linear_depth(vec2 rays, float depth, vec2 place)",
            "position_from_projection_terms(vec2 rays, float depth, vec2 clip, vec2 terms, vec2 place)",
        }
    ),
)
