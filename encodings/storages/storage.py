"""What numbers are stored in: render target formats, and integers laid across their channels.

Numbers may be laid across channels of 8 bits as integers of any size, the highest bits first: 12:12 in three bytes. A
signed one of n bits is then the integer of SNORM plus 2^(n-1) - 1, so that -1 is 0 and there is a code for 0. How
numbers become texels is in `rounding.py`.

A format in STORAGES holds normals everywhere. FORMATS, which layouts name, has these and more. Those of tangent frames
and of motion vectors are picked from STORAGES by their names.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

ROUNDINGS = ("nearest", "truncate", "truncate_half")
# Of floats by their size: bits of the mantissa, and the biased exponent of 1.
MANTISSA = {32: 23, 16: 10, 11: 6, 10: 5}
FLOAT_ONE = {32: 127, 16: 15, 11: 15, 10: 15}
LARGEST = {32: float(np.finfo(np.float32).max), 16: 65504.0, 11: 65024.0, 10: 64512.0}


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
        is_centred: the integers of SNORM lie in UNORM channels, 2^(n-1) - 1 more than themselves.
        holds_unit: its texels hold numbers in [0, 1] though it has a sign: those of an encoder that returns them so.
        is_said: somebody said its bits, however few they are.
    """

    name: str
    title: str
    kind: str
    bits: tuple[int, ...]
    internal_format: int
    curved: int = 0
    is_packed: bool = False
    is_centred: bool = False
    holds_unit: bool = False
    is_said: bool = field(default=False, compare=False)

    @property
    def channels(self) -> int:
        """How many numbers it holds."""
        return len(self.bits)

    @property
    def is_biased(self) -> bool:
        """Whether a number c is stored as c/2 + 1/2: the format has no sign, or its sign is not used."""
        return self.holds_unit or self.kind == "unorm" or (self.kind == "float" and self.bits[0] < 16)

    @property
    def largest(self) -> float:
        """The largest finite number of a texel that every channel holds."""
        return min(LARGEST[bits] for bits in self.bits) if self.kind == "float" else 1.0

    @property
    def target(self) -> Storage:
        """The format of the render target: another one where numbers are laid across its channels, or centred."""
        if self.is_centred:
            return STORAGES[self.name.removesuffix(CENTRED)]
        return STORAGES["rgba8"] if self.is_packed else self

    @property
    def texel_bytes(self) -> int:
        """Bytes of a texel of the render target, used or not."""
        return sum(self.target.bits) // 8

    def scale(self, channel: int) -> int:
        """The integer that stands for 1 in a channel; 1 for float formats."""
        if self.kind == "float":
            return 1
        return 2 ** (self.bits[channel] - (self.kind == "snorm")) - 1

    def levels(self, channel: int) -> int:
        """How many values of a number in [-1, 1] a channel tells apart at least, evenly spread ones."""
        if self.kind != "float":
            return self.scale(channel) * (1 + (not self.is_biased)) + 1
        return 2 ** (MANTISSA[self.bits[channel]] + 1 - self.is_biased)

    def step(self, channel: int) -> float:
        """How far apart the numbers in [-1, 1] are that a fixed-point channel tells apart."""
        return 2.0 / (self.levels(channel) - 1)

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


def _packed_storage(name: str, title: str, kind: str, *bits: int) -> Storage:
    return Storage(name, title, kind, bits, RGBA8, is_packed=True)


def _centred_storage(like: Storage) -> Storage:
    name, title = f"{like.name}{CENTRED}", f"{like.title} centred"
    return replace(like, name=name, title=title, kind="snorm", is_centred=True)


def of_unit(storage: Storage) -> Storage:
    """A storage as an encoder fills it whose codes are in [0, 1]: nothing between the code and the texel."""
    return storage if storage.is_biased else replace(storage, holds_unit=True)


CENTRED = "_centred"
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
            for s in (_centred_storage(STORAGES[name]) for name in ("rg8", "rgb10a2", "rg16", "rgba8", "rgba16"))
        },
    }
)


# Most bits of a number laid across channels, far from the 24 that float32 has; and of such storages by the number of
# channels what their names begin with.
MOST_BITS = 20
ACROSS = ("r8", "rg8", "rgb8", "rgba8")


