"""Curves: monotonicity from 0 to the range, inversion and the values in their sources."""

import numpy as np
import pytest
from parity.comparison import ULP
from parity.curves import range_of, shares
from typed import storages_named

from normalbench.encodings.catalogue import CURVE_ENCODINGS
from normalbench.encodings.codecs.curve_codec import CurveCodec
from normalbench.encodings.storages.storage import CURVE_STORAGES

EVERY = sorted(CURVE_ENCODINGS)


@pytest.mark.parametrize("name", EVERY)
def test_a_curve_is_monotonic_over_its_range_and_can_be_inverted(name):
    """0 and the range map to the ends of the numbers, the curve is monotonic, and decoding returns the input."""
    encoding, largest = CURVE_ENCODINGS[name], np.float32(range_of(CURVE_ENCODINGS[name]))
    x = np.sort(np.minimum(shares() * largest, largest))
    numbers = np.asarray(encoding.encode(x, largest))
    ends = {"inverted": (1, 0), "reflectivity": (0.04, 1)}.get(name, (0, 1))
    assert (numbers[0], numbers[-1]) == pytest.approx(ends, abs=4 * ULP)
    # A logarithm is within 2 units, so that neighbours may change places by as much.
    assert (np.diff(numbers) * (ends[1] - ends[0]) > -4 * ULP).all() and numbers.min() >= 0 and numbers.max() < 1 + 1e-6
    off = np.abs(np.asarray(encoding.decode(numbers, largest)) - x).max() / largest
    # The square's root doubles what rounding takes from a small number: 2^-12 of the range at most.
    allowed = 2.0**-12 if name == "squared" else max(encoding.inverse_error, 64 * ULP)
    assert off <= allowed and (off > allowed / 2 or not encoding.inverse_error), f"{off:.2e} of {allowed:.2e}"


@pytest.mark.parametrize(
    "name, limit, quantity, number",
    [
        ("linear", 0.08, 0.04, 0.5),  # Unreal's default specular
        ("square_root", 0.16, 0.04, 0.5),  # Frostbite's default reflectance
        ("squared", 1, 0.5, 0.25),
        ("inverted", 1, 0.3, 0.7),
        ("srgb", 1, 0.5, 0.7353569),  # IEC 61966-2-1
        ("srgb", 1, 0.003, 0.03876),
        ("gamma_2_2", 1, 0.5, 0.7297401),
        ("fast_srgb", 1, 0.5, 0.7353569),
        ("fast_srgb", 1, 0.0, 0.0),
        ("log", 31, 1.0, 0.2),
        ("log", 31, 31.0, 1.0),
        ("ray_bits", 1, 0.5, 15 / 255),
        ("ray_bits", 1, 1.0, 1.0),
        ("reflectivity", 1, 0.5, 0.52),
    ],
)
def test_a_curve_matches_the_values_in_its_source(name, limit, quantity, number):
    code = float(CURVE_ENCODINGS[name].encode(np.float32(quantity), np.float32(limit)))
    assert code == pytest.approx(number, abs=1e-6)


def test_unitys_polynomial_is_within_a_sixth_of_a_percent_of_its_curve():
    """Decoded values are off by up to 0.00167 even without a storage: 0.4 of an 8-bit step."""
    fast = CURVE_ENCODINGS["fast_srgb"]
    x = np.linspace(0, 1, 100_001)
    off = np.abs(np.asarray(fast.decode(fast.encode(x, 1.0), 1.0)) - x).max()
    assert off == pytest.approx(0.00167, abs=2e-5)


@pytest.mark.parametrize(
    "name, first",
    [("linear", 1 / 255), ("square_root", 1 / 255**2), ("squared", 1 / 255**0.5), ("srgb", 1 / 255 / 12.92)],
)
def test_the_smallest_decoded_value_above_0_matches_the_curve(name, first):
    """In 8 bits this is the value of code 1. Inputs up to half a code on the curve decode to 0."""
    codec = CurveCodec(CURVE_ENCODINGS[name], CURVE_STORAGES["r8"])
    decoded = np.asarray(codec.round_trip(np.linspace(0, 0.1, 200_001, dtype=np.float32)))
    assert decoded[0] == 0 and decoded[decoded > 0].min() == pytest.approx(first, rel=1e-5)


# A number f in [0, 1] and an integer in one byte, as engines write them: the byte of f and of an integer, and back.
MIXED = {
    "Unity HDRP: f (256 / 8 - 1) / 255 + i 256 / 8 / 255": (5, lambda f, i: (f * 31 + i * 32) / 255),
    "Unreal's Encode71: f 127 / 255 + i 128 / 255": (7, lambda f, i: (f * 127 + i * 128) / 255),
    "Godot: f 127 / 255, and 1 less that where a bit is set": (7, lambda f, i: abs(i - f * 127 / 255)),
}


@pytest.mark.parametrize("bits, written", MIXED.values(), ids=MIXED)
@pytest.mark.parametrize("integer", [0, 1])
def test_a_number_in_a_shared_byte_equals_a_number_with_fewer_bits(bits, written, integer):
    """The hardware rounds the sum to a byte, in which the number has the steps of `unorm:7` or `unorm:5`."""
    f = np.random.default_rng(0).random(2**14)
    byte = np.rint(255 * written(f, integer))
    of_number = 255 - byte if "abs" in written.__code__.co_names and integer else byte % 2**bits
    (storage,) = storages_named(f"unorm:{bits}")
    by_fields = np.asarray(CurveCodec(CURVE_ENCODINGS["linear"], storage).round_trip(f.astype(np.float32)))
    differs = abs(of_number / (2**bits - 1) - by_fields) > 1e-6
    assert differs.mean() < 1e-3, f[differs][:3]


def test_fixed_point_clips_values_above_the_range_and_floats_keep_them():
    x = np.float32([0.2])
    for storage, kept in (("r8", 0.1), ("r16f", 0.2)):
        codec = CurveCodec(CURVE_ENCODINGS["linear"], CURVE_STORAGES[storage], 0.1)
        assert np.asarray(codec.round_trip(x)) == pytest.approx(kept, rel=1e-3)
