"""A model of a light buffer: lights are added one by one, with rounding at every blend."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..vec import Vec4, jnp, light_or_none
from .light_codec import LightCodec

if TYPE_CHECKING:
    from jaxtyping import Array, ArrayLike, Float, Int


@dataclass(frozen=True)
class Blending:
    """The way in which a device accumulates light in a render target.

    Attributes:
        rounding: rounding of the result, "nearest" or "truncate".
        rounds_source: whether the shader's output is also rounded to the format before it is blended, as
            fixed-point hardware may do if the format is linear.
        by_shifts: whether products of such codes are computed with shifts, p + p / 256 + 1/2 for p / 255, as
            software rasterisers do.
    """

    rounding: str = "nearest"
    rounds_source: bool = False
    by_shifts: bool = False


IDEAL = Blending()


def blended(codec: LightCodec, texel: Vec4, light: Vec4, blending: Blending = IDEAL) -> Vec4:
    """Return a texel (any shape) after one more light is added by the codec's method: decoding, adding and encoding
    again, or blending codes by a sum or a product."""
    storage = codec.storage
    if codec.blend == "read":
        total = light_or_none(codec.decode(texel) + light)
        return codec.store(codec.encode(total), blending.rounding)
    source = codec.encode(light_or_none(light))
    if blending.rounds_source and storage.kind == "unorm" and not storage.curved:
        source = codec.store(source)
    if codec.blend == "add":
        return codec.store(texel + source, blending.rounding)
    if blending.by_shifts:
        return Vec4(*(_shifted(a, b, storage.scale(i)) for i, (a, b) in enumerate(zip(texel, source, strict=True))))
    return codec.store(texel * source, blending.rounding)


def _shifted(a: Float[Array, "*shape"], b: Float[Array, "*shape"], scale: int) -> Float[Array, "*shape"]:
    """Return the product of two codes of a fixed-point channel, rounded as in arithmetic with shifts."""
    bits = (scale + 1).bit_length() - 1
    product = jnp.round(a * scale).astype(jnp.int32) * jnp.round(b * scale).astype(jnp.int32)
    code = product + (product >> bits) + 2 ** (bits - 1) >> bits
    return code.astype(jnp.float32) * jnp.float32(1.0 / scale)


def accumulate(codec: LightCodec, lights: Vec4, count: Int[ArrayLike, ""], blending: Blending = IDEAL) -> Vec4:
    """Return texels after the first `count` lights have been added one by one, in their order.

    Args:
        lights: float32 planes of shape (lights, ...), linear.
        count: number of lights to add; may be traced.
        blending: how the device rounds each sum or product.

    Returns:
        planes of shape (...), not yet decoded; see `codec.decode`.
    """
    from jax import lax

    start = Vec4(*(jnp.full(c.shape[1:], codec.no_light, jnp.float32) for c in lights))
    return lax.fori_loop(
        0, count, lambda i, texel: blended(codec, texel, Vec4(*(c[i] for c in lights)), blending), start
    )
