"""Curves: every magnitude up to the range, the range's ends, 0, and values around a curve's knee."""

from functools import cache

import jax
import numpy as np

from normalbench.encodings.catalogue import CURVE_ENCODINGS
from normalbench.encodings.codecs.curve_codec import CurveCodec, CurveEncoding
from normalbench.encodings.storages.storage import CURVE_STORAGES
from normalbench.gbuffer.codecs.curve.curve_passes import CurvePasses, exact_curves

from .comparison import ULP, Comparison, Parity, in_ulps


def range_of(encoding: CurveEncoding) -> float:
    """Return a range other than 1 or a power of two, so that a forgotten or exchanged range is noticed."""
    return 0.3 * encoding.usual_range


CODECS = [CurveCodec(e, s, range_of(e)) for e in CURVE_ENCODINGS.values() for s in CURVE_STORAGES.values()]


@cache
def shares() -> np.ndarray:
    """Return numbers from 0 to 1: both ends, every magnitude down to 2^-60, around the knee of sRGB, evenly spread
    and random numbers."""
    rng = np.random.default_rng(0)
    knee = 0.0031308 + np.linspace(-1e-4, 1e-4, 256)
    line = np.concatenate([[0.0, 1.0], 2.0 ** -np.arange(0, 61), knee, knee * 12.92, np.linspace(0, 1, 4096)])
    return rng.permutation(np.concatenate([line, rng.uniform(0, 1, 4096), rng.uniform(0, 1, 512) ** 8])).astype("f4")


def quantities(encoding: CurveEncoding) -> np.ndarray:
    """Return quantities from 0 to the range."""
    largest = np.float32(range_of(encoding))
    return np.minimum(shares() * largest, largest)


@cache
def expected(encoding: CurveEncoding) -> tuple[np.ndarray, np.ndarray]:
    """Return JAX's results: the numbers encoded from quantities, and the quantities decoded from numbers."""
    largest = np.float32(range_of(encoding))
    by_jax = jax.jit(encoding.encode)(quantities(encoding), largest), jax.jit(encoding.decode)(shares(), largest)
    return np.asarray(by_jax[0]), np.asarray(by_jax[1])


def compared(gl, encoding: CurveEncoding) -> list[Comparison]:
    """Compare numbers in units of 2^-23, and quantities in units of 2^-23 of the range."""
    largest, x = range_of(encoding), quantities(encoding)
    numbers, back = expected(encoding)
    by_gl = exact_curves(gl, encoding, largest, np.stack([x, x, shares(), shares()], axis=1))
    name, ulps, reason = encoding.name, encoding.ulps, encoding.ulps_reason
    encode = in_ulps(numbers[:, None], by_gl[:, :1])
    decode = in_ulps(back[:, None], by_gl[:, 2:3], largest)
    return [
        Comparison(f"{name}_encode", x, numbers, by_gl[:, 0], encode, ulps[0], reason),
        Comparison(f"{name}_decode", shares(), back, by_gl[:, 2], decode, ulps[1], reason),
    ]


def stored(gl, codec: CurveCodec, _: bool) -> list[Comparison]:
    """Compare round trips: 99.5% give the same result as JAX, and the largest error agrees to 1%."""
    given = quantities(codec.encoding)[:8448]
    by_jax = np.asarray(jax.jit(codec.round_trip)(given))
    with CurvePasses(gl, codec) as passes:
        by_gl = passes.round_trip(np.stack([given, 0 * given], axis=1).reshape(-1, 256, 2)).ravel()
    apart = np.abs(by_jax.astype(np.float64) - by_gl)
    same = apart <= ULP * codec.range * codec.encoding.ulps[1] * 2
    errors = [np.abs(back.astype(np.float64) - given).max(keepdims=True) for back in (by_jax, by_gl)]
    off = np.abs(errors[0] - errors[1]) / np.maximum(0.01 * errors[1], 8 * ULP * codec.range)
    return [
        Comparison(codec.name, given, by_jax, by_gl, apart / (ULP * codec.range), np.inf, same=same, share=0.995),
        Comparison(f"{codec.name}'s largest error", np.arange(1), *errors, off, 1.0),
    ]


PARITY = Parity(
    compared,
    codecs=CODECS,
    stored=stored,
    # A number times the range is the range times the number: nothing else changes.
    same=frozenset({"linear_decode_curve(float range, float e)"}),
)
