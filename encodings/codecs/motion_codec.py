"""Motion codecs: a motion encoding, which maps motion vectors to two numbers and back in both languages, and its
storage. `normalbench vectors` measures them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from ..kinds import MOTION, Kind
from ..storages.dither import Dither
from ..storages.rounding import store_number
from ..storages.rules import of_count
from ..storages.storage import DITHERED, Storage, of_unit, rounds_to
from ..vec import Vec2
from .codec import codec_name, dither_of, numbers_misfit, rounding_misfit

if TYPE_CHECKING:
    from jaxtyping import ArrayLike, Float

NUMBERS = 2


@dataclass(frozen=True, eq=False)
class MotionEncoding:
    """A pair of maps between motion vectors and codes, in JAX and, in the file next to it, in GLSL.

    Motion is in screens per frame: 1 is the width of the image along x and its height along y. The range, in screens,
    is the largest motion, which becomes 1 or -1. The GLSL file defines
    `vec2 <name>_encode_motion(vec2 motion, float range)` and `vec2 <name>_decode_motion(vec2 e, float range)`.
    Encoders do not clip; fixed-point storages do. An encoder that computes a root or a logarithm treats NaN as no
    motion; `linear` leaves NaN to the format.

    Attributes:
        name: the catalogue's key, the file's name and the prefix of the GLSL functions.
        title: human-readable name.
        encode: (motion, range) -> two numbers, in [-1, 1] for motions up to the range.
        decode: (numbers, range) -> motion.
        storages: usual storages, names of MOTION_STORAGES.
        citation: source of the encoding.
        glsl: the GLSL twin.
        ulps: allowed differences between the two languages before storage, for motions up to the range: of encode in
            units of 2^-23, of decode in units of 2^-23 of the range.
        ulps_reason: reason for these numbers.
        own_units: whether float formats hold the motion in screens, as with a range of 1, and so need no range.
        constants: numbers that both languages need, by GLSL name.
        functions: prefix of the GLSL functions in a user's file; empty if it is the name.
        is_unit: whether its author's functions take and return numbers u in [0, 1], with c = 2 u - 1; every storage
            then holds u.
        own_range: for functions without a range, the largest motion, which becomes 1 or -1; None for others.
    """

    kind: ClassVar[Kind] = MOTION
    name: str
    title: str
    encode: Callable[[Vec2, Any], Vec2]
    decode: Callable[[Vec2, Any], Vec2]
    storages: tuple[str, ...]
    citation: str
    glsl: Path
    ulps: tuple[int, int]
    ulps_reason: str
    own_units: bool = False
    constants: Mapping[str, float | tuple[float, ...]] = field(default_factory=dict)
    functions: str = ""
    is_unit: bool = False
    own_range: float | None = None

    @property
    def prefix(self) -> str:
        """The prefix of the names of the GLSL functions."""
        return self.functions or self.name

    @property
    def signatures(self) -> tuple[str, str]:
        """The GLSL signatures of the encoder and the decoder, without semicolons."""
        return (
            f"vec2 {self.prefix}_encode_motion(vec2 motion, float range)",
            f"vec2 {self.prefix}_decode_motion(vec2 e, float range)",
        )


@dataclass(frozen=True)
class MotionCodec:
    """A motion encoding, the storage whose first two channels hold its numbers, and the rounding: one of
    `storage.ROUNDINGS`, or DITHERED."""

    encoding: MotionEncoding
    storage: Storage
    rounding: str = "nearest"

    def __post_init__(self) -> None:
        object.__setattr__(self, "storage", of_count(self.storage, NUMBERS))
        if self.encoding.is_unit:
            object.__setattr__(self, "storage", of_unit(self.storage))

    @property
    def name(self) -> str:
        return codec_name(self.encoding.name, self.storage.name, self.rounding)

    @property
    def misfit(self) -> str | None:
        """The reason why the storage cannot hold the encoding's numbers; None if it can."""
        return numbers_misfit(self.storage, [0] * NUMBERS) or rounding_misfit(self.storage, self.rounding)

    @property
    def is_dithered(self) -> bool:
        """Whether noise is added to the numbers before they are rounded to nearest."""
        return self.rounding == DITHERED

    def dither(self, frame: int) -> Dither:
        """Return noise of one step for the codec's numbers in a frame."""
        return dither_of(self.storage, [0] * NUMBERS, frame)

    @property
    def bits(self) -> int:
        """The number of bits needed: the bits of two channels."""
        return sum(self.storage.bits[:NUMBERS])

    @property
    def codes(self) -> int:
        """The number of codes: all combinations of values that the numbers in [-1, 1] can have."""
        return math.prod(map(self.storage.count, range(NUMBERS)))

    @property
    def needs_range(self) -> bool:
        """Whether the codec's numbers depend on the range; float formats may hold the motion itself."""
        is_ranged = self.encoding.own_range is None
        return is_ranged and not (self.encoding.own_units and self.storage.kind == "float")

    def ranges(self, asked: Sequence[float]) -> Sequence[float]:
        """Return the ranges over which the codec is measured: the encoding's own range if it has one; otherwise all
        of `asked` if `needs_range` is true, and only the first of them if not."""
        if self.encoding.own_range is not None:
            return (self.encoding.own_range,)
        return asked if self.needs_range else asked[:1]

    @property
    def clips(self) -> bool:
        """Whether motions beyond the range are clipped to the range."""
        return self.storage.kind != "float"

    def stored(self, motion: Vec2, largest: Float[ArrayLike, "*shape"], noise: Vec2 | None = None) -> Vec2:
        """Return the code of motions as the storage returns it.

        Args:
            motion: screens per frame, float32 of any shape.
            largest: the range, float32, for all motions or per motion; ignored unless `needs_range` is true.
            noise: noise to add to the numbers before they are rounded, of the same shape; None for no noise.
        """
        code = self.encoding.encode(motion, self._range_or_one(largest))
        noisy, rounding = (code + noise if noise else code), rounds_to(self.rounding)
        return Vec2(*(store_number(c, self.storage, i, rounding) for i, c in enumerate(noisy)))

    def round_trip(self, motion: Vec2, largest: Float[ArrayLike, "*shape"], noise: Vec2 | None = None) -> Vec2:
        """Return motions after encoding, storage and decoding; see `stored`."""
        return self.encoding.decode(self.stored(motion, largest, noise), self._range_or_one(largest))

    def _range_or_one(self, largest: Float[ArrayLike, "*shape"]) -> Float[ArrayLike, "*shape"]:
        return largest if self.needs_range else 1.0
