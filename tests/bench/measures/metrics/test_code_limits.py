"""The error bound for N codes: its values, measurements that respect it and wrong measures that are caught."""

import math
import re

import jax
import jax.numpy as jnp
import pytest

from normalbench.bench.measures.metrics import meter as metrics
from normalbench.bench.measures.metrics.code_limits import HEMISPHERE, SPHERE, code_limit
from normalbench.bench.measures.native import meter as native
from normalbench.bench.subjects.normals.normal_sets import sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import dot

COUNT = 2**18


def row_of(codec: Codec, normals) -> dict:
    return quality.measure(quality.QualityCase(codec, normals, "jax"))


@pytest.mark.parametrize(
    "bits, mean, rms, largest", [(16, 0.29926, 0.31773, 0.49222), (24, 0.018704, 0.019858, 0.030764)]
)
def test_the_bound_has_the_expected_figures(bits, mean, rms, largest):
    """Fejes Toth's covering and the hexagon's moments, computed independently."""
    least = code_limit(2**bits)
    assert [least.mean_deg, least.rms_deg, least.max_deg] == pytest.approx([mean, rms, largest], rel=5e-5)


def test_covering_bound_is_exact_for_polyhedra_and_free_of_cancellation():
    """Tetrahedron, octahedron and icosahedron give the circumradii of their faces; 2^62 codes lose no digits."""
    circumradii = {4: math.acos(1 / 3), 6: math.acos(1 / math.sqrt(3)), 12: math.acos(math.sqrt((5 + 2 * 5**0.5) / 15))}
    for count, radius in circumradii.items():
        assert code_limit(count).max_deg == pytest.approx(math.degrees(radius), rel=1e-12)
    assert code_limit(2**62).max_deg / code_limit(2**20).max_deg == pytest.approx(2.0**-21, rel=1e-5)


def test_the_bound_for_a_hemisphere_uses_half_the_area():
    whole, half = code_limit(2**16, SPHERE), code_limit(2**16, HEMISPHERE)
    assert half.rms_deg == pytest.approx(whole.rms_deg / math.sqrt(2))
    assert half.max_deg == pytest.approx(whole.max_deg / math.sqrt(2), rel=1e-4)


@pytest.mark.parametrize("count", [999_999, 1_000_003, 1_100_000, 1_200_000])
def test_coinciding_lattices_are_not_reported_as_a_wrong_measurement(count):
    """For latitude and longitude, directions and their nearest codes are closer than chance predicts."""
    row = row_of(Codec(ENCODINGS["latitude_longitude"], STORAGES["rg8"]), sphere(count))
    assert row["below_limit"] == "", row


def test_codes_that_a_format_cannot_distinguish_are_not_counted():
    """SNORM8 has 255 values and a half float 30,721 from -1 to 1; a sign is one more bit."""
    pairs = {"rg8_snorm": 255**2, "rg8": 2**16, "rg16f": 30721**2, "rg16": 2**32}
    for name, codes in pairs.items():
        assert Codec(ENCODINGS["octahedral"], STORAGES[name]).codes == codes
    assert Codec(ENCODINGS["xy_sign"], STORAGES["rg8"]).codes == 2**17


def broken(monkeypatch, angle_between) -> None:
    """Replace the measure's angle function, and compile again."""
    monkeypatch.setattr(metrics, "angle_between", angle_between)
    monkeypatch.setattr(metrics, "_scan", jax.jit(lambda chunk: metrics._traced_scan(chunk)))
    monkeypatch.setattr(native, "_row_library", native._row_library.__wrapped__)
    monkeypatch.setattr(quality, "meter_of", quality.meter_of.__wrapped__)


def test_an_arc_cosine_in_float32_is_caught(monkeypatch):
    """The first step of the arc cosine is 0.02 degrees, so too many angles are 0 for this number of codes. The mean
    and the RMS would not show the error, because all other angles are too large."""
    broken(monkeypatch, lambda a, b: jnp.degrees(jnp.arccos(jnp.minimum(dot(a, b), 1.0))))
    for name in ("rg8", "rgb10a2", "rg16", "rg16f"):
        below = row_of(Codec(ENCODINGS["octahedral"], STORAGES[name]), sphere(COUNT))["below_limit"]
        assert re.match(r"\d+ angles are below .* degrees", below), name


def test_radians_are_caught_with_exit_status_1(monkeypatch, run):
    right = metrics.angle_between
    broken(monkeypatch, lambda a, b: jnp.radians(right(a, b)))
    words = ["--encoding", "octahedral", "--storage", "rg8", "--normals", "sphere", "--backend", "jax"]
    status, out, err = run("quality", *words, "--count", "10000", "--format", "json")
    assert status == 1 and '"below_limit": "RMS 0.006' in out
    assert err.count("\n") == 1 and "below the bound of 0.31773 degrees; 65536 codes cannot be that accurate" in err


def test_a_set_that_coincides_with_a_lattice_of_codes_is_accepted():
    """Of 65,536 directions, 153 are within 0.0039 degrees of a spherical 10:10 code; by chance it would be 80."""
    for name in ("rgb8_10_10_2", "rgb8_10_10_3"):
        assert row_of(Codec(ENCODINGS["spherical"], STORAGES[name]), sphere(2**16))["below_limit"] == ""
