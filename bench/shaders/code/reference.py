"""The required results of a codec's functions: from its JAX twin, or from OpenGL if a user's encoding has no twin."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.storages.depth_storage import fixed, from_fixed
from ....encodings.storages.words import float_words, floats_of
from ....encodings.vec import Vec2, Vec3, Vec4
from .channels import Channel, Channels
from .kinds.table import kind_of

VECTORS = {2: Vec2, 3: Vec3, 4: Vec4}


@dataclass(frozen=True, eq=False)
class Reference:
    """Values of a codec and the catalogue's results for them.

    Attributes:
        n, view: float32 of shape (count, 3 or 4): see `code_kind.py`; for normals, unit normals and positions.
        stored: the codes as they come back from the storage, (count, size).
        integers: the stored bits of each number, uint32 of shape (count, components).
        words: the texels, uint32 of shape (count, words).
        texels: the values that a shader reads from the render target, float32 of shape (count, 4).
        decoded: the decoded values; for normals, (count, 3).
    """

    n: np.ndarray
    view: np.ndarray
    stored: np.ndarray
    integers: np.ndarray
    words: np.ndarray
    texels: np.ndarray
    decoded: np.ndarray


# Each has megabytes; the languages of one codec follow each other.
@lru_cache(8)
def reference(codec: Any) -> Reference:
    """Return the catalogue's results for a codec, at the test values of its kind."""
    return reference_of(codec, *kind_of(codec).values(codec))


def reference_of(codec: Any, n: np.ndarray, view: np.ndarray, compiled: bool = True) -> Reference:
    """Return the catalogue's results for given values, float32 of shape (count, 3 or 4).

    Args:
        codec: a codec of any kind.
        compiled: whether XLA compiles the codec as a whole. Otherwise each step is rounded separately, as on GPUs:
            XLA may round a product and a sum only once. Separate steps take less time if a codec is needed only once.
    """
    transform = jax.jit if compiled else _step_by_step
    kind, channels = kind_of(codec), Channels(codec)
    by_device = None if kind.has_twin(codec) else kind.by_device(codec, n, view)
    given = jnp.asarray(n), jnp.asarray(view)
    code = by_device[0] if by_device else _array(transform(lambda *rows: kind.stored(codec, *rows))(*given))
    texels = code.astype(np.float64) * 0.5 + 0.5 if channels.numbers.is_biased else code
    integers = np.stack([_integers(c, texels[:, i]) for i, c in enumerate(channels.channels)], axis=1)
    words = channels.texel_words(integers)
    stored = _stored_numbers(channels, integers, code)
    if by_device:
        decoded = by_device[1]
    else:
        planes = [jnp.asarray(number) for number in stored.T]
        read = VECTORS[len(planes)](*planes) if len(planes) > 1 else planes[0]
        decoded = _array(transform(lambda *given: kind.decoded(codec, *given))(read, given[1]))
    return Reference(n, view, stored, integers, words, _texels(channels, integers, words), decoded)


def _step_by_step(function: Callable[..., Any]) -> Callable[..., Any]:
    def run(*given: Any) -> Any:
        with jax.disable_jit():
            return function(*given)

    return run


def _stored_numbers(channels: Channels, integers: np.ndarray, code: np.ndarray) -> np.ndarray:
    """Return codes as the numbers that their stored bits stand for. Each product and each sum is rounded separately;
    compilers may round a product and a sum only once."""
    stored = code.copy()
    for index, channel in enumerate(channels.channels):
        texel = values_of(channel, integers[:, index])
        stored[:, index] = texel * np.float32(2) - np.float32(1) if channels.numbers.is_biased else texel
    return stored


def _array(planes) -> np.ndarray:
    """Return planes, a tuple or a single array, as one float32 array of shape (count, size)."""
    return np.stack(
        [np.asarray(plane, np.float32) for plane in (planes if isinstance(planes, tuple) else (planes,))], 1
    )


def _integers(channel: Channel, texels: np.ndarray) -> np.ndarray:
    """Return the bits in which a channel stores the numbers of texels, uint32 of shape (count,)."""
    numbers = texels.astype(np.float64)
    if channel.form:
        return float_words(numbers, channel.form)
    if channel.share:
        return np.asarray(fixed(jnp.asarray(texels), channel.integer, channel.share == "signed"))
    whole = np.rint(numbers * channel.integer).astype(np.int64) + channel.is_offset * channel.integer
    return (whole & (1 << channel.bits) - 1).astype(np.uint32)


def _texels(channels: Channels, integers: np.ndarray, words: np.ndarray) -> np.ndarray:
    """Return the values that a shader reads from a render target, float32 of shape (count, 4)."""
    texels = np.zeros((len(integers), 4), np.float32)
    for part in range(channels.parts):
        texels[:, part] = channels.part_in(words, part) * np.float32(1 / ((1 << channels.numbers.storage.part) - 1))
    if channels.parts:
        return texels
    for index, channel in enumerate(channels.channels):
        # A centred number is read as UNORM.
        is_plain = not channel.is_offset
        texels[:, index] = (
            values_of(channel, integers[:, index])
            if is_plain
            else integers[:, index].astype(np.float32) * np.float32(1 / ((1 << channel.bits) - 1))
        )
    return texels


def values_of(channel: Channel, integers: np.ndarray) -> np.ndarray:
    """Return the numbers that a texel's bits stand for, float32 of shape (count,)."""
    if channel.form:
        return floats_of(integers, channel.form)
    if channel.share:
        return np.asarray(from_fixed(jnp.asarray(integers), channel.integer, channel.share == "signed"))
    whole = signed(channel, integers) - channel.is_offset * channel.integer
    return whole.astype(np.float32) * np.float32(1 / channel.integer)


def signed(channel: Channel, integers: np.ndarray) -> np.ndarray:
    """Return bits as integers in the order of the numbers that they stand for, int64; differences count steps."""
    whole = integers.astype(np.int64)
    has_sign = channel.form.is_signed if channel.form else channel.kind == "snorm" and not channel.is_offset
    if not has_sign:
        return whole
    negative = whole >> channel.bits - 1 != 0
    if channel.kind == "snorm":
        return np.where(negative, whole - (1 << channel.bits), whole)
    magnitude = whole & (1 << channel.bits - 1) - 1
    return np.where(negative, -magnitude, magnitude)
