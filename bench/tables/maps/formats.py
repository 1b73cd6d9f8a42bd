"""Block formats and swizzles, as values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType

import numpy as np
from PIL import Image

from ....encodings.storages.blocks.bits import SIDE, TEXELS
from ....encodings.storages.blocks.eac import decode_rg11
from ....encodings.storages.blocks.rgtc import decode_bc5
from .encoders import ASTC, BC3, BC7, NONE, QUICKTEX, RG11, Encoder

# Blocks that are decoded at once, for memory's sake.
TOGETHER = 2**14
CHANNELS, ONE = "rgba", 255


@dataclass(frozen=True)
class Swizzle:
    """The layout of a code's numbers in the channels of a texel.

    Attributes:
        name: key in the catalogue.
        laid: content of each channel: the first, second or third number as `r`, `g` and `b`, or 0 or 1.
        read: the channel from which each number is read.
    """

    name: str
    laid: str
    read: str

    def texels(self, numbers: np.ndarray) -> np.ndarray:
        """Return texels of shape (height, width, 4) that hold numbers, uint8 of shape (height, width, components)."""
        full = np.full(numbers.shape[:2], ONE, np.uint8)
        planes = {"0": 0 * full, "1": full, **{CHANNELS[i]: numbers[..., i] for i in range(numbers.shape[-1])}}
        return np.ascontiguousarray(np.stack([planes[letter] for letter in self.laid], axis=-1))

    def numbers(self, texels: np.ndarray) -> np.ndarray:
        """Return the numbers in texels, of shape (height, width, components)."""
        return texels[..., [CHANNELS.index(letter) for letter in self.read]]


SWIZZLES: Mapping[str, Swizzle] = MappingProxyType(
    {
        "rg": Swizzle("rg", "rg01", "rg"),
        "rrrg": Swizzle("rrrg", "rrrg", "ra"),
        "dxt5nm": Swizzle("dxt5nm", "1g1r", "ag"),
        "rgb": Swizzle("rgb", "rgb1", "rgb"),
    }
)


@dataclass(frozen=True)
class BlockFormat:
    """A texture format.

    Attributes:
        name: the catalogue's key.
        title: display name.
        channels: number of channels.
        encoder: encoder from images to blocks.
        decode: function from blocks, uint8 of shape (count, 16), to texels in [0, 1], (count, 16, channels), as
            specified; None if the encoder's package decodes.
        internal_format: the OpenGL enum; 0 if the format is uncompressed.
        swizzles: names of the swizzles that are usual for the format.
    """

    name: str
    title: str
    channels: int
    encoder: Encoder
    decode: Callable[[np.ndarray], np.ndarray] | None = None
    internal_format: int = 0
    swizzles: tuple[str, ...] = ("rg", "rrrg", "rgb")

    @property
    def is_compressed(self) -> bool:
        """Whether texels are stored in blocks."""
        return bool(self.internal_format)

    def bits(self, components: int) -> int:
        """Return the bits per texel: 8 if compressed (128 per block), 16 for two components, otherwise 32."""
        return 8 if self.is_compressed else 16 if components == 2 else 32

    def by_specification(self, blocks: bytes, size: tuple[int, int]) -> np.ndarray:
        """Return the texels of blocks in row order, decoded according to the specification: float32 of shape (height,
        width, channels) in [0, 1].

        Args:
            size: width and height, multiples of 4.
        """
        if self.decode is None:
            return self.encoder.decoded(blocks, size)
        given = np.frombuffer(blocks, np.uint8).reshape(-1, 16)
        parts = [self.decode(given[start : start + TOGETHER]) for start in range(0, len(given), TOGETHER)]
        width, height = size
        texels = np.concatenate(parts).reshape(height // SIDE, width // SIDE, SIDE, SIDE, self.channels)
        return texels.transpose(0, 2, 1, 3, 4).reshape(height, width, self.channels)


def _bc_texels(number: int, blocks: np.ndarray) -> np.ndarray:
    """Return the texels of BC3 or BC7 blocks, float32 of shape (blocks, 16, 4), as Pillow decodes them: it
    interpolates BC3's end points in integers."""
    image = Image.frombytes("RGBA", (SIDE, SIDE * len(blocks)), blocks.tobytes(), "bcn", (number,))
    return np.asarray(image, np.float32).reshape(-1, TEXELS, len(CHANNELS)) / np.float32(ONE)


FORMATS: Mapping[str, BlockFormat] = MappingProxyType(
    {
        "none": BlockFormat("none", "8 bits", 4, NONE),
        "bc5": BlockFormat("bc5", "BC5", 2, QUICKTEX, decode_bc5, 0x8DBD),
        "bc3": BlockFormat("bc3", "BC3", 4, BC3, partial(_bc_texels, 3), 0x83F3, ("dxt5nm", "rgb")),
        "bc7": BlockFormat("bc7", "BC7", 4, BC7, partial(_bc_texels, 7), 0x8E8C),
        "eac_rg11": BlockFormat("eac_rg11", "EAC RG11", 2, RG11, decode_rg11, 0x9272),
        "astc_4x4": BlockFormat("astc_4x4", "ASTC 4x4", 4, ASTC, None, 0x93B0),
    }
)


def swizzles_of(block_format: BlockFormat, components: int, asked: list[Swizzle]) -> list[Swizzle]:
    """Return the swizzles with which to measure an encoding; empty if none fits its number of components.

    Args:
        components: number of numbers in a code.
        asked: the requested swizzles; empty for the usual swizzles of the format.
    """
    if block_format.channels < components:
        return []
    asked = asked or [SWIZZLES[name] for name in block_format.swizzles]
    fit = [swizzle for swizzle in asked if len(swizzle.read) == components]
    # Where there is nothing to choose, the numbers lie in the channels in their order.
    is_plain = not block_format.is_compressed or block_format.channels == components
    return [s for s in SWIZZLES.values() if s.read == CHANNELS[:components]] if is_plain else fit
