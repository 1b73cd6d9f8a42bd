"""The model of a device that mixes texels: the results of filtering, mip levels, resolving and blending in a channel.

Stored numbers are mixed in float32 arithmetic, and results that are written are rounded as the format requires. If
numbers are packed across channels, their bytes are mixed. A `Way` describes how a device mixes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.storages.rounding import store_texel
from ....encodings.storages.storage import Storage
from ....encodings.storages.words import numbers_across, words
from .patches import Mixes

F32 = np.float32
BYTE = 8
# The first four texels of a patch, row by row, and by level the texels that a mip level is the mean of.
QUAD = (0, 1, 4, 5)


@dataclass(frozen=True)
class Way:
    """A device's way of mixing texels.

    Attributes:
        is_fixed: whether fixed-point numbers are mixed as integers: each step of a filter is rounded, and a blend's
            products use shifts, p + p / 256 + 1/2 for p / 255.
        fraction_bits: bits of a filter's position between two texels; 0 for the full precision of a float32.
        rounding: rounding on writing, one of storage.ROUNDINGS; CUT rounds to 16 bits and truncates the lowest of
            them.
        rounds_source: whether a shader's output is rounded as the codec requires before it is blended.
    """

    is_fixed: bool = False
    fraction_bits: int = 0
    rounding: str = "nearest"
    rounds_source: bool = False

    def __str__(self) -> str:
        parts = ["integers" if self.is_fixed else "32-bit floats"]
        parts += [f"fractions of {self.fraction_bits} bits"] if self.fraction_bits else []
        parts += ["the source rounded first"] if self.rounds_source else []
        parts += [WRITTEN[self.rounding]] if self.rounding in WRITTEN else []
        return ", ".join(parts)


CUT = "cut"
WRITTEN: Mapping[str, str] = MappingProxyType(
    {"truncate": "truncated when written", CUT: "rounded to 16 bits and truncated when written"}
)
MODEL = Way()
# How devices have been found to mix, the plainest first: a filter, a blend, and whatever else is written.
FILTERS = (MODEL, *(Way(is_fixed, bits) for is_fixed in (True, False) for bits in (8, 6, 4)))
BLENDS = (
    MODEL,
    Way(rounding="truncate"),
    Way(rounds_source=True),
    Way(rounding="truncate", rounds_source=True),
    Way(rounding=CUT, rounds_source=True),
    Way(is_fixed=True, rounds_source=True),
)
MEANS_WAYS = (MODEL, Way(rounding="truncate"), Way(rounding=CUT), Way(is_fixed=True))
WAYS: Mapping[str, Sequence[Way]] = MappingProxyType(
    {
        "filter": FILTERS,
        **dict.fromkeys(("mip_2x2", "mip_4x4", "resolve"), MEANS_WAYS),
        **dict.fromkeys(("blend", "detail"), BLENDS),
    }
)


@partial(jax.jit, static_argnames=("storage", "rounding"))
def _stored_planes(planes, storage: Storage, rounding: str):
    return [store_texel(x, storage, channel, rounding) for channel, x in enumerate(planes)]


class Texels:
    """Conversion between a codec's numbers and texels: a plane for each channel, and for the sign of depth, if any.

    Args:
        codec: the codec whose numbers are stored.
    """

    def __init__(self, codec: Codec):
        self._codec, self._storage = codec, codec.storage.target
        self._components = codec.encoding.components
        self._signs = codec.encoding.sign_bits

    def of(self, code: np.ndarray) -> np.ndarray:
        """Return the texels that hold a code's numbers, float32 of shape (numbers, ...), before or after storage.

        Returns:
            planes (channels and sign, ...); the sign is a depth of 1 or -1.
        """
        signs = code[self._components : self._components + self._signs]
        if self._codec.storage.is_packed:
            return np.concatenate([self._packed_channels(code), signs])
        numbers = code[: self._components]
        return np.concatenate([numbers * F32(0.5) + F32(0.5) if self._codec.storage.is_biased else numbers, signs])

    def code(self, texels: np.ndarray) -> np.ndarray:
        """Return the code in texels, as floats, without decoding the normal: a row for each number, signs last."""
        signs = np.where(np.signbit(texels[len(texels) - self._signs :]), F32(-1), F32(1))
        if self._codec.storage.is_packed:
            return np.concatenate([self._unpacked_numbers(texels), signs])
        numbers = texels[: self._components]
        numbers = numbers * F32(2) - F32(1) if self._codec.storage.is_biased else numbers
        return np.concatenate([numbers, signs])

    def _packed_channels(self, code: np.ndarray) -> np.ndarray:
        storage, part = self._codec.storage, self._codec.storage.part
        whole = np.zeros(code.shape[1:], np.uint64)
        for channel, bits in enumerate(storage.bits):
            # A channel that the encoding has no number for holds 0.
            number = code[channel] if channel < self._components else np.zeros_like(code[0])
            whole = whole << np.uint64(bits) | words(number, storage, channel).astype(np.uint64)
        whole = whole << np.uint64(self._spare_bits)
        shifts, most = range((self._storage.channels - 1) * part, -1, -part), 2**part - 1
        return np.stack([(whole >> np.uint64(s) & np.uint64(most)).astype(F32) * F32(1 / most) for s in shifts])

    @property
    def _spare_bits(self) -> int:
        return self._storage.channels * self._codec.storage.part - sum(self._codec.storage.bits)

    def _unpacked_numbers(self, texels: np.ndarray) -> np.ndarray:
        storage, whole = self._codec.storage, np.zeros(texels.shape[1:], np.uint64)
        most = 2**storage.part - 1
        for held in texels[: self._storage.channels]:
            whole = whole << np.uint64(storage.part) | np.floor(held * F32(most) + F32(0.5)).astype(np.uint64)
        shift, numbers = self._storage.channels * storage.part, []
        for channel, bits in enumerate(storage.bits):
            shift -= bits
            integer = (whole >> np.uint64(shift) & np.uint64(2**bits - 1)).astype(np.uint32)
            numbers.append(numbers_across(integer, storage, channel))
        return np.stack(numbers[: self._components])

    def written(self, texels: np.ndarray, rounding: str) -> np.ndarray:
        """Return texels as the target stores them with a rounding; the depth's sign is unchanged."""
        channels = len(texels) - self._signs
        if rounding == CUT:
            return np.concatenate([self._cut_planes(texels[:channels]), texels[channels:]])
        kept = _stored_planes([jnp.asarray(p) for p in texels[:channels]], self._storage, rounding)
        return np.concatenate([np.stack([np.asarray(p) for p in kept]), texels[channels:]])

    def _cut_planes(self, texels: np.ndarray) -> np.ndarray:
        """Return UNORM planes rounded to 16 bits and then truncated to the format's bits, given planes without the
        sign; other formats are unchanged."""
        if self._storage.kind != "unorm":
            return texels
        scales = [self._storage.scale(channel) for channel in range(len(texels))]
        scale = np.array(scales, np.float64).reshape(-1, *[1] * (texels.ndim - 1))
        sixteen = np.rint(np.clip(texels.astype(np.float64), 0, 1) * (2**16 - 1))
        return (np.floor(sixteen * (scale + 1) / 2**16) / scale).astype(F32)

    def _whole_values(self, texels: np.ndarray) -> np.ndarray:
        """Return the integer that represents 1 in each plane, in a shape that broadcasts; 0 for floats and signs."""
        channels = len(texels) - self._signs
        is_float = self._storage.kind == "float"
        scales = [0 if is_float else self._storage.scale(c) for c in range(channels)] + [0] * self._signs
        return np.array(scales, np.float64).reshape(-1, *[1] * (texels.ndim - 1))

    def lerped(self, a: np.ndarray, b: np.ndarray, share: np.ndarray, way: Way) -> np.ndarray:
        """Return a + (b - a) share, computed as `way` describes: with a rounded `share`, or in integers."""
        step = 2.0**way.fraction_bits
        share = np.rint(share * step) / step if way.fraction_bits else share
        mixed = a + (b - a) * share.astype(F32)
        scale = self._whole_values(a)
        if not way.is_fixed or not scale.any():
            return mixed
        low, high = np.rint(a * scale), np.rint(b * scale)
        whole = low + np.floor((high - low) * share + 0.5)
        return np.where(scale > 0, whole / np.maximum(scale, 1), mixed).astype(F32)

    def blended(self, base: np.ndarray, source: np.ndarray, alpha: np.ndarray, way: Way) -> np.ndarray:
        """Return source alpha + base (1 - alpha) as the target stores it, computed as `way` describes."""
        source = self.written(source, self._codec.rounding) if way.rounds_source else source
        x = alpha.astype(F32)
        mixed = self.written(source * x + base * (F32(1) - x), way.rounding)
        scale = self._whole_values(base)
        if not way.is_fixed or not scale.any():
            return mixed
        share = np.rint(alpha * scale)
        parts = (
            _scaled_product(np.rint(source * scale), share, scale),
            _scaled_product(np.rint(base * scale), scale - share, scale),
        )
        # Products that go down may add up to one step below -1, which reads as -1.
        return np.where(scale > 0, np.maximum(sum(parts) / np.maximum(scale, 1), -1), mixed).astype(F32)


