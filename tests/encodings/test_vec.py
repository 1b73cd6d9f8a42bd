"""Vectors, and the functions that both languages share."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from directions import NOT_DIRECTIONS, random_directions

from normalbench.encodings import vec
from normalbench.encodings.elementary import ATAN_PI, COS_PI, SIN_PI, atan2_pi, atan_pi, sincos_pi
from normalbench.encodings.vec import Vec2, Vec3


def test_operators_work_component_by_component():
    a, b = Vec3(1.0, 2.0, 3.0), Vec3(4.0, 5.0, 6.0)
    assert a + b == Vec3(5, 7, 9) and b - a == Vec3(3, 3, 3) and a * b == Vec3(4, 10, 18)
    assert a * 2.0 == Vec3(2, 4, 6) == 2.0 * a and 1.0 - a == Vec3(0, -1, -2) and b / 2.0 == Vec3(2, 2.5, 3)
    assert -a == Vec3(-1, -2, -3) and abs(-a) == a and a.xy == Vec2(1, 2) and a.xy.yx == Vec2(2, 1)
    assert vec.dot(a, b) == 32 and vec.cross(a, b) == Vec3(-3, 6, -3)


def test_a_numpy_array_on_the_left_scales_each_component():
    scale, v = np.float32([1, 2]), Vec2(np.float32([1, 1]), np.float32([3, 3]))
    for scaled in (scale * v, v * scale):
        assert isinstance(scaled, Vec2) and scaled.y.tolist() == [3, 6]


def test_vectors_of_different_sizes_cannot_be_added():
    with pytest.raises(TypeError):
        _ = Vec2(1.0, 2.0) + Vec3(1.0, 2.0, 3.0)


def test_vectors_are_pytrees():
    doubled = jax.jit(lambda v: v * 2.0)(Vec3(*jnp.eye(3)))
    assert isinstance(doubled, Vec3) and doubled.y.tolist() == [0, 2, 0]


def test_arrays_convert_there_and_back():
    n = random_directions(10).reshape(2, 5, 3)
    assert np.array_equal(vec.to_array(vec.from_array(n)), n)
    with pytest.raises(ValueError, match=r"\(\.\.\., 3\), not \(4,\)"):
        vec.from_array(np.zeros(4))


def test_a_vector_without_a_direction_becomes_forward():
    assert np.array_equal(vec.to_array(vec.from_array(NOT_DIRECTIONS)), np.tile([0, 0, 1], (len(NOT_DIRECTIONS), 1)))


def test_unit_of_zero_is_the_first_axis():
    assert [float(c) for c in vec.unit(Vec2(jnp.float32(0), jnp.float32(-0.0)))] == [1, 0]
    assert [float(c) for c in vec.unit(Vec3(*[jnp.float32(0)] * 3))] == [1, 0, 0]


def test_the_polynomials_are_as_accurate_as_stated():
    """The shipped coefficients are evaluated in float64."""
    s = np.linspace(1e-12, 1, 100_001)
    r = np.sqrt(s)
    assert abs(np.polyval(ATAN_PI[::-1], s) / (np.arctan(r) / r / np.pi) - 1).max() < 5e-8
    s, r = s / 16, r / 4
    assert abs(np.polyval(SIN_PI[::-1], s) / (np.sin(np.pi * r) / r) - 1).max() < 4e-8
    assert abs(np.polyval(COS_PI[::-1], s) - np.cos(np.pi * r)).max() < 1e-8


def test_the_angle_is_within_two_units_of_the_arc_tangent():
    """Compared with float64 over the whole circle, axes, diagonals and both zeros; all scales from 1e-18 to 1e18."""
    turns = np.linspace(-1, 1, 200_001)
    y, x = (np.concatenate([f(np.pi * turns) * s for s in (1, 1e-18, 1e18)]) for f in (np.sin, np.cos))
    y, x = y.astype(np.float32), x.astype(np.float32)
    got = np.asarray(jax.jit(atan2_pi)(jnp.asarray(y), jnp.asarray(x)), np.float64)
    expected = np.arctan2(y.astype(np.float64), x.astype(np.float64)) / np.pi
    wrapped = np.abs(got - expected)
    wrapped = np.minimum(wrapped, np.abs(wrapped - 2)) / np.spacing(np.float32(1))
    assert wrapped.max() <= 2, f"{wrapped.max():.2f} ulp at {y[wrapped.argmax()]!r}, {x[wrapped.argmax()]!r}"
    assert float(atan2_pi(jnp.float32(0), jnp.float32(0))) == 0
    assert float(atan2_pi(jnp.float32(0), jnp.float32(-1))) == 1


def test_the_arc_tangent_of_one_number_equals_the_angle():
    """The functions agree to the bit in the octants that both cover."""
    t = jnp.linspace(-1, 1, 99_999, dtype=jnp.float32)
    np.testing.assert_array_equal(jax.jit(atan_pi)(t), jax.jit(atan2_pi)(t, jnp.ones_like(t)))


@pytest.mark.parametrize("is_wide", [False, True])
def test_a_python_number_does_not_select_another_angle_function(is_wide):
    """Rows are measured where Python's numbers are float64. Next to a float32 such numbers still use the polynomial
    of GLSL, not JAX's function."""
    y = jnp.linspace(-3, 3, 999, dtype=jnp.float32)
    with jax.enable_x64(is_wide):
        got, traced = jax.jit(lambda y: atan2_pi(y, 1.0))(y), str(jax.make_jaxpr(lambda y: atan2_pi(y, 1.0))(y))
    assert got.dtype == jnp.float32 and " atan2 " not in traced
    np.testing.assert_array_equal(got, jax.jit(atan2_pi)(y, jnp.ones_like(y)))


def test_sine_and_cosine_are_within_two_units():
    a = np.linspace(-1, 1, 400_001).astype(np.float32)
    for got, f in zip(jax.jit(sincos_pi)(jnp.asarray(a)), (np.sin, np.cos), strict=True):
        ulps = np.abs(np.asarray(got, np.float64) - f(np.pi * a.astype(np.float64))) / np.spacing(np.float32(1))
        assert ulps.max() <= 2, f"{f.__name__}: {ulps.max():.2f} ulp at {a[ulps.argmax()]!r}"
