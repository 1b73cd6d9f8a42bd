"""Light encodings: values from below the range of floats to above halves, and steps of exponents and multipliers."""

import itertools
from functools import cache

import jax
import numpy as np
from typed import light_buffers_named

from normalbench.bench.tables.lights.sums import steps_apart
from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.encodings.codecs.light_buffer import Blending, accumulate
from normalbench.encodings.codecs.light_codec import LightCodec
from normalbench.encodings.vec import Vec4, light_or_none
from normalbench.gbuffer.codecs.light.light_passes import LightPasses, exact_light

from .comparison import ULP, Comparison, Parity, is_finite, rows
from .comparison import planes as planes_of

SPECIAL = np.float32([0, -0.0, 1e-45, 1e-39, 2.0**-126, -1, -1e30, np.nan, np.inf, -np.inf, 3e38, 65408, 65504, 65536])


def planes(array: np.ndarray) -> Vec4:
    return planes_of(Vec4, array)


def lights(count: int = 2**15) -> np.ndarray:
    """Return light from below the range of floats to above that of halves, special numbers in every channel, and
    numbers at and next to powers of two, shared exponents' ties and the steps of RGBM's multiplier; float32 (count,
    4)."""
    rng = np.random.default_rng(0)
    wide = np.exp2(rng.uniform(-150, 127, (count, 1)) * rng.uniform(0, 1, (count, 1)) + rng.uniform(-9, 0, (count, 4)))
    edges = np.concatenate([2.0 ** np.arange(-26, 17), 511.5 * 2.0 ** np.arange(-24, 7), np.arange(256) * 6 / 255])
    edges = np.concatenate(
        [edges.astype(np.float32)] + [np.nextafter(np.float32(edges), s, dtype=np.float32) for s in (0, 9e9)]
    )
    beside = np.concatenate([np.stack([edges, 0.3 * edges, edges * 0, edges], 1), np.stack([edges] * 4, 1)])
    special = np.array(list(itertools.product(SPECIAL, repeat=2)), np.float32)
    special = np.concatenate([special[:, [0, 1, 1, 0]], special[:, [1, 1, 0, 0]]])
    return np.concatenate([special, beside, wide]).astype(np.float32)


def given_texels(encoding, texels: np.ndarray) -> np.ndarray:
    """Return texels to decode, as the format returns them: any bytes, or floats that were stored."""
    if encoding.storage.kind == "float":
        return texels
    channels = range(encoding.storage.channels)
    scales = np.array([encoding.storage.scale(channel) for channel in channels] + [1] * (4 - len(channels)))
    codes = np.random.default_rng(1).integers(0, scales + 1, texels.shape)
    corners = np.array(list(itertools.product(*((0, 1, scale // 2 + 1, scale) for scale in scales))))
    codes[: len(corners)] = corners
    return codes.astype(np.float32) * (1 / scales).astype(np.float32)


@cache
def decoder(codec: LightCodec):
    return jax.jit(codec.decode)


def decoded(codec: LightCodec, texels: np.ndarray) -> np.ndarray:
    return rows(decoder(codec)(planes(texels)))


@cache
def expected(codec: LightCodec):
    """Return light, its texels, texels to decode, and the light decoded from both sets of texels, by JAX."""
    light = lights()
    texels = rows(jax.jit(lambda light: codec.encode(light_or_none(light)))(planes(light)))
    given = given_texels(codec, texels)
    return light, texels, given, decoded(codec, given), decoded(codec, texels)


def apart(one: np.ndarray, other: np.ndarray, least: float = 2.0**-100) -> np.ndarray:
    """Return the distance between lights, in units in the last place of the brightest channel. Differences below
    2^-126 count as 0, because either language may flush them."""
    difference = np.abs(one.astype(np.float64) - other).max(axis=1)
    ulps = np.where(difference < 2.0**-126, 0, difference) / np.maximum(np.abs(one).max(axis=1), least) / ULP
    return np.where(np.all(np.isfinite(other), axis=1), ulps, np.inf)


def compared(gl, codec: LightCodec) -> list[Comparison]:
    """Compare an encoder's texels, which agree if they or their light are near: next to a step of a shared multiplier
    or exponent, codes far apart stand for similar light."""
    light, texels, given, light_of_given, light_of_texels = expected(codec)
    gl_texels, gl_light = exact_light(gl, codec, light, given)
    encode = np.minimum(apart(texels, gl_texels, 1.0), apart(light_of_texels, decoded(codec, gl_texels)))
    ulps, reason = codec.encoding.ulps, codec.encoding.ulps_reason
    return [
        Comparison(f"{codec.name}_encode", light, texels, gl_texels, encode, ulps[0], reason),
        Comparison(
            f"{codec.name}_decode", given, light_of_given, gl_light, apart(light_of_given, gl_light), ulps[1], reason
        ),
    ]


def guarded(gl, codec: LightCodec) -> list[Comparison]:
    """Compare denormals, infinities, NaN and negative light; their texels must also decode to finite light."""
    light, texels, _, _, light_of_texels = expected(codec)
    gl_texels, gl_light = exact_light(gl, codec, light, texels)
    return [
        is_finite(f"{codec.name}_encode", light, texels, gl_texels),
        is_finite(f"{codec.name}_decode", texels, light_of_texels, gl_light),
    ]


def stored(gl, codec: LightCodec, _: bool) -> list[Comparison]:
    """Compare a single light in an empty buffer: 99.9% of 2^14 lights give the same texel, and none is more than a
    step off. The limit is 1.5 steps if the device converts to a format in its own way, which sRGB allows."""
    rng, count = np.random.default_rng(0), 2**14
    light = rng.uniform(0, 1, (count, 1)) * rng.uniform(0, 1, (count, 4)) * min(codec.limit, 64)
    light = light.astype(np.float32)
    # What lies across channels is rounded by the shader.
    rounding = "nearest" if codec.storage.is_packed else gl.native_rounding(codec.storage)
    blending = Blending(rounding if rounding == "truncate" else "nearest")
    alone = Vec4(*(c[None] for c in planes(light)))
    by_jax = rows(jax.jit(lambda lights: accumulate(codec, lights, 1, blending))(alone))
    with LightPasses(gl, codec) as passes:
        by_gl = passes.accumulate(light[None]).texels
    off = steps_apart(codec.storage, by_jax, by_gl).max(axis=-1)
    allowed, share = (1.5, 0.0) if rounding == "other" else (1.0, 0.999)
    return [Comparison(codec.name, light, by_jax, by_gl, off, allowed, same=off < 0.5, share=share)]


PARITY = Parity(
    compared,
    cases=lambda encoding: [codec for codec in LIGHT_BUFFERS.values() if codec.encoding is encoding],
    guarded=guarded,
    codecs=[*LIGHT_BUFFERS.values(), *light_buffers_named("ufloat:6:9,linear/unorm:10:10:10,linear:3/unorm:9:9:9:5")],
    stored=stored,
)
