"""Encoders whose codes are in [0, 1]: one rule for every language, and stored as an engine writes them."""

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


def test_signed_and_float_targets_hold_what_the_engine_writes(run):
    """Of the same bits half are used: 1 dB is a sixth of a bit, and twice the angle is one bit."""
    rows = figures(run, "unit.glsl,octahedral", "rg8,rg8_snorm,rg16f,rg16_snorm", "--backend", "glsl")
    means = {name: row["angle_mean_deg"] for name, row in rows.items()}
    assert means["dir", "rg16f"] == pytest.approx(0.0296, rel=0.01)
    assert means["octahedral", "rg16f"] == pytest.approx(0.0150, rel=0.01)
    for storage in ("rg8_snorm", "rg16_snorm"):
        assert means["dir", storage] == pytest.approx(2 * means["octahedral", storage], rel=0.01), storage
    assert {(name, row["code_range"]) for (name, _), row in rows.items()} == {("dir", "[0, 1]"), ("octahedral", None)}


def test_a_layout_holds_what_the_engine_writes(run):
    """Of an image the normals lose about a bit in signed and float targets, and nothing in unsigned ones."""
    storages = "rg8,rg8_snorm,rg16f"
    words = ("--size", "160x100", "--repeats", "1", "--scene", "room", "--format", "json")
    status, out, err = run("render", "--encoding", "unit.glsl,octahedral", "--storage", storages, *words)
    found = {(row["encoding"], row["storage"]): row["normal_psnr_db"] for row in json.loads(out)}
    assert status == 0, err
    loss = {storage: found["octahedral", storage] - found["dir", storage] for storage in storages.split(",")}
    # A room has few directions: more or less than 6 dB is chance.
    assert abs(loss["rg8"]) < 0.05 and 4 < loss["rg8_snorm"] < 12 and 4 < loss["rg16f"] < 12, loss


def test_a_twin_of_such_codes_is_measured_the_same(run, tmp_path):
    (tmp_path / "unit.py").write_text(TWIN)
    for storage in ("rg8", "rg16f", "rg16_snorm"):
        status, out, err = run("quality", "--encoding", "unit.glsl", "--storage", storage, *SPHERE)
        by_jax, by_gl = json.loads(out)
        assert (status, err) == (0, "")
        assert by_jax["psnr_db"] == pytest.approx(by_gl["psnr_db"], abs=0.02), storage


@pytest.mark.parametrize("storage", ["rg8_snorm", "rg16f"])
def test_code_of_such_an_encoder_is_verified(run, storage):
    """What `code` writes gives the texels that were measured."""
    status, out, err = run("code", "unit.glsl", "--storage", storage, "--to", "c")
    assert status == 0 and "dir" in out, err
