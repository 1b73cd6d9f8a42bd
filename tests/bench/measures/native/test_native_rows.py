"""Rows that the C compiler's code measures: those of XLA's code, whatever the set and the decodes are like."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from directions import random_directions

from normalbench.bench.ground.native import library
from normalbench.bench.measures.metrics.meter import Meter, measure_together
from normalbench.bench.measures.metrics.totals import statistics
from normalbench.bench.measures.native.meter import NativeMeter
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


# A root of what cancels next to -z: whether a product is rounded before it is added shows, by hundredths of a degree.
CANCELS, CANCELLED_DEG = {"spheremap": 1e-3, "cryengine3": 1e-4}, 1e-2


# A unit in the last place of a component, as an angle.
UNIT_DEG = float(np.degrees(2.0**-23))


def both(function, normals: NormalSet, given=()):
    """The statistics of a decoder of (n, view), by C and by XLA."""
    native = NativeMeter(function, given)
    usual = Meter(jax.jit(lambda chunk: function(chunk.n, chunk.view, *given)))
    totals = (measure_together([meter], normals.loads(), lambda _: None, 3)[0] for meter in (native, usual))
    return [statistics(normals.count, total) for total in totals]


def assert_same(found, expected, relative=2e-6, largest_deg=UNIT_DEG):
    """Figures of two compilers, which round a product before it is added, or not: a few normals get another code, and
    angles differ by a unit in the last place of a component."""
    exact = ("count", "pixels", "invalid")
    assert [getattr(found, name) for name in exact] == [getattr(expected, name) for name in exact]
    assert found.mse == pytest.approx(expected.mse, rel=relative, abs=1e-13)
    assert found.article_mse == pytest.approx(expected.article_mse, rel=max(relative, 1e-3), abs=1e-9)
    unit = UNIT_DEG
    for name, least, apart in (("mean", 0, unit), ("rms", 0, unit), ("p99", 2e-4, unit), ("max", 2e-5, largest_deg)):
        here, there = (getattr(one, f"angle_{name}_deg") for one in (found, expected))
        assert here == pytest.approx(there, rel=max(relative, least), abs=apart), f"angle_{name}_deg"


def codecs_of(name: str) -> list[Codec]:
    """A codec in the first format of each kind that it fits."""
    kinds: dict[tuple, Codec] = {}
    for storage in STORAGES.values():
        codec = Codec(ENCODINGS[name], storage)
        if codec.fits and not storage.curved:
            kinds.setdefault((storage.kind, storage.bits[0] if storage.kind == "float" else 0), codec)
    return [*kinds.values()]


@pytest.mark.parametrize("name", sorted(set(ENCODINGS) - BY_XLA))
def test_rows_are_those_of_xla(name, at=0):
    """Every codec of the catalogue, in a format of each kind."""
    normals = sphere(CHUNK)
    for codec in codecs_of(name)[1:] if at else codecs_of(name)[:1]:
        meters = [quality.meter_of(codec, is_compiled) for is_compiled in (True, False)]
        assert [meter.compiler for meter in meters] == [library.compiler(), "XLA"]
        found, expected = (statistics(CHUNK, t) for t in measure_together(meters, normals.loads(), lambda _: None))
        assert_same(found, expected, *((CANCELS[name], CANCELLED_DEG) if name in CANCELS else ()))
        if name not in CANCELS:
            assert found.worst.angle_deg == pytest.approx(expected.worst.angle_deg, rel=2e-5, abs=2e-6), codec.name


def test_what_c_cannot_say_is_measured_by_xla():
    found = {name for name in ENCODINGS if _first(name).compiler == "XLA"}
    assert found == BY_XLA


def _first(name: str):
    return quality.meter_of(codecs_of(name)[0], True)


def test_decodes_that_are_not_numbers_count_as_the_opposite_direction():
    """A tenth of them, NaN and infinite; and all."""
    n = random_directions(5000)

    def some(n: Vec3, _: Vec3) -> Vec3:
        return select(n.x > 0.8, n * jnp.nan, select(n.x < -0.8, n * jnp.inf, n * 0.999))

    for decode in (some, lambda n, _: n * jnp.nan):
        found, expected = both(decode, from_arrays("", "", n, n, np.ones(len(n), bool)))
        assert expected.invalid > 400 and found.worst.angle_deg == 180.0
        assert_same(found, expected)


def test_squared_errors_of_which_four_are_too_large_for_a_float_add_up():
    found, expected = both(lambda n, _: n * 1.5e19, sphere(CHUNK))
    assert found.mse == pytest.approx(expected.mse, rel=1e-6) and 7e37 < found.mse < 8e37
    assert found.invalid == expected.invalid == 0


def test_the_background_does_not_count():
    """Of several chunks, with whole blocks of it, and a part of a block; the worst normal is not among it."""
    n = random_directions(CHUNK + 5000)
    covered = (np.arange(len(n)) // 700) % 2 == 0
    view = np.where(covered[:, None], n + np.float32(0.01), -n).astype(np.float32)
    found, expected = both(lambda _, view: view, from_arrays("", "", n, view, covered))
    assert_same(found, expected)
    assert found.worst.angle_deg < 2 and found.pixels == len(n) > found.count
    nothing = from_arrays("", "", n, view, np.zeros(len(n), bool))
    ((figures, counts, worst),) = NativeMeter(lambda _, view: view).parts([*nothing.loads()])
    assert not any(figures) and counts.sum() == counts[-1] == 2 * CHUNK and worst is None


def test_the_worst_normal_is_that_of_xla():
    """Ties are settled in float64; normals that come back as they were are one."""
    n = random_directions(3000)
    at = 1234
    turned = np.where(np.arange(len(n))[:, None] == at, n[:, [1, 2, 0]], n).astype(np.float32)
    for view in (turned, n):
        found, expected = both(lambda _, view: view, from_arrays("", "", n, view, np.ones(len(n), bool)))
        np.testing.assert_array_equal(found.worst.normal, expected.worst.normal)
        assert found.worst.angle_deg == expected.worst.angle_deg
    assert found.worst.angle_deg == 0.0


@pytest.mark.parametrize("at", [7, CHUNK + 7])
def test_the_worst_normal_is_that_of_all_chunks(at):
    """Whichever of two chunks of a part has it."""
    n = random_directions(CHUNK + 99)
    turned = np.where(np.arange(len(n))[:, None] == at, n[:, [1, 2, 0]], n * np.float32([1, 1, 0.99]))
    normals = from_arrays("", "", n, turned.astype(np.float32), np.ones(len(n), bool))
    ((figures, _, worst),) = NativeMeter(lambda _, view: view).parts([*normals.loads()])
    np.testing.assert_array_equal(worst.normal, n[at])
    assert figures.largest == pytest.approx(worst.angle_deg, rel=1e-5)


@pytest.mark.parametrize("make", [sphere, hemisphere])
@pytest.mark.parametrize("start", [0, 7 * CHUNK, TURN - CHUNK, TURN, 5 * TURN + CHUNK])
def test_large_sets_are_filled_with_the_same_normals(make, start, monkeypatch):
    """To the last bit, in the first turn of 2^32 and in later ones; what is beyond the set's end does not count."""
    count = start + CHUNK - 99
    monkeypatch.setattr(normal_sets, "LARGE", 1)
    filled = make(count, seed=3).chunk(start)
    monkeypatch.setattr(normal_sets, "LARGE", count + 1)
    expected = make(count, seed=3).chunk(start)
    assert isinstance(filled.n.x, np.ndarray) and not isinstance(expected.n.x, np.ndarray)
    for ours, theirs in zip(jax.tree.leaves(filled), jax.tree.leaves(expected), strict=True):
        np.testing.assert_array_equal(ours, theirs)
    assert np.count_nonzero(filled.covered) == CHUNK - 99


