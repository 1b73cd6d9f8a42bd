"""Motion encodings: every magnitude up to the range, the range's ends, both zeros, and motions beyond the range."""

from functools import cache

import jax
import numpy as np

from normalbench.encodings.catalogue import MOTION_ENCODINGS
from normalbench.encodings.codecs.motion_codec import MotionCodec, MotionEncoding
from normalbench.encodings.storages.storage import MOTION_STORAGES
from normalbench.encodings.vec import Vec2
from normalbench.gbuffer.codecs.motion.motion_passes import MotionPasses, exact_motions

from .comparison import ULP, Comparison, Parity, in_ulps, planes, rows

# Neither 1 nor a power of two, so that a range that is forgotten or exchanged is seen.
RANGE = 0.3
CODECS = [MotionCodec(e, s) for e in MOTION_ENCODINGS.values() for s in MOTION_STORAGES.values()]
# Where moving pixels, still ones and those that are too fast are among what goes through a codec.
MOVING, STILL, BEYOND = slice(0, 16384), slice(16384, 16640), slice(16640, 16896)


@cache
def motions() -> np.ndarray:
    """Return motions up to the range: both zeros, both ends, every magnitude down to 2^-40 of the range, and random
    motions."""
    rng = np.random.default_rng(0)
    powers = RANGE * 2.0 ** -np.arange(0, 41)
    line = np.concatenate([[0.0, -0.0], powers, -powers])
    grid = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    free = rng.uniform(-RANGE, RANGE, (8192, 2))
    slow = rng.normal(size=(8192, 2)) * RANGE * 10.0 ** rng.uniform(-7, -1, (8192, 1))
    return np.clip(np.concatenate([grid, free, slow]), -RANGE, RANGE).astype(np.float32)


@cache
def expected(encoding: MotionEncoding) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return codes of the motions by JAX, codes to decode, and the motions that JAX decodes."""
    largest = np.float32(RANGE)
    codes = rows(jax.jit(encoding.encode)(planes(Vec2, motions()), largest))
    given = np.random.default_rng(1).permutation(codes.ravel()).reshape(-1, 2)
    return codes, given, rows(jax.jit(encoding.decode)(planes(Vec2, given), largest))


def compared(gl, encoding: MotionEncoding) -> list[Comparison]:
    """Compare codes in units of 2^-23, and motions in units of 2^-23 of the range."""
    codes, given, decoded = expected(encoding)
    by_gl = exact_motions(gl, encoding, RANGE, np.concatenate([motions(), given], axis=1))
    name, ulps, reason = encoding.name, encoding.ulps, encoding.ulps_reason
    encode, decode = in_ulps(codes, by_gl[:, :2]), in_ulps(decoded, by_gl[:, 2:], RANGE)
    return [
        Comparison(f"{name}_encode", motions(), codes, by_gl[:, :2], encode, ulps[0], reason),
        Comparison(f"{name}_decode", given, decoded, by_gl[:, 2:], decode, ulps[1], reason),
    ]


@cache
def pixels() -> np.ndarray:
    """Return the motions that go through a codec; see MOVING, STILL and BEYOND."""
    beyond = np.tile(np.float32([[2 * RANGE, -2 * RANGE]]), (256, 1))
    return np.concatenate([motions()[-MOVING.stop :], np.zeros((256, 2), np.float32), beyond])


@cache
def through_jax(codec: MotionCodec) -> np.ndarray:
    return rows(jax.jit(codec.round_trip)(planes(Vec2, pixels()), np.float32(RANGE)))


@cache
def through_gl(gl, codec: MotionCodec) -> np.ndarray:
    with MotionPasses(gl, codec) as passes:
        return passes.round_trip(pixels().reshape(-1, 256, 2), RANGE).reshape(-1, 2)


def stored(gl, codec: MotionCodec, _: bool) -> list[Comparison]:
    """Compare round trips: 99.5% give the same result as JAX, and each component's largest error agrees to 1%."""
    given, by_jax, by_gl = (vectors[MOVING] for vectors in (pixels(), through_jax(codec), through_gl(gl, codec)))
    apart = np.abs(by_jax.astype(np.float64) - by_gl).max(axis=1)
    same = apart <= ULP * RANGE * codec.encoding.ulps[1] * 2
    # One row for each number, in shares of what is allowed.
    errors = [np.abs(back.astype(np.float64) - given).max(axis=0) for back in (by_jax, by_gl)]
    off = np.abs(errors[0] - errors[1]) / np.maximum(0.01 * errors[1], 4 * ULP)
    return [
        Comparison(codec.name, given, by_jax, by_gl, apart / (ULP * RANGE), np.inf, same=same, share=0.995),
        Comparison(f"{codec.name}'s largest error", np.arange(2), *errors, off, 1.0),
    ]


PARITY = Parity(
    compared,
    codecs=CODECS,
    stored=stored,
    # A number times a vector is the vector times the number: nothing else changes.
    same=frozenset({"linear_decode_motion(vec2 range, float e)"}),
)
