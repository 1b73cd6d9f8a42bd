"""The statistics of a row, compared with NumPy in float64 and with mathematical laws."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from directions import random_directions
from typed import codecs_named

from normalbench.bench.ground.angles import angles_deg
from normalbench.bench.ground.machine.cores import cores, on_all_cores
from normalbench.bench.ground.options import counts
from normalbench.bench.measures.metrics.meter import Meter, angle_between
from normalbench.bench.measures.metrics.totals import psnr_db
from normalbench.bench.subjects.normals.normal_sets import CHUNK, STEPS, from_arrays, hemisphere, sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings import vec
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES


def turned(n: np.ndarray, degrees: np.ndarray, seed: int = 3) -> np.ndarray:
    """Return each direction rotated by an angle about a random perpendicular axis; float64."""
    across = np.cross(n, random_directions(len(n), seed)).astype(np.float64)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    angle = np.radians(degrees)[:, None]
    return n * np.cos(angle) + np.cross(across, n) * np.sin(angle)


def measured(meter: Meter, normals):
    return meter.measure(normals.loads(), normals.count)


def measured_angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.asarray(jax.jit(angle_between)(vec.Vec3(*jnp.asarray(a.T)), vec.Vec3(*jnp.asarray(b.T))))


def test_small_angles_keep_six_digits_in_float32():
    """From 1e-5 to 180 degrees the angle matches float64 for the same float32 vectors, to a relative 2e-6."""
    n = random_directions(2**16)
    degrees = np.geomspace(1e-5, 179.9, len(n))
    other = turned(n, degrees).astype(np.float32)
    got, expected = measured_angles(n, other), angles_deg(n, other)
    worst = np.argmax(np.abs(got - expected) / expected)
    assert got[worst] == pytest.approx(expected[worst], rel=2e-6), f"at {degrees[worst]} degrees"


def test_the_angle_does_not_depend_on_the_decoded_length():
    n = random_directions(4096)
    other = turned(n, np.full(len(n), 7.0)).astype(np.float32)
    assert np.allclose(measured_angles(n, other), measured_angles(n, other * np.float32(0.9)), rtol=1e-5)


def test_a_decoded_value_that_is_not_a_direction_has_the_largest_error():
    n = random_directions(8)
    assert np.all(measured_angles(n, np.zeros_like(n)) == 180)
    broken = measured(Meter(jax.jit(lambda block: block.n * jnp.nan)), from_arrays("", "", n, n, np.ones(8, bool)))
    assert broken.angle_max_deg == pytest.approx(180) and broken.mse == pytest.approx(4 / 3)


DECODED = Meter(jax.jit(lambda block: block.view))


def test_only_the_articles_measure_counts_the_background():
    n = random_directions(1000)
    other = turned(n, np.full(1000, 2.0)).astype(np.float32)
    covered = np.arange(1000) < 500
    half = measured(DECODED, from_arrays("", "", n, other, covered))
    only = measured(DECODED, from_arrays("", "", n[:500], other[:500], covered[:500]))
    assert half.count == 500 and half.pixels == 1000
    assert half.mse == pytest.approx(only.mse) and half.angle_mean_deg == pytest.approx(only.angle_mean_deg)
    assert half.article_mse == pytest.approx(only.article_mse / 2)


def test_the_worst_normal_is_the_normal_that_was_rotated_most():
    """The set has several chunks, a background with larger errors, and decoded values that are not numbers."""
    n, degrees = random_directions(CHUNK + 5000), np.full(CHUNK + 5000, 1.0)
    degrees[[77, CHUNK + 3]] = 2.0, 2.5
    covered = np.arange(len(n)) != 5
    other = turned(n, degrees).astype(np.float32)
    other[5] = -n[5]
    stats = measured(DECODED, from_arrays("", "", n, other, covered))
    assert stats.worst.angle_deg == pytest.approx(2.5, abs=1e-4) == pytest.approx(stats.angle_max_deg, abs=1e-4)
    assert np.array_equal(stats.worst.normal, n[CHUNK + 3]) and np.array_equal(stats.worst.decoded, other[CHUNK + 3])
    other[9] = np.nan
    stats = measured(DECODED, from_arrays("", "", n, other, covered))
    assert stats.worst.angle_deg == 180 and np.array_equal(stats.worst.normal, n[9])
    assert measured(DECODED, from_arrays("", "", n[:9], n[:9], covered[:9])).worst.angle_deg == 0


@pytest.mark.usefixtures("gl")
def test_both_backends_report_the_worst_normal():
    """In the row's own columns, the angle between the normal and its decoded value is the largest sampled error."""
    for backend in ("jax", "glsl"):
        row = quality.measure(
            quality.QualityCase(Codec(ENCODINGS["spheremap"], STORAGES["rg8"]), sphere(5000), backend)
        )
        normal, decode = (
            np.array([float(c) for c in row[f"worst_{what}"][1:-1].split(",")]) for what in ("normal", "decode")
        )
        across = np.linalg.norm(np.cross(normal, decode))
        assert np.degrees(np.arctan2(across, normal @ decode)) == pytest.approx(row["angle_max_deg"], rel=1e-5), backend


def test_psnr_matches_scikit_image():
    # Its import takes a second, which collecting these tests does without.
    from skimage.metrics import peak_signal_noise_ratio

    rng = np.random.default_rng(0)
    a, b = rng.uniform(-1, 1, (2, 64, 64, 3))
    assert psnr_db(float(np.mean((a - b) ** 2))) == pytest.approx(peak_signal_noise_ratio(a, b, data_range=1))


def test_identical_normals_have_infinite_psnr():
    row = quality.measure(quality.QualityCase(Codec(ENCODINGS["xyz"], STORAGES["rgba32f"]), sphere(1000), "jax"))
    assert row["psnr_db"] == np.inf and row["exact"] and row["angle_max_deg"] == 0 and row["angle_p99_deg"] == 0


