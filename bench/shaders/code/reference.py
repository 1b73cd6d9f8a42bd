"""What a codec's code must give: the results of its own twin by JAX, or by OpenGL of users' encoders without one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.vec import Vec2, Vec3
from ....gbuffer.codecs.codec_passes import CodecPasses
from ....gbuffer.gl.device import device
from ...ground.directions import directions
from .channels import WORD, Channel, Channels
from .twin import has_twin

COUNT = 2**16
SIDE = 2**8
VECTORS = {2: Vec2, 3: Vec3}
FLOATS = {32: np.float32, 16: np.float16}
# A float of 11 or 10 bits is a half float without its sign and the lowest bits of its mantissa.
HALF = 15


@dataclass(frozen=True, eq=False)
class Reference:
    """Normals of a codec's domain and what the catalogue makes of them.

    Attributes:
        n, view: float32 of shape (count, 3).
        stored: the codes as they come back from the storage, (count, size).
        integers: the stored bits of each number, uint32 of shape (count, components).
        words: the texels, uint32 of shape (count, words).
        texels: what a shader reads from the render target, float32 of shape (count, 4).
        decoded: (count, 3).
    """

    n: np.ndarray
    view: np.ndarray
    stored: np.ndarray
    integers: np.ndarray
    words: np.ndarray
    texels: np.ndarray
    decoded: np.ndarray


@cache
def normals(domain: str) -> tuple[np.ndarray, np.ndarray]:
    """2^16 unit normals of a domain and views: axes and what lies beside them, diagonals, then random directions."""
    generator = np.random.default_rng(0)
    random = generator.normal(size=(COUNT, 3))
    n = np.concatenate([directions(), random / np.linalg.norm(random, axis=1, keepdims=True)])[:COUNT]
    view = generator.uniform((-1.0, -1.0, -3.0), (1.0, 1.0, -0.5), (COUNT, 3))
    if domain == "hemisphere":
        n[:, 2] = np.abs(n[:, 2])
    if domain == "view":
        n[np.sum(n * view, axis=1) > 0] *= -1.0
    return n.astype(np.float32), view.astype(np.float32)


# Each has megabytes; the languages of one codec follow each other.
@lru_cache(8)
def reference(codec: Codec) -> Reference:
    """What the catalogue makes of the normals of a codec's domain."""
    return reference_of(codec, *normals(codec.encoding.domain))


def reference_of(codec: Codec, n: np.ndarray, view: np.ndarray, compiled: bool = True) -> Reference:
    """What the catalogue makes of normals and views, float32 of shape (count, 3).

    Args:
        compiled: whether XLA compiles the codec as a whole. Else each step is rounded by itself, as GPUs round it: XLA
            may round a product and a sum once. Step by step takes less time where a codec is needed once.
    """
    made = jax.jit if compiled else _step_by_step
    planes = (Vec3(*(jnp.asarray(a[:, i]) for i in range(3))) for a in (n, view))
    by_device = None if has_twin(codec.encoding) else _by_device(codec, n, view)
    n_planes, view_planes = planes
    code = _array(made(codec.stored)(n_planes, view_planes)) if by_device is None else by_device[0]
    channels = Channels(codec)
    texels = code.astype(np.float64) * 0.5 + 0.5 if codec.storage.is_biased else code
    integers = np.stack([_integers(c, texels[:, at]) for at, c in enumerate(channels.channels)], axis=1)
    words = _words(channels, integers)
    stored = _stored_numbers(codec, channels, integers, code)
    if by_device is None:
        read = VECTORS[stored.shape[1]](*(jnp.asarray(number) for number in stored.T))
        decoded = _array(made(codec.encoding.decode)(read, view_planes))
    else:
        decoded = by_device[1]
    return Reference(n, view, stored, integers, words, _texels(codec, channels, integers, words), decoded)


def _step_by_step(function: Callable[..., Any]) -> Callable[..., Any]:
    def run(*given: Any) -> Any:
        with jax.disable_jit():
            return function(*given)

    return run


