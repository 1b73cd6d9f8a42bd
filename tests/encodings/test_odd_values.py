"""Light, quantities, motion and depth that no image should hold: NaN, infinities, negatives, denormals, -0, and
one step beyond each range. bench/shaders/code/test_odd_code.py checks emitted code in the same way."""

from itertools import product

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from parity.comparison import rows

from normalbench.encodings.catalogue import CURVE_ENCODINGS, LIGHT_BUFFERS, MOTION_ENCODINGS
from normalbench.encodings.codecs.curve_codec import CurveCodec
from normalbench.encodings.codecs.motion_codec import MotionCodec
from normalbench.encodings.storages.rounding import store_texel
from normalbench.encodings.storages.storage import CURVE_STORAGES, MOTION_STORAGES, R11G11B10F, STORAGES
from normalbench.encodings.vec import Vec2, Vec4

NAN, INF, DENORMAL = np.nan, np.inf, 1e-42
# What is not light or a quantity, and counts as 0.
NOTHING = np.float32([NAN, -INF, -3e38, -1.0, -1e-3, -DENORMAL, -0.0])
COMPUTED = {name: codec for name, codec in LIGHT_BUFFERS.items() if not codec.encoding.is_plain}
CURVES = [
    CurveCodec(encoding, CURVE_STORAGES[storage], encoding.usual_range)
    for encoding, storage in product(CURVE_ENCODINGS.values(), ("r8", "r16f"))
]
# These leave quantities to the format, and a float format keeps them.
KEPT = {"linear/r16f", "reflectivity/r16f"}


def light_of(name: str, light) -> np.ndarray:
    """Return the decoded light of lights that are stored one at a time, (count, 3)."""
    planes = [jnp.asarray(np.float32(light)[:, i]) for i in range(3)]
    return rows(jax.jit(LIGHT_BUFFERS[name].round_trip)(Vec4(*planes, jnp.zeros_like(planes[0]))))[:, :3]


@pytest.mark.parametrize("name", COMPUTED)
def test_negative_and_nan_light_become_0(name):
    """In each channel, next to channels that are lit: EXT_texture_shared_exponent requires this of RGB9E5."""
    lights = [np.roll([odd, *others], channel) for odd in NOTHING for channel in range(3) for others in LIT]
    dark = np.where(np.isin(lights, NOTHING) | np.isnan(lights), 0, lights)
    back, expected = light_of(name, lights), light_of(name, dark)
    wrong = (back != expected).any(axis=1)
    assert not wrong.any(), f"{lights[wrong.argmax()]} comes back as {back[wrong][0]}, not {expected[wrong][0]}"


LIT = ((0.0, 0.0), (1.0, 0.25), (NAN, -1.0))


@pytest.mark.parametrize("name", COMPUTED)
def test_light_beyond_the_limit_comes_back_as_the_limit(name):
    """One step beyond, far beyond and infinite light; white light of a 16-bit logarithm ends at 2^64."""
    limit = np.float32(min(COMPUTED[name].limit, 1e38))
    white = np.repeat(np.float32([limit, np.nextafter(limit, np.float32(INF)), 3e38, INF])[:, None], 3, axis=1)
    back = light_of(name, white)
    assert np.allclose(back[1:], back[0], rtol=2e-2), back


def test_rgb9e5_is_black_for_negative_light_and_at_most_65408():
    """ClampRange_for_rgb9e5 of EXT_texture_shared_exponent: NaN fails the comparison with 0, and becomes 0."""
    lights = np.float32([[-1, -1, -1], [NAN, NAN, NAN], [-INF, 1, -0.0], [INF, NAN, 2], [65409, DENORMAL, -65409]])
    expected = [[0, 0, 0], [0, 0, 0], [0, 1, 0], [65408, 0, 0], [65408, 0, 0]]
    assert np.array_equal(light_of("rgb9e5", lights), expected)


@pytest.mark.parametrize("codec", [codec for codec in CURVES if codec.name not in KEPT], ids=lambda codec: codec.name)
def test_negative_and_nan_quantities_become_0(codec):
    """The root, power or logarithm of such a quantity is undefined in GLSL. In fixed point the format makes it 0."""
    back = np.asarray(jax.jit(codec.round_trip)(jnp.asarray(NOTHING)))
    zero = np.asarray(jax.jit(codec.round_trip)(jnp.zeros(1, jnp.float32)))
    assert (back == zero).all(), dict(zip(NOTHING.tolist(), back.tolist(), strict=True))


@pytest.mark.parametrize("codec", CURVES, ids=lambda codec: codec.name)
def test_fixed_point_clips_quantities_beyond_the_range_and_floats_keep_them(codec):
    largest = np.float32(codec.range)
    given = np.float32([largest, np.nextafter(largest, np.float32(INF)), 3e38, INF])
    back = np.asarray(jax.jit(codec.round_trip)(jnp.asarray(given)))
    is_cut = codec.storage.kind != "float" or codec.encoding.name == "ray_bits"
    assert (back == back[0]).all() if is_cut else back[-1] == INF and back[1] == pytest.approx(largest, rel=2e-3), back


@pytest.mark.parametrize("storage", ["rg8", "rg16_snorm", "rg16_centred", "rg16f", "rgba32f"])
@pytest.mark.parametrize("name", MOTION_ENCODINGS)
def test_nan_motion_becomes_rest_and_infinite_motion_becomes_the_range(name, storage):
    """`linear` leaves NaN to the format: in UNORM it becomes code 0, the full range to the left."""
    codec = MotionCodec(MOTION_ENCODINGS[name], MOTION_STORAGES[storage])
    given = np.float32([0.0, NAN, -0.0, DENORMAL, INF, -INF, 1.0, -1.0])
    planes = Vec2(jnp.asarray(given), jnp.asarray(given[::-1].copy()))
    still, nan, *zeros, left, right, most, least = rows(jax.jit(codec.round_trip)(planes, np.float32(1)))[:, 0]
    assert np.abs(np.subtract(zeros, still)).max() < 1e-40, zeros
    assert left == most or left > 1e30, left
    assert right == least or right < -1e30, right
    as_the_format = NAN if codec.storage.kind == "float" else -1.0
    assert np.array_equal(nan, as_the_format if name == "linear" else still, equal_nan=True), nan


@pytest.mark.parametrize(
    "storage, value, kept",
    [
        # OpenGL 4.6, 2.3.5; Direct3D 11.3, 3.2.3: NaN is 0 in UNORM.
        (STORAGES["rgba8"], [NAN, -INF, -0.0, np.nextafter(np.float32(1), np.float32(2)), INF], [0, 0, 0, 1, 1]),
        (STORAGES["rg16f"], [NAN, -INF, -1.0, 65519, 65520, INF], [NAN, -INF, -1.0, 65504, INF, INF]),
        # EXT_packed_float: no sign; the largest finite value, or infinity in Direct3D, for more than that.
        (R11G11B10F, [NAN, -INF, -1.0, -0.0, 65025, INF], [NAN, 0, 0, 0, 65024, INF]),
    ],
    ids=["unorm", "half", "r11g11b10f"],
)
def test_formats_store_invalid_and_extreme_floats_as_specified(storage, value, kept):
    back = np.asarray(store_texel(jnp.float32(value), storage, 0))
    assert np.array_equal(back, np.float32(kept), equal_nan=True), back
