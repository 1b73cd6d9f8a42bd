"""Light encodings: their ranges, and formats that store values as emulated."""

import colorsys

import jax.numpy as jnp
import numpy as np
import pytest
from parity.comparison import rows
from parity.light import planes
from test_light_encodings import stored_texels

from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.encodings.storages.rounding import from_srgb, scale_of, store_srgb, to_srgb
from normalbench.encodings.storages.storage import SRGB8_A8
from normalbench.encodings.vec import light_or_none


@pytest.mark.parametrize("name", ["rgbm", "rgb9e5", "linear", "srgb"])
def test_light_that_is_read_and_rewritten_is_unchanged(name):
    """A light pass that adds nothing changes nothing: rounding never loses a step, however often light is rewritten.

    The first time RGBM may find a smaller multiplier for the stored light; after that nothing changes.
    """
    encoding = LIGHT_BUFFERS[name]
    light = np.random.default_rng(0).uniform(0, 1.5, (4096, 4)).astype(np.float32)
    light *= np.linspace(0, 1, 4096, dtype=np.float32)[:, None]
    texels = encoding.store(encoding.encode(planes(light)))
    texels = encoding.store(encoding.encode(light_or_none(encoding.decode(texels))))
    again = encoding.store(encoding.encode(light_or_none(encoding.decode(texels))))
    held = 4 if encoding.has_alpha else 3
    changed = np.abs(rows(encoding.decode(again)) - rows(encoding.decode(texels)))[:, :held].max(axis=1) > 1e-6
    assert not changed.any(), f"{name}: {light[changed][0]!r} becomes {rows(again)[changed][0]!r}"


def test_rgb9e5_matches_the_specification():
    """Compared with the specification's arithmetic in float64: B = 15, N = 9, the largest 65408."""
    rng = np.random.default_rng(0)
    light = np.exp2(rng.uniform(-26, 17, (4096, 1)) + rng.uniform(-11, 0, (4096, 4))).astype(np.float32)
    clamped = np.minimum(light[:, :3].astype(np.float64), 65408)
    exponent = np.maximum(np.floor(np.log2(clamped.max(axis=1))), -16) + 16
    largest = np.floor(clamped.max(axis=1) / 2.0 ** (exponent - 24) + 0.5)
    exponent = np.where(largest == 512, exponent + 1, exponent)
    mantissas = np.floor(clamped / 2.0 ** (exponent - 24)[:, None] + 0.5)
    got = rows(LIGHT_BUFFERS["rgb9e5"].decode(stored_texels("rgb9e5", light)))[:, :3]
    assert np.array_equal(got, (mantissas * 2.0 ** (exponent - 24)[:, None]).astype(np.float32))


# Of Dagor's table of 256 colours, by their code.
DAGORS = {
    0: (1, 0.75, 0.75),
    1: (1, 0.773810, 0.75),
    11: (0.988095, 1, 0.75),
    62: (1, 0.75, 0.773809),
    63: (1, 1, 1),
    64: (1, 0.5, 0.5),
    96: (0.5, 0.976190, 1),
    127: (1, 0.5, 0.5),
    170: (0.25, 0.25, 1),
    202: (1, 0.952381, 0),
    255: (1, 0, 0),
}


def test_hues_and_saturations_match_dagors_table():
    """At the largest light, 16, each code is stored as itself, except for the last hue, which equals the first."""
    code = np.array(list(DAGORS))
    texels = np.stack([(code & 63) / 63, (code >> 6) / 3, np.ones(len(code)), 0 * code], axis=1).astype(np.float32)
    light = rows(LIGHT_BUFFERS["hue_saturation"].decode(planes(texels)))
    assert light[:, :3] / 16 == pytest.approx(np.array(list(DAGORS.values())), abs=2e-6)
    again = np.rint(rows(stored_texels("hue_saturation", light))[:, :2] * [63, 3]) @ [1, 64]
    is_last = ((code & 63) == 63) & (code > 63)
    assert np.array_equal(again[~is_last], code[~is_last]) and (again[is_last] == code[is_last] - 63).all()


def test_hue_and_saturation_match_colorsys():
    """Compared in float64: light with a saturation below 1/4 is white; other hues and saturations are the nearest."""
    light = np.random.default_rng(0).uniform(0, 16, (2048, 4)).astype(np.float32)
    exact = np.array([colorsys.rgb_to_hsv(*map(float, row[:3])) for row in light])
    got = rows(stored_texels("hue_saturation", light))[:, :3]
    white = exact[:, 1] < 0.25
    assert white.any() and (got[white, :2] == [1, 0]).all()
    turned = (got[~white, 0] - exact[~white, 0] + 0.5) % 1 - 0.5
    assert abs(turned).max() < 0.5001 / 63
    assert abs((3 * got[~white, 1] + 1) / 4 - exact[~white, 1]).max() < 0.5001 / 4
    assert abs(got[:, 2] - np.sqrt(exact[:, 2] / 16)).max() < 0.5001 / 255


def test_the_srgb_curve_matches_the_standard():
    """IEC 61966-2-1 in float64; the two branches meet, and every code comes back as itself."""
    x = np.linspace(0, 1, 100_001)
    exact = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    assert np.abs(np.asarray(to_srgb(jnp.asarray(x, jnp.float32))) - exact).max() < 3e-7
    codes = jnp.asarray(np.arange(256), jnp.float32) * jnp.float32(1 / 255)
    linear = from_srgb(codes)
    assert float(linear[255]) == 1.0 and float(linear[0]) == 0.0
    assert np.array_equal(np.asarray(store_srgb(linear, scale_of(255))), np.asarray(linear))
    assert SRGB8_A8.curved == 3
