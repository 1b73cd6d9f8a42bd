"""Bit fields of many blocks at once."""

from __future__ import annotations

import numpy as np

# A texel block is 4 x 4 texels in every format here.
SIDE = 4
TEXELS = SIDE * SIDE


def bits_of(blocks: np.ndarray) -> np.ndarray:
    """Return the bits of blocks (uint8, (count, bytes)) as 0 and 1, uint8 of shape (count, 8 * bytes): byte by byte,
    the lowest bit first."""
    return np.unpackbits(blocks, axis=1, bitorder="little")


def field(bits: np.ndarray, start: int, width: int) -> np.ndarray:
    """Return the whole number in `width` bits of each block, the lowest bit at `start`; int32 of shape (count,)."""
    return bits[:, start : start + width].astype(np.int32) @ (1 << np.arange(width, dtype=np.int32))


def fields(bits: np.ndarray, start: int, width: int, count: int) -> np.ndarray:
    """Return `count` whole numbers per block, each of `width` bits, one after the other from bit `start`; int32 of
    shape (blocks, count)."""
    part = bits[:, start : start + width * count].reshape(len(bits), count, width)
    return part.astype(np.int32) @ (1 << np.arange(width, dtype=np.int32))
