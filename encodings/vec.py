"""Vectors with named components, and the few functions that both languages need, named as in GLSL.

`Vec2`, `Vec3` and `Vec4` hold one array per component (separate planes), all of the same shape. They are named
tuples, so JAX sees them as pytrees without being imported here: importing an encoding must remain instant for
`normalbench list`. The GLSL twin of this file is `vec.glsl`.
"""

from __future__ import annotations

import operator
from collections import namedtuple
from typing import TYPE_CHECKING, Any, TypeVar, cast

if TYPE_CHECKING:
    import jax.numpy as jnp
    from jax import Array
else:

    class _Lazy:
        """A stand-in for `jax.numpy` that imports it at the first use of a function: importing JAX takes a second."""

        def __getattr__(self, name: str):
            import jax.numpy

            return getattr(jax.numpy, name)

    jnp = _Lazy()

# The least square of a length that is still told from zero; its root, 2^-60, is far below a unit vector's rounding.
TINY = 2.0**-120

# What light counts as infinite: far beyond every format but RGBA32F, where it leaves room to add.
BRIGHTEST = 2.0**120

# What the exponent of a float32 is biased by.
FLOAT_BIAS = 127

CONSTANTS = {"TINY": TINY, "BRIGHTEST": BRIGHTEST, "FLOAT_BIAS": FLOAT_BIAS}


class _Operators:
    """Component-wise arithmetic between vectors of the same size, and between a vector and a scalar or array."""

    __slots__ = ()
    __array_ufunc__ = None  # a NumPy array on the left must ask __rmul__ here, not take the tuple for an array

    def _map(self, function, other):
        if isinstance(other, _Operators) and not isinstance(other, type(self)):
            raise TypeError(f"{type(self).__name__} and {type(other).__name__} cannot be combined")
        others = other if isinstance(other, type(self)) else (other,) * len(self)  # type: ignore[arg-type]
        return type(self)(*(function(a, b) for a, b in zip(self, others, strict=True)))  # type: ignore[call-overload]

    def __add__(self, other):
        return self._map(operator.add, other)

    def __sub__(self, other):
        return self._map(operator.sub, other)

    def __mul__(self, other):
        return self._map(operator.mul, other)

    def __truediv__(self, other):
        return self._map(operator.truediv, other)

    def __radd__(self, other):
        return self._map(lambda a, b: b + a, other)

    def __rsub__(self, other):
        return self._map(lambda a, b: b - a, other)

    def __rmul__(self, other):
        return self._map(lambda a, b: b * a, other)

    def __neg__(self):
        return type(self)(*(-c for c in self))  # type: ignore[attr-defined, call-arg]

    def __abs__(self):
        return type(self)(*(abs(c) for c in self))  # type: ignore[attr-defined, call-arg]


class Vec2(_Operators, namedtuple("Vec2", "x y")):  # type: ignore[misc]
    """Two arrays of the same shape, `x` and `y`."""

    __slots__ = ()
    x: Any
    y: Any

    @property
    def yx(self) -> Vec2:
        return Vec2(self.y, self.x)


class Vec3(_Operators, namedtuple("Vec3", "x y z")):  # type: ignore[misc]
    """Three arrays of the same shape, `x`, `y` and `z`."""

    __slots__ = ()
    x: Any
    y: Any
    z: Any

    @property
    def xy(self) -> Vec2:
        return Vec2(self.x, self.y)


class Vec4(_Operators, namedtuple("Vec4", "x y z w")):  # type: ignore[misc]
    """Four arrays of the same shape, `x`, `y`, `z` and `w`."""

    __slots__ = ()
    x: Any
    y: Any
    z: Any
    w: Any

    @property
    def xyz(self) -> Vec3:
        return Vec3(self.x, self.y, self.z)


V = TypeVar("V", Vec2, Vec3, Vec4)
S = TypeVar("S")


def sqrt(x):
    """The square root."""
    return jnp.sqrt(x)


def inversesqrt(x):
    """Return one over the square root."""
    return 1.0 / jnp.sqrt(x)


def exp2(x):
    """2 to a power."""
    return jnp.exp2(x)


def log2(x):
    """The logarithm to base 2."""
    return jnp.log2(x)


def floor(x):
    """Return the largest whole number that is not greater than `x`."""
    return jnp.floor(x)


def ceil(x):
    """Return the smallest whole number that is not less than `x`."""
    return jnp.ceil(x)


def floor_log2(x):
    """Return the exact floor of the base-2 logarithm of a positive float32; -127 for 0 and numbers below 2^-126."""
    return (x.view(jnp.uint32) >> 23).astype(jnp.float32) - FLOAT_BIAS


