"""Tangent-frame codecs, which `normalbench frames` measures: a frame encoding and its storage."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..rotation import Frame
from ..storages.dither import Dither
from ..storages.rounding import store_number
from ..storages.rules import of_count
from ..storages.storage import DITHERED, Storage, of_unit, rounds_to
from ..vec import TINY, Vec4, select
from .codec import codec_name, dither_of, numbers_misfit, rounding_misfit
from .frame_encoding import FrameEncoding


@dataclass(frozen=True)
class FrameCodec:
    """A frame encoding, the storage for its numbers, and the rounding: one of `storage.ROUNDINGS`, or DITHERED.
    Numbers with a fixed number of values are rounded to nearest, without noise."""

    encoding: FrameEncoding
    storage: Storage
    rounding: str = "nearest"

    def __post_init__(self) -> None:
        object.__setattr__(self, "storage", of_count(self.storage, self.encoding.components))
        if self.encoding.is_unit:
            object.__setattr__(self, "storage", of_unit(self.storage))

    @property
    def name(self) -> str:
        return codec_name(self.encoding.name, self.storage.name, self.rounding)

    @property
    def misfit(self) -> str | None:
        """The reason why the storage cannot hold the encoding's numbers; None if it can."""
        return numbers_misfit(self.storage, self.encoding.levels) or rounding_misfit(self.storage, self.rounding)

    @property
    def bits(self) -> int:
        """The number of bits used: all bits of every channel in use."""
        return sum(self.storage.bits[: self.encoding.components])

    @property
    def codes(self) -> int:
        """The number of codes: all combinations of values that the numbers in [-1, 1] can have, used or not."""
        return math.prod(n or self.storage.count(i) for i, n in enumerate(self.encoding.levels))

    @property
    def least(self) -> float:
        """The smallest positive number that the storage can hold in the component whose sign is the hand: a whole
        step of SNORM, or half a step of UNORM, which has no 0. It is 0 if the encoding does not keep the hand."""
        if self.encoding.hand_in is None:
            return 0.0
        if self.storage.kind == "float":
            # The least normal float: none that a device may flush to 0.
            return max(2.0 ** (1 - self.storage.float_form(self.encoding.hand_in).one), TINY)
        return 1.0 / self.storage.scale(self.encoding.hand_in)

    @property
    def is_dithered(self) -> bool:
        """Whether noise is added to the numbers before they are rounded to nearest."""
        return self.rounding == DITHERED

    @property
    def dither(self) -> Dither:
        """Noise of one step for the codec's numbers, the same in every frame."""
        return dither_of(self.storage, self.encoding.levels, 0)

    def rounding_of(self, component: int) -> str:
        """Return the rounding of a component: always to nearest if it has a fixed number of values."""
        has_levels = component < self.encoding.components and self.encoding.levels[component]
        return "nearest" if has_levels else rounds_to(self.rounding)

    def store(self, code: Vec4) -> Vec4:
        """Return a code (float32, any shape) as the storage returns it; components beyond the encoding's are 0."""
        return Vec4(
            *(
                store_number(c, self.storage, i, self.rounding_of(i)) if i < self.encoding.components else 0.0 * c
                for i, c in enumerate(code)
            )
        )

    def stored(self, frame: Frame, noise: Vec4 | None = None) -> Vec4:
        """Return the code of frames as the storage returns it.

        Args:
            noise: noise to add to the numbers before they are rounded, of the same shape; None for no noise.
        """

        def store(code: Vec4) -> Vec4:
            return self.store(code + noise if noise else code)

        code = store(self.encoding.encode(frame, self.least))
        if not self.encoding.settle:
            return code
        settled = self.encoding.settle(frame, code)
        stored = store(settled)
        if self.rounding == "nearest":
            return stored
        # What is stored already stays, as to the nearest it does by itself: cut off again, or with more noise, it could
        # lose a step.
        kept = zip(settled, code, stored, strict=True)
        return Vec4(*(select(number == before, before, after) for number, before, after in kept))

    def round_trip(self, frame: Frame, noise: Vec4 | None = None) -> Frame:
        """Return frames (float32, any shape, as from `frame_of`) after encoding, storage and decoding. See `stored`
        for `noise`."""
        return self.encoding.decode(self.stored(frame, noise), self.least)
