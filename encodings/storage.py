"""How numbers become texels and come back: the arithmetic of render target formats, emulated bit for bit.

UNORM of n bits: x = c/2 + 1/2 is clamped to [0, 1] and stored as the integer nearest x (2^n - 1). SNORM: c is clamped
to [-1, 1] and stored as the integer nearest c (2^(n-1) - 1). Products are float32 products, ties go to the even
integer, NaN takes the lower end; what comes back is the integer times the float32 reciprocal of the scale. That is
OpenGL 4.6, section 2.3.5, with the choices it leaves open made as the devices tested make them (tests/test_storage.py).

Half floats round to nearest even, or are cut off: GL allows both, and both ship. To truncate is to cut off the texel:
UNORM goes down, which is toward -1 in the code; SNORM and floats go toward zero. Where a device does not round as a
codec asks, the shader rounds before the write (`storage.glsl`), and the row says so.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from .vec import jnp, maximum, minimum, select

ROUNDINGS = ("nearest", "truncate")


@dataclass(frozen=True)
class Storage:
    """A render target format.

    Attributes:
        name: the catalogue's key.
        title: what a reader calls it.
        kind: "unorm", "snorm" or "float".
        bits: bits of each channel, in channel order.
        internal_format: the GL enum.
    """

    name: str
    title: str
    kind: str
    bits: tuple[int, ...]
    internal_format: int

    @property
    def channels(self) -> int:
        return len(self.bits)

    def scale(self, channel: int) -> int:
        """The integer that stands for 1 in a channel; 1 for float formats."""
        if self.kind == "float":
            return 1
        return 2 ** (self.bits[channel] - (self.kind == "snorm")) - 1


STORAGES: Mapping[str, Storage] = MappingProxyType(
    {
        "rgba8": Storage("rgba8", "RGBA8", "unorm", (8, 8, 8, 8), 0x8058),
        "rgba8_snorm": Storage("rgba8_snorm", "RGBA8 signed", "snorm", (8, 8, 8, 8), 0x8F97),
        "rg8": Storage("rg8", "RG8", "unorm", (8, 8), 0x822B),
        "rg8_snorm": Storage("rg8_snorm", "RG8 signed", "snorm", (8, 8), 0x8F95),
        "rgb10a2": Storage("rgb10a2", "RGB10 A2", "unorm", (10, 10, 10, 2), 0x8059),
        "rg16": Storage("rg16", "RG16", "unorm", (16, 16), 0x822C),
        "rg16_snorm": Storage("rg16_snorm", "RG16 signed", "snorm", (16, 16), 0x8F99),
        "rg16f": Storage("rg16f", "RG16F", "float", (16, 16), 0x822F),
        "rgba16f": Storage("rgba16f", "RGBA16F", "float", (16, 16, 16, 16), 0x881A),
        "rgba32f": Storage("rgba32f", "RGBA32F", "float", (32, 32, 32, 32), 0x8814),
    }
)


def store_unorm(x, scale: int, rounding: str = "nearest"):
    """x (float32, any shape) as UNORM stores it and gives it back, in [0, 1]; NaN is 0."""
    product = minimum(maximum(x, 0.0), 1.0) * jnp.float32(scale)
    code = jnp.round(product) if rounding == "nearest" else jnp.floor(product)
    return code * jnp.float32(1.0 / scale)


def store_snorm(x, scale: int, rounding: str = "nearest"):
    """x (float32, any shape) as SNORM stores it and gives it back, in [-1, 1]; NaN is -1."""
    product = minimum(maximum(x, -1.0), 1.0) * jnp.float32(scale)
    code = jnp.round(product) if rounding == "nearest" else jnp.trunc(product)
    # An integer has no negative zero.
    return code.astype(jnp.int32).astype(jnp.float32) * jnp.float32(1.0 / scale)


def store_half(x, rounding: str = "nearest"):
    """x (float32, any shape) as a 16-bit float stores it: 11 significant bits, steps of 2^-24 below 2^-14.

    Nearest turns what is at least 65520 into infinity; toward zero stops at 65504 and keeps only infinity infinite.
    """
    if rounding == "nearest":
        return x.astype(jnp.float16).astype(jnp.float32)
    bits = x.view(jnp.uint32)
    normal = (bits & jnp.uint32(0xFFFFE000)).view(jnp.float32)
    subnormal = jnp.trunc(x * 2.0**24) * 2.0**-24
    kept = select(abs(x) < 2.0**-14, subnormal, normal)
    return select(jnp.isfinite(x), minimum(maximum(kept, -65504.0), 65504.0), x)


def store_number(c, storage: Storage, channel: int, rounding: str = "nearest"):
    """One number of a code (float32, any shape, nominally in [-1, 1]) through one channel and back."""
    if storage.kind == "unorm":
        return store_unorm(c * 0.5 + 0.5, storage.scale(channel), rounding) * 2.0 - 1.0
    if storage.kind == "snorm":
        return store_snorm(c, storage.scale(channel), rounding)
    return store_half(c, rounding) if storage.bits[channel] == 16 else c
