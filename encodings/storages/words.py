"""The bits of stored numbers: the channels of texels, read as unsigned integers."""

from __future__ import annotations

import numpy as np

from .storage import FORMS, FloatForm, Storage


def words(numbers: np.ndarray, storage: Storage, channel: int) -> np.ndarray:
    """Return the bits of a channel, as unsigned integers.

    Args:
        numbers: any shape, as the channel returns them; in integer formats NaN is treated as 0.
        storage: the format; colours on the sRGB curve are not supported.
        channel: index of the channel.

    Returns:
        uint32 of the same shape. SNORM of a render target is two's complement; laid across channels it is biased, so
        that -1 is 0 (see `storage.py`).
    """
    exact = np.asarray(numbers, np.float64)
    if storage.is_biased:
        exact = exact / 2 + 0.5
    if storage.kind == "float":
        return float_words(exact, storage.float_form(channel))
    whole = np.rint(np.nan_to_num(exact) * storage.scale(channel)).astype(np.int64)
    if storage.kind == "snorm" and storage.is_packed:
        whole += storage.scale(channel)
    return (whole & 2 ** storage.bits[channel] - 1).astype(np.uint32)


def float_words(texels: np.ndarray, form: FloatForm) -> np.ndarray:
    """Return the bits (uint32) of numbers (any shape) that a float of this form holds: the inverse of `floats_of`."""
    if form == FORMS[32]:
        return texels.astype(np.float32).view(np.uint32)
    magnitude = np.where(np.isfinite(texels), np.abs(texels), 0.0)
    # A float is (1 + m 2^-mantissa) 2^(e - one), or m 2^(1 - one - mantissa) below normal ones: its bits count steps.
    least = 1 - form.one
    octave = np.where(magnitude > 0, np.maximum(np.frexp(magnitude)[1] - 1, least), least)
    steps = np.ldexp(magnitude, form.mantissa - octave).astype(np.uint32)
    words = steps + ((octave + form.one - 1) << form.mantissa).astype(np.uint32)
    endless = (2**form.exponent - 1) << form.mantissa
    words = np.where(np.isinf(texels), endless, np.where(np.isnan(texels), endless + 2 ** (form.mantissa - 1), words))
    signs = np.signbit(texels) & form.is_signed
    return (words + (signs.astype(np.uint32) << (form.bits - 1))).astype(np.uint32)


def numbers_across(words: np.ndarray, storage: Storage, channel: int) -> np.ndarray:
    """Return the numbers (float32) for integers (uint32, any shape) laid across channels: the inverse of `words`."""
    number = _numbers_of(words, storage, channel)
    return number * np.float32(2) - np.float32(1) if storage.is_biased else number


def _numbers_of(words: np.ndarray, storage: Storage, channel: int) -> np.ndarray:
    if storage.kind == "float":
        return floats_of(words, storage.float_form(channel))
    scale = storage.scale(channel)
    signed = words.astype(np.int64) - (scale if storage.kind == "snorm" else 0)
    return signed.astype(np.float32) * np.float32(1 / scale)


def floats_of(words: np.ndarray, form: FloatForm) -> np.ndarray:
    """Return the numbers (float32) for the bits of floats (uint32, any shape): the inverse of `float_words`."""
    magnitude = words & 2 ** (form.exponent + form.mantissa) - 1
    exponent, mantissa = magnitude >> form.mantissa, magnitude & 2**form.mantissa - 1
    steps = mantissa + np.where(exponent > 0, 2**form.mantissa, 0)
    value = np.ldexp(steps.astype(np.float64), np.maximum(exponent, 1).astype(int) - form.one - form.mantissa)
    value = np.where(exponent == 2**form.exponent - 1, np.where(mantissa, np.nan, np.inf), value)
    return np.where(words == magnitude, value, -value).astype(np.float32)
