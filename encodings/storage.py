"""How numbers become texels and come back: the arithmetic of render target formats, emulated bit for bit.

UNORM of n bits: x = c/2 + 1/2 is clamped to [0, 1] and stored as the integer nearest x (2^n - 1). SNORM: c is clamped
to [-1, 1] and stored as the integer nearest c (2^(n-1) - 1). Products are float32 products, ties go to the even
integer, NaN takes the lower end; what comes back is the integer times the float32 reciprocal of the scale. That is
OpenGL 4.6, section 2.3.5, with the choices it leaves open made as the devices tested make them (tests/test_storage.py).

Half floats round to nearest even, or are cut off: GL allows both, and both ship. To truncate is to cut off the texel:
UNORM goes down, which is toward -1 in the code; SNORM and floats go toward zero. `truncate_half` is what engines that
pack by hand write to make up for that, floor(x (2^n - 1/2)). Where a device does not round as a codec asks, the shader
rounds before the write (`storage.glsl`), and the row says so.

Numbers may be laid across channels of 8 bits as integers of any size, the highest bits first: 12:12 in three bytes. A
signed one of n bits is then the integer of SNORM above plus 2^(n-1) - 1, so that -1 is 0 and there is a code for 0.

Numbers in float64 stand for the exact map: the same integers and floats, products and reciprocals in float64.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from .vec import jnp, maximum, minimum, select, sign_bit

ROUNDINGS = ("nearest", "truncate", "truncate_half")
# Of floats by their size: bits of the mantissa, and the biased exponent of 1.
MANTISSA = {32: 23, 16: 10, 11: 6, 10: 5}
FLOAT_ONE = {32: 127, 16: 15, 11: 15, 10: 15}
LARGEST = {32: float(np.finfo(np.float32).max), 16: 65504.0, 11: 65024.0, 10: 64512.0}
# IEC 61966-2-1: x is slope x up to the knee, and (1 + offset) x^(1/power) - offset above.
SRGB_KNEE, SRGB_SLOPE, SRGB_OFFSET, SRGB_POWER = 0.0031308, 12.92, 0.055, 2.4


@dataclass(frozen=True)
class Storage:
    """A render target format.

    Attributes:
        name: the catalogue's key.
        title: what a reader calls it.
        kind: "unorm", "snorm" or "float".
        bits: bits of each channel, in channel order.
        internal_format: the GL enum.
        curved: how many of its channels, the first, keep linear light by the sRGB curve.
        is_packed: numbers of so many bits lie as integers across the channels of RGBA8.
    """

    name: str
    title: str
    kind: str
    bits: tuple[int, ...]
    internal_format: int
    curved: int = 0
    is_packed: bool = False

    @property
    def channels(self) -> int:
        """How many numbers it holds."""
        return len(self.bits)

    @property
    def is_biased(self) -> bool:
        """Whether a number c is stored as c/2 + 1/2: the format has no sign."""
        return self.kind == "unorm" or (self.kind == "float" and self.bits[0] < 16)

    @property
    def largest(self) -> float:
        """The largest finite number of a texel that every channel holds."""
        return min(LARGEST[bits] for bits in self.bits) if self.kind == "float" else 1.0

    @property
    def target(self) -> Storage:
        """The format of the render target: another one where numbers are laid across its channels."""
        return STORAGES["rgba8"] if self.is_packed else self

    def scale(self, channel: int) -> int:
        """The integer that stands for 1 in a channel; 1 for float formats."""
        if self.kind == "float":
            return 1
        return 2 ** (self.bits[channel] - (self.kind == "snorm")) - 1

    def levels(self, channel: int) -> int:
        """How many values of a number in [-1, 1] a channel tells apart at least, evenly spread ones."""
        if self.kind != "float":
            return self.scale(channel) * (1 + (self.kind == "snorm")) + 1
        return 2 ** (MANTISSA[self.bits[channel]] + 1 - self.is_biased)

    def count(self, channel: int) -> int:
        """How many numbers in [-1, 1] a channel tells apart, however spread."""
        if self.kind != "float":
            return self.levels(channel)
        # From 0 to 1 the floats of each octave, down from the exponent of 1.
        to_one = FLOAT_ONE[self.bits[channel]] << MANTISSA[self.bits[channel]]
        return to_one + 1 if self.is_biased else 2 * to_one + 1

    def numbers(self, channel: int) -> np.ndarray:
        """Those numbers, ascending; float64. Not of 32-bit floats, which are too many."""
        if self.kind != "float":
            return np.linspace(-1.0, 1.0, self.count(channel))
        one, mantissa = FLOAT_ONE[self.bits[channel]], MANTISSA[self.bits[channel]]
        word = np.arange((one << mantissa) + 1)
        octave, rest = np.maximum(word >> mantissa, 1), np.where(word >> mantissa, 1.0, 0.0)
        texels = np.ldexp(rest + (word & 2**mantissa - 1) * 2.0**-mantissa, octave - one)
        return texels * 2.0 - 1.0 if self.is_biased else np.concatenate([-texels[:0:-1], texels])


def _packed(name: str, title: str, kind: str, *bits: int) -> Storage:
    return Storage(name, title, kind, bits, RGBA8, is_packed=True)


RGBA8 = 0x8058
R11G11B10F = Storage("r11g11b10f", "R11F G11F B10F", "float", (11, 11, 10), 0x8C3A)
STORAGES: Mapping[str, Storage] = MappingProxyType(
    {
        "rgba8": Storage("rgba8", "RGBA8", "unorm", (8, 8, 8, 8), RGBA8),
        "rgba8_snorm": Storage("rgba8_snorm", "RGBA8 signed", "snorm", (8, 8, 8, 8), 0x8F97),
        "rg8": Storage("rg8", "RG8", "unorm", (8, 8), 0x822B),
        "rg8_snorm": Storage("rg8_snorm", "RG8 signed", "snorm", (8, 8), 0x8F95),
        "rgb10a2": Storage("rgb10a2", "RGB10 A2", "unorm", (10, 10, 10, 2), 0x8059),
        "rg16": Storage("rg16", "RG16", "unorm", (16, 16), 0x822C),
        "rg16_snorm": Storage("rg16_snorm", "RG16 signed", "snorm", (16, 16), 0x8F99),
        "rg16f": Storage("rg16f", "RG16F", "float", (16, 16), 0x822F),
        "rgba16f": Storage("rgba16f", "RGBA16F", "float", (16, 16, 16, 16), 0x881A),
        "rgba32f": Storage("rgba32f", "RGBA32F", "float", (32, 32, 32, 32), 0x8814),
        "r11g11b10f": R11G11B10F,
        "rgb8_8_8_1": _packed("rgb8_8_8_1", "8:8:1 in RGB8", "unorm", 8, 8, 1),
        "rgb8_10_10_2": _packed("rgb8_10_10_2", "10:10:2 in RGB8", "unorm", 10, 10, 2),
        "rgb8_10_10_3": _packed("rgb8_10_10_3", "10:10:3 in RGB8", "unorm", 10, 10, 3),
        "rgb8_12_12": _packed("rgb8_12_12", "12:12 in RGB8", "unorm", 12, 12),
        "rgb8_12_12_snorm": _packed("rgb8_12_12_snorm", "12:12 signed in RGB8", "snorm", 12, 12),
        "rgba8_11_11_10": _packed("rgba8_11_11_10", "11:11:10 in RGBA8", "unorm", 11, 11, 10),
        "rgba8_11_10_11": _packed("rgba8_11_10_11", "11:10:11 in RGBA8", "unorm", 11, 10, 11),
        "rgba8_16_16": _packed("rgba8_16_16", "16:16 in RGBA8", "unorm", 16, 16),
    }
)

# What holds a tangent frame: four numbers.
FRAME_STORAGES: Mapping[str, Storage] = MappingProxyType(
    {
        **{name: STORAGES[name] for name in ("rgb10a2", "rgba8", "rgba8_snorm", "rgba16f", "rgba32f")},
        "rgba8_10_10_11_1": _packed("rgba8_10_10_11_1", "10:10:11:1 in RGBA8", "unorm", 10, 10, 11, 1),
        "rgba16": Storage("rgba16", "RGBA16", "unorm", (16, 16, 16, 16), 0x805B),
        "rgba16_snorm": Storage("rgba16_snorm", "RGBA16 signed", "snorm", (16, 16, 16, 16), 0x8F9B),
    }
)


# Most bits of a number laid across channels, far from the 24 that float32 has; and of such storages by the number of
# channels what their names begin with.
MOST_BITS = 20
ACROSS = ("r8", "rg8", "rgb8", "rgba8")


def across(kind: str, bits: tuple[int, ...]) -> Storage:
    """Numbers of so many bits laid across as few channels of 8 bits as hold them: rg8_9_7.

    Raises:
        ValueError: no number or a negative one, more than MOST_BITS, or more than 32 altogether; a line.
    """
    if not all(1 <= b <= MOST_BITS for b in bits) or sum(bits) > 32 or len(bits) not in (2, 3, 4):
        raise ValueError(f"two to four numbers of 1 to {MOST_BITS} bits, 32 altogether, not {':'.join(map(str, bits))}")
    channels, spread = ACROSS[(sum(bits) - 1) // 8], ":".join(map(str, bits))
    is_signed = kind == "snorm"
    name = f"{channels}_{spread.replace(':', '_')}" + ("_snorm" if is_signed else "")
    return _packed(name, f"{spread} {'signed ' if is_signed else ''}in {channels.upper()}", kind, *bits)


def storage_of(name: str) -> Storage | None:
    """The storage of a name: one of the catalogue's, or numbers laid across channels as `rg8_9_7` has them; else None.

    Raises:
        ValueError: laid across channels, but not so; a line.
    """
    match = re.fullmatch(r"(r|rg|rgb|rgba)8((?:_\d{1,3}){2,})(_snorm)?", name)
    if name in STORAGES or not match:
        return STORAGES.get(name)
    made = across("snorm" if match[3] else "unorm", tuple(map(int, match[2][1:].split("_"))))
    if made.name != name:
        raise ValueError(f"{name}: so many bits lie in {made.name}")
    return made


R32F = Storage("r32f", "R32F", "float", (32,), 0x822E)
# Blending and clearing convert colours of it to linear light and back; it is no format for numbers that are not light.
SRGB8_A8 = Storage("srgb8_a8", "sRGB8 A8", "unorm", (8, 8, 8, 8), 0x8C43, curved=3)

# What holds light.
LIGHT_STORAGES: Mapping[str, Storage] = MappingProxyType(
    {**{name: STORAGES[name] for name in ("rgba32f", "rgba16f", "r11g11b10f", "rgba8")}, "srgb8_a8": SRGB8_A8}
)

# Every format that a render target may have; normals are measured in those above.
FORMATS: Mapping[str, Storage] = MappingProxyType(
    {
        **{name: storage for name, storage in STORAGES.items() if not storage.is_packed},
        "r8": Storage("r8", "R8", "unorm", (8,), 0x8229),
        "r32f": R32F,
    }
)


def rounded(x, scale: int, rounding: str = "nearest"):
    """x in [-1, 1] (any shape) as a whole number, `scale` standing for 1: nearest, or cut off toward zero, or
    cut off of x (scale + 1/2)."""
    if rounding == "nearest":
        return jnp.round(x * float(scale))
    widened = jnp.trunc(x * (scale + 0.5 if rounding == "truncate_half" else float(scale)))
    return minimum(maximum(widened, -float(scale)), float(scale))


def store_unorm(x, scale: int, rounding: str = "nearest"):
    """x (float32, any shape) as UNORM stores it and gives it back, in [0, 1]; NaN is 0."""
    return rounded(minimum(maximum(x, 0.0), 1.0), scale, rounding) * (1.0 / scale)


def store_snorm(x, scale: int, rounding: str = "nearest"):
    """x (float32, any shape) as SNORM stores it and gives it back, in [-1, 1]; NaN is -1."""
    code = rounded(minimum(maximum(x, -1.0), 1.0), scale, rounding)
    # An integer has no negative zero.
    return code.astype(jnp.int32).astype(x.dtype) * (1.0 / scale)


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


def store_small_float(x, bits: int, rounding: str = "nearest"):
    """x (float32, any shape) as an unsigned float of 11 or 10 bits stores it: five of exponent, the rest of mantissa.

    There is nothing below 0, and what is finite stays finite: 65024 or 64512 at most (OpenGL 4.6, 2.3.4.3 and 2.3.4.4).
    """
    cut = 23 - (bits - 5)
    least, most = 2.0 ** (-14 - (bits - 5)), 2.0**16 - 2.0 ** (15 - (bits - 5))
    word = maximum(x, 0.0).view(jnp.uint32)
    half = jnp.uint32(2 ** (cut - 1) - 1) + (word >> cut & 1) if rounding == "nearest" else jnp.uint32(0)
    normal = (word + half & jnp.uint32(2**32 - 2**cut)).view(jnp.float32)
    steps = maximum(x, 0.0) * (1.0 / least)
    subnormal = (jnp.round(steps) if rounding == "nearest" else jnp.floor(steps)) * least
    kept = minimum(select(x < 2.0**-14, subnormal, normal), most)
    return select((x == jnp.inf) | jnp.isnan(x), x, kept)


def store_float(x, bits: int, rounding: str = "nearest"):
    """x (float64, any shape, magnitude below 2^15) as a float of so many bits stores it, by arithmetic: what stands for
    the exact map. Of 11 and 10 bits there is nothing below 0."""
    if bits == 32:
        return x.astype(jnp.float32).astype(x.dtype)
    octave = maximum(jnp.frexp(x)[1] - 1, -14)
    step = jnp.ldexp(jnp.ones_like(x), octave - MANTISSA[bits])
    whole = x / step
    stored = (jnp.round(whole) if rounding == "nearest" else jnp.trunc(whole)) * step
    return stored if bits == 16 else maximum(stored, 0.0)


def to_srgb(x):
    """Linear light in [0, 1] (float32, any shape) by the sRGB curve."""
    curved = (1.0 + SRGB_OFFSET) * maximum(x, SRGB_KNEE) ** (1.0 / SRGB_POWER) - SRGB_OFFSET
    return select(x <= SRGB_KNEE, x * SRGB_SLOPE, curved)


def from_srgb(x):
    """Linear light of a value of the sRGB curve in [0, 1] (float32, any shape)."""
    straight = x * (1.0 / SRGB_SLOPE)
    return select(straight <= SRGB_KNEE, straight, ((x + SRGB_OFFSET) / (1.0 + SRGB_OFFSET)) ** SRGB_POWER)


def store_srgb(x, scale: int, rounding: str = "nearest"):
    """x (float32, any shape) as a colour of an sRGB target stores it and gives it back, in [0, 1]; NaN is 0."""
    return from_srgb(store_unorm(to_srgb(minimum(maximum(x, 0.0), 1.0)), scale, rounding))


def store_exactly(x):
    """x (float32, any shape) as it is. Nothing is rounded, and yet XLA must not see through it: it would make one scale
    and offset of the encoder's and the decoder's, and measure another method."""
    from jax.lax import optimization_barrier  # a second to import, which `normalbench list` does not take

    return optimization_barrier(x)


def store_texel(x, storage: Storage, channel: int, rounding: str = "nearest"):
    """One number of a texel (float32, any shape), as the format is given it, through one channel and back."""
    bits, scale = storage.bits[channel], storage.scale(channel)
    if storage.kind == "float":
        if x.dtype != jnp.float32:
            return store_float(x, bits, rounding)
        if bits == 32:
            return store_exactly(x)
        return store_half(x, rounding) if bits == 16 else store_small_float(x, bits, rounding)
    if storage.kind == "snorm":
        return store_snorm(x, scale, rounding)
    return (store_srgb if channel < storage.curved else store_unorm)(x, scale, rounding)


def store_number(c, storage: Storage, channel: int, rounding: str = "nearest"):
    """One number of a code (float32, any shape, nominally in [-1, 1]) through one channel and back."""
    # What is laid across channels is a whole number as UNORM and SNORM have it; its bytes are exact.
    if storage.is_biased:
        return store_texel(c * 0.5 + 0.5, storage, channel, rounding) * 2.0 - 1.0
    return store_texel(c, storage, channel, rounding)


def numbers_around(c, storage: Storage, channel: int):
    """The two numbers that a fixed-point channel can hold around c (float32, any shape), the lower one first."""
    scale = storage.scale(channel)
    x = minimum(maximum(c * 0.5 + 0.5, 0.0) if storage.is_biased else maximum(c, -1.0), 1.0)
    below = jnp.floor(x * float(scale))
    texels = (step * (1.0 / scale) for step in (below, minimum(below + 1.0, float(scale))))
    return tuple(texel * 2.0 - 1.0 if storage.is_biased else texel for texel in texels)


@dataclass(frozen=True)
class DepthStorage:
    """Where the number of a depth lies.

    Attributes:
        name: the catalogue's key.
        title: what a reader calls it.
        format: of the render target, or of the depth attachment.
        home: "packed", an unsigned integer over the last of a target's 8-bit channels; "channel", a target's first; or
            "attachment", the depth buffer itself.
        bits: of the number.
    """

    name: str
    title: str
    format: Storage
    home: str
    bits: int

    @property
    def scale(self) -> int:
        """The integer that stands for 1; 1 for floats."""
        return 1 if self.format.kind == "float" else 2**self.bits - 1

    @property
    def is_signed(self) -> bool:
        """Whether there is room for a sign: a depth buffer holds 0 to 1."""
        return self.home != "attachment"

    @property
    def is_open(self) -> bool:
        """Whether numbers beyond 1 keep their value: floats that are not a depth buffer's."""
        return self.format.kind == "float" and self.home == "channel"