def _scaled_product(a: np.ndarray, b: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Return a b / scale for integers, computed with shifts that round down, also for negative products."""
    product = a * b
    return np.floor((product + np.floor(product / (scale + 1)) + np.copysign((scale + 1) / 2, product)) / (scale + 1))


def _filtered_texels(texels: Texels, quad: np.ndarray, mixes: Mixes, way: Way) -> np.ndarray:
    x, y = mixes.shares.T
    low, high = (texels.lerped(quad[:, first], quad[:, first + 1], x, way) for first in (0, 2))
    return texels.lerped(low, high, y, way)


def _averaged_texels(texels: Texels, quad: np.ndarray, way: Way) -> np.ndarray:
    """Return the mean of four texels (planes, 4, ...) as the target stores it."""
    half = np.full(quad.shape[2:], 0.5)
    low, high = (texels.lerped(quad[:, first], quad[:, first + 1], half, way) for first in (0, 2))
    return texels.written(texels.lerped(low, high, half, way), way.rounding)


def _reduced_texels(texels: Texels, planes: np.ndarray, way: Way) -> np.ndarray:
    """Return the next mip level of texels of shape (planes, side, side, patches), with half the side."""
    quad = np.stack([planes[:, y::2, x::2] for y in (0, 1) for x in (0, 1)], axis=1)
    return _averaged_texels(texels, quad, way)


def _mip_texel(level: int, texels: Texels, planes: np.ndarray, way: Way) -> np.ndarray:
    side = int(planes.shape[1] ** 0.5)
    reduced = planes.reshape(len(planes), side, side, -1)
    for _ in range(level):
        reduced = _reduced_texels(texels, reduced, way)
    return reduced[:, 0, 0]


def _resolved_texels(texels: Texels, planes: np.ndarray, mixes: Mixes, way: Way) -> np.ndarray:
    """Return the mean of a pixel's samples as the target stores it; `counts` samples have the first texel, the others
    the second."""
    total = np.zeros_like(planes[:, 0])
    for sample in range(mixes.samples):
        total = total + np.where(sample < mixes.counts, planes[:, 0], planes[:, 1])
    return texels.written(total * F32(1 / mixes.samples), way.rounding)


@dataclass(frozen=True, eq=False)
class Given:
    """Input of the model, float32.

    Attributes:
        planes: stored texels of the patches, (planes, TEXELS, patches).
        second, detail: a shader's output for the second normal and the detail, not yet rounded, (planes, patches).
    """

    planes: np.ndarray
    second: np.ndarray
    detail: np.ndarray


# By operation, how texels are mixed. What is not here mixes normals that are decoded.
BY_MODEL: Mapping[str, Callable[[Texels, Given, Mixes, Way], np.ndarray]] = MappingProxyType(
    {
        "filter": lambda texels, given, mixes, way: _filtered_texels(texels, given.planes[:, QUAD], mixes, way),
        "mip_2x2": lambda texels, given, _, way: _mip_texel(1, texels, given.planes, way),
        "mip_4x4": lambda texels, given, _, way: _mip_texel(2, texels, given.planes, way),
        "resolve": lambda texels, given, mixes, way: _resolved_texels(texels, given.planes, mixes, way),
        "blend": lambda texels, given, mixes, way: texels.blended(given.planes[:, 0], given.second, mixes.alphas, way),
        "detail": lambda texels, given, mixes, way: texels.blended(given.planes[:, 0], given.detail, mixes.alphas, way),
    }
)
