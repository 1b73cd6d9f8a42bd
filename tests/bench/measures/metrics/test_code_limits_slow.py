"""The error bound for N codes: its values, measurements that respect it and wrong measures that are caught."""

import math

import numpy as np
import pytest
from exact_codes import nearest_of, storage
from test_code_limits import COUNT, row_of

from normalbench.bench.measures.metrics.code_limits import SPHERE
from normalbench.bench.subjects.normals.normal_sets import from_arrays, hemisphere, sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

# One of each size and kind in every run.
SOME = ("rg8", "rgb10a2", "rg16f", "rgba8_snorm")


@pytest.mark.parametrize("name", SOME)
def test_no_row_is_below_its_bound(name):
    """The whole catalogue is measured: every encoding that fits, on the sphere and on a hemisphere."""
    codecs = [Codec(encoding, STORAGES[name]) for encoding in ENCODINGS.values()]
    cases = quality.cases([c for c in codecs if c.fits], [sphere(COUNT), hemisphere(COUNT)], ["jax"])
    for row in quality.rows(cases, lambda _: None):
        assert not row["below_limit"], row
        held = row["limit_rms_deg"] > 1e-5
        assert (row["below_limit"] == "") == held == (row["reached_rms_percent"] is not None)
        if held:
            assert row["effective_bits"] <= math.log2(row["codes"]) + 0.01, row


def polar_directions(count: int, seed: int) -> np.ndarray:
    """Return directions with uniform angles, which crowd the poles: the most common mistake for a uniform sphere."""
    polar, azimuth = np.random.default_rng(seed).uniform(0, [[np.pi], [2 * np.pi]], (2, count))
    return np.stack([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)], axis=1)


def settled(directions: np.ndarray, count: int) -> np.ndarray:
    """Return points that are the means of their nearest directions (S. Lloyd's iteration)."""
    from scipy.spatial import cKDTree

    points = directions[:count]
    for _ in range(30):
        nearest = cKDTree(points).query(directions)[1]
        sums = np.stack([np.bincount(nearest, axis, count) for axis in directions.T], axis=1)
        points = sums / np.linalg.norm(sums, axis=1, keepdims=True)
    return points


def test_directions_that_are_not_uniform_are_caught():
    """A code fitted to a set that crowds the poles beats the bound on that set, but not on a uniform set."""
    side = 24
    codec = Codec(nearest_of(settled(polar_directions(2**16, 0), side**2), side), storage("unorm", 5, 5))
    n = polar_directions(COUNT, 1).astype(np.float32)
    said_to_be_uniform = from_arrays("sphere", "", n, -n, np.ones(COUNT, bool))
    object.__setattr__(said_to_be_uniform, "area", SPHERE)
    assert codec.codes == side**2
    assert row_of(codec, said_to_be_uniform)["below_limit"].startswith("mean")
    assert row_of(codec, sphere(COUNT))["below_limit"] == ""