def _native(name: str, title: str, kind: str, bits: int, internal_format: int) -> DepthStorage:
    return DepthStorage(name, title, Storage(name, title, kind, (bits,), internal_format), "attachment", bits)


# A depth buffer of 32-bit integers is not among them: few devices have one, and a shader's depth is a float32, whose
# steps below 1 are 2^-24.
DEPTH_STORAGES: Mapping[str, DepthStorage] = MappingProxyType(
    {
        "packed16": DepthStorage("packed16", "8:8 in B and A of RGBA8", STORAGES["rgba8"], "packed", 16),
        "packed24": DepthStorage("packed24", "8:8:8 in G, B and A of RGBA8", STORAGES["rgba8"], "packed", 24),
        "r16f": DepthStorage("r16f", "R16F", Storage("r16f", "R16F", "float", (16,), 0x822D), "channel", 16),
        "r32f": DepthStorage("r32f", "R32F", R32F, "channel", 32),
        "depth16": _native("depth16", "depth buffer, 16 bits", "unorm", 16, 0x81A5),
        "depth24": _native("depth24", "depth buffer, 24 bits", "unorm", 24, 0x81A6),
        "depth32f": _native("depth32f", "depth buffer, 32-bit float", "float", 32, 0x8CAC),
    }
)


def fixed(c, scale: int, is_signed: bool):
    """The unsigned integer (uint32) for c in [0, 1] (float32, any shape) where `scale` stands for 1; NaN is 0.

    A signed c in [-1, 1] lies in sign and magnitude: the upper half of the integers is for the negative and for -0.
    """
    half = scale // 2
    magnitude = minimum(maximum(abs(c) if is_signed else c, 0.0), 1.0)
    integer = jnp.round(magnitude * jnp.float32(half if is_signed else scale)).astype(jnp.uint32)
    return select(sign_bit(c), integer + jnp.uint32(half + 1), integer) if is_signed else integer