def across(kind: str, bits: tuple[int, ...]) -> Storage:
    """Numbers of so many bits laid across as few channels of 8 bits as hold them: rg8_9_7.

    Raises:
        ValueError: no number or a negative one, a signed one of a bit, more than MOST_BITS, or more than 32 altogether;
            a line.
    """
    if not all(1 <= b <= MOST_BITS for b in bits) or sum(bits) > 32 or len(bits) not in (2, 3, 4):
        raise ValueError(f"two to four numbers of 1 to {MOST_BITS} bits, 32 altogether, not {':'.join(map(str, bits))}")
    if kind == "snorm" and 1 in bits:
        raise ValueError(f"a signed number has at least 2 bits, not {':'.join(map(str, bits))}")
    channels, spread = ACROSS[(sum(bits) - 1) // 8], ":".join(map(str, bits))
    is_signed = kind == "snorm"
    name = f"{channels}_{spread.replace(':', '_')}" + ("_snorm" if is_signed else "")
    made = _packed_storage(name, f"{spread} {'signed ' if is_signed else ''}in {channels.upper()}", kind, *bits)
    return replace(made, is_said=True)


# Storages by rule: unorm:9:7.
BY_RULE = re.compile(r"(?P<kind>unorm|snorm|centred):(?P<bits>\d{1,3}(?::\d{1,3})*)")


def by_rule(kind: str, bits: tuple[int, ...]) -> Storage:
    """Numbers of so many bits: the catalogue's format that has just these, or laid across channels.

    Args:
        kind: "unorm" or "snorm"; "centred" for the integers of SNORM in the channels of a UNORM format.

    Raises:
        ValueError: as `across`; and centred ones that are no format of a GPU.
    """
    if kind == "centred":
        like = by_rule("unorm", bits)
        if like.is_packed:
            raise ValueError(
                f"centred numbers lie in a format of a GPU, such as centred:8:8, not {':'.join(map(str, bits))}"
            )
        return _centred_storage(like)
    alike = (s for s in STORAGES.values() if (s.kind, s.bits) == (kind, bits))
    return next(alike, None) or across(kind, bits)


def storage_of(name: str) -> Storage | None:
    """The storage of a name: one of the catalogue's, numbers by rule as in `unorm:9:7`, or laid across channels as
    `rg8_9_7` has them; else None.

    Raises:
        ValueError: by rule or laid across channels, but not so; a line.
    """
    if by := BY_RULE.fullmatch(name):
        return by_rule(by["kind"], tuple(map(int, by["bits"].split(":"))))
    if name.endswith(CENTRED) and name in MOTION_STORAGES:
        return MOTION_STORAGES[name]
    match = re.fullmatch(r"(r|rg|rgb|rgba)8((?:_\d{1,3}){2,})(_snorm)?", name)
    if name in STORAGES or not match:
        return STORAGES.get(name)
    made = across("snorm" if match[3] else "unorm", tuple(map(int, match[2][1:].split("_"))))
    if made.name != name:
        raise ValueError(f"{name}: these bits are called {made.name}")
    return made


R16F = Storage("r16f", "R16F", "float", (16,), 0x822D)
R32F = Storage("r32f", "R32F", "float", (32,), 0x822E)
# Writing, blending and clearing convert its colours from linear light: what lies there must be colours.
SRGB8_A8 = Storage("srgb8_a8", "sRGB8 A8", "unorm", (8, 8, 8, 8), 0x8C43, curved=3)

# What holds light.
LIGHT_STORAGES: Mapping[str, Storage] = MappingProxyType(
    {**{name: STORAGES[name] for name in ("rgba32f", "rgba16f", "r11g11b10f", "rgba8")}, "srgb8_a8": SRGB8_A8}
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
        "srgb8_a8": SRGB8_A8,
    }
)

# What holds a number of a material, such as a roughness: one channel.
CURVE_STORAGES: Mapping[str, Storage] = MappingProxyType(
    {
        name: FORMATS[name]
        for name in ("r8", "rgba8", "rgb10a2", "r16", "rgba8_snorm", "rgba16_snorm", "r11g11b10f", "r16f", "r32f")
    }
)
