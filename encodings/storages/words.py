"""The bits that hold numbers: what a channel of a texel is, read as an unsigned integer."""

from __future__ import annotations

import numpy as np

from .storage import MANTISSA, Storage


def words(numbers: np.ndarray, storage: Storage, channel: int) -> np.ndarray:
    """The bits of a channel, as unsigned integers.

    Args:
        numbers: any shape, as they come back from the channel; to integers NaN is 0.
        storage: the format; colours by the sRGB curve are not numbers of a code.
        channel: which one.

    Returns:
        uint32 of the same shape. SNORM of a render target is two's complement; laid across channels it is biased, so
        that -1 is 0 (see `storage.py`).
    """
    exact, bits = np.asarray(numbers, np.float64), storage.bits[channel]
    if storage.is_biased:
        exact = exact / 2 + 0.5
    if storage.kind == "float":
        return _float_words(exact, bits)
    whole = np.rint(np.nan_to_num(exact) * storage.scale(channel)).astype(np.int64)
    if storage.kind == "snorm" and storage.is_packed:
        whole += storage.scale(channel)
    return (whole & 2**bits - 1).astype(np.uint32)


def _float_words(texels: np.ndarray, bits: int) -> np.ndarray:
    if bits == 32:
        return texels.astype(np.float32).view(np.uint32)
    # Floats of 11 and 10 bits are halves without a sign and with a shorter mantissa.
    with np.errstate(over="ignore"):
        return texels.astype(np.float16).view(np.uint16).astype(np.uint32) >> MANTISSA[16] - MANTISSA[bits]
