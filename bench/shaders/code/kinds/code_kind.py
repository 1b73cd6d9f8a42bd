"""A kind of codec, as `code` handles it: its functions, its numbers, and the catalogue's results for some values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .....encodings.kinds import Kind
from .....encodings.storages.storage import STORAGES, Storage

# How many values a code is tried with.
COUNT = 2**16


@dataclass(frozen=True)
class Numbers:
    """The numbers of a code, and how they are stored.

    Attributes:
        storage: their storage, with the first number in the first channel.
        roundings: the rounding of each number that is stored, one of `storage.ROUNDINGS`.
        is_biased: whether a number c is stored as c/2 + 1/2.
        size: the number of components of the code's vector; components that are not stored are read back as 0.
        sign_bits: 1 if the last component is a sign that is stored elsewhere, else 0.
        is_precise: whether the encoder takes the neighbouring code that decodes nearest.
        settle: the function (value, the code as read back) -> the code to store, if some numbers depend on how
            others are rounded; else empty.
        skipped: the number of bits that are skipped before numbers laid across channels.
        share: "unsigned" or "signed" for an integer from `storage.fixed_code`, in sign and magnitude; else empty.
    """

    storage: Storage
    roundings: tuple[str, ...]
    is_biased: bool
    size: int
    sign_bits: int = 0
    is_precise: bool = False
    settle: str = ""
    skipped: int = 0
    share: str = ""

    @property
    def target(self) -> Storage:
        """The format of the render target."""
        return STORAGES["rgba8"] if self.skipped else self.storage.target

    @property
    def count(self) -> int:
        """The number of components that are stored."""
        return len(self.roundings)


@dataclass(frozen=True)
class CodeKind:
    """A kind of codec, as `code` handles it. Values are rows of numbers, n and view, as in `run.interface`.

    Attributes:
        kind: the catalogue's kind.
        plural: the name of the encoded values, in the plural.
        given: (codec) -> the places of an encoder's input in these rows, such as n.xyz.
        named: (codec) -> the usual name of its encoding.
        fields: the names of these places in the structure that an encoder takes and a decoder returns; else empty.
        settings: the places of the other inputs of both functions, by parameter, such as view.xyz.
        result: (codec) -> the number of values that a decoder returns; in a structure, the values of n come first.
        defines: (codec) -> the macros of its GLSL: CODE, ENCODE and DECODE, and constants.
        numbers: (codec) -> its numbers.
        bound: (codec) -> the settings that are constants of the codec.
        values: (codec) -> n and view, float32 of shape (COUNT, 3 or 4).
        stored: (codec, n, view) -> the code as read back from the storage, as planes; in JAX.
        decoded: (codec, code, view) -> the decoded value, as planes; in JAX.
        by_device: (codec, n, view) -> codes as read back, (count, size), and their decoded values, (count, result),
            by OpenGL, for encodings that exist only in GLSL.
        has_twin: (codec) -> whether its encoding exists in JAX.
        is_ours: (codec) -> whether its encoding is the catalogue's.
        errors: (input, result) -> the error, float64 of shape (count,).
        unit: the unit of the errors.
        units: (input) -> the unit of differences between decoded values, (count, 1).
        searches: (codec) -> whether the encoder takes the best of several codes.
        held: (codec) -> the values that its functions take, in words.
        called: the default beginning of names, if that is not the kind's word.
    """

    kind: Kind
    plural: str
    given: Callable[[Any], tuple[str, ...]]
    settings: Mapping[str, str]
    result: Callable[[Any], int]
    defines: Callable[[Any], dict[str, object]]
    numbers: Callable[[Any], Numbers]
    values: Callable[[Any], tuple[np.ndarray, np.ndarray]]
    stored: Callable[[Any, Any, Any], Any]
    decoded: Callable[[Any, Any, Any], Any]
    by_device: Callable[[Any, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
    has_twin: Callable[[Any], bool]
    is_ours: Callable[[Any], bool]
    errors: Callable[[np.ndarray, np.ndarray], np.ndarray]
    unit: str
    held: Callable[[Any], str]
    units: Callable[[np.ndarray], np.ndarray] = field(default=lambda given: np.ones((len(given), 1)))
    bound: Callable[[Any], Mapping[str, float]] = field(default=lambda _: {})
    searches: Callable[[Any], bool] = field(default=lambda _: False)
    named: Callable[[Any], str] = field(default=lambda codec: codec.encoding.name)
    fields: tuple[str, ...] = ()
    called: str = ""

    @property
    def prefix(self) -> str:
        """The default beginning of the names of functions: `called`, or the kind's word."""
        return self.called or self.kind.word
