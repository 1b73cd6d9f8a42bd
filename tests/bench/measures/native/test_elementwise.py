"""JAX functions in C: the results of each operation, bit for bit, and functions that cannot be written in C."""

import ctypes
import shutil

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from normalbench.bench.ground.compilers.text import judged, own
from normalbench.bench.ground.native.elementwise import NotElementwiseError, c_function, c_type
from normalbench.bench.ground.native.library import HEAD, address, library
from normalbench.encodings.vec import floor_log2, maximum, minimum, power_of_two, sign_not_zero

needs_c = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")


FLOAT = np.dtype(np.float32)


LOOP = """
void each(size_t count, const FROM *a, const FROM *b, TO *to) {
    for (size_t k = 0; k < count; k++) function(a[k], b[k], to + k);
}
"""


TINY = float(np.finfo(np.float32).tiny)


FLOATS = np.array(
    [
        *(0.0, -0.0, 0.5, -0.5, 1.5, 2.5, -2.5, 1.0, -1.0, 0.3, 1e-3, TINY, 65504.0, 65520.0, 7e-8, 1e9, -3e9, 3e38),
        *(np.nan, np.inf, -np.inf),
    ],
    np.float32,
)


WORDS = np.array([0, 1, 2, 3, 31, 255, 2**16 + 1, 2**31 - 1, 2**31, 2**32 - 1, 0x9E3779B9], np.uint32)


def by_c(function, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    kind = jax.eval_shape(function, a, b).dtype
    written = c_function("function", function, a.dtype, b.dtype) + LOOP
    text = own(HEAD, FROM=c_type(a.dtype), TO=c_type(kind)) + judged(written, "c")
    compiled = library(text, "each")
    output = np.empty(len(a), kind)
    compiled.each(ctypes.c_size_t(len(a)), *map(address, (a, b, output)))
    return output


def all_pairs(values: np.ndarray) -> list[np.ndarray]:
    return [np.ascontiguousarray(side.ravel()) for side in np.meshgrid(values, values)]


FUNCTIONS = {
    "sum, difference, product": lambda a, b: (a + b) * (a - b),
    "quotient": lambda a, b: a / b,
    "round, to even": lambda a, _: jnp.round(a),
    "floor": lambda a, _: jnp.floor(a + 0.5),
    "cut off": lambda a, _: jnp.trunc(a),
    "magnitude and root": lambda a, _: jnp.sqrt(abs(a)),
    "negative": lambda a, _: -a,
    "larger": maximum,
    "smaller": minimum,
    "comparisons": lambda a, b: ((a < b) | (a >= b)) & ~(a == b),
    "not equal, not above": lambda a, b: (a != b) | (a <= b) | (a > b),
    "sign": lambda a, b: sign_not_zero(a) * b,
    "to an integer, within its range": lambda a, _: a.astype(jnp.int32),
    "to an unsigned integer, within its range": lambda a, _: a.astype(jnp.uint32),
    "to a half float and back": lambda a, _: a.astype(jnp.float16).astype(jnp.float32),
    "bits": lambda a, _: (a.view(jnp.uint32) >> 13).astype(jnp.int32) - 7,
    "signed bits": lambda a, _: (a.view(jnp.int32) >> 3) << 1,
    "octave": lambda a, _: floor_log2(abs(a)),
    "power of two": lambda a, _: power_of_two(jnp.round(a * 0.0 + 3.0)),
    "finite": lambda a, _: jnp.isfinite(a),
}


@needs_c
@pytest.mark.parametrize("name", FUNCTIONS)
def test_floats_match_jax_bit_for_bit(name):
    """All pairs of zeros, ties, values too large for an integer or a half float, infinities and NaN are compared."""
    function = FUNCTIONS[name]
    a, b = all_pairs(FLOATS)
    with jax.numpy_dtype_promotion("standard"):
        expected, output = np.asarray(jax.jit(function)(a, b)), by_c(function, a, b)
    same = (expected == output) | ((expected != expected) & (output != output))
    if expected.dtype.kind == "f":
        same &= (np.signbit(expected) == np.signbit(output)) | np.isnan(expected)
        # JAX takes numbers below the normal ones for 0.
        same |= (expected == 0) & (abs(output) < TINY)
    assert same.all(), f"{name} of {a[~same][0]}, {b[~same][0]}: {output[~same][0]}, JAX {expected[~same][0]}"


@needs_c
@pytest.mark.parametrize(
    "function",
    [
        lambda a, b: a * jnp.uint32(0x9E3779B9) + b,
        lambda a, b: (a.view(jnp.int32) * jnp.int32(2**30 + 1)) - b.view(jnp.int32),
        lambda a, _: jnp.clip(a.view(jnp.int32), -5, 40),
        lambda a, b: (a & b) | (~a >> 7),
        lambda a, b: (a.view(jnp.int32) >> 5) + jax.lax.shift_right_logical(b.view(jnp.int32), jnp.int32(9)),
        lambda a, _: a.astype(jnp.float32) * jnp.float32(0.5),
        lambda a, _: (a.view(jnp.int32)).astype(jnp.float32),
    ],
    ids=["products wrap", "signed products wrap", "limits", "bits", "shifts", "unsigned to float", "signed to float"],
)
def test_integers_match_jax(function):
    a, b = all_pairs(WORDS)
    expected, output = np.asarray(jax.jit(function)(a, b)), by_c(function, a, b)
    differ = np.flatnonzero(expected != output)
    assert not differ.size, f"of {a[differ[0]]}, {b[differ[0]]}: {output[differ[0]]}, JAX {expected[differ[0]]}"


@pytest.mark.parametrize(
    "function, said",
    [
        (lambda a: jnp.sin(a), "sin"),
        (lambda a: a - a.sum(), "reduce_sum"),
        (lambda a: jnp.maximum(a, 0.0), "max"),
        (lambda a: a.astype(jnp.float16) + jnp.float16(1.0), "add of half floats"),
        (lambda a: jnp.asarray([1.0, 2.0], jnp.float32)[a.astype(jnp.int32)], "an array of constants"),
        (lambda a: a.astype(jnp.complex64), "numbers of type complex64"),
        (lambda a: jax.lax.round(a), "rounding away from zero"),
        (lambda a: jax.lax.select_n(a.astype(jnp.int32), a, a, a), "a choice between more than two values"),
        (lambda a: jax.lax.bitcast_convert_type(a, jnp.uint16).sum(axis=1), "a view with numbers of a different size"),
        (lambda a: a.astype(jnp.int32) // 3, "a quotient of integers|sign"),
        (lambda a: jax.lax.div(a.view(jnp.uint32), a.view(jnp.uint32)), "a quotient of integers"),
        (lambda a: a.view(jnp.int32) >> a.astype(jnp.int32), "a shift by an unknown number of bits"),
        (lambda a: a.view(jnp.uint32) << jnp.uint32(32), "a shift by an unknown number of bits"),
        (lambda _: jnp.float32(1.0), "a result of the wrong shape"),
        (lambda a: a[:, None], "a result of the wrong shape"),
    ],
)
def test_operations_that_c_cannot_express_are_reported(function, said):
    """The operation mixes elements, is rounded differently in C, or is not implemented."""
    with pytest.raises(NotElementwiseError, match=said):
        c_function("function", function, FLOAT)
