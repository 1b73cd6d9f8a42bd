"""The results of the two languages for the same inputs, and the comparison of each kind of encoding."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import jax.numpy as jnp
import numpy as np

ULP = 2.0**-23


@dataclass(frozen=True, repr=False)
class Comparison:
    """The results of the two languages for the same inputs.

    Attributes:
        what: the function or the codec.
        given, by_jax, by_gl: a row for each input.
        apart: how far apart the results are, in the kind's units; float64 of shape (count,).
        allowed: maximum number of units.
        reason: reason for this maximum.
        same: which results are the same, of shape (count,); by default those at most `allowed` apart.
        share: minimum share of results that are the same.
        details: other values of each input to report, by name.
    """

    what: str
    given: np.ndarray
    by_jax: np.ndarray
    by_gl: np.ndarray
    apart: np.ndarray
    allowed: float
    reason: str = ""
    same: np.ndarray | None = None
    share: float = 0.0
    details: Mapping[str, np.ndarray] = field(default_factory=dict)

    @property
    def agrees(self) -> bool:
        """Whether no result is too far apart, and enough are the same."""
        return bool(self.apart.max() <= self.allowed and self._share >= self.share)

    @property
    def _share(self) -> float:
        return float(np.mean(self.apart <= self.allowed if self.same is None else self.same))

    def __repr__(self) -> str:
        i = int(np.argmax(self.apart))
        details = "".join(f", {name} {values[i]:.9g}" for name, values in self.details.items())
        story = f"{self.what} of {self.given[i]!r}: JAX {self.by_jax[i]!r}, GLSL {self.by_gl[i]!r}{details}"
        story += f"; {self.apart[i]:.2f} units apart, allowed {self.allowed:g}"
        return f"{story}; {self._share:.4%} are the same, wanted {self.share:.2%}; {self.reason}".rstrip("; ")


@dataclass(frozen=True)
class Parity:
    """The comparison of encodings of a kind.

    Attributes:
        compared: (device, case) -> encoder and decoder before storage.
        cases: cases of an encoding: the encoding itself, or with each camera or format. A swap of two arguments is
            tried in the first case.
        guarded: (device, case) -> the encoder of invalid inputs, such as NaN; None if the kind has no such test.
        codecs: codecs that the quick test compares after storage.
        more_codecs: other codecs, which the slow test compares.
        stored: (device, codec, whether the slow test asks) -> codes after storage.
        shared: by encoding, files of shared functions, or FILE:FUNCTION, whose swaps that encoding notices.
        same: swaps of two arguments that leave the function the same.
    """

    compared: Callable[[Any, Any], list[Comparison]]
    cases: Callable[[Any], Sequence[Any]] = lambda encoding: (encoding,)
    guarded: Callable[[Any, Any], list[Comparison]] | None = None
    codecs: Sequence[Any] = ()
    more_codecs: Sequence[Any] = ()
    stored: Callable[[Any, Any, bool], list[Comparison]] = lambda _, __, ___: []
    shared: Mapping[str, Sequence[str]] = field(default_factory=dict)
    same: frozenset[str] = frozenset()


def planes(kind, array: np.ndarray):
    """Return rows of an array as a Vec2, Vec3 or Vec4 of JAX."""
    return kind(*(jnp.asarray(np.ascontiguousarray(c)) for c in array.T))


def rows(planes) -> np.ndarray:
    """Return vectors of JAX as an array with a row for each."""
    return np.stack([np.asarray(c) for c in planes], axis=1)


def widened(array: np.ndarray) -> np.ndarray:
    """Return rows of four numbers, as in buffers of GLSL."""
    return np.concatenate([array, np.zeros((len(array), 4 - array.shape[1]), np.float32)], axis=1)


def in_ulps(one: np.ndarray, other: np.ndarray, of: float | np.ndarray = 1.0) -> np.ndarray:
    """Return the largest difference of each row, in 2^-23 of `of`; infinite where `other` is not finite."""
    apart = np.abs(one.astype(np.float64) - other).max(axis=1) / of / ULP
    return np.where(np.isfinite(other).all(axis=1), apart, np.inf)


def is_finite(what: str, given: np.ndarray, by_jax: np.ndarray, by_gl: np.ndarray) -> Comparison:
    """Compare whether results are finite in both languages."""
    finite = np.isfinite(by_jax).all(axis=1) & np.isfinite(by_gl).all(axis=1)
    return Comparison(what, given, by_jax, by_gl, np.where(finite, 0.0, np.inf), 0.0, "all are finite")
