"""Curve codecs: a curve encoding, which maps a quantity to a number in [0, 1] and back in both languages, and its
storage."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from ..kinds import CURVE, Kind
from ..storages.rounding import store_texel
from ..storages.rules import of_count
from ..storages.storage import DITHERED, Storage, rounds_to
from .codec import rounding_misfit

if TYPE_CHECKING:
    import numpy as np
    from jaxtyping import Array, ArrayLike, Float


@dataclass(frozen=True, eq=False)
class CurveEncoding:
    """A pair of maps between a quantity and a number in [0, 1], in JAX and, in the file next to it, in GLSL.

    A quantity is a single material value at a point: a roughness, a metallic value, a reflectance, ambient occlusion
    or a channel of a colour. The range is the largest quantity that is kept; fixed-point storages, not encoders,
    clamp larger quantities. An encoder that computes a root, a power or a logarithm, or that decreases, treats
    negative quantities and NaN as 0; `linear` and `reflectivity` leave them to the format. The GLSL file defines
    `float <name>_encode_curve(float x, float range)` and `float <name>_decode_curve(float e, float range)`.

    Attributes:
        name: the catalogue's key, the file's name and the prefix of the GLSL functions.
        title: human-readable name.
        encode: (quantity, range) -> number, in [0, 1] for quantities up to the range. Exact on float64 arrays.
        decode: (number, range) -> quantity. Exact on float64 arrays.
        storages: usual storages, names of CURVE_STORAGES.
        citation: source of the encoding.
        glsl: the GLSL twin.
        ulps: allowed differences between the two languages before storage: of encode in units of 2^-23, of decode in
            units of 2^-23 of the range.
        ulps_reason: reason for these numbers.
        usual_range: range if none is given.
        inverse_error: error of a quantity after encoding and decoding without rounding, as a fraction of the range;
            0 if the two maps are inverses.
        constants: numbers that both languages need, by GLSL name.
        functions: prefix of the GLSL functions in a user's file; empty if it is the name.
        stores_colours: whether it is used for colour channels; other curves have no errors in display steps.
    """

    kind: ClassVar[Kind] = CURVE
    name: str
    title: str
    encode: Callable[[Any, Any], Any]
    decode: Callable[[Any, Any], Any]
    storages: tuple[str, ...]
    citation: str
    glsl: Path
    ulps: tuple[int, int]
    ulps_reason: str
    usual_range: float = 1.0
    inverse_error: float = 0.0
    constants: Mapping[str, float | tuple[float, ...]] = field(default_factory=dict)
    functions: str = ""
    stores_colours: bool = True

    @property
    def prefix(self) -> str:
        """The prefix of the names of the GLSL functions."""
        return self.functions or self.name

    @property
    def signatures(self) -> tuple[str, str]:
        """The GLSL signatures of the encoder and the decoder, without semicolons."""
        return (
            f"float {self.prefix}_encode_curve(float x, float range)",
            f"float {self.prefix}_decode_curve(float e, float range)",
        )


@dataclass(frozen=True)
class CurveCodec:
    """A curve over a range, and the storage whose first channel holds its number.

    Attributes:
        range: the largest quantity that is kept.
        rounding: one of `storage.ROUNDINGS`; or DITHERED, which adds noise of one step to the number before it is
            rounded to nearest.
    """

    encoding: CurveEncoding
    storage: Storage
    range: float = 1.0
    rounding: str = "nearest"

    def __post_init__(self) -> None:
        object.__setattr__(self, "storage", of_count(self.storage, 1))

    @property
    def name(self) -> str:
        return f"{self.encoding.name}/{self.storage.name}"

    @property
    def misfit(self) -> str | None:
        """The reason why the storage cannot hold the encoding's number with this rounding; None if it can."""
        if self.storage.is_centred:
            return "centred numbers are signed, but a curve's values are 0 to 1"
        return rounding_misfit(self.storage, self.rounding)

    @property
    def is_dithered(self) -> bool:
        """Whether noise is added to the number before it is rounded to nearest."""
        return self.rounding == DITHERED

    @property
    def step(self) -> float:
        """The distance between neighbouring numbers in a fixed-point channel."""
        return 1.0 / self.storage.scale(0)

    @property
    def bits(self) -> int:
        """The number of bits needed: the bits of one channel."""
        return self.storage.bits[0]

    @property
    def codes(self) -> int:
        """The number of codes: the channel's numbers in [0, 1], about half of all its numbers if it has a sign."""
        count = self.storage.count(0)
        return count if self.storage.is_biased else count // 2 + 1

    def stored(
        self, x: Float[Array | np.ndarray, "*shape"], noise: Float[ArrayLike, "*shape"] = 0.0
    ) -> Float[Array | np.ndarray, "*shape"]:
        """Return the number for a quantity (float32, any shape, not negative) as the storage returns it.

        Args:
            noise: noise to add to the number before it is rounded, of the same shape.
        """
        return store_texel(self.encoding.encode(x, self.range) + noise, self.storage, 0, rounds_to(self.rounding))

    def round_trip(
        self, x: Float[Array | np.ndarray, "*shape"], noise: Float[ArrayLike, "*shape"] = 0.0
    ) -> Float[Array | np.ndarray, "*shape"]:
        """Return quantities after encoding, storage and decoding; see `stored`."""
        return self.encoding.decode(self.stored(x, noise), self.range)
