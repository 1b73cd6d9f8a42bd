"""Storages for numbers: render target formats, and integers laid across their channels.

Numbers may be laid across 8-bit channels as integers of any size, the highest bits first (12:12 in three bytes), and
across 16-bit channels if they have more than 32 bits in total. A signed number of n bits is then the integer of SNORM
plus 2^(n-1) - 1, so that -1 becomes 0 and there is a code for 0. Floats of any size are laid out as their own bits.
The conversion of numbers to texels is in `rounding.py`.

Every format in STORAGES can hold normals. FORMATS, whose names layouts use, contains more formats. Formats for
tangent frames and motion vectors are selected from STORAGES by name.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

ROUNDINGS = ("nearest", "truncate", "truncate_half")
# Noise of a step, then to the nearest: of codecs whose measure gives the noise.
DITHERED = "dithered"
ROUNDINGS_AND_DITHERED = (*ROUNDINGS, DITHERED)


def rounds_to(rounding: str) -> str:
    """Return one of ROUNDINGS: "nearest" for DITHERED, because noise is added first; other roundings unchanged."""
    return "nearest" if rounding == DITHERED else rounding


@dataclass(frozen=True)
class FloatForm:
    """The layout of a float: a sign, an exponent and a mantissa. The highest exponent is for infinity and NaN.

    Attributes:
        exponent: number of exponent bits, 2 to 8.
        mantissa: number of mantissa bits, 1 to 23.
        is_signed: whether it has a sign; without a sign, negative numbers become 0 and finite numbers stay finite.
    """

    exponent: int
    mantissa: int
    is_signed: bool = True

    @property
    def bits(self) -> int:
        """The bits of a float."""
        return self.is_signed + self.exponent + self.mantissa

    @property
    def one(self) -> int:
        """The biased exponent of 1."""
        return 2 ** (self.exponent - 1) - 1

    @property
    def largest(self) -> float:
        """The largest finite float."""
        return (2.0 - 2.0**-self.mantissa) * 2.0**self.one


# The floats of GPUs by their size.
FORMS: Mapping[int, FloatForm] = MappingProxyType(
    {32: FloatForm(8, 23), 16: FloatForm(5, 10), 11: FloatForm(5, 6, False), 10: FloatForm(5, 5, False)}
)


@dataclass(frozen=True)
class Storage:
    """A render target format.

    Attributes:
        name: the catalogue's key.
        title: human-readable name.
        kind: "unorm", "snorm" or "float".
        bits: bits of each channel, in channel order.
        internal_format: the OpenGL enum.
        curved: number of leading channels that store linear light on the sRGB curve.
        part: bits per channel of the target across which numbers are laid as integers, 8 or 16; 0 if each number has
            its own channel.
        is_word: whether the numbers are in one integer, the first in the lowest bits, for an integer format or a
            buffer. `part` then describes the channels that the same integer fills in other targets, where it is
            measured.
        is_centred: whether UNORM channels hold the integers of SNORM, increased by 2^(n-1) - 1.
        holds_unit: whether the texels hold numbers in [0, 1] although the format has a sign, because an encoder
            returns such numbers.
        is_said: whether the bits were given explicitly, however few they are.
        is_full: whether signed integers are -2^(n-1) to 2^(n-1) - 1, so that 2^(n-1) would represent 1.
        form: layout of the floats if no GPU has it; otherwise None.
        is_integer: whether the channels are integers, which hold bits and are not blended.
        is_uncounted: whether the bits per float were given, but not the number of floats (see `rules.of_count`).
    """

    name: str
    title: str
    kind: str
    bits: tuple[int, ...]
    internal_format: int
    curved: int = 0
    part: int = 0
    is_word: bool = False
    is_centred: bool = False
    holds_unit: bool = False
    is_said: bool = field(default=False, compare=False)
    is_full: bool = False
    form: FloatForm | None = None
    is_integer: bool = False
    is_uncounted: bool = False

    @property
    def is_packed(self) -> bool:
        """Whether the numbers are laid across channels as integers."""
        return self.part > 0

    def float_form(self, channel: int) -> FloatForm:
        """Return the layout of the floats in a channel."""
        return self.form or FORMS[self.bits[channel]]

    @property
    def channels(self) -> int:
        """The number of values that a texel holds."""
        return len(self.bits)

    @property
    def is_biased(self) -> bool:
        """Whether a number c is stored as c/2 + 1/2: the format has no sign, or its sign is not used."""
        return self.holds_unit or self.kind == "unorm" or (self.kind == "float" and not self.float_form(0).is_signed)

    @property
    def largest(self) -> float:
        """The largest finite number that every channel of a texel can hold: 1 unless the channels are floats."""
        if self.kind != "float":
            return 1.0
        return min(self.float_form(channel).largest for channel in range(self.channels))

    @property
    def target(self) -> Storage:
        """The format of the render target; not the storage itself if numbers are centred or laid across channels."""
        if self.is_centred:
            return STORAGES[self.name.removesuffix(CENTRED)]
        return FORMATS[TARGETS[self.part][-(-sum(self.bits) // self.part)]] if self.is_packed else self

    @property
    def only_measured(self) -> str:
        """A description of the numbers if layouts do not store them and pages do not read them; otherwise empty."""
        if self.form:
            return "float formats that no GPU has"
        if self.is_centred:
            return "centred numbers"
        if self.is_full:
            return "signed integers over a power of two"
        return "words of more than 32 bits" if self.part > 8 else ""

    @property
    def texel_bytes(self) -> int:
        """The number of bytes in a texel of the render target, used or not."""
        return sum(self.target.bits) // 8

    @property
    def field_bits(self) -> int:
        """The total bits of all channels as large as the first, across which integers may be laid; 0 if none may."""
        return self.bits.count(self.bits[0]) * self.bits[0] if self.kind == "unorm" else 0

    def scale(self, channel: int) -> int:
        """Return the integer that represents 1 in a channel; 1 for float formats."""
        if self.kind == "float":
            return 1
        return 2 ** (self.bits[channel] - (self.kind == "snorm")) - (not self.is_full)

    def most(self, channel: int) -> int:
        """Return the largest integer that a fixed-point channel can hold."""
        return self.scale(channel) - self.is_full

    def levels(self, channel: int) -> int:
        """Return the minimum number of evenly spaced values in [-1, 1] that a channel can distinguish."""
        if self.kind != "float":
            return self.scale(channel) * (not self.is_biased) + self.most(channel) + 1
        return 2 ** (self.float_form(channel).mantissa + 1 - self.is_biased)

    def step(self, channel: int) -> float:
        """Return the distance between neighbouring numbers in [-1, 1] in a fixed-point channel."""
        return 1.0 / self.scale(channel) if self.is_full else 2.0 / (self.levels(channel) - 1)

    def count(self, channel: int) -> int:
        """Return how many numbers in [-1, 1] a channel can distinguish, evenly spaced or not."""
        if self.kind != "float":
            return self.levels(channel)
        # From 0 to 1 the floats of each octave, down from the exponent of 1.
        form = self.float_form(channel)
        to_one = form.one << form.mantissa
        return to_one + 1 if self.is_biased else 2 * to_one + 1

    def numbers(self, channel: int) -> np.ndarray:
        """Return the numbers that `count` counts, ascending; float64. Not for 32-bit floats: there are too many."""
        if self.kind != "float":
            return np.linspace(-1.0, 1.0 - self.is_full * self.step(channel), self.count(channel))
        bias, mantissa = self.float_form(channel).one, self.float_form(channel).mantissa
        word = np.arange((bias << mantissa) + 1)
        octave, rest = np.maximum(word >> mantissa, 1), np.where(word >> mantissa, 1.0, 0.0)
        texels = np.ldexp(rest + (word & 2**mantissa - 1) * 2.0**-mantissa, octave - bias)
        return texels * 2.0 - 1.0 if self.is_biased else np.concatenate([-texels[:0:-1], texels])


def _packed_storage(name: str, title: str, kind: str, *bits: int) -> Storage:
    return Storage(name, title, kind, bits, RGBA8, part=8)


def centred_storage(like: Storage) -> Storage:
    """Return a UNORM format as a storage for SNORM integers, with zero in the middle of its range."""
    name, title = f"{like.name}{CENTRED}", f"{like.title} centred"
    return replace(like, name=name, title=title, kind="snorm", is_centred=True)


def of_unit(storage: Storage) -> Storage:
    """Return a storage as filled by an encoder whose codes are in [0, 1]: its texels hold the codes themselves.
    A biased storage is returned unchanged."""
    return storage if storage.is_biased else replace(storage, holds_unit=True)


CENTRED = "_centred"
# By the bits of a channel that numbers are laid across, and by how many channels they take: the target.
TARGETS: Mapping[int, tuple[str, ...]] = MappingProxyType(
    {8: ("", "r8", "rg8", "rgba8", "rgba8"), 16: ("", "r16", "rg16", "rgba16", "rgba16")}
)
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
        "rgba16": Storage("rgba16", "RGBA16", "unorm", (16, 16, 16, 16), 0x805B),
        "rgba16_snorm": Storage("rgba16_snorm", "RGBA16 signed", "snorm", (16, 16, 16, 16), 0x8F9B),
        "rg16f": Storage("rg16f", "RG16F", "float", (16, 16), 0x822F),
        "rgba16f": Storage("rgba16f", "RGBA16F", "float", (16, 16, 16, 16), 0x881A),
        "rgba32f": Storage("rgba32f", "RGBA32F", "float", (32, 32, 32, 32), 0x8814),
        "r11g11b10f": R11G11B10F,
        "rgb8_8_8_1": _packed_storage("rgb8_8_8_1", "8:8:1 in RGB8", "unorm", 8, 8, 1),
        "rgb8_10_10_2": _packed_storage("rgb8_10_10_2", "10:10:2 in RGB8", "unorm", 10, 10, 2),
        "rgb8_10_10_3": _packed_storage("rgb8_10_10_3", "10:10:3 in RGB8", "unorm", 10, 10, 3),
        "rgb8_12_12": _packed_storage("rgb8_12_12", "12:12 in RGB8", "unorm", 12, 12),
        "rgb8_12_12_snorm": _packed_storage("rgb8_12_12_snorm", "12:12 signed in RGB8", "snorm", 12, 12),
        "rgba8_11_11_10": _packed_storage("rgba8_11_11_10", "11:11:10 in RGBA8", "unorm", 11, 11, 10),
        "rgba8_11_10_11": _packed_storage("rgba8_11_10_11", "11:10:11 in RGBA8", "unorm", 11, 10, 11),
        "rgba8_10_10_10_snorm": _packed_storage(
            "rgba8_10_10_10_snorm", "10:10:10 signed in RGBA8", "snorm", 10, 10, 10
        ),
        "rgba8_16_16": _packed_storage("rgba8_16_16", "16:16 in RGBA8", "unorm", 16, 16),
    }
)

# An integer that a user's encoder makes itself, as two halves that are stored exactly.
BITS_32 = replace(STORAGES["rg16"], name="bits32", title="32 bits as they stand")

# What holds a tangent frame: four numbers.
FRAME_STORAGES: Mapping[str, Storage] = MappingProxyType(
    {
        **{name: STORAGES[name] for name in ("rgb10a2", "rgba8", "rgba8_snorm", "rgba16f", "rgba32f")},
        **{name: STORAGES[name] for name in ("rgba16", "rgba16_snorm")},
        "rgba8_10_10_11_1": _packed_storage("rgba8_10_10_11_1", "10:10:11:1 in RGBA8", "unorm", 10, 10, 11, 1),
    }
)

# What holds a motion vector: two numbers. UNORM has no code for 0, unless it is centred.
_OF_MOTION = ("rg8", "rg8_snorm", "rgb10a2", "rg16", "rg16_snorm", "rg16f")
_OF_MOTION += ("rgba8", "rgba8_snorm", "rgba16", "rgba16_snorm", "rgba16f", "rgba32f")
MOTION_STORAGES: Mapping[str, Storage] = MappingProxyType(
    {
        **{name: STORAGES[name] for name in _OF_MOTION},
        **{
            s.name: s
            for s in (centred_storage(STORAGES[name]) for name in ("rg8", "rgb10a2", "rg16", "rgba8", "rgba16"))
        },
    }
)


R16F = Storage("r16f", "R16F", "float", (16,), 0x822D)
R32F = Storage("r32f", "R32F", "float", (32,), 0x822E)
# Writing, blending and clearing convert its colours from linear light: what lies there must be colours.
SRGB8_A8 = Storage("srgb8_a8", "sRGB8 A8", "unorm", (8, 8, 8, 8), 0x8C43, curved=3)

# What holds light.
LIGHT_STORAGES: Mapping[str, Storage] = MappingProxyType(
    {
        **{name: STORAGES[name] for name in ("rgba32f", "rgba16f", "r11g11b10f", "rgba8")},
        "srgb8_a8": SRGB8_A8,
        "rg8_6_2_8": _packed_storage("rg8_6_2_8", "6:2:8 in RG8", "unorm", 6, 2, 8),
        "rgb16_8_8_8_16": Storage("rgb16_8_8_8_16", "8:8:8:16 in RGB16", "unorm", (8, 8, 8, 16), RGBA8, part=16),
    }
)

# Every format that a render target may have; normals are measured in those above.
FORMATS: Mapping[str, Storage] = MappingProxyType(
    {
        **{name: storage for name, storage in STORAGES.items() if not storage.is_packed},
        BITS_32.name: BITS_32,
        "r8": Storage("r8", "R8", "unorm", (8,), 0x8229),
        "r16": Storage("r16", "R16", "unorm", (16,), 0x822A),
        "r16f": R16F,
        "r32f": R32F,
        "rg32f": Storage("rg32f", "RG32F", "float", (32, 32), 0x8230),
        "srgb8_a8": SRGB8_A8,
        "rgb565": Storage("rgb565", "R5 G6 B5", "unorm", (5, 6, 5), 0x8D62),
    }
)

# Whole numbers, which a layout lays bits into. They are not blended, filtered or resolved.
_INTEGERS = {"r8": 0x8232, "r16": 0x8234, "r32": 0x8236, "rg16": 0x823A, "rg32": 0x823C}
_INTEGERS |= {"rgba8": 0x8D7C, "rgba16": 0x8D76, "rgba32": 0x8D70}


def _integer_format(name: str, internal_format: int) -> Storage:
    channels, size = name.rstrip("0123456789"), int(name.lstrip("rgba"))
    title = f"{channels.upper()}{size} UINT"
    return Storage(f"{name}_uint", title, "unorm", (size,) * len(channels), internal_format, is_integer=True)


TARGET_FORMATS: Mapping[str, Storage] = MappingProxyType(
    {**FORMATS, **{f"{name}_uint": _integer_format(name, value) for name, value in _INTEGERS.items()}}
)

# What holds a number of a material, such as a roughness: one channel.
CURVE_STORAGES: Mapping[str, Storage] = MappingProxyType(
    {
        name: FORMATS[name]
        for name in ("r8", "rgba8", "rgb10a2", "r16", "rgba8_snorm", "rgba16_snorm", "r11g11b10f", "r16f", "r32f")
    }
)
