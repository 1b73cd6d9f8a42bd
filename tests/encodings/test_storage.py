"""Storage: the emulation and the OpenGL device store the same bits."""

import itertools
from contextlib import ExitStack
from functools import partial
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from neighbours import around

from normalbench.encodings.storages.rounding import (
    fixed,
    scale_of,
    shared,
    store_half,
    store_number,
    store_texel,
    store_unorm,
)
from normalbench.encodings.storages.rules import by_rule
from normalbench.encodings.storages.storage import ROUNDINGS, STORAGES
from normalbench.encodings.storages.words import words
from normalbench.gbuffer.codecs.codec_passes import storage_defines
from normalbench.gbuffer.defines.packings import StoragePacking
from normalbench.gbuffer.gl.device import in_steps, read_pixels

INTEGERS = [name for name, s in STORAGES.items() if s.kind != "float" and not s.is_packed]


# Each with the first channel of every size that it has.
CHANNELS = [(name, STORAGES[name].bits.index(bits)) for name in INTEGERS for bits in dict.fromkeys(STORAGES[name].bits)]


FORMS_SAID = [by_rule(*rule) for rule in (("float", (2, 1)), ("float", (3, 4)), ("float", (4, 3)), ("float", (5, 2)))]


FORMS_SAID += [by_rule(*rule) for rule in (("float", (6, 9)), ("float", (8, 7)), ("float", (7, 13)))]


FORMS_SAID += [by_rule(*rule) for rule in (("ufloat", (4, 4)), ("ufloat", (5, 6)), ("ufloat", (8, 12)))]


FLOATS = [name for name, s in STORAGES.items() if s.kind == "float" and s.bits[0] < 32]


FLOAT_ROUNDINGS = ROUNDINGS[:2]


OUTSIDE = np.array([0.0, -0.0, 1, -1, 1.5, -1.5, 1e-30, -1e-30, 3e38, -3e38, np.inf, -np.inf], np.float32)


def integer_inputs(storage) -> np.ndarray:
    """Return every code and every tie between codes with their neighbours, values out of range, infinities and random
    values."""
    scale = storage.scale(0)
    codes = np.arange(-scale if storage.kind == "snorm" else 0, storage.most(0) + 1)
    random = np.random.default_rng(0).uniform(-1.2, 1.2, 2**16)
    return np.concatenate([around(codes / scale), around((codes + 0.5) / scale), OUTSIDE, random.astype(np.float32)])


def half_inputs() -> np.ndarray:
    """Return all finite half floats and all ties between them, with float32 neighbours, and values that overflow."""
    halves = np.arange(2**16, dtype=np.uint16).view(np.float16)
    exact = np.unique(halves[np.isfinite(halves)].astype(np.float32))
    ties = (exact[1:] + exact[:-1]) / 2
    edges = np.array([65504, 65519.996, 65520, 65536, 1e-8, 2.0**-25, 2.0**-26], np.float32)
    return np.concatenate([around(exact, 1), around(ties, 2), edges, -edges, OUTSIDE])


