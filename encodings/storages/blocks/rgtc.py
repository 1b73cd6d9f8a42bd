"""BC4 and BC5 (RGTC): Khronos Data Format Specification, chapter on RGTC.

A BC4 block has two endpoints and, for each texel, the index of one of eight values: the endpoints, and values between
them. The specification gives these values as real numbers, for example (6 RED0 + RED1) / 7, without rounding. They
are therefore exact here: sevenths or fifths of the way between the endpoints, in 35ths of an 8-bit step.
"""

from __future__ import annotations

import numpy as np

from .bits import bits_of, field, fields

# Of a step of the ends.
PARTS = 35
# What stands for 1, unsigned and signed.
ONE, SIGNED_ONE = 255, 127
# How much of the first and the second end is in each value, in 35ths: of six between the ends, and of four.
SIX = np.array([[7, 0], [0, 7], [6, 1], [5, 2], [4, 3], [3, 4], [2, 5], [1, 6]]) * (PARTS // 7)
FOUR = np.array([[5, 0], [0, 5], [4, 1], [3, 2], [2, 3], [1, 4], [0, 0], [0, 0]]) * (PARTS // 5)


def bc4_parts(blocks: np.ndarray, is_signed: bool = False) -> np.ndarray:
    """Return the texels of BC4 blocks in 35ths of a step.

    Args:
        blocks: uint8 of shape (count, 8).

    Returns:
        int32 of shape (count, 16), row by row; 1 is 35 x 255, or 35 x 127 if `is_signed`.
    """
    bits = bits_of(blocks)
    ends = np.stack([field(bits, 0, 8), field(bits, 8, 8)], axis=1)
    if is_signed:
        ends = np.where(ends > SIGNED_ONE, ends - 256, ends)
    has_six = ends[:, :1] > ends[:, 1:]
    # -128 is -1 as -127 is, once the ends are compared.
    ends = np.maximum(ends, -SIGNED_ONE) if is_signed else ends
    four = ends @ FOUR.T
    least, most = (-SIGNED_ONE, SIGNED_ONE) if is_signed else (0, ONE)
    four[:, 6:] = PARTS * least, PARTS * most
    values = np.where(has_six, ends @ SIX.T, four)
    return np.take_along_axis(values, fields(bits, 16, 3, 16), axis=1).astype(np.int32)


def decode_bc5(blocks: np.ndarray, is_signed: bool = False) -> np.ndarray:
    """Return the texels of BC5 blocks as the specification defines them.

    Args:
        blocks: uint8 of shape (count, 16).

    Returns:
        red and green, float32 of shape (count, 16, 2): in [0, 1], or in [-1, 1] if `is_signed`.
    """
    scale = PARTS * (SIGNED_ONE if is_signed else ONE)
    halves = (bc4_parts(np.ascontiguousarray(blocks[:, start : start + 8]), is_signed) for start in (0, 8))
    return np.stack([parts / scale for parts in halves], axis=2).astype(np.float32)
