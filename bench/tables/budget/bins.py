"""The possible render targets of a G-buffer, as bins into which fields are packed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

from ....encodings.storages.storage import TARGET_FORMATS
from .attributes import FLOAT, RGB9E5, SRGB, UNORM, Code

Channel = tuple[str, int]


@dataclass(frozen=True, eq=False)
class Bin:
    """A render target that encodings can be packed into.

    Attributes:
        name: name of the bin: the target's format and how it is used.
        format: format of the target in a layout.
        bytes: bytes per pixel.
        channels: number of channels by kind and bits; empty if encodings share all bits of the target.
        fields: number of bits that encodings share as bit fields of any size; 0 if each component has a channel.
        copies: maximum number of such targets in a layout.
        blends: whether decals blend into the target; its fourth channel then stores only the blend factor.
        fuss: penalty for features that engineers would rather avoid; 0 for plain channels.
        shares: whether encodings share, bit by bit, the UNORM channels that are as large as the first channel.
        is_usual: whether the target is tried if no formats are named.
    """

    name: str
    format: str
    bytes: int
    channels: Mapping[Channel, int]
    fields: int = 0
    copies: int = 2
    blends: bool = False
    fuss: float = 0.0
    shares: bool = False
    is_usual: bool = True

    @property
    def part(self) -> int:
        """The number of bits in each channel that contains bit fields."""
        return TARGET_FORMATS[self.format].bits[0]

    def need(self, code: Code) -> Mapping[Channel, float] | None:
        """Return the number of channels by kind, or of shared bits, that an encoding takes in this target; None if it
        does not fit."""
        if self.blends and not code.blends:
            return None
        if self.fields:
            fits = code.in_fields and code.kind == UNORM and code.total_bits <= self.fields
            return {BITS: code.total_bits} if fits else None
        taken = {(code.kind, bits): float(code.bits.count(bits)) for bits in code.bits}
        if not code.is_exact and all(self.channels.get(channel, 0) >= count for channel, count in taken.items()):
            return taken
        # Two bits lie in the fourth channel of 10:10:10:2, which nothing else fits.
        if code.is_exact and all((UNORM, bits) in self.channels and bits != self.part for bits in code.bits):
            return self._need_of_exact(code)
        # Channels are shared bit by bit, also the one beside a colour on the sRGB curve.
        if self.shares and code.in_fields and code.kind == UNORM:
            fits = code.total_bits <= self.part * self.channels.get((UNORM, self.part), 0)
            return {SHARED: code.total_bits / self.part} if fits else None
        return self._need_of_exact(code) if code.is_exact else None

    def channels_of(self, code: Code) -> list[Channel]:
        """Return the kind of channel for each component of an encoding, in a target with separate channels."""
        if not code.is_exact:
            return [(code.kind, bits) for bits in code.bits]
        sizes = sorted(bits for kind, bits in self.channels if kind == UNORM)
        return [(UNORM, next(size for size in sizes if size >= bits)) for bits in code.bits]

    def _need_of_exact(self, code: Code) -> Mapping[Channel, float] | None:
        """Return the number of whole channels of each size that the parts of an encoding take, with the narrowest
        channel for each part; None if the parts do not fit."""
        sizes = sorted(bits for kind, bits in self.channels if kind == UNORM)
        taken: dict[Channel, float] = {}
        for bits in code.bits:
            size = next((size for size in sizes if size >= bits), None)
            if size is None:
                return None
            taken[UNORM, size] = taken.get((UNORM, size), 0) + 1
        return taken if all(self.channels[channel] >= count for channel, count in taken.items()) else None


# What is shared bit by bit, of whole numbers and of channels.
BITS, SHARED = ("bits", 0), ("shared", 0)


# What an engineer would rather do without: targets of fewer than 32 bits, which many GPUs round up in tiles, and those
# of whole numbers, which nothing blends, filters or converts.
SMALL, INTEGER = 2.0, 1.5


# Channels of these bits are shared: of 16 there are few, and half of one is as much as a byte.
SHARED_SIZES = (8, 10)


def _plain(name: str, size: int, copies: int = 2, **channels: int) -> Bin:
    kinds = {"u": UNORM, "s": SRGB, "f": FLOAT}
    held = {(kinds[key[0]], int(key[1:])): count for key, count in channels.items()}
    return Bin(
        name, name, size, held, 0, copies, fuss=SMALL * (size < 4), shares=TARGET_FORMATS[name].bits[0] in SHARED_SIZES
    )


_PLAIN = (
    _plain("rgba8", 4, 3, u8=4),
    _plain("srgb8_a8", 4, 1, s8=3, u8=1),
    _plain("rgb10a2", 4, 2, u10=3, u2=1),
    _plain("r8", 1, 1, u8=1),
    _plain("rg8", 2, 1, u8=2),
    _plain("r16", 2, 1, u16=1),
    _plain("rg16", 4, 2, u16=2),
    _plain("rg16f", 4, 1, f16=2),
    _plain("rgba16", 8, 1, u16=4),
    _plain("rgba16f", 8, 1, f16=4),
)
_WHOLE = (
    Bin("rgb9e5", "rgba8", 4, {(RGB9E5, 32): 1}, copies=1),
    # Of 6 bits of mantissa where RGB9E5 has 9.
    Bin("r11g11b10f", "r11g11b10f", 4, {(FLOAT, 11): 2, (FLOAT, 10): 1}, copies=1, fuss=1.0),
)
# Whole numbers, whose bits codes share in any sizes. Others hold no more than these do.
_USUAL_FIELDS = {"r8_uint": 1, "r16_uint": 1, "r32_uint": 4, "rg32_uint": 2}
_FIELDS = tuple(
    Bin(
        f"{name}_fields",
        name,
        storage.texel_bytes,
        {},
        8 * storage.texel_bytes,
        _USUAL_FIELDS.get(name, 2),
        fuss=INTEGER + SMALL * (storage.texel_bytes < 4),
        is_usual=name in _USUAL_FIELDS,
    )
    for name, storage in TARGET_FORMATS.items()
    if storage.is_integer
)
LAST = {
    "rgba8": (UNORM, 8),
    "srgb8_a8": (UNORM, 8),
    "rgb10a2": (UNORM, 2),
    "rgba16": (UNORM, 16),
    "rgba16f": (FLOAT, 16),
}


def _blended(plain: Bin) -> Bin:
    # The factor is the shader's fourth number, which lies nowhere where there are fewer channels.
    channels = {channel: count - (channel == LAST.get(plain.format)) for channel, count in plain.channels.items()}
    kept = {channel: count for channel, count in channels.items() if count}
    return replace(plain, name=f"{plain.name}_blended", channels=kept, blends=True, shares=False)


# What a render target of each format costs of WebGPU's 32 bytes a sample, and to how many bytes it is aligned (WebGPU,
# "Plain color formats": render target pixel byte cost, render target component alignment); formats that it does not
# render to have none.
WEBGPU: Mapping[str, tuple[int, int]] = MappingProxyType(
    {
        name: (cost, alignment)
        for alignment, costs in (
            (1, {"r8": 1, "rg8": 2, "rgba8": 8, "srgb8_a8": 8, "r8_uint": 1, "rgba8_uint": 4}),
            (2, {"rg16f": 4, "rgba16f": 8, "r16_uint": 2, "rg16_uint": 4, "rgba16_uint": 8}),
            (4, {"rgb10a2": 8, "r11g11b10f": 8, "r32_uint": 4, "rg32_uint": 8, "rgba32_uint": 16}),
        )
        for name, cost in costs.items()
    }
)
WEBGPU_BYTES = 32


def webgpu_cost(formats: Sequence[str]) -> int | None:
    """Return the bytes per sample that WebGPU counts for ordered targets; None if it cannot render to all of them."""
    total = 0
    for name in formats:
        if name not in WEBGPU:
            return None
        cost, alignment = WEBGPU[name]
        total = -(-total // alignment) * alignment + cost
    return total


BINS: Mapping[str, Bin] = MappingProxyType(
    {target.name: target for target in (*_PLAIN, *_WHOLE, *_FIELDS, *map(_blended, _PLAIN))}
)
