"""Bit fields of many blocks at once."""

from __future__ import annotations

import numpy as np

# A texel block is 4 x 4 texels in every format here.
SIDE = 4
TEXELS = SIDE * SIDE


def bits_of(blocks: np.ndarray) -> np.ndarray:
    """The bits of blocks, uint8 of shape (count, bytes): the lowest of the first byte first, (count, 8 bytes)."""
    return np.unpackbits(blocks, axis=1, bitorder="little")


def field(bits: np.ndarray, start: int, width: int) -> np.ndarray:
    """`width` bits from `start` on as whole numbers, the lowest bit first; int32 of shape (count)."""
    return bits[:, start : start + width].astype(np.int32) @ (1 << np.arange(width, dtype=np.int32))


def fields(bits: np.ndarray, start: int, width: int, count: int) -> np.ndarray:
    """`count` such numbers one after the other; int32 of shape (blocks, count)."""
    part = bits[:, start : start + width * count].reshape(len(bits), count, width)
    return part.astype(np.int32) @ (1 << np.arange(width, dtype=np.int32))
