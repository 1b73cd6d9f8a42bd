"""What the two languages made of the same inputs, and how each kind of encoding is compared."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import jax.numpy as jnp
import numpy as np

ULP = 2.0**-23


@dataclass(frozen=True, repr=False)
class Comparison:
    """What the two languages made of the same inputs.

    Attributes:
        what: the function or the codec.
        given, by_jax, by_gl: a row for each input.
        apart: how far apart the results are, in the kind's units; float64 of shape (count,).
        allowed: the most units.
        reason: why it is that many.
        same: which results are the same, of shape (count,); without it those that are no more than `allowed` apart.
        share: the least share of results that are the same.
        details: what else to say of each input, by name.
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
    """How encodings of a kind are compared.

    Attributes:
        compared: (device, case) -> encoder and decoder before storage.
        cases: what an encoding is compared as; itself, or itself with each camera or format. A swap of two arguments
            is tried in the first case.
        guarded: (device, case) -> the encoder of inputs that mean nothing, such as NaN; None where the kind has none.
        codecs: what the quick test compares after storage.
        more_codecs: what the slow test compares, those of `codecs` aside.
        stored: (device, codec, whether the slow test asks) -> codes after storage.
        shared: by encoding, files of functions that several share, or FILE:FUNCTION, whose swaps that encoding notices.
        same: swaps of two arguments that make no other function.
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
    """Rows of an array as a Vec2, Vec3 or Vec4 of JAX."""
    return kind(*(jnp.asarray(np.ascontiguousarray(c)) for c in array.T))


def rows(planes) -> np.ndarray:
    """Vectors of JAX as an array with a row for each."""
    return np.stack([np.asarray(c) for c in planes], axis=1)


def widened(array: np.ndarray) -> np.ndarray:
    """Rows of four numbers, as buffers of GLSL have them."""
    return np.concatenate([array, np.zeros((len(array), 4 - array.shape[1]), np.float32)], axis=1)


def in_ulps(one: np.ndarray, other: np.ndarray, of: float | np.ndarray = 1.0) -> np.ndarray:
    """The largest difference of each row, in 2^-23 of `of`; infinite where the other is not finite."""
    apart = np.abs(one.astype(np.float64) - other).max(axis=1) / of / ULP
    return np.where(np.isfinite(other).all(axis=1), apart, np.inf)


def is_finite(what: str, given: np.ndarray, by_jax: np.ndarray, by_gl: np.ndarray) -> Comparison:
    """Whether results are numbers, in both languages."""
    finite = np.isfinite(by_jax).all(axis=1) & np.isfinite(by_gl).all(axis=1)
    return Comparison(what, given, by_jax, by_gl, np.where(finite, 0.0, np.inf), 0.0, "all are finite")
