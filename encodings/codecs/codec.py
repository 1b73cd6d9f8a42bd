"""Codecs, the subject of all measurements: an encoding and the storage for its numbers."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np

from ..storages.dither import Dither
from ..storages.rounding import numbers_around, store_number
from ..storages.rules import of_count
from ..storages.storage import BITS_32, DITHERED, FORMS, Storage, of_unit, rounds_to
from ..vec import Vec3, dot, jnp, select
from .encoding import Code, Encoding

if TYPE_CHECKING:
    from jaxtyping import Array, Float

# A number that is not one of few values is not laid into fewer bits, unless somebody said them.
LEAST_BITS = 4


def numbers_misfit(storage: Storage, levels: Sequence[int]) -> str | None:
    """Return why a storage's channels cannot hold numbers with these value counts (0: any); None if they can."""
    if len(levels) > storage.channels:
        has = f"{storage.channels} channel" + "s" * (storage.channels > 1)
        return f"{len(levels)} components, but {storage.title} has {has}"
    for channel, count in enumerate(levels):
        bits = storage.bits[channel]
        if count > storage.levels(channel):
            return f"component {channel + 1} has {count} values, more than {storage.title} can distinguish"
        if not count and bits < LEAST_BITS and not storage.is_said:
            least = f"ordinary components need at least {LEAST_BITS}"
            return f"component {channel + 1} has only {bits} bits in {storage.title}; {least}"
    return None


def fewer_bits(bits: int | None, code_bits: float | None) -> int | None:
    """Return `code_bits`, rounded to a whole number, if it is below `bits`; otherwise, or if one is missing, None."""
    return round(code_bits) if bits and code_bits and round(code_bits) < bits else None


def codec_name(encoding_name: str, storage_name: str, rounding: str) -> str:
    """Return the name of a codec, `encoding/storage/rounding`, without the rounding if it is to nearest."""
    return f"{encoding_name}/{storage_name}" + ("" if rounding == "nearest" else f"/{rounding}")


def rounding_misfit(storage: Storage, rounding: str) -> str | None:
    """Return why a storage does not support a rounding, one of ROUNDINGS or DITHERED; None if it does."""
    if storage.kind == "float" and rounding == DITHERED:
        return f"{storage.title}: float steps are uneven; use noise only with fixed point"
    if storage.kind == "float" and rounding == "truncate_half":
        return f"{storage.title} stores floats, but {rounding} is for fixed point"
    return None


def dither_of(storage: Storage, levels: Sequence[int], frame: int) -> Dither:
    """Return noise of one step of the storage for each component whose value count in `levels` is 0, and no noise for
    the others. For `frame`, see `Dither`."""
    return Dither(tuple(0.0 if count else storage.step(channel) for channel, count in enumerate(levels)), frame)


