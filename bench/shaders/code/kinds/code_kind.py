"""What `code` knows of a kind of codes: their functions, their numbers, and what the catalogue makes of some values."""

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
    """The numbers of a code, and how they are kept.

    Attributes:
        storage: what keeps them, the first number in the first channel.
        roundings: how each number that is kept is rounded, one of `storage.ROUNDINGS`.
        is_biased: whether a number c is kept as c/2 + 1/2.
        size: how many numbers the code's vector has; those that are not kept come back as 0.
        sign_bits: 1 where the last of them is a sign that is kept elsewhere, else 0.
        is_precise: whether the encoder takes the one of the codes around that decodes nearest.
        settle: the function (value, the code as it comes back) -> the code to keep, where some numbers depend on how
            others are rounded; empty where none do.
        skipped: how many bits are left out before numbers that lie across channels.
        share: "unsigned" or "signed" of an integer as `storage.fixed_code` makes it, in sign and magnitude; else empty.
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
        """How many numbers are kept."""
        return len(self.roundings)


@dataclass(frozen=True)
class CodeKind:
    """What `code` knows of a kind. Values are rows of numbers, as `run.interface` has them: n and view.

    Attributes:
        kind: of the catalogue.
        plural: what is encoded, in words.
        given: where in these rows lies what an encoder is given: n.xyz.
        named: (codec) -> its encoding as people name it.
        fields: what these are called in the structure that an encoder is given and a decoder gives; none of others.
        settings: by its parameter, where what both functions are given besides lies: view.xyz.
        result: how many numbers a decoder gives; of a structure those of n first.
        defines: (codec) -> the macros of its GLSL: CODE, ENCODE and DECODE, and constants.
        numbers: (codec) -> its numbers.
        bound: (codec) -> the settings that are constants of the codec.
        values: (codec) -> n and view, float32 of shape (COUNT, 3 or 4).
        stored: (codec, n, view) -> the code as it comes back from the storage, as planes; of JAX.
        decoded: (codec, code, view) -> what it is decoded to, as planes; of JAX.
        by_device: (codec, n, view) -> codes as they come back and what they are decoded to, by OpenGL, of codes that
            are there in GLSL alone; (count, size) and (count, result).
        has_twin: (codec) -> whether it is there in JAX.
        is_ours: (codec) -> whether it is the catalogue's.
        errors: (what was given, what came back) -> how far off it is, float64 of shape (count,).
        unit: what the errors are counted in.
        units: (what was given) -> what differences of what is decoded are counted in, (count, 1).
        searches: (codec) -> whether the encoder takes the best of several codes.
        held: (codec) -> the values that its functions take, in words.
        called: what names begin with where nobody says otherwise, if that is not the kind's word.
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
        """What names begin with where nobody says otherwise."""
        return self.called or self.kind.word