def as_pixels(values: np.ndarray) -> np.ndarray:
    width = 1024
    padded = np.zeros(-(-len(values) // width) * width, np.float32)
    padded[: len(values)] = values
    return np.repeat(padded.reshape(-1, width, 1), 4, axis=2)


def steps_of(storage, channel: int = 0):
    """Return the function from texels of a channel to whole numbers; None for floats."""
    return None if storage.kind == "float" else partial(in_steps, storage=storage, channel=channel)


def emulated(values: np.ndarray, storage, rounding: str, channel: int = 0) -> np.ndarray:
    return np.asarray(store_texel(jnp.asarray(values), storage, channel, rounding))


def assert_same_bits(values, expected, got, what: str) -> None:
    # Bits, so that the sign of a zero counts; one NaN is as good as another.
    assert_all(
        (expected.view(np.uint32) == got.view(np.uint32)) | (np.isnan(expected) & np.isnan(got)),
        values,
        expected,
        got,
        what,
    )


def assert_same_texels(gl, values, expected, got, held, what: str) -> None:
    """Check the texels of a device: bit for bit on a software device. A GPU may divide by a format's scale instead of
    multiplying by its reciprocal: the whole numbers must be the same, and the values within 2^-23.

    Args:
        held: the function from texels to the whole numbers that the format holds; None for floats.
    """
    if gl.is_software or held is None:
        assert_same_bits(values, expected, got, what)
    else:
        assert_all((held(expected) == held(got)) & (abs(expected - got) <= 2.0**-23), values, expected, got, what)


def assert_all(same, values, expected, got, what: str) -> None:
    different = np.flatnonzero(~same)
    if len(different):
        i = different[0]
        pytest.fail(f"{what}: {len(different)} of {len(values)} differ; {values[i]!r}: {expected[i]!r}, GL {got[i]!r}")


@pytest.mark.parametrize("name", [*INTEGERS, *FLOATS])
def test_the_device_stores_the_same_values_as_the_emulation(gl, name):
    """The format's own conversion is compared, with the rounding that the device was found to use."""
    storage = STORAGES[name]
    rounding = gl.native_rounding(storage)
    values = half_inputs() if storage.kind == "float" else integer_inputs(storage)
    got = gl.through(as_pixels(values), storage)[..., 0].ravel()[: len(values)].copy()
    if rounding == "other":
        # Codecs round before the write, which the next test holds to the emulation.
        if not gl.is_software:
            assert_within_direct3ds_tolerance(values, got, storage)
            return
        # llvmpipe makes 10 bits of 16 by dropping six.
        assert name == "rgb10a2", f"{gl.renderer} rounds {name} in a way that is not emulated"
        sixteen = np.rint(np.clip(values, 0, 1) * np.float32(65535)).astype(np.int64)
        assert_same_bits(values, (sixteen >> 6).astype(np.float32) * np.float32(1 / 1023), got, name)
        return
    what = f"{name} on {gl.renderer}, {rounding}"
    assert_same_texels(gl, values, emulated(values, storage, rounding), got, steps_of(storage), what)


def assert_within_direct3ds_tolerance(values: np.ndarray, got: np.ndarray, storage) -> None:
    """Check that each whole number is within 0.6 of the exact number (Direct3D 11.3, 3.2.3.6). An H200 truncates up
    to 0.56."""
    finite = np.isfinite(values)
    exact = np.clip(values[finite].astype(np.float64), 0 if storage.is_biased else -1, 1) * storage.scale(0)
    off = abs(in_steps(got[finite], storage) - exact)
    assert off.max() <= 0.6, f"{storage.name} of {values[finite][off.argmax()]!r}: {off.max():.3f} off"


def rounded_in_the_shader(gl, values: np.ndarray, storage, rounding: str) -> np.ndarray:
    """Return numbers rounded by storage.glsl, written to the format and read back; (count, 4)."""
    with ExitStack() as stack:
        defines = storage_defines(storage, [rounding] * storage.channels, shader_rounds=True)
        writes, reads = (
            gl.owned(stack, gl.fragment_pass(Path(__file__).with_name("round.frag"), defines | {"READS": reads}))
            for reads in (0, 1)
        )
        copy = gl.owned(stack, gl.fragment_pass("copy.frag"))
        source = gl.owned(stack, gl.upload(as_pixels(values)))
        target = gl.owned(stack, gl.target(source.size, storage.target))
        result = gl.owned(stack, gl.target(source.size, STORAGES["rgba32f"]))
        gl.render(writes, [target], source=source)
        gl.render(reads if storage.is_packed else copy, [result], source=target)
        return read_pixels(result).reshape(-1, 4)[: len(values)]


@pytest.mark.parametrize(
    "name, rounding", [*itertools.product(INTEGERS, ROUNDINGS), *itertools.product(FLOATS, FLOAT_ROUNDINGS)]
)
def test_the_shader_rounds_as_the_emulation_does(gl, name, rounding):
    """Numbers are rounded in the shader before they are written, so the device's conversion no longer matters."""
    storage = STORAGES[name]
    values = half_inputs() if storage.kind == "float" else integer_inputs(storage)
    got = rounded_in_the_shader(gl, values, storage, rounding)[:, 0]
    what = f"{name} rounded in the shader, {rounding}"
    assert_same_texels(gl, values, emulated(values, storage, rounding), got.copy(), steps_of(storage), what)


def form_inputs(form) -> np.ndarray:
    """Return every float of a form of up to 16 bits, or about 2^16 floats of a larger form, ties between neighbours,
    and values beyond the largest; mostly from -1 to 1."""
    every = every_float(form)
    some = every[:: max(1, len(every) // 2**16)]
    ties = ((some[1:].astype(np.float64) + some[:-1]) / 2).astype(np.float32)
    beyond = np.float32([min(form.largest * 1.5, 3.3e38), np.nan])
    values = np.concatenate([around(some, 1), around(ties, 1), beyond, OUTSIDE])
    # Those below 2^-126 are float32's own, which GPUs may take for 0.
    return values[(abs(values) >= 2.0**-126) | (values == 0) | np.isnan(values)]


def every_float(form) -> np.ndarray:
    """Return the finite floats of a form from 0 up, in ascending order, computed from their bits; a sample if the
    form has very many."""
    count = (2**form.exponent - 1) << form.mantissa
    bits = np.arange(0, count, max(1, count // 2**18))
    exponent, mantissa = bits >> form.mantissa, bits & 2**form.mantissa - 1
    scale = np.ldexp(1.0, np.maximum(exponent, 1) - form.one - form.mantissa)
    values = (mantissa + np.where(exponent > 0, 2**form.mantissa, 0)) * scale
    return values.astype(np.float32)


@pytest.mark.parametrize("rounding", FLOAT_ROUNDINGS)
@pytest.mark.parametrize("storage", [s for s in FORMS_SAID if s.form.bits <= 16], ids=lambda s: s.name)
def test_floats_of_any_form_round_to_nearest_or_toward_zero(storage, rounding):
    """Compared with a search among all floats of the form, in float64."""
    form = storage.form
    every = every_float(form).astype(np.float64)
    values = np.concatenate([form_inputs(form), -form_inputs(form)])
    values = values[np.isfinite(values) & (abs(values) <= form.largest)].astype(np.float64)
    inside = values if form.is_signed else np.maximum(values, 0.0)
    below = np.searchsorted(every, abs(inside), side="right") - 1
    above = np.minimum(below + 1, len(every) - 1)
    low, high = abs(inside) - every[below], every[above] - abs(inside)
    up = (high < low) | ((high == low) & (above % 2 == 0) & (low > 0))
    magnitude = np.where(up & (rounding == "nearest"), every[above], every[below])
    expected = (np.copysign(magnitude, inside) if form.is_signed else magnitude).astype(np.float32)
    got = emulated(values.astype(np.float32), storage, rounding)
    assert_same_bits(values, expected, got, f"{storage.name}, {rounding}")
    with jax.enable_x64(True):
        in_double = np.asarray(store_texel(jnp.asarray(inside), storage, 0, rounding))
    assert np.array_equal(in_double, expected)


@pytest.mark.parametrize("rounding", FLOAT_ROUNDINGS)
@pytest.mark.parametrize("storage", FORMS_SAID, ids=lambda s: s.name)
def test_floats_of_any_form_come_back_from_their_bits(gl, storage, rounding):
    """The floats are rounded, their bits split across channels and read back: the result equals the emulation's."""
    values = np.concatenate([form_inputs(storage.form), -form_inputs(storage.form)])
    with np.errstate(over="ignore"):
        numbers = values * 2 - 1 if storage.is_biased else values
    got = rounded_in_the_shader(gl, numbers, storage, rounding)
    for channel in range(storage.channels):
        expected = np.asarray(store_number(jnp.asarray(numbers), storage, channel, rounding))
        assert_same_bits(numbers, expected, got[:, channel].copy(), f"{storage.name}, number {channel}, {rounding}")
    # The bits of floats from 0 on count.
    if not storage.is_biased:
        every = every_float(storage.form).astype(np.float64)
        counted = np.unique(words(every, storage, 0))
        assert len(counted) == len(every) and counted[0] == 0


def test_truncate_half_is_the_floor_of_f_times_4095_and_a_half():
    """Engines write 12 bits of f in [0, 1] as floor(f 4095.5)."""
    f = np.random.default_rng(0).random(2**16, np.float32)
    stored = np.asarray(store_unorm(jnp.asarray(f), scale_of(4095), "truncate_half")) * 4095
    assert np.array_equal(np.round(stored), np.floor(f * np.float32(4095.5)))


@pytest.mark.parametrize("rounding", ROUNDINGS)
def test_the_two_bits_of_alpha_are_rounded_with_their_own_scale(gl, rounding):
    storage = STORAGES["rgb10a2"]
    values = np.concatenate([around(np.arange(4) / 3), around((np.arange(3) + 0.5) / 3), OUTSIDE])
    got = rounded_in_the_shader(gl, values, storage, rounding)[:, 3]
    expected = np.asarray(store_unorm(jnp.asarray(values), scale_of(storage.scale(3)), rounding))
    assert_same_texels(gl, values, expected, got.copy(), steps_of(storage, 3), f"alpha, {rounding}")


def test_every_half_float_survives_both_roundings():
    halves = np.arange(2**16, dtype=np.uint16).view(np.float16)
    for rounding in FLOAT_ROUNDINGS:
        back = np.asarray(store_half(jnp.asarray(halves.astype(np.float32)), rounding)).astype(np.float16)
        same = (back == halves) | (np.isnan(back) & np.isnan(halves))
        assert same.all(), f"{rounding}: {halves[~same][0]!r} became {back[~same][0]!r}"


def test_half_floats_round_as_numpy_rounds():
    """NumPy's conversion is the reference for nearest even, and for the overflow to infinity at 65520."""
    values = half_inputs()
    with np.errstate(over="ignore"):
        expected = values.astype(np.float16).astype(np.float32)
    assert_same_bits(values, expected, np.asarray(store_half(jnp.asarray(values))), "nearest")


def test_truncated_halves_never_grow():
    values = half_inputs()
    kept = np.asarray(store_half(jnp.asarray(values), "truncate"))
    finite = np.isfinite(values)
    assert np.all(np.abs(kept[finite]) <= np.abs(values[finite]))
    inside = np.abs(values) < 65504
    step = np.spacing(np.abs(kept[inside]).astype(np.float16)).astype(np.float64)
    assert np.all(np.abs(values[inside].astype(np.float64) - kept[inside]) < step), "more than a step was cut off"


@pytest.mark.parametrize("name, channel", CHANNELS)
def test_every_code_decodes_to_itself(name, channel):
    storage = STORAGES[name]
    codes = np.arange(-storage.scale(channel) if storage.kind == "snorm" else 0, storage.scale(channel) + 1).astype(
        np.float32
    )
    back = emulated(codes * np.float32(1 / storage.scale(channel)), storage, "nearest", channel)
    assert np.array_equal(np.round(back * storage.scale(channel)), codes), f"{name}: a code is not stored as itself"


@pytest.mark.parametrize("name, channel", CHANNELS)
def test_ties_of_the_float32_product_go_to_the_even_code(name, channel):
    storage = STORAGES[name]
    scale = np.float32(storage.scale(channel))
    lower = np.arange(0, storage.scale(channel), dtype=np.float32)
    middle = (lower + np.float32(0.5)) / scale
    ties = middle * scale == lower + np.float32(0.5)
    stored = np.round(emulated(middle[ties], storage, "nearest", channel) * scale)
    assert ties.sum() > len(lower) / 2
    assert np.all(stored % 2 == 0), f"{name}: {middle[ties][stored % 2 == 1][0]!r} goes to an odd code"


def test_nan_becomes_the_lowest_code(gl):
    """The emulation documents this, and llvmpipe does it. Other devices may differ, but no encoder makes a NaN."""
    nan = np.float32([np.nan])
    for name, lower in (("rgba8", 0), ("rgba8_snorm", -1)):
        assert emulated(nan, STORAGES[name], "nearest")[0] == lower
        if gl.is_software:
            assert gl.through(np.full((1, 1, 4), np.nan, np.float32), STORAGES[name])[0, 0, 0] == lower


def test_snorm_has_no_code_below_minus_one():
    """-128 would equal -127: the emulation never uses -128, and -1 is exact."""
    assert emulated(np.float32([-1, -1.003, -5]), STORAGES["rg8_snorm"], "nearest").tolist() == [-1, -1, -1]


@pytest.mark.parametrize("name", [name for name, s in STORAGES.items() if s.bits[0] <= 16])
def test_every_number_has_distinct_bits(name):
    """The bits of a channel's numbers are all different, and in the order of the numbers if the format is UNORM."""
    storage = STORAGES[name]
    for channel, bits in enumerate(storage.bits):
        numbers = storage.numbers(channel)
        patterns = words(numbers, storage, channel)
        assert patterns.dtype == np.uint32 and patterns.max() < 2**bits
        assert len(np.unique(patterns)) == len(numbers), f"{name}, channel {channel}"
        if storage.kind == "unorm":
            assert (np.diff(patterns.astype(np.int64)) > 0).all()


@pytest.mark.parametrize(
    "name, number, bits",
    [
        ("rgba8", -1.0, 0x00),
        ("rgba8", 1.0, 0xFF),
        ("rgb10a2", 1.0, 0x3FF),
        ("rg8_snorm", -1.0, 0x81),
        ("rg8_snorm", 1.0, 0x7F),
        ("rgb8_12_12_snorm", -1.0, 0x000),
        ("rg16f", 1.0, 0x3C00),
        ("rg16f", -0.5, 0xB800),
        ("rgba32f", 1.0, 0x3F800000),
        ("r11g11b10f", 1.0, 0x3C0),
        ("rgba8", np.nan, 0x00),
        ("rg16f", np.inf, 0x7C00),
        ("rg16f", np.nan, 0x7E00),
    ],
)
def test_the_bits_of_a_number_match_the_format(name, number, bits):
    """OpenGL 4.6, sections 2.3.4 and 2.3.5; an 11-bit float has the exponent of a half and six bits of mantissa."""
    assert int(words(np.array(number), STORAGES[name], 0)) == bits


@pytest.mark.parametrize("name", sorted(STORAGES))
def test_a_stand_in_format_stores_the_same_numbers(name):
    """One program serves all formats to which `shared` gives the same stand-in. With a format's own scales, the
    numbers of the stand-in equal the format's numbers, bit for bit, for any number of channels."""
    storage = STORAGES[name]
    c = jnp.asarray(np.random.default_rng(1).uniform(-1.1, 1.1, 4096), jnp.float32)
    for count in range(1, storage.channels + 1):
        like, scales = shared(storage, count)
        for channel in range(count):
            stored = store_number(c, fixed(like, scales), channel)
            assert np.array_equal(stored, store_number(c, storage, channel)), (count, channel)


@pytest.mark.parametrize("bits", [(4, 4), (9, 7), (12, 12), (11, 11, 10), (20, 20), (12, 12, 12), (20, 20, 20)])
@pytest.mark.parametrize("kind", ["unorm", "snorm", "float"])
def test_a_packing_writes_the_channels_that_its_target_has(kind, bits):
    """A packing has enough channels for all numbers, and at least two, because GLSL has no one-component vectors."""
    storage = by_rule(kind, bits) if kind != "float" else by_rule("float", (8, 7))
    numbers = min(len(bits), 3)
    packing = StoragePacking(storage, numbers)
    across = -(-sum(storage.bits[:numbers]) // storage.part) if storage.is_packed else numbers
    assert packing.channels == max(2, across) <= max(2, storage.target.channels)
