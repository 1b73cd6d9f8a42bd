"""Packing of codes into storages, and of a depth into layouts: operations whose cost is measured separately."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any, Protocol

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.codec import Codec
from ...encodings.storages.storage import STORAGES, Storage
from ..codecs.codec_passes import storage_defines
from ..codecs.depth.depth_passes import depth_defines
from ..layouts.layout import Layout
from ..layouts.words import COMPONENTS, Target
from .kernels import Operation
from .layouts import layout_defines
from .materials import CONSTANTS

# Of the depths that are packed; what they are changes no count.
NEAR, FAR = 0.1, 1000.0
# Of a channel that words are laid across.
BYTE = 8


class Packing(Protocol):
    """A packing of numbers into a texel and back.

    Attributes:
        name: its display name.
        storage: the storage that it packs into; None for a packing in which no codec is measured.
    """

    @property
    def name(self) -> str: ...

    @property
    def storage(self) -> Storage | None: ...

    def pack(self) -> Operation:
        """Return the operation that packs the numbers into a texel; a depth is an additional input."""
        ...

    def unpack(self) -> Operation:
        """Return the operation that unpacks the numbers from a texel."""
        ...


@dataclass(frozen=True)
class StoragePacking:
    """A packing of the first 2 or 3 numbers of a code into the first channels of a storage. Rounding is left to the
    device, as in codecs whose rounding the device performs."""

    storage: Storage
    numbers: int

    @property
    def name(self) -> str:
        return f"{self.storage.name} {':'.join(map(str, self.storage.bits[: self.numbers]))}"

    @property
    def channels(self) -> int:
        """The number of target channels in use: at least 2, because GLSL has no one-component vectors."""
        storage = self.storage
        taken = -(-sum(storage.bits[: self.numbers]) // storage.part) if storage.is_packed else self.numbers
        return max(2, taken)

    def pack(self) -> Operation:
        return Operation("kernel_store.glsl", self.numbers, 3, self.channels, self._defines(), is_portable=False)

    def unpack(self) -> Operation:
        return Operation("kernel_load.glsl", self.channels, 3, self.numbers, self._defines(), is_portable=False)

    def _defines(self) -> dict[str, object]:
        return storage_defines(self.storage, ("nearest",) * self.storage.channels, False)


@dataclass(frozen=True)
class WordPacking:
    """A packing of a layout's words into the channels of a target: the numbers of a code, or a depth.

    Attributes:
        name: its display name.
        target: the format and the words that fill it.
        numbers: number of a code's numbers; 0 for a depth.
        signed: whether the depth has the sign of the normal's z.
    """

    name: str
    target: Target
    numbers: int = 0
    signed: bool = False

    @property
    def storage(self) -> None:
        return None

    @property
    def channels(self) -> int:
        """The number of channels in use: at least 2, because GLSL has no one-component vectors."""
        words, size = self._layout.words, self.target.storage.bits[0]
        last = (((w.first + w.bits - 1) // size if w.bits else w.first) for w in words if w.target == 0)
        return max(1, *last) + 1

    @cached_property
    def _layout(self) -> Layout:
        suits = (e for e in ENCODINGS.values() if e.components == self.numbers or not self.numbers)
        encoding = next(e for e in suits if bool(e.sign_bits) == self.signed)
        # A depth needs a normal beside it to be a layout; that lies in a second target, which no kernel writes.
        beside = Target("rgba16f", " ".join(f"normal.{axis}" for axis in "xyz"[: encoding.components]))
        return Layout(self.name, self.name, (self.target, *(() if self.numbers else (beside,))), encoding, "")

    def pack(self) -> Operation:
        return Operation("kernel_pack.glsl", max(self.numbers, 2), 3, self.channels, *self._read(), is_portable=False)

    def unpack(self) -> Operation:
        outputs = max(self.numbers, 2)
        return Operation("kernel_unpack.glsl", self.channels, 3, outputs, *self._read(), is_portable=False)

    def _read(self) -> tuple[Any, ...]:
        """Return the macros of a layout with these numbers, and the files named in the macros."""
        layout = self._layout
        first = 0 if self.numbers else COMPONENTS.index("depth")
        rounds = (0,) * len(layout.targets)
        needed = {"LOG2_POWER_MAX": CONSTANTS["LOG2_POWER_MAX"], "SIGN_BITS": 0, "FIRST_NUMBER": first}
        needed |= {"KERNEL_NEAR": NEAR, "KERNEL_FAR": FAR}
        depth = layout.depth_encoding
        defines = {**needed, **depth_defines(depth), **layout_defines(layout, rounds)}
        return defines, {"DEPTH_ENCODING": depth.glsl}


def packings_of(storage: Storage) -> tuple[Packing, ...]:
    """Return the packings of two and of three numbers into a storage, as far as its channels suffice; else ()."""
    return tuple(StoragePacking(storage, numbers) for numbers in (2, 3) if numbers <= storage.channels)


# What `--storage` may name: a storage for two numbers and for three, some by their bits alone, and words of layouts.
PACKINGS: Mapping[str, tuple[Packing, ...]] = MappingProxyType(
    {name: packings_of(storage) for name, storage in STORAGES.items()}
    | {
        "12:12": packings_of(STORAGES["rgb8_12_12"]),
        "16:16": packings_of(STORAGES["rgba8_16_16"]),
        "11:10:11": packings_of(STORAGES["rgba8_11_10_11"]),
        "11:11": (WordPacking("rgba8 11:11", Target("rgba8", "normal.x:11 normal.y:11"), 2),),
        "depth16": (WordPacking("rgba8 depth 8:8", Target("rgba8", "depth:16")),),
        "depth24": (WordPacking("rgba8 depth 8:8:8", Target("rgba8", "depth:24")),),
        "depth16_sign": (WordPacking("rgba8 signed depth 8:8", Target("rgba8", "depth:16"), signed=True),),
        "depth24_sign": (WordPacking("rgba8 signed depth 8:8:8", Target("rgba8", "depth:24"), signed=True),),
    }
)
# What a code's sign bit costs: a depth that carries it, less one that does not.
SIGN = (PACKINGS["depth24_sign"][0], PACKINGS["depth24"][0])


def packing_of(codec: Codec) -> Packing:
    """Return the packing of a codec's numbers, at least two, into its storage, without its sign bits."""
    return StoragePacking(codec.storage, max(codec.encoding.components, 2))
