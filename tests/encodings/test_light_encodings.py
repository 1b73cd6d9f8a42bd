"""Light encodings: their ranges, and formats that store values as emulated."""

from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from parity.comparison import ULP, rows
from parity.light import apart, given_texels, lights, planes
from typed import light_buffers_named

from normalbench.bench.ground.output.errors import UsageError
from normalbench.encodings.catalogue import LIGHT_BUFFERS, LIGHT_ENCODINGS, LIGHT_NAMES
from normalbench.encodings.codecs.light_codec import LightCodec
from normalbench.encodings.codecs.light_encoding import BLENDS
from normalbench.encodings.light.nao32 import INVERSE, MATRIX
from normalbench.encodings.shared.chromaticity import chromaticity, coloured, luminance
from normalbench.encodings.storages.rounding import store_small_float
from normalbench.encodings.storages.storage import FORMS, LIGHT_STORAGES, R11G11B10F
from normalbench.encodings.vec import BRIGHTEST, Vec3, Vec4, floor_log2, light_or_none, power_of_two
from normalbench.gbuffer.codecs.light.light_passes import exact_light, light_defines
from normalbench.gbuffer.gl.shader import Source

EVERY = sorted(LIGHT_BUFFERS)


@pytest.mark.parametrize("name", LIGHT_NAMES)
def test_a_light_encoding_is_blended_in_a_known_way(name):
    assert LIGHT_ENCODINGS[name].blend in BLENDS


def test_a_light_buffer_is_an_encoding_in_a_storage():
    """A buffer is named after its encoding, or after its format if a texel is the light itself."""
    plain = [name for name, codec in LIGHT_BUFFERS.items() if codec.encoding is LIGHT_ENCODINGS["plain"]]
    assert plain == ["rgba32f", "rgba16f", "r11g11b10f"]
    assert list(LIGHT_BUFFERS) == [*plain, "linear", "srgb", *LIGHT_NAMES[2:]]
    curved = LIGHT_BUFFERS["srgb"]
    assert curved.encoding is LIGHT_ENCODINGS["linear"] and curved.storage is LIGHT_STORAGES["srgb8_a8"]
    assert [name for name, codec in LIGHT_BUFFERS.items() if codec.misfit] == []
    misfit = LightCodec(LIGHT_ENCODINGS["rgbm"], LIGHT_STORAGES["rgba16f"]).misfit
    assert misfit == "rgbm is made for rgba8"


def round_trip(name: str, light) -> np.ndarray:
    encoding = LIGHT_BUFFERS[name]
    whole = np.repeat(np.atleast_1d(np.float32(light))[:, None], 4, axis=1)
    return rows(encoding.decode(encoding.store(encoding.encode(light_or_none(planes(whole))))))


@pytest.mark.parametrize("name", EVERY)
def test_zero_light_is_exact_and_an_empty_buffer_decodes_to_zero(name):
    encoding = LIGHT_BUFFERS[name]
    assert np.all(round_trip(name, 0.0) == 0.0)
    empty = Vec4(*[jnp.full(1, encoding.no_light, jnp.float32)] * 4)
    assert np.all(rows(encoding.decode(empty)) == 0.0)


@pytest.mark.parametrize("name", EVERY)
def test_the_limit_is_the_brightest_white_light_that_round_trips(name):
    """The limit is log2(255) = 7.994 for log, the range for linear, sRGB and RGBM, or a format's largest value."""
    encoding = LIGHT_BUFFERS[name]
    below = np.float32(min(encoding.limit * 0.999, BRIGHTEST))
    kept, most = round_trip(name, below)[0, :3], round_trip(name, 1e30)[0, :3]
    if encoding.storage.kind == "float":
        # Exactly the largest of the format's least channel; RGBA32F's is not reached by light that is bounded.
        largest = {32: float(np.finfo(np.float32).max), 16: 65504.0, 11: 64512.0}[encoding.storage.bits[0]]
        assert encoding.limit == largest
    tolerance = {"nao32": 0.02, "log": 0.05}.get(name, 0.01)
    assert np.all(np.abs(kept / below - 1) < tolerance), f"{name}: {below!r} comes back as {kept!r}"
    if encoding.limit < 1e30 and np.all(np.isfinite(most)):
        assert abs(most.min() / encoding.limit - 1) < tolerance, f"{name}: at most {most!r}, said {encoding.limit}"


@pytest.mark.parametrize("name", ["linear:1.7", "srgb:5.3", "rgbm:11.1"])
def test_a_range_that_is_not_a_power_of_two_is_the_same_in_both_languages(gl, name):
    """The reciprocal, the product and the decoding may each be one unit off."""
    (encoding,) = light_buffers_named(name)
    light = lights(2**12)
    texels = rows(jax.jit(lambda light: encoding.encode(light_or_none(light)))(planes(light)))
    given = given_texels(encoding, texels)
    gl_texels, gl_light = exact_light(gl, encoding, light, given)
    by_jax, *as_light = (rows(jax.jit(encoding.decode)(planes(stored))) for stored in (given, texels, gl_texels))
    for what, ulps in (("encode", apart(*as_light).max()), ("decode", apart(by_jax, gl_light).max())):
        assert ulps <= 4, f"{name} {what}: {ulps:.1f} ulp"


