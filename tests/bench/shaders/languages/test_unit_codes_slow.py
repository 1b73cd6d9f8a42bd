"""Encoders whose codes are in [0, 1], recognised alike in every language and stored as an engine writes them."""

import json

import pytest
import test_unit_codes
from test_unit_codes import SPHERE, figures

pytestmark = pytest.mark.usefixtures("gl")
_here = test_unit_codes._here


TWIN = """
from normalbench.encodings.normals import octahedral


def encode(n, view):
    return octahedral.encode(n, view) * 0.5 + 0.5


def decode(e, view):
    return octahedral.decode(e * 2.0 - 1.0, view)
"""


def test_signed_and_float_targets_store_codes_as_the_engine_does(run):
    """Only half of the codes are used: 1 dB is a sixth of a bit, and twice the angle is one bit."""
    rows = figures(run, "unit.glsl,octahedral", "rg8,rg8_snorm,rg16f,rg16_snorm", "--backend", "glsl")
    means = {name: row["angle_mean_deg"] for name, row in rows.items()}
    assert means["dir", "rg16f"] == pytest.approx(0.0296, rel=0.01)
    assert means["octahedral", "rg16f"] == pytest.approx(0.0150, rel=0.01)
    for storage in ("rg8_snorm", "rg16_snorm"):
        assert means["dir", storage] == pytest.approx(2 * means["octahedral", storage], rel=0.01), storage
    assert {(name, row["code_range"]) for (name, _), row in rows.items()} == {("dir", "[0, 1]"), ("octahedral", None)}


def test_a_layout_stores_codes_as_the_engine_does(run):
    """In an image, normals lose about one bit in signed and float targets, and nothing in unsigned targets."""
    storages = "rg8,rg8_snorm,rg16f"
    words = ("--size", "160x100", "--repeats", "1", "--scene", "room", "--format", "json")
    status, out, err = run("render", "--encoding", "unit.glsl,octahedral", "--storage", storages, *words)
    psnr_db = {(row["encoding"], row["storage"]): row["normal_psnr_db"] for row in json.loads(out)}
    assert status == 0, err
    loss = {storage: psnr_db["octahedral", storage] - psnr_db["dir", storage] for storage in storages.split(",")}
    # A room has few directions: more or less than 6 dB is chance.
    assert abs(loss["rg8"]) < 0.05 and 4 < loss["rg8_snorm"] < 12 and 4 < loss["rg16f"] < 12, loss


def test_python_twin_of_unit_codes_gives_the_same_figures(run, tmp_path):
    (tmp_path / "unit.py").write_text(TWIN)
    for storage in ("rg8", "rg16f", "rg16_snorm"):
        status, out, err = run("quality", "--encoding", "unit.glsl", "--storage", storage, *SPHERE)
        by_jax, by_gl = json.loads(out)
        assert (status, err) == (0, "")
        assert by_jax["psnr_db"] == pytest.approx(by_gl["psnr_db"], abs=0.02), storage


@pytest.mark.parametrize("storage", ["rg8_snorm", "rg16f"])
def test_written_code_for_unit_codes_is_verified(run, storage):
    """The code that `code` writes gives the measured texels."""
    status, out, err = run("code", "unit.glsl", "--storage", storage, "--to", "c")
    assert status == 0 and "dir" in out, err
