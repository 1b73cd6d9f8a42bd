"""The normals that browsers encode, and the checksums of a codec's codes for these normals."""

import base64
import json

import numpy as np
import pytest

from normalbench.bench.measures.live import checks, kept, normals
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

OCTAHEDRAL = Codec(ENCODINGS["octahedral"], STORAGES["rgb10a2"])


# Of normals and of views, as Python and Chromium 156 make them, 2026.
SUMS = {"sphere": [3911770442, 2656752413], "hemisphere": [1654182782, 2656752413], "view": [1989013, 2656752413]}


@pytest.mark.parametrize("domain", SUMS)
def test_normals_have_the_same_bits_on_every_machine(domain):
    """Pages are read for years, so a new version of a library must not change the checksums."""
    assert checks.sums(domain) == SUMS[domain]


@pytest.mark.parametrize("domain", SUMS)
def test_normals_are_in_their_domain_and_have_unit_length(domain):
    n, view = normals.normals(domain)
    assert n.shape == view.shape == (2**16, 3) and n.dtype == view.dtype == np.float32
    assert abs(np.linalg.norm(n.astype(float), axis=1) - 1).max() < 4e-7
    if domain == "hemisphere":
        assert n[:, 2].min() >= 0
    if domain == "view":
        assert np.sum(n.astype(float) * view, axis=1).max() < 1e-6
    assert (view[:, 2] <= -0.5).all()


def test_random_normals_are_uniform():
    """Each component of a uniform direction is uniform in [-1, 1]: mean 0 and variance 1/3."""
    n = normals.normals("sphere")[0][len(normals.hard()) :].astype(float)
    assert abs(n.mean(axis=0)).max() < 0.01
    assert abs(n.var(axis=0) - 1 / 3).max() < 0.005


def test_hard_normals_include_both_signed_zeros_and_neighbouring_floats():
    n = normals.hard()
    zeros = n[(n == 0).any(axis=1)]
    assert np.signbit(zeros[zeros == 0]).any() and not np.signbit(zeros[zeros == 0]).all()
    diagonal = np.abs(n - np.float32(3**-0.5)).max(axis=1)
    assert 3 <= ((diagonal > 0) & (diagonal < 1e-7)).sum() < 10


def test_two_sign_changes_change_the_checksum():
    """A plain sum of weighted words would reveal only whether an odd number of signs changed."""
    array = np.ones(64, np.float32)
    other = array.copy()
    other[[3, 5]] = -1
    assert checks.checksum(array) != checks.checksum(other)


def test_a_step_changes_the_sum_of_its_group_by_its_weight():
    codes = np.arange(2 * checks.GROUP * 3, dtype=np.int32).reshape(-1, 3)
    stepped = codes.copy()
    stepped[checks.GROUP + 7, 1] -= 1
    apart = checks.group_sums(codes) - checks.group_sums(stepped)
    assert apart.tolist() == [0, checks.weights()[7, 1]]


def test_codes_are_numbered_in_the_order_of_their_values():
    """From the smallest positive float to 0 is one step, and from 0 to the largest negative float another."""
    codec = Codec(ENCODINGS["xy"], STORAGES["rg16f"])
    n = np.array([[2.0**-24, -(2.0**-24), 1], [0, 0, 1]], np.float32)
    reference = checks.reference_of(codec, n, np.zeros_like(n), compiled=False)
    assert checks.ordered(codec, reference).tolist() == [[1, -1], [0, 0]]


def test_checks_in_a_file_are_complete_or_left_out(tmp_path):
    """A run's folder may be edited, and its normals may come from another version."""
    kept.write_live([OCTAHEDRAL], tmp_path)
    (path,) = tmp_path.iterdir()
    (whole,), left_out = kept.read_live(tmp_path)
    assert whole["checks"] and not left_out
    short = base64.b64encode(bytes(8)).decode()
    for change in ({"normals": 1}, {"groups": short}, {"sample": ""}, {"numbers": "A==="}):
        record = {**whole, "checks": {**whole["checks"], **change}}
        path.write_text(json.dumps(record))
        (read,), left_out = kept.read_live(tmp_path)
        assert read["checks"] is None and not left_out, change
    for change in ({"mean_deg": -1.0}, {"groups": 3}, {"more": 1}):
        path.write_text(json.dumps({**whole, "checks": {**whole["checks"], **change}}))
        assert kept.read_live(tmp_path) == ([], {path.name: "its file is damaged"}), change