def test_numbers_below_the_normal_ones_are_0():
    """As XLA has them; and the processor is left as it was."""
    n = random_directions(3000)
    normals = from_arrays("", "", n, n, np.ones(len(n), bool))
    found, expected = both(lambda n, _: n * 1e-38 * 1e-3 * 1e38 * 1e3, normals)
    assert found.angle_mean_deg == expected.angle_mean_deg == 180.0
    assert np.float32(1e-45) * np.float32(1) > 0


@pytest.mark.parametrize("kind", [jnp.float16, jnp.float64, jnp.int32, None])
def test_decodes_become_numbers_of_one_type(kind):
    """A decode with a component of another type, or one for all normals, is measured by both compilers."""

    def decode(e, _):
        return Vec3(e.x, e.y, 1 if kind is None else (e.z * 0.0 + 1.0).astype(kind))

    codec = Codec(replace(ENCODINGS["xyz"], name="odd", decode=decode), STORAGES["rgba16"])
    totals = measure_together(
        [quality.meter_of(codec, c) for c in (True, False)], sphere(CHUNK).loads(), lambda _: None
    )
    found, expected = (statistics(CHUNK, total) for total in totals)
    assert_same(found, expected)
    assert found.invalid == 0 and 30 < found.angle_mean_deg < 60
