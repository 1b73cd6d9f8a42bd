"""Conversion of numbers to texels and back: the arithmetic of render target formats, emulated bit for bit.

UNORM of n bits: x = c/2 + 1/2 is clamped to [0, 1] and stored as the integer nearest x (2^n - 1). SNORM: c is
clamped to [-1, 1] and stored as the integer nearest c (2^(n-1) - 1). Products are float32 products, ties go to the
even integer, and NaN becomes the lower end; the value read back is the integer times the float32 reciprocal of the
scale. This is OpenGL 4.6, section 2.3.5; its open choices are made as on the tested devices (`test_storage.py`).

Half floats are rounded to nearest even, or truncated: OpenGL allows both, and devices do both. Truncation applies to
the texel: UNORM is rounded down, toward -1 in the code; SNORM, centred or not, and floats are rounded toward zero.
With `truncate_half`, floor(x (2^n - 1/2)), engines that pack by hand compensate for this. If a device does not
round as a codec requests, the shader rounds before the write (`storage.glsl`), and the row states this.

Numbers in float64 represent the exact map: the same integers and floats, but products and reciprocals in float64.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..vec import jnp, maximum, minimum, select, sign_bit
from .storage import FORMS, STORAGES, FloatForm, Storage, of_unit

if TYPE_CHECKING:
    from jaxtyping import Array, Float

# IEC 61966-2-1: x is slope x up to the knee, and (1 + offset) x^(1/power) - offset above.
SRGB_KNEE, SRGB_SLOPE, SRGB_OFFSET, SRGB_POWER = 0.0031308, 12.92, 0.055, 2.4


class Scale(NamedTuple):
    """The integer for 1 in a fixed-point channel, and its reciprocal; numbers, or arguments of a traced function."""

    one: Any
    reciprocal: Any


def scale_of(integer: int) -> Scale:
    """Return the scale of a channel in which an integer represents 1."""
    return Scale(float(integer), 1.0 / integer)


def rounded(x: Float[Array, "*shape"], scale: Scale, rounding: str = "nearest", most=None) -> Float[Array, "*shape"]:
    """Scale x in [-1, 1] (any shape) and return it as whole numbers: to nearest, or truncated toward zero.

    "truncate_half" truncates x (one + 1/2).

    Args:
        most: the largest whole number, if it does not represent 1.
    """
    if rounding == "nearest":
        whole = jnp.round(x * scale.one)
        return whole if most is None else minimum(whole, most)
    widened = jnp.trunc(x * (scale.one + 0.5 if rounding == "truncate_half" else scale.one))
    return minimum(maximum(widened, -scale.one), scale.one if most is None else most)


def store_unorm(
    x: Float[Array | np.ndarray, "*shape"], scale: Scale, rounding: str = "nearest"
) -> Float[Array, "*shape"]:
    """Return x (float32, any shape) after storage as UNORM, in [0, 1]; NaN becomes 0."""
    return rounded(minimum(maximum(x, 0.0), 1.0), scale, rounding) * scale.reciprocal


def store_snorm(
    x: Float[Array | np.ndarray, "*shape"], scale: Scale, rounding: str = "nearest", is_full: bool = False
) -> Float[Array, "*shape"]:
    """Return x (float32, any shape) after storage as SNORM, in [-1, 1]; NaN becomes -1. A full SNORM lacks 1."""
    code = rounded(minimum(maximum(x, -1.0), 1.0), scale, rounding, scale.one - 1 if is_full else None)
    # An integer has no negative zero.
    return code.astype(jnp.int32).astype(x.dtype) * scale.reciprocal


def store_half(
    x: Float[Array | np.ndarray, "*shape"], rounding: str = "nearest"
) -> Float[Array | np.ndarray, "*shape"]:
    """Return x (float32, any shape) as a 16-bit float stores it: 11 significant bits, steps of 2^-24 below 2^-14.

    Rounding to nearest turns numbers of at least 65520 into infinity; rounding toward zero stops at 65504 and keeps
    only infinity infinite.
    """
    if rounding == "nearest":
        return x.astype(jnp.float16).astype(jnp.float32)
    return store_small_float(x, FORMS[16], rounding)


def store_small_float(
    x: Float[Array | np.ndarray, "*shape"], form: FloatForm, rounding: str = "nearest"
) -> Float[Array, "*shape"]:
    """Return x (float32, any shape) as a float of the given form stores it.

    Without a sign, negative numbers become 0 and finite numbers stay finite (OpenGL 4.6, 2.3.4.3 and 2.3.4.4). With a
    sign, numbers that are too large become infinite if rounded to nearest, but not toward zero (IEEE 754).
    """
    magnitude = abs(x) if form.is_signed else maximum(x, 0.0)
    cut, word = 23 - form.mantissa, magnitude.view(jnp.uint32)
    is_nearest = rounding == "nearest" and cut > 0
    half = jnp.uint32(2 ** (cut - 1) - 1) + (word >> cut & 1) if is_nearest else jnp.uint32(0)
    kept = (word + half & jnp.uint32(2**32 - 2**cut)).view(jnp.float32)
    # Of eight bits of exponent those below the normal ones are float32's own.
    if form.exponent < 8:
        least = 2.0 ** (1 - form.one - form.mantissa)
        steps = magnitude * (1.0 / least)
        subnormal = (jnp.round(steps) if rounding == "nearest" else jnp.floor(steps)) * least
        kept = select(magnitude < 2.0 ** (1 - form.one), subnormal, kept)
    too_large = jnp.inf if form.is_signed and rounding == "nearest" else form.largest
    kept = select(kept > form.largest, too_large, kept)
    signed = select(sign_bit(x), -kept, kept) if form.is_signed else kept
    is_endless = jnp.isinf(x) if form.is_signed else x == jnp.inf
    return select(is_endless | jnp.isnan(x), x, signed)


def store_float(
    x: Float[Array | np.ndarray, "*shape"], form: FloatForm, rounding: str = "nearest"
) -> Float[Array | np.ndarray, "*shape"]:
    """Return x (float64, any shape, magnitude below 2^15) as a float of the given form stores it, computed by
    arithmetic, because float64 represents the exact map. Without a sign, negative numbers become 0."""
    if form == FORMS[32]:
        return x.astype(jnp.float32).astype(x.dtype)
    octave = maximum(jnp.frexp(x)[1] - 1, 1 - form.one)
    step = jnp.ldexp(jnp.ones_like(x), octave - form.mantissa)
    whole = x / step
    stored = (jnp.round(whole) if rounding == "nearest" else jnp.trunc(whole)) * step
    return stored if form.is_signed else maximum(stored, 0.0)


def to_srgb(x: Float[Array | np.ndarray, "*shape"]) -> Float[Array | np.ndarray, "*shape"]:
    """Return the sRGB-encoded value of linear light in [0, 1] (float32, any shape)."""
    curved = (1.0 + SRGB_OFFSET) * maximum(x, SRGB_KNEE) ** (1.0 / SRGB_POWER) - SRGB_OFFSET
    return select(x <= SRGB_KNEE, x * SRGB_SLOPE, curved)


def from_srgb(x: Float[Array | np.ndarray, "*shape"]) -> Float[Array | np.ndarray, "*shape"]:
    """Return the linear light of an sRGB-encoded value in [0, 1] (float32, any shape)."""
    straight = x * (1.0 / SRGB_SLOPE)
    return select(straight <= SRGB_KNEE, straight, ((x + SRGB_OFFSET) / (1.0 + SRGB_OFFSET)) ** SRGB_POWER)


def store_srgb(
    x: Float[Array | np.ndarray, "*shape"], scale: Scale, rounding: str = "nearest"
) -> Float[Array | np.ndarray, "*shape"]:
    """Return x (float32, any shape) after storage as a colour in an sRGB target, in [0, 1]; NaN becomes 0."""
    return from_srgb(store_unorm(to_srgb(minimum(maximum(x, 0.0), 1.0)), scale, rounding))


def store_exactly(x: Float[Array | np.ndarray, "*shape"]) -> Float[Array | np.ndarray, "*shape"]:
    """Return x (float32, any shape) unchanged, behind an optimisation barrier. Without the barrier, XLA would merge
    the scales and offsets of the encoder and the decoder, and a different method would be measured."""
    from jax.lax import optimization_barrier  # a second to import, which `normalbench list` does not take

    return optimization_barrier(x)


@dataclass(frozen=True)
class Fixed(Storage):
    """A fixed-point format whose scales are arguments, so that a function is traced once for all bit counts."""

    scales: tuple[Scale, ...] = ()


def scales_of(storage: Storage, number: type[np.floating] = np.float32) -> tuple[Scale, ...]:
    """Return the scales of all channels of a fixed-point format, in float32 or float64, for a traced function."""
    scales = (scale_of(storage.scale(channel)) for channel in range(storage.channels))
    return tuple(Scale(*map(number, scale)) for scale in scales)


def shared(storage: Storage, count: int, number: type[np.floating] = np.float32) -> tuple[Storage, tuple[Scale, ...]]:
    """Return the arguments with which one traced function serves all fixed-point formats of a kind: a format that
    represents them all, and the scales of this format's first `count` channels, in float32 or float64. The scales are
    empty for float and sRGB formats. A GPU's float format is represented by the first format with the same bits in
    these channels, and other such formats by themselves."""
    if storage.kind == "float":
        if storage.form:
            return storage, ()
        alike = (s for s in STORAGES.values() if (s.kind, s.bits[:count]) == ("float", storage.bits[:count]))
        return _filled_as(storage, next(alike, storage)), ()
    if storage.curved:
        return storage, ()
    like = replace(STORAGES["rgba8" if storage.kind == "unorm" else "rgba8_snorm"], is_full=storage.is_full)
    return _filled_as(storage, like), scales_of(storage, number)[:count]


def _filled_as(storage: Storage, like: Storage) -> Storage:
    return of_unit(like) if storage.holds_unit else like


def fixed(like: Storage, scales: tuple[Scale, ...]) -> Storage:
    """Return `like` with the given scales, one per channel in use; `like` itself if there are no scales."""
    return Fixed(**vars(like), scales=scales) if scales else like


def _scale(storage: Storage, channel: int) -> Scale:
    return storage.scales[channel] if isinstance(storage, Fixed) else scale_of(storage.scale(channel))


def store_texel(
    x: Float[Array | np.ndarray, "*shape"], storage: Storage, channel: int, rounding: str = "nearest"
) -> Float[Array | np.ndarray, "*shape"]:
    """Return one number of a texel (float32, any shape), as given to the format, after storage in one channel.

    A float16 is a result of half arithmetic, which covers the shader's number, not the format's own conversion.
    """
    if x.dtype == jnp.float16:
        return store_texel(x.astype(jnp.float32), storage, channel, rounding).astype(jnp.float16)
    if storage.kind == "float":
        return _store_float_texel(x, storage.float_form(channel), rounding)
    if storage.kind == "snorm":
        return store_snorm(x, _scale(storage, channel), rounding, storage.is_full)
    return (store_srgb if channel < storage.curved else store_unorm)(x, _scale(storage, channel), rounding)


def _store_float_texel(
    x: Float[Array | np.ndarray, "*shape"], form: FloatForm, rounding: str
) -> Float[Array | np.ndarray, "*shape"]:
    if x.dtype != jnp.float32:
        return store_float(x, form, rounding)
    if form == FORMS[32]:
        return store_exactly(x)
    return store_half(x, rounding) if form == FORMS[16] else store_small_float(x, form, rounding)


def store_number(
    c: Float[Array | np.ndarray, "*shape"], storage: Storage, channel: int, rounding: str = "nearest"
) -> Float[Array | np.ndarray, "*shape"]:
    """Return one number of a code (float32, any shape, nominally in [-1, 1]) after storage in one channel."""
    # What is laid across channels is a whole number as UNORM and SNORM have it; its bytes are exact.
    if storage.is_biased:
        return store_texel(c * 0.5 + 0.5, storage, channel, rounding) * 2.0 - 1.0
    return store_texel(c, storage, channel, rounding)


def numbers_around(c: Float[Array, "*shape"], storage: Storage, channel: int) -> tuple[Float[Array, "*shape"], ...]:
    """Return the two neighbouring numbers of a fixed-point channel around c (float32, any shape), the lower first;
    they are equal if c is at the upper end."""
    scale = _scale(storage, channel)
    x = minimum(maximum(c * 0.5 + 0.5, 0.0) if storage.is_biased else maximum(c, -1.0), 1.0)
    below = jnp.floor(x * scale.one)
    most = scale.one - 1.0 if storage.is_full else scale.one
    texels = (step * scale.reciprocal for step in (minimum(below, most), minimum(below + 1.0, most)))
    return tuple(texel * 2.0 - 1.0 if storage.is_biased else texel for texel in texels)
