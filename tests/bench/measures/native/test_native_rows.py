"""Rows that compiled C measures match those of XLA for all kinds of sets and decoded values."""

from contextlib import contextmanager
from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from directions import random_directions

from normalbench.bench.ground.native import library
from normalbench.bench.ground.output import errors
from normalbench.bench.measures.metrics.meter import Meter, measure_together
from normalbench.bench.measures.metrics.totals import statistics
from normalbench.bench.measures.native.meter import NativeMeter, decoder
from normalbench.bench.subjects.normals import normal_sets
from normalbench.bench.subjects.normals.normal_sets import CHUNK, TURN, NormalSet, from_arrays, hemisphere, sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import Vec3, select

pytestmark = pytest.mark.skipif(not library.compiler(), reason="no C compiler")


# What is written for each element of a table, or by a loop, is measured by XLA's code.
BY_XLA = {"best_fit", "best_fit_searched", "optimised_rings", "spherical_fibonacci", "spherical_lut"}


# A unit in the last place of a component, as an angle.
UNIT_DEG = float(np.degrees(2.0**-23))


def both(function, normals: NormalSet, given=()):
    """Return the statistics of a decoder of (n, view), from C and from XLA."""
    native = NativeMeter(decoder(function, given), given)
    usual = Meter(jax.jit(lambda chunk: function(chunk.n, chunk.view, *given)))
    totals = (measure_together([meter], normals.loads(), lambda _: None)[0] for meter in (native, usual))
    return [statistics(normals.count, total) for total in totals]


def assert_same(found, expected, relative=2e-6, largest_deg=UNIT_DEG):
    """Check figures of two compilers, which may round a product before it is added: a few normals get another code,
    and angles differ by a unit in the last place of a component."""
    exact = ("count", "pixels", "invalid")
    assert [getattr(found, name) for name in exact] == [getattr(expected, name) for name in exact]
    assert found.mse == pytest.approx(expected.mse, rel=relative, abs=1e-13)
    assert found.article_mse == pytest.approx(expected.article_mse, rel=max(relative, 1e-3), abs=1e-9)
    unit = UNIT_DEG
    for name, least, apart in (("mean", 0, unit), ("rms", 0, unit), ("p99", 2e-4, unit), ("max", 2e-5, largest_deg)):
        here, there = (getattr(figures, f"angle_{name}_deg") for figures in (found, expected))
        assert here == pytest.approx(there, rel=max(relative, least), abs=apart), f"angle_{name}_deg"


def first_meter(name: str):
    """Return the meter of an encoding in its first storage."""
    codecs = (Codec(ENCODINGS[name], storage) for storage in STORAGES.values())
    return quality.meter_of(next(codec for codec in codecs if codec.fits))


def test_encodings_without_c_are_measured_by_xla():
    assert {name for name in ENCODINGS if isinstance(first_meter(name), Meter)} == BY_XLA


def test_encodings_without_c_are_reported(capsys):
    codecs = [Codec(ENCODINGS[name], STORAGES["rgba8"]) for name in ("octahedral", "best_fit")]
    with told():
        quality.tell_by_xla(quality.cases(codecs, [sphere(64)], ["jax"]))
    line = "computed by XLA, not by compiled C like the other rows: best_fit"
    assert capsys.readouterr().err == f"normalbench: {line}\n"


def test_xla_measures_without_a_c_compiler_and_reports_it(monkeypatch, capsys):
    codec = Codec(ENCODINGS["octahedral"], STORAGES["rg8"])
    usual = quality.measure(*quality.cases([codec], [sphere(64)], ["jax"]))
    monkeypatch.setattr(library, "compiler", lambda: "")
    monkeypatch.setattr(quality, "compiler", lambda: "")
    forget_what_is_compiled()
    try:
        cases = quality.cases([codec], [sphere(64)], ["jax"])
        (row,) = quality.rows(cases, lambda _: None)
        with told():
            quality.tell_by_xla(cases)
        assert isinstance(quality.meter_of(codec), Meter) and normal_sets._fill(True) is None
    finally:
        forget_what_is_compiled()
    assert "no C compiler found (cc): XLA computes the rows" in capsys.readouterr().err
    assert row["angle_mean_deg"] == pytest.approx(usual["angle_mean_deg"], rel=1e-6)


def forget_what_is_compiled():
    for kept in (library._made, quality.meter_of, quality._compiled, normal_sets._fill):
        kept.cache_clear()


@contextmanager
def told():
    """Allow lines that were printed before to be printed again."""
    before = {*errors.told}
    errors.told.clear()
    yield
    errors.told.update(before)


def test_decoded_values_that_are_not_numbers_count_as_the_opposite_direction():
    """A tenth of the values are NaN and a tenth are infinite; then all are NaN."""
    n = random_directions(5000)

    def some(n: Vec3, _: Vec3) -> Vec3:
        return select(n.x > 0.8, n * jnp.nan, select(n.x < -0.8, n * jnp.inf, n * 0.999))

    for decode in (some, lambda n, _: n * jnp.nan):
        stats, expected = both(decode, from_arrays("", "", n, n, np.ones(len(n), bool)))
        assert expected.invalid > 400 and stats.worst.angle_deg == 180.0
        assert_same(stats, expected)