def test_the_range_of_the_log_encoding_is_7_994():
    assert abs(LIGHT_BUFFERS["log"].limit - np.log2(255)) < 1e-12
    steps = np.diff(rows(LIGHT_BUFFERS["log"].decode(planes(np.float32([[c / 255] * 4 for c in (1, 2, 3)]))))[:, 0])
    assert abs(steps[0] + 1) < 1e-6, "the last step is a whole 1.0 of light"


def test_nao32_multiplies_by_the_inverse_of_its_matrix():
    """The inverse was published with four digits; with these digits the product is the identity in float32."""
    product = np.reshape(MATRIX, (3, 3)) @ np.reshape(INVERSE, (3, 3))
    assert np.abs(product - np.eye(3)).max() < 2e-8
    published = np.array([6.0013, -2.7, -1.7995, -1.332, 3.1029, -5.772, 0.3007, -1.088, 5.6268])
    assert np.abs(published - INVERSE).max() < 1e-3


def test_chroma_half_matches_rtx_remix():
    """Compared with RTX Remix in NumPy: the largest channel as a half float, and each channel's share of this largest
    value as a square root in eight bits."""
    rng = np.random.default_rng(0)
    light = np.exp2(rng.uniform(-14, 17, (4096, 1)) + rng.uniform(-9, 0, (4096, 4))).astype(np.float32)
    clamped = np.minimum(light[:, :3], 65504).astype(np.float32)
    half = clamped.max(axis=1).astype(np.float16)
    shares = np.minimum(clamped / half.astype(np.float64)[:, None], 1)
    got = rows(stored_texels("chroma_half", light))
    assert np.array_equal(np.rint(got[:, 3] * 65535).astype(np.uint16), half.view(np.uint16))
    assert abs(got[:, :3] - np.sqrt(shares)).max() < 0.5001 / 255
    endless = planes(np.float32([[1, 1, 1, bits / 65535] for bits in (0x7C00, 0x7E00, 0xFFFF)]))
    assert (rows(LIGHT_BUFFERS["chroma_half"].decode(endless))[:, :3] == 65504).all()


def test_light_can_be_stored_in_any_bit_counts_that_fit():
    """Light whose numbers span channels is read and written again, because hardware cannot blend such numbers."""
    names = "ufloat:6:9,plain/float:8:7,linear/unorm:10:10:10,linear:4/unorm:10:10:10:2,linear/rgba16,plain/rgba16f"
    codecs = light_buffers_named(names)
    assert [(codec.name, codec.blend, codec.bits, codec.bytes_per_pixel) for codec in codecs] == [
        ("ufloat_6_9", "read", 60, 16),
        ("float_8_7", "read", 64, 16),
        ("linear/rgba8_10_10_10", "read", 30, 8),
        ("linear:4/rgb10a2", "add", 32, 4),
        ("linear/rgba16", "add", 64, 8),
        ("rgba16f", "add", 64, 8),
    ]
    assert [codec.limit for codec in codecs[2:5]] == [2, 4, 2] and not codecs[2].has_alpha
    assert light_buffers_named("plain/rgba16f") == [LIGHT_BUFFERS["rgba16f"]]


@pytest.mark.parametrize(
    "name, said",
    [
        ("rgbm/unorm:9:9:9:5", "rgbm is made for rgba8"),
        ("unorm:8:8:8", "plain is made for rgba32f, rgba16f, r11g11b10f, and float of any bits"),
        ("linear/unorm:9:9", "light has 3 or four components"),
        ("linear/ufloat:5:6", "linear is made for rgba8, srgb8_a8, and unorm of any bits"),
        ("linear/unorm:33:1:1", "one to four components of 1 to 20 bits"),
        ("cubic/unorm:8:8:8", "expected one of plain, linear"),
    ],
)
def test_light_that_does_not_fit_is_a_one_line_error(name, said):
    with pytest.raises(UsageError) as error:
        light_buffers_named(name)
    assert said in str(error.value) and "\n" not in str(error.value)


def stored_texels(name: str, light: np.ndarray) -> Vec4:
    encoding = LIGHT_BUFFERS[name]
    return encoding.store(encoding.encode(light_or_none(planes(light))))


def small_floats(bits: int) -> np.ndarray:
    """Return every finite unsigned float of 11 or 10 bits, with five bits of exponent."""
    mantissa = bits - 5
    codes = np.arange(31 << mantissa)
    exponent, fraction = codes >> mantissa, (codes & (1 << mantissa) - 1) / (1 << mantissa)
    return np.where(exponent == 0, fraction * 2.0**-14, (1 + fraction) * 2.0 ** (exponent - 15.0))


