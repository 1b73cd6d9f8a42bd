"""Errors over the sphere and their histograms: rows and files agree."""

import numpy as np
import pytest
from test_sphere_maps import codec

from normalbench.bench.subjects.normals.normal_sets import hemisphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.quality import sphere_maps
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES


def test_a_codec_without_a_jax_twin_is_mapped_by_glsl(gl, monkeypatch):  # noqa: ARG001
    """The angles agree with JAX to within the error of float32."""
    codec = Codec(ENCODINGS["octahedral"], STORAGES["rg8"])
    by_jax = sphere_maps.sphere_map(codec)
    monkeypatch.setattr(sphere_maps, "has_twin", lambda _: False)
    by_glsl = sphere_maps.sphere_map(codec)
    assert np.nanmax(np.abs(by_jax.mean_deg - by_glsl.mean_deg)) < 1e-4
    assert np.nanmax(np.abs(by_jax.max_deg - by_glsl.max_deg)) < 1e-3


def row(name: str, normals) -> dict:
    return quality.measure(quality.QualityCase(codec(name), normals, "jax"))


@pytest.mark.parametrize("name", ["octahedral", "xy", "spheremap", "spherical"])
def test_a_map_agrees_with_the_hemisphere_row(name):
    """Weighted by their directions, the cells have the mean of the uniform set and nearly its largest angle."""
    sphere_map = sphere_maps.sphere_map(codec(name))
    cells, fine = sphere_maps.CELLS, sphere_maps.FINE
    weights = sphere_maps._grid()[1].reshape(cells, fine, cells, fine).sum(axis=(1, 3))
    measured = row(name, hemisphere(2**20))
    mean = np.nansum(sphere_map.mean_deg[0] * weights) / weights.sum()
    assert mean == pytest.approx(measured["angle_mean_deg"], rel=0.01)
    assert 0.85 * measured["angle_max_deg"] <= np.nanmax(sphere_map.max_deg[0]) <= 1.01 * measured["angle_max_deg"]
