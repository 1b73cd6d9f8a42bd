"""The error that storage is expected to make, as a smooth function of an encoding's parameters, and its gradient.

Rounding has no gradient. But a number that is stored in steps of h is off by h^2 / 12 in the mean square, and moves the
decoded normal by its derivative; to that comes in full what a number beyond [-1, 1] loses. The gradient is JAX's, in
float64, through the derivative of the decoder.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.vec import Vec3, dot, maximum, minimum, select

# By goal, the power of which the mean is least: what the smooth objective takes for a maximum is nearly one.
POWERS: Mapping[str, float] = MappingProxyType({"psnr": 2.0, "rms": 2.0, "mean": 1.0, "max": 32.0})


@dataclass(frozen=True)
class Normals:
    """Unit normals and view-space positions, float32 of shape (count, 3)."""

    n: np.ndarray
    view: np.ndarray

    def __len__(self) -> int:
        return len(self.n)

    def some(self, most: int) -> Normals:
        """At most so many of them, evenly spread over the set."""
        step = -(-len(self) // most)
        return Normals(self.n[::step], self.view[::step])

    def planes(self, dtype: Any = np.float32) -> tuple[Vec3, Vec3]:
        """Normals and positions as planes; float64 where JAX has that enabled."""
        return tuple(Vec3(*(jnp.asarray(c) for c in a.astype(dtype).T)) for a in (self.n, self.view))  # type: ignore[return-value]


def step_at(codec: Codec, component: int, number):
    """The distance between the numbers that a component may come back as around `number` (float64, any shape)."""
    storage, levels = codec.storage, codec.encoding.levels_of(component)
    if levels or storage.kind != "float":
        return jnp.full_like(number, 2.0 / ((levels or storage.count(component)) - 1))
    form = storage.float_form(component)
    texel = abs(number * 0.5 + 0.5) if storage.is_biased else abs(number)
    octave = jnp.floor(jnp.log2(maximum(texel, 2.0 ** (1 - form.one))))
    return (1.0 + storage.is_biased) * 2.0 ** (octave - form.mantissa)


def moved_squares(codec: Codec, values: Mapping[str, Any], code, view: Vec3) -> list[Any]:
    """For each component the square of how far a unit of it moves the decoded normal, just inside its range."""
    inside = type(code)(*(_inside(codec, i, c) for i, c in enumerate(code)))
    decode = partial(codec.encoding.decode, view=view, **values)
    squares = []
    for i in range(codec.encoding.components):
        along = type(code)(*(jnp.full_like(c, float(i == k)) for k, c in enumerate(code)))
        moved = jax.jvp(decode, (inside,), (along,))[1]
        squares.append(dot(moved, moved))
    return squares


def _inside(codec: Codec, component: int, number):
    """At least half a step from the ends, where derivatives may be infinite; one of few values as it is."""
    half = step_at(codec, component, number) / 2
    is_free = not codec.encoding.levels_of(component)
    return minimum(maximum(number, half - 1.0), 1.0 - half) if is_free else number


def expected_squares(codec: Codec, values: Mapping[str, Any], n: Vec3, view: Vec3):
    """The expected squared error of each normal (float64 planes), as a smooth function of the parameters' values."""
    code = codec.encoding.encode(n, view, **values)
    held = type(code)(*(minimum(maximum(c, -1.0), 1.0) for c in code))
    miss = n - codec.encoding.decode(held, view, **values)
    moved = moved_squares(codec, values, held, view)
    rounding = [step_at(codec, i, held[i]) ** 2 / 12 * square for i, square in enumerate(moved)]
    # No error is larger than that of the opposite direction; at a pole a derivative is.
    return minimum(dot(miss, miss) + sum(rounding), 4.0)


def smooth_objective(codec: Codec, goal: str, n: Vec3, view: Vec3) -> Callable[[Any], tuple[Any, Any]]:
    """From a vector of values to the expected error on normals (float64 planes), in radians, and its gradient."""
    names, power = list(codec.encoding.published), POWERS[goal]

    def squares(vector):
        return expected_squares(codec, dict(zip(names, vector, strict=True)), n, view)

    @jax.jit
    def objective(vector):
        # Normal by normal and forward, so that one at which a decoder has no derivative spoils no other.
        square, slope = squares(vector), jax.jacfwd(squares)(vector)
        usable = jnp.isfinite(square) & jnp.isfinite(slope).all(axis=1) & (square > 0)
        square = select(usable, square, 1.0)
        count = maximum(usable.astype(jnp.float64).sum(), 1.0)
        # The largest is taken out of the powers, which would underflow.
        largest = jnp.where(usable, square, 0.0).max()
        share = jnp.where(usable, (square / largest) ** (power / 2), 0.0)
        mean = share.sum() / count
        error = jnp.sqrt(largest) * mean ** (1 / power)
        weight = jnp.where(usable, share / square, 0.0)[:, None]
        return error, error * (weight * jnp.where(usable[:, None], slope, 0.0)).sum(axis=0) / (2 * share.sum())

    return objective