@pytest.mark.parametrize("bits", [11, 10])
@pytest.mark.parametrize("rounding", ["nearest", "truncate"])
def test_small_floats_round_to_nearest_or_truncate(bits, rounding):
    """Every value, every tie and their neighbours, compared with a search of all values."""
    values = small_floats(bits)
    ties = (values[1:] + values[:-1]) / 2
    x = np.concatenate([values, ties, ties * (1 + 1e-6), ties * (1 - 1e-6), [values[-1] * 2, 1e30]]).astype(np.float32)
    above = np.searchsorted(values, x, side="right").clip(1, len(values) - 1)
    low, high = values[above - 1], values[above]
    nearest = np.where(
        x - low == high - x, np.where((above - 1) % 2 == 0, low, high), np.where(x - low < high - x, low, high)
    )
    expected = np.where(x >= values[-1], values[-1], nearest if rounding == "nearest" else low)
    got = np.asarray(store_small_float(jnp.asarray(x), FORMS[bits], rounding))
    wrong = got != expected
    assert not wrong.any(), f"{x[wrong][0]!r} is stored as {got[wrong][0]!r}, not {expected[wrong][0]!r}"


def test_small_floats_have_no_sign_and_keep_infinity_and_nan():
    x = jnp.float32([-1.0, -0.0, -np.inf, np.inf, np.nan])
    assert np.array_equal(np.asarray(store_small_float(x, FORMS[11])), [0, 0, 0, np.inf, np.nan], equal_nan=True)


def test_the_device_stores_small_floats_with_the_rounding_that_it_reports(gl):
    values = np.concatenate(
        [small_floats(11), np.random.default_rng(0).uniform(0, 4, 4096), [7e4, np.inf, -1, -np.inf]]
    )
    rounding = gl.native_rounding(R11G11B10F)
    assert rounding in ("nearest", "truncate"), f"{gl.renderer} rounds r11g11b10f in a way that is not emulated"
    got = gl.through(np.repeat(values.astype(np.float32)[None, :, None], 4, axis=2), R11G11B10F)[0]
    for channel, bits in enumerate((11, 11, 10)):
        expected = np.asarray(store_small_float(jnp.asarray(values, jnp.float32), FORMS[bits], rounding))
        assert np.array_equal(got[:, channel], expected), f"channel {channel}, {rounding}"


def test_whole_powers_and_logarithms_are_exact():
    powers = np.arange(-126, 128)
    exact = np.ldexp(np.float32(1), powers).astype(np.float32)
    assert np.array_equal(np.asarray(power_of_two(jnp.asarray(powers, jnp.float32))), exact)
    for factor in (1.0, 1.5, np.float32(2) - np.float32(2.0**-22)):
        assert np.array_equal(np.asarray(floor_log2(jnp.asarray(exact[:-1] * np.float32(factor)))), powers[:-1])
    assert float(floor_log2(jnp.float32(0))) == -127


def test_invalid_light_becomes_0_and_infinite_light_is_bounded():
    light = light_or_none(Vec4(*(jnp.float32([x]) for x in (-1.0, np.nan, np.inf, 2.0))))
    assert [float(c[0]) for c in light] == [0, 0, BRIGHTEST, 2]


def test_a_highlight_has_the_diffuse_lights_colour_and_black_gives_no_nan():
    """chroma(D) A: luminance A in the colour of D; white light of luminance A where D is black."""
    diffuse = Vec3(*(jnp.float32([r, 0.0]) for r in (0.2, 0.4, 0.1)))
    highlight = coloured(diffuse, jnp.float32([0.5, 0.5]))
    assert abs(float(luminance(highlight)[0]) - 0.5) < 1e-6
    assert [float(c[1]) for c in highlight] == [0.5, 0.5, 0.5]
    blue = chromaticity(Vec3(jnp.float32(0), jnp.float32(0), jnp.float32(1e-3)))
    assert abs(float(blue.z) * 0.0722 - 1) < 1e-6, "a blue of luminance 1 is 13.85"


def test_both_languages_rebuild_the_same_colour(gl):
    """chromaticity.glsl is compared with chromaticity.py, including black and nearly black."""
    rng = np.random.default_rng(0)
    given = np.exp2(rng.uniform(-110, 20, (4096, 4))).astype(np.float32)
    given[:64, :3], given[64:128, :2] = 0, 0
    source = Source(Path(__file__).with_name("chromaticity.comp"), light_defines(LIGHT_BUFFERS["rgba32f"]))
    compute = gl.context.compute_shader(source.text)
    inputs, outputs = gl.context.buffer(given.tobytes()), gl.context.buffer(reserve=given.nbytes)
    for binding, buffer in enumerate((inputs, outputs)):
        buffer.bind_to_storage_buffer(binding)
    compute.run(group_x=64)
    got = np.frombuffer(outputs.read(), np.float32).reshape(-1, 4)[:, :3]
    for thing in (compute, inputs, outputs):
        thing.release()
    by_jax = rows(jax.jit(lambda p: coloured(p.xyz, p.w))(planes(given)))
    assert np.isfinite(got).all()
    ulps = np.abs(by_jax - got) / np.maximum(by_jax.max(axis=1, keepdims=True), 1e-30) / ULP
    assert ulps.max() <= 4, f"{given[ulps.max(axis=1).argmax()]!r}: {ulps.max():.1f} ulp"