@pytest.mark.parametrize("make, z_mean, z2_mean", [(sphere, 0, 1 / 3), (hemisphere, 1 / 2, 1 / 3)])
def test_uniform_sets_are_uniform(make, z_mean, z2_mean):
    """Moments of a uniform sphere (Archimedes: z is uniform), unit lengths, and equally filled octants."""
    chunk = make(CHUNK).chunk(0)
    n = np.stack([np.asarray(c, np.float64) for c in chunk.n], axis=1)
    assert np.allclose(np.linalg.norm(n, axis=1), 1, atol=3e-7)
    assert n[:, 2].mean() == pytest.approx(z_mean, abs=1e-4)
    assert (n**2).mean(axis=0) == pytest.approx([1 / 3, 1 / 3, z2_mean], abs=1e-4)
    octant = (n > 0) @ [1, 2, 4]
    shares = np.bincount(octant, minlength=8) / len(n)
    expected = np.full(8, 1 / 8) if make is sphere else np.repeat([0, 1 / 4], 4)
    assert shares == pytest.approx(expected, abs=1e-3)


def test_a_uniform_sets_rounding_errors_are_independent():
    """The lengths of its float32 vectors scatter like those of any rounded unit vectors; z is not special."""
    chunk = sphere(CHUNK).chunk(0)
    n = np.stack([np.asarray(c, np.float64) for c in chunk.n], axis=1)
    any_unit = random_directions(CHUNK).astype(np.float64)
    scatter, expected = (np.std(np.linalg.norm(v, axis=1) - 1) for v in (n, any_unit))
    assert scatter == pytest.approx(expected, rel=0.02)
    # On a lattice of z near -1, spheremap would look 14 dB better in 16 bits than it is.
    row = quality.measure(quality.QualityCase(Codec(ENCODINGS["spheremap"], STORAGES["rg16"]), sphere(), "jax"))
    assert row["psnr_db"] == pytest.approx(73.1, abs=1) and row["angle_max_deg"] > 10


def test_another_seed_changes_the_set_but_hardly_the_error():
    a, b, again = (sphere(2**18, seed) for seed in (0, 1, 0))
    x = [np.asarray(s.chunk(0).n.x) for s in (a, b, again)]
    assert np.array_equal(x[0], x[2]) and not np.array_equal(x[0], x[1])
    codec = Codec(ENCODINGS["octahedral"], STORAGES["rgba8"])
    psnr = [quality.measure(quality.QualityCase(codec, s, "jax"))["psnr_db"] for s in (a, b)]
    assert psnr[0] == pytest.approx(psnr[1], abs=0.01)


def test_a_partial_chunk_is_counted_exactly():
    row = quality.measure(quality.QualityCase(Codec(ENCODINGS["xy"], STORAGES["rgba8"]), sphere(CHUNK + 7), "jax"))
    assert row["count"] == CHUNK + 7


def test_the_largest_count_can_be_addressed():
    """The last chunk of the largest set is complete and finite."""
    last = sphere(counts.MAX_COUNT).chunk(counts.MAX_COUNT - CHUNK)
    assert np.asarray(last.covered).all()
    assert np.all(np.isfinite(np.asarray(last.n.z)))


def test_nothing_is_simplified_across_a_storage_without_rounding():
    """One program that encodes and decodes agrees with two programs, so the row measures the error of float32."""
    (codec,) = codecs_named("spherical:scale=0.3", "rgba32f", "nearest")
    chunk = hemisphere(CHUNK).chunk(0)
    fused = jax.jit(codec.round_trip)(chunk.n, chunk.view)
    stored = jax.jit(codec.stored)(chunk.n, chunk.view)
    two = jax.jit(codec.encoding.decode)(stored, chunk.view)
    worst = max(float(np.abs(np.asarray(a) - np.asarray(b)).max()) for a, b in zip(fused, two, strict=True))
    assert worst <= 2.0**-23, worst


def test_work_in_flight_is_bounded():
    taken = []
    results = on_all_cores(lambda i: i, (taken.append(i) or i for i in range(1000)))
    assert next(results) == 0
    assert len(taken) <= 2 * cores()
    assert list(results) == list(range(1, 1000))


def rows_of(normals, names=("octahedral", "spherical", "xyz")) -> list[dict]:
    codecs = [Codec(ENCODINGS[name], STORAGES["rgba8"]) for name in names]
    return list(quality.rows(quality.cases(codecs, [normals], ["jax"]), lambda _: None))


def test_a_chunk_is_made_once_for_all_codecs():
    starts, normals = [], sphere(2 * CHUNK)
    counted = replace(normals, chunk=lambda start: (starts.append(start), normals.chunk(start))[1])
    rows_of(counted)
    assert sorted(starts) == [0, CHUNK]


def test_uniform_sets_are_computed_in_float64_and_rounded_once():
    """NumPy's float64 sines of the same sequence, rounded, differ in about one value per million."""
    n = sphere(CHUNK, 3).chunk(0).n
    offsets = np.random.default_rng(3).integers(0, 2**32, 2, dtype=np.uint32)
    index = np.arange(CHUNK, dtype=np.uint64)
    u, v = (((index * s + o) % 2**32 + 0.5) * 2.0**-32 for s, o in zip(STEPS, offsets.astype(np.uint64), strict=True))
    r = 2 * np.sqrt(u * (1 - u))
    for ours, exact in zip(n, (np.cos(2 * np.pi * v) * r, np.sin(2 * np.pi * v) * r, 1 - 2 * u), strict=True):
        assert np.count_nonzero(np.asarray(ours) != exact.astype(np.float32)) <= 3