def from_fixed(integer, scale: int, is_signed: bool):
    """The number that an unsigned integer (uint32) stands for."""
    half = scale // 2
    if not is_signed:
        return _share(integer, scale)
    is_negative = integer > half
    magnitude = _share(select(is_negative, integer - jnp.uint32(half + 1), integer), half)
    return select(is_negative, -magnitude, magnitude)


def _share(integer, scale: int):
    """integer / scale for a scale of 2^n - 1, rounded once: i / (2^n - 1) = i 2^-n + i 2^-2n + ...

    As a quotient a compiler may multiply by the rounded reciprocal, which is a whole step off where n is 24.
    """
    high = integer.astype(jnp.float32) * jnp.float32(1.0 / (scale + 1))
    return high + high * jnp.float32(1.0 / (scale + 1))


def store_bytes(integer, bits: int):
    """An unsigned integer over channels of 8-bit UNORM, the highest byte first, and back. No byte is rounded by itself,
    so none can carry into another."""
    together = jnp.zeros_like(integer)
    for shift in range(bits - 8, -1, -8):
        byte = ((integer >> shift) & 0xFF).astype(jnp.float32)
        texel = store_unorm(byte / 255.0, 255)
        together = together | ((texel * 255.0 + 0.5).astype(jnp.uint32) << shift)
    return together


def store_depth(c, storage: DepthStorage, is_signed: bool = False):
    """The number of a depth (float32, any shape) as it comes back; with a sign where `is_signed`."""
    if storage.home == "packed":
        integer = store_bytes(fixed(c, storage.scale, is_signed), storage.bits)
        return from_fixed(integer, storage.scale, is_signed)
    if storage.format.kind != "float":
        return store_unorm(c, storage.scale)
    kept = c if storage.is_open else minimum(maximum(c, 0.0), 1.0)
    return store_half(kept) if storage.bits == 16 else kept