@dataclass(frozen=True)
class Codec:
    """An encoding, the storage for its components, and the rounding: one of `storage.ROUNDINGS`, or DITHERED.

    If an encoding's numbers are in [0, 1], the texels hold these numbers unchanged, even in a signed storage. An
    encoding that packs its own code has its own storage, which replaces the given storage.
    """

    encoding: Encoding
    storage: Storage
    rounding: str = "nearest"

    def __post_init__(self) -> None:
        object.__setattr__(self, "storage", of_count(self.storage, self.encoding.components))
        if self.encoding.is_packed:
            object.__setattr__(self, "storage", BITS_32)
            # An integer is as it is made; noise, which would make another one of it, does not fit.
            object.__setattr__(self, "rounding", DITHERED if self.is_dithered else "nearest")
        if self.encoding.is_unit:
            object.__setattr__(self, "storage", of_unit(self.storage))

    @property
    def name(self) -> str:
        return codec_name(self.encoding.name, self.storage.name, self.rounding)

    @property
    def misfit(self) -> str | None:
        """The reason why the storage cannot hold the encoding's output; None if it can.

        Sign bits are stored elsewhere, in the sign of the depth.
        """
        encoding, storage = self.encoding, self.storage
        if encoding.before and encoding.before.misfit:
            return f"{encoding.before.name}: {encoding.before.misfit}"
        levels = [encoding.levels_of(channel) for channel in range(encoding.components)]
        if len(levels) > storage.channels:
            return numbers_misfit(storage, levels)
        if misfit := rounding_misfit(storage, self.rounding) or self._not_with_noise:
            return misfit
        if storage.kind == "float" and encoding.is_precise:
            return f"{storage.title} stores floats, but precise rounding is for fixed point"
        if encoding.is_precise and self.rounding != "nearest":
            return "it supports only precise rounding"
        if encoding.is_half and self._not_in_half:
            return f"{self._not_in_half} for half arithmetic"
        return numbers_misfit(storage, levels)

    @property
    def is_dithered(self) -> bool:
        """Whether noise is added to the numbers before they are rounded to nearest."""
        return self.rounding == DITHERED

    @property
    def _not_with_noise(self) -> str:
        """The reason why measurements cannot add the requested noise; empty if they can, or if none is requested."""
        if not self.is_dithered:
            return ""
        if self.encoding.is_half or self.encoding.before:
            return "noise can be added only to a single encoding in float32"
        return self.undithered or ""

    @property
    def _not_in_half(self) -> str:
        """The reason why the encoding does not support half arithmetic, worded to precede "for half arithmetic" in a
        message; empty if the encoding supports it."""
        if self.encoding.is_packed:
            return "a 32-bit integer code is not supported"
        if self.encoding.before:
            return "chains are not supported"
        if self.encoding.is_precise:
            return "precise rounding compares errors that are too small"
        # Whole numbers are bits and counts of loops, which stay integers.
        numbers = [value for value in self.encoding.constants.values() if isinstance(value, float)]
        is_large = self.encoding.has_tables or max(numbers, default=0.0) > FORMS[16].largest
        return "it uses numbers that are too large" if is_large else ""

    @property
    def undithered(self) -> str | None:
        """The reason why noise, requested or not, cannot be added to the numbers before rounding; None if it can."""
        encoding = self.encoding
        if encoding.is_packed or (encoding.levels and all(encoding.levels)):
            return "its code is an integer, such as an index, and noise would select a different one"
        if encoding.is_precise or rounds_to(self.rounding) != "nearest":
            return "noise can be added only with rounding to nearest"
        if self.storage.kind == "float":
            return f"{self.storage.title}: float steps are uneven"
        return None

    def dither(self, frame: int) -> Dither:
        """Return noise of one step for the codec's numbers, for a frame of moving noise; frame 0 is still noise."""
        return dither_of(self.storage, list(map(self.encoding.levels_of, range(self.encoding.components))), frame)

    @property
    def fits(self) -> bool:
        """Whether the storage can hold the encoding's code."""
        return self.misfit is None

    @property
    def is_integer(self) -> bool:
        """Whether the texels hold bits without a meaningful mean: an integer, or floats laid across channels."""
        return self.encoding.is_packed or self.storage.is_word or self.storage.form is not None

    @property
    def bits(self) -> int:
        """The number of bits used: all bits of each channel in use, and the sign bits; for an integer, its used bits.

        A component with few values also counts as a whole channel, since other storages have a channel that fits.
        """
        if self.encoding.is_packed:
            return self.encoding.packed_bits
        return sum(self.storage.bits[: self.encoding.components]) + self.encoding.sign_bits

    @property
    def codes(self) -> int:
        """The number of codes: all combinations of values that the numbers in [-1, 1] can have, used or not."""
        if self.encoding.is_packed:
            return 2**self.encoding.packed_bits
        size = self.encoding.components + self.encoding.sign_bits
        return math.prod(self.encoding.levels_of(i) or self.storage.count(i) for i in range(size))

    @property
    def code_bits(self) -> float | None:
        """The base-2 logarithm of the number of codes if every component has fixed levels; otherwise None."""
        is_fixed = all(map(self.encoding.levels_of, range(self.encoding.components)))
        return math.log2(self.codes) if is_fixed else None

    def numbers(self, component: int) -> Float[np.ndarray, " numbers"]:
        """Return all numbers in [-1, 1] that a component can have after storage, ascending; float64. For a component
        with a fixed number of values, these are the nearest stored numbers; for a sign bit, -1 and 1."""
        if component >= self.encoding.components:
            return np.array([-1.0, 1.0])
        levels = self.encoding.levels_of(component)
        wanted = np.linspace(-1.0, 1.0, levels or 0)
        if levels and self.storage.bits[component] == 32 and self.storage.kind == "float":
            # There are two billions of these numbers, and the nearest is what NumPy makes.
            return wanted.astype(np.float32).astype(np.float64)
        every = self.storage.numbers(component)
        if not levels:
            return every
        above = np.clip(np.searchsorted(every, wanted), 1, len(every) - 1)
        is_above = every[above] - wanted < wanted - every[above - 1]
        return every[above - ~is_above]

    def rounding_of(self, component: int) -> str:
        """Return the rounding of a component: always to nearest if it has a fixed number of values."""
        return "nearest" if self.encoding.levels_of(component) else rounds_to(self.rounding)

    def store(self, code):
        """Return a code (Vec2 or Vec3) as the storage returns it. Sign bits are unchanged."""
        stored = (
            store_number(c, self.storage, i, self.rounding_of(i)) if i < self.encoding.components else c
            for i, c in enumerate(code)
        )
        return type(code)(*stored)

    def stored(self, n: Vec3, view: Vec3, noise: Sequence[Float[Array | np.ndarray, "*shape"]] | None = None):
        """Return the code of unit normals as the storage returns it.

        Args:
            noise: noise to add to the numbers before they are rounded, planes of the normals' shape.
        """
        # A number chosen from constants has no width of its own; half arithmetic has another one.
        dtype = jnp.float16 if self.encoding.is_half else n.z.dtype
        code = type(code := self.encoding.encode(n, view))(*(jnp.asarray(c, dtype) for c in code))
        if noise is not None:
            code = type(code)(*(c + added for c, added in zip(code, noise, strict=False)))
        return self.store(self._nearest_of(code, n, view) if self.encoding.is_precise else code)

    def around(self, code) -> list:
        """Return the 2^n codes around a code (Vec2 or Vec3) of n numbers, each number rounded down or up by a
        fixed-point format. Components with a fixed number of values keep their number."""
        around = [
            (c,) * 2 if self.encoding.levels_of(i) else numbers_around(c, self.storage, i) for i, c in enumerate(code)
        ]
        return [type(code)(*numbers) for numbers in itertools.product(*around)]

    def _nearest_of(self, code, n: Vec3, view: Vec3):
        """Return the code that decodes nearest to n, from the codes around `code`."""
        codes = self.around(code)
        # Squared distances, not cosines: near 1 those no longer tell fine codes apart.
        misses = [n - self.encoding.decode(candidate, view) for candidate in codes]
        return reduce(_nearer, zip((dot(miss, miss) for miss in misses), codes, strict=True))[1]

    def round_trip(
        self, n: Vec3, view: Vec3, noise: Sequence[Float[Array | np.ndarray, "*shape"]] | None = None
    ) -> Vec3:
        """Return unit normals (any shape, as from `from_array`) after encoding, storage and decoding; not
        renormalised. For `noise`, see `stored`."""
        decoded = self.encoding.decode(self.stored(n, view, noise), view)
        # A component that is a number of Python, or of another type, becomes one for each normal.
        return Vec3(*(jnp.broadcast_to(jnp.asarray(c, n.z.dtype), jnp.shape(n.z)) for c in decoded))


def _nearer(
    a: tuple[Float[Array, "*shape"], Code], b: tuple[Float[Array, "*shape"], Code]
) -> tuple[Float[Array, "*shape"], Code]:
    """Return, element by element, the nearer of two (distance, code) pairs; the first if both are equally near."""
    is_nearer = b[0] < a[0]
    return select(is_nearer, b[0], a[0]), select(is_nearer, b[1], a[1])
