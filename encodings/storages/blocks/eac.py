"""EAC R11 and RG11, unsigned and signed: Khronos Data Format Specification, chapter on ETC2.

A block holds a base value, a multiplier, the number of one of 16 tables and, for each texel, the index of one of the
table's eight modifiers, the highest bit first and texels column by column. Texels have 11 bits.
"""

from __future__ import annotations

import numpy as np

from .bits import SIDE, TEXELS, bits_of

# What stands for 1, unsigned and signed.
ONE, SIGNED_ONE = 2047, 1023
# The first four modifiers of each table without their sign; the other four are one less than those.
_TEXT = """
    3 6 9 15  3 7 10 13  2 5 8 13  2 4 6 13  3 6 8 12  3 7 9 11  4 7 8 11  3 5 8 11
    2 6 8 10  2 5 8 10  2 4 8 10  2 5 7 10  3 4 7 10  1 2 3 10  4 6 8 9  3 5 7 9
"""
_NEGATIVE = -np.array([int(word) for word in _TEXT.split()]).reshape(16, 4)
MODIFIERS = np.concatenate([_NEGATIVE, -1 - _NEGATIVE], axis=1)


def eac_r11(blocks: np.ndarray, is_signed: bool = False) -> np.ndarray:
    """Return the texels of EAC R11 blocks as 11-bit integers.

    Args:
        blocks: uint8 of shape (count, 8).

    Returns:
        int32 of shape (count, 16), row by row: 0 to 2047, or -1023 to 1023 if `is_signed`.
    """
    base = blocks[:, :1].astype(np.int32)
    multiplier, table = blocks[:, 1] >> 4, blocks[:, 1] & 15
    steps = np.where(multiplier, 8 * multiplier.astype(np.int32), 1)[:, None]
    moved = np.take_along_axis(MODIFIERS[table], _indices(blocks), axis=1) * steps
    if is_signed:
        base = np.maximum(np.where(base > 127, base - 256, base), -127)
        return np.clip(base * 8 + moved, -SIGNED_ONE, SIGNED_ONE)
    return np.clip(base * 8 + 4 + moved, 0, ONE)


def _indices(blocks: np.ndarray) -> np.ndarray:
    """Return the index of each texel's modifier, row by row; blocks store the indices column by column, from the
    third byte's highest bit down."""
    bits = bits_of(np.ascontiguousarray(blocks[:, :1:-1]))[:, ::-1].reshape(-1, TEXELS, 3)
    by_columns = bits.astype(np.int32) @ np.array([4, 2, 1])
    return by_columns.reshape(-1, SIDE, SIDE).transpose(0, 2, 1).reshape(-1, TEXELS)


def decode_rg11(blocks: np.ndarray, is_signed: bool = False) -> np.ndarray:
    """Return the texels of EAC RG11 blocks.

    Args:
        blocks: uint8 of shape (count, 16), red before green.

    Returns:
        float32 of shape (count, 16, 2): in [0, 1], or in [-1, 1] if `is_signed`.
    """
    halves = (eac_r11(blocks[:, start : start + 8], is_signed) for start in (0, 8))
    return np.stack([half / (SIGNED_ONE if is_signed else ONE) for half in halves], axis=2).astype(np.float32)