def power_of_two(x):
    """Return 2^x as an exact float32, for a whole number x from -126 to 127."""
    return ((x.astype(jnp.int32) + FLOAT_BIAS) << 23).view(jnp.float32)


def maximum(a, b):
    """Return the larger of `a` and `b`, or `b` where `a` is NaN, as `max` does on the OpenGL device."""
    return jnp.where(a > b, a, b)


def minimum(a, b):
    """Return the smaller of `a` and `b`, or `b` where `a` is NaN."""
    return jnp.where(a < b, a, b)


def select(condition, a: S, b: S) -> S:
    """Return GLSL's `condition ? a : b`, for arrays and vectors."""
    if isinstance(a, Vec2 | Vec3 | Vec4):
        chosen = type(a)(*(jnp.where(condition, p, q) for p, q in zip(a, b, strict=True)))  # type: ignore[arg-type]
    else:
        chosen = jnp.where(condition, a, b)  # type: ignore[arg-type]
    return cast("S", chosen)


def dot(a: V, b: V) -> Any:
    """Return the dot product of two vectors, as one array."""
    products = a * b
    return sum(products[1:], start=products[0])


def cross(a: Vec3, b: Vec3) -> Vec3:
    """Return the right-handed cross product: cross(x, y) = z."""
    return Vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)


def normalize(v: V) -> V:
    """Return `v` at length 1; `v` must not be zero."""
    return v * inversesqrt(dot(v, v))


def unit(v: V) -> V:
    """Return `v` at length 1, or the first axis where `v` is zero."""
    length2 = dot(v, v)
    first_axis = type(v)(*(1.0, 0.0, 0.0)[: len(v)])
    return select(length2 > TINY, v * inversesqrt(length2), first_axis)


def sign_not_zero(v: Any) -> Any:
    """Return the sign of an array or vector, 1 or -1; both zeros give 1, so that a fold has no seam of zeros."""
    if isinstance(v, Vec2 | Vec3):
        return type(v)(*(sign_not_zero(c) for c in v))
    return jnp.where(v < 0.0, jnp.full_like(v, -1.0), jnp.ones_like(v))


def number_of(index, levels: int):
    """Return the number in [-1, 1] that an index from 0 to levels - 1 represents."""
    return index * (2.0 / (levels - 1)) - 1.0


def index_of(number, levels: int):
    """Return the index (a float) from 0 to levels - 1 that is nearest to a number in [-1, 1]."""
    return jnp.floor((number * 0.5 + 0.5) * (levels - 1) + 0.5)


def direction_or_forward(v: Vec3) -> Vec3:
    """Return `v`, or (0, 0, 1) if it is not a direction: zero, NaN or infinite.

    Every input of an encoder passes through this function once, so that no texel becomes NaN: arrays in `from_array`,
    pixels in the shader that encodes them.
    """
    length2 = dot(v, v)
    is_direction = (length2 > TINY) & (length2 < 1.0 / TINY)
    return select(is_direction, v, Vec3(0.0, 0.0, 1.0))


def sign_bit(x):
    """Whether the sign bit of a float32 is set, as in negative numbers and -0."""
    return jnp.signbit(x)


def with_sign_of(x, signed):
    """Return `x`, which must not be negative, with the sign bit of `signed`."""
    return select(sign_bit(signed), -x, x)


def depth_or_far(depth, far):
    """Return a signed depth, limited to a magnitude of `far`; NaN and infinity become `far`. The sign bit is kept.

    Every input of a depth encoder passes through this function once, so that no texel becomes NaN.
    """
    magnitude = abs(depth)
    return with_sign_of(select(magnitude <= far, magnitude, far), depth)


def from_array(array) -> Vec3:
    """Return unit vectors, an array of shape (..., 3), as float32 planes; an invalid direction becomes (0, 0, 1).

    Raises:
        ValueError: the array has the wrong shape.
    """
    array = jnp.asarray(array, jnp.float32)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"normals must have the shape (..., 3), not {array.shape}")
    return direction_or_forward(Vec3(array[..., 0], array[..., 1], array[..., 2]))


def to_array(v: Vec3) -> Array:
    """Return an array of shape (..., 3) from three planes."""
    return jnp.stack(list(v), axis=-1)


def light_or_none(light: Vec4) -> Vec4:
    """Return light with negative and NaN components set to 0 and all components limited to BRIGHTEST.

    Every input of a light encoder passes through this function once, as normals pass through `direction_or_forward`.
    """
    return Vec4(*(minimum(maximum(c, 0.0), BRIGHTEST) for c in light))
