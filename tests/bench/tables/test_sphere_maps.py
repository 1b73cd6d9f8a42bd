"""Errors over the sphere and their histograms: rows and files agree."""

import numpy as np
import pytest

from normalbench.bench.measures.metrics import histogram as metrics
from normalbench.bench.subjects.normals.normal_sets import playground
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.quality import sphere_maps
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import ROUNDINGS, STORAGES


def codec(name: str, storage: str = "rgba8") -> Codec:
    return Codec(ENCODINGS[name], STORAGES[storage])


def test_cells_have_equal_areas_and_the_first_half_faces_the_viewer():
    halves, inside = sphere_maps._grid()
    directions = halves[:, inside].astype(np.float64)
    assert np.allclose(np.linalg.norm(directions, axis=-1), 1, atol=1e-6)
    assert directions[0, :, 2].min() >= 0 >= directions[1, :, 2].max()
    # Archimedes: of equal areas z is uniform.
    shares = np.histogram(directions[0, :, 2], bins=10, range=(0, 1))[0] / len(directions[0])
    assert shares == pytest.approx(np.full(10, 0.1), abs=0.002)
    top = halves[0, 2, inside.shape[0] // 2]
    assert top[1] > 0.98, "y is up"


def test_the_spheremap_is_least_accurate_directly_away_from_the_viewer():
    means = sphere_maps.sphere_map(codec("spheremap")).mean_deg
    middle = slice(sphere_maps.CELLS // 2 - 4, sphere_maps.CELLS // 2 + 4)
    towards, away = (half[middle, middle].mean() for half in means)
    assert away > 10 * towards, f"{away:.2f} away, {towards:.2f} towards"
    worst = np.unravel_index(np.nanargmax(means), means.shape)
    assert worst[0] == 1 and abs(worst[1] - 47.5) < 5 > abs(worst[2] - 47.5), worst


def test_normals_that_an_encoding_cannot_represent_are_left_out():
    assert np.isnan(sphere_maps.sphere_map(codec("xy")).mean_deg[1]).all()
    assert not np.isnan(sphere_maps.sphere_map(codec("octahedral")).mean_deg[1]).all()


def test_maps_are_read_as_written_and_damaged_maps_are_ignored(tmp_path):
    sphere_maps.write_maps([codec("octahedral")], tmp_path)
    path = tmp_path / sphere_maps.file_name("octahedral", "rgba8", "nearest")
    first, kept = path.read_bytes(), sphere_maps.read_map(path)
    sphere_map = sphere_maps.sphere_map(codec("octahedral"))
    assert kept and np.array_equal(kept.mean_deg, sphere_map.mean_deg, equal_nan=True)
    assert kept.directions == sphere_map.directions == 25
    sphere_maps.write_maps([codec("octahedral")], tmp_path)
    assert path.read_bytes() == first, "the same file whenever it is written"
    for data in (first[:-100], b"", b"PK", b"\x80\x04."):
        path.write_bytes(data)
        assert sphere_maps.read_map(path) is None
    np.savez(path, mean_deg=np.zeros(3), max_deg=np.zeros(3), directions=1)
    assert sphere_maps.read_map(path) is None, "of another shape"
    assert sphere_maps.read_map(tmp_path / "none.npz") is None


@pytest.mark.usefixtures("gl")
def test_no_two_codecs_share_a_file():
    """Codecs that differ only in their rounding have separate files too."""
    names = {sphere_maps.file_name("xy", storage, way) for storage in ("rg8", "rgba8") for way in ROUNDINGS}
    assert len(names) == 2 * len(ROUNDINGS)


@pytest.mark.parametrize("backend", ["jax", "glsl"])
def test_a_rows_histogram_counts_every_normal_and_agrees_with_its_angles(backend):
    measured = quality.measure(quality.QualityCase(codec("octahedral"), playground(), backend))
    bins = [tuple(map(float, word.split(":"))) for word in measured["angle_counts"].split()]
    edges, counts = np.array(bins).T
    assert counts.sum() == measured["count"] and (counts > 0).all() and (np.diff(edges) > 0).all()
    widths = np.maximum(2.0 ** np.floor(np.log2(np.maximum(edges, 2.0**-40))) / 8, 2.0**-43)
    low, high = (counts @ edge / counts.sum() for edge in (edges, edges + widths))
    assert low <= measured["angle_mean_deg"] <= high
    assert edges[-1] <= measured["angle_max_deg"] <= edges[-1] + widths[-1]
    tail = counts[::-1].cumsum()[::-1] / counts.sum()
    assert edges[tail >= 0.01][-1] <= measured["angle_p99_deg"] <= (edges + widths)[tail >= 0.01][-1]


def test_zero_errors_are_in_the_first_bin():
    histogram = np.zeros(metrics.BINS + 1, np.int64)
    histogram[0] = 5
    assert metrics.counts_by_angle(histogram) == ((0.0, 5),)