def _by_device(codec: Codec, n: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stored codes and decoded normals by OpenGL, of an encoder that is there in GLSL alone."""
    pixels = (np.pad(array, ((0, 0), (0, 1))).reshape(SIDE, -1, 4) for array in (n, view))
    with CodecPasses(device(), codec) as passes:
        found = passes.round_trip(*pixels)
    size = codec.encoding.components + codec.encoding.sign_bits
    return found.codes.reshape(COUNT, 4)[:, :size].copy(), found.normals.reshape(COUNT, 3)


def _stored_numbers(codec: Codec, channels: Channels, integers: np.ndarray, code: np.ndarray) -> np.ndarray:
    """The numbers that bits stand for, each product and sum rounded: a compiler may round the two of them once."""
    stored = code.copy()
    for at, channel in enumerate(channels.channels):
        texel = numbers_of(channel, integers[:, at])
        stored[:, at] = texel * np.float32(2) - np.float32(1) if codec.storage.is_biased else texel
    return stored


def _array(planes) -> np.ndarray:
    return np.stack([np.asarray(plane, np.float32) for plane in planes], axis=1)


def _integers(channel: Channel, texels: np.ndarray) -> np.ndarray:
    """The bits that a texel's numbers are kept as, uint32 of shape (count,)."""
    numbers = texels.astype(np.float64)
    if channel.kind == "unorm":
        return np.rint(numbers * channel.integer).astype(np.uint32)
    if channel.kind == "snorm":
        whole = np.rint(numbers * channel.integer).astype(np.int64) + (channel.integer if channel.is_across else 0)
        return (whole & (1 << channel.bits) - 1).astype(np.uint32)
    if channel.bits in FLOATS:
        kind = FLOATS[channel.bits]
        return numbers.astype(kind).view(f"u{channel.bits // 8}").astype(np.uint32)
    return (numbers.astype(np.float16).view(np.uint16) >> HALF - channel.bits).astype(np.uint32)


def _words(channels: Channels, integers: np.ndarray) -> np.ndarray:
    """Texels of integers, uint32 of shape (count, words)."""
    words = np.zeros((len(integers), channels.words), np.uint32)
    for at, channel in enumerate(channels.channels):
        words[:, channel.first // WORD] |= integers[:, at] << np.uint32(channel.first % WORD)
    return bytes_turned(words, channels.bytes) if channels.codec.storage.is_packed else words


def bytes_turned(words: np.ndarray, count: int) -> np.ndarray:
    """uint32 with their lowest bytes in the opposite order: numbers laid across bytes begin with the highest bit of the
    first byte, which is the lowest of a texel's word."""
    turned = np.zeros_like(words)
    for at in range(count):
        turned |= (words >> np.uint32(8 * at) & np.uint32(255)) << np.uint32(8 * (count - 1 - at))
    return turned


def _texels(codec: Codec, channels: Channels, integers: np.ndarray, words: np.ndarray) -> np.ndarray:
    """What a shader reads from a render target, float32 of shape (count, 4)."""
    texels = np.zeros((len(integers), 4), np.float32)
    if codec.storage.is_packed:
        for at in range(channels.bytes):
            texels[:, at] = (words[:, 0] >> np.uint32(8 * at) & np.uint32(255)) * np.float32(1 / 255)
        return texels
    for at, channel in enumerate(channels.channels):
        texels[:, at] = numbers_of(channel, integers[:, at])
    return texels


def numbers_of(channel: Channel, integers: np.ndarray) -> np.ndarray:
    """The texel's numbers that bits stand for, float32 of shape (count,)."""
    if channel.kind == "unorm":
        return integers.astype(np.float32) * np.float32(1 / channel.integer)
    if channel.kind == "snorm":
        whole = signed(channel, integers) - (channel.integer if channel.is_across else 0)
        return whole.astype(np.float32) * np.float32(1 / channel.integer)
    if channel.bits in FLOATS:
        return integers.astype(f"u{channel.bits // 8}").view(FLOATS[channel.bits]).astype(np.float32)
    return (integers << HALF - channel.bits).astype(np.uint16).view(np.float16).astype(np.float32)


def signed(channel: Channel, integers: np.ndarray) -> np.ndarray:
    """Bits as integers in the order of the numbers that they stand for, int64: how many steps two are apart."""
    whole = integers.astype(np.int64)
    is_unsigned = channel.kind == "unorm" or (channel.kind == "float" and channel.bits < 16)
    if is_unsigned or channel.is_across:
        return whole
    negative = whole >> channel.bits - 1 != 0
    if channel.kind == "snorm":
        return np.where(negative, whole - (1 << channel.bits), whole)
    magnitude = whole & (1 << channel.bits - 1) - 1
    return np.where(negative, -magnitude, magnitude)