def test_huge_squared_errors_are_summed_without_overflow():
    stats, expected = both(lambda n, _: n * 1.5e19, sphere(CHUNK))
    assert stats.mse == pytest.approx(expected.mse, rel=1e-6) and 7e37 < stats.mse < 8e37
    assert stats.invalid == expected.invalid == 0


def test_the_background_does_not_count():
    """The background fills blocks completely and partly, in several chunks; it never has the worst normal."""
    n = random_directions(CHUNK + 5000)
    covered = (np.arange(len(n)) // 700) % 2 == 0
    view = np.where(covered[:, None], n + np.float32(0.01), -n).astype(np.float32)
    stats, expected = both(lambda _, view: view, from_arrays("", "", n, view, covered))
    assert_same(stats, expected)
    assert stats.worst.angle_deg < 2 and stats.pixels == len(n) > stats.count
    nothing = from_arrays("", "", n, view, np.zeros(len(n), bool))
    for load in nothing.loads():
        figures, counts, worst = NativeMeter(decoder(lambda _, view: view)).one(load)
        assert not any(figures) and counts.sum() == counts[-1] == CHUNK and worst is None


def test_the_worst_normal_matches_xla():
    """Ties are resolved in float64; if no normal changes, all of them tie."""
    n = random_directions(3000)
    index = 1234
    turned = np.where(np.arange(len(n))[:, None] == index, n[:, [1, 2, 0]], n).astype(np.float32)
    for view in (turned, n):
        stats, expected = both(lambda _, view: view, from_arrays("", "", n, view, np.ones(len(n), bool)))
        np.testing.assert_array_equal(stats.worst.normal, expected.worst.normal)
        assert stats.worst.angle_deg == expected.worst.angle_deg
    assert stats.worst.angle_deg == 0.0


@pytest.mark.parametrize("at", [7, CHUNK + 7])
def test_the_worst_normal_is_found_in_any_chunk(at):
    """The worst normal is in the first or the second of two chunks."""
    n = random_directions(CHUNK + 99)
    turned = np.where(np.arange(len(n))[:, None] == at, n[:, [1, 2, 0]], n * np.float32([1, 1, 0.99]))
    normals = from_arrays("", "", n, turned.astype(np.float32), np.ones(len(n), bool))
    (total,) = measure_together([NativeMeter(decoder(lambda _, view: view))], normals.loads(), lambda _: None)
    np.testing.assert_array_equal(total.worst.normal, n[at])
    assert float(total.figures.largest) == pytest.approx(total.worst.angle_deg, rel=1e-5)


@pytest.mark.parametrize("make", [sphere, hemisphere])
@pytest.mark.parametrize("start", [0, 7 * CHUNK, TURN - CHUNK, TURN, 5 * TURN + CHUNK])
def test_compiled_sets_have_the_same_normals_as_xla(make, start, monkeypatch):
    """Normals match to the last bit, before and after the index wraps at 2^32. Normals beyond the end do not
    count."""
    count = start + CHUNK - 99
    filled = make(count, seed=3).chunk(start)
    monkeypatch.setattr(normal_sets, "_fill", lambda _: None)
    expected = make(count, seed=3).chunk(start)
    assert isinstance(filled.n.x, np.ndarray) and not isinstance(expected.n.x, np.ndarray)
    for ours, theirs in zip(jax.tree.leaves(filled), jax.tree.leaves(expected), strict=True):
        np.testing.assert_array_equal(ours, theirs)
    assert np.count_nonzero(filled.covered) == CHUNK - 99


def test_subnormal_numbers_are_flushed_to_zero():
    """XLA does the same; the processor's mode does not change."""
    n = random_directions(3000)
    normals = from_arrays("", "", n, n, np.ones(len(n), bool))
    stats, expected = both(lambda n, _: n * 1e-38 * 1e-3 * 1e38 * 1e3, normals)
    assert stats.angle_mean_deg == expected.angle_mean_deg == 180.0
    assert np.float32(1e-45) * np.float32(1) > 0


@pytest.mark.parametrize("kind", [jnp.float16, jnp.float64, jnp.int32, None])
def test_decoded_components_are_converted_to_one_type(kind):
    """Both compilers measure a component of another type, or one constant for all normals."""

    def decode(e, _):
        return Vec3(e.x, e.y, 1 if kind is None else (e.z * 0.0 + 1.0).astype(kind))

    codec = Codec(replace(ENCODINGS["xyz"], name="odd", decode=decode), STORAGES["rgba16"])
    meters = [quality.meter_of(codec), quality.meter_by_xla(codec)]
    assert isinstance(meters[0], NativeMeter)
    totals = measure_together(meters, sphere(CHUNK).loads(), lambda _: None)
    stats, expected = (statistics(CHUNK, total) for total in totals)
    assert_same(stats, expected)
    assert stats.invalid == 0 and 30 < stats.angle_mean_deg < 60
