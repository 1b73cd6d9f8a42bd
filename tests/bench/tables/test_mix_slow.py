"""`normalbench mix`: the effect of filters, mip levels, resolves and blending on stored codes."""

import json
import re
from ast import literal_eval

import numpy as np
import pytest
import test_mix
from test_mix import COUNT, SAMPLES, angle_deg, codec, rows_of

from normalbench.bench.subjects.normals.normal_sets import NORMAL_SETS
from normalbench.bench.tables.mix.figures import error_of_percent
from normalbench.bench.tables.mix.judge import judgement
from normalbench.bench.tables.mix.measure import MixCase, measure
from normalbench.bench.tables.mix.model import BY_MODEL
from normalbench.bench.tables.mix.patches import SIDE, mixes_of, patches_of
from normalbench.bench.tables.mix.table import AGREE_DEG, OPERATIONS

rows = test_mix.rows


OWN = "its own arithmetic"


def on_sphere(name: str, operations: tuple[str, ...], seed: int = 0, worst_case: bool = False):
    """Return the rows of a codec on the whole sphere, with normals 5 degrees apart, computed by the model."""
    (patches,) = patches_of(NORMAL_SETS["sphere"](COUNT, seed), (5.0,), COUNT, seed)
    return measure(MixCase(codec(name), mixes_of(patches, SAMPLES), "jax", operations, 64.0, worst_case=worst_case))


def test_the_fold_of_octahedral_and_the_wrap_of_spherical_are_reported(rows):
    """Octahedral fails between normals with z < 0 across x = 0 or y = 0; spherical with x < 0 across y = 0."""
    for row in rows:
        pair = np.array([[float(c) for c in row[f"worst_{end}"][1:-1].split(",")] for end in ("first", "second")])
        if row["operation"] not in ("filter", "mip_2x2", "resolve", "blend"):
            continue
        if row["encoding"] == "xyz_renormalised":
            assert row["garbage_percent"] == 0, row
        if row["encoding"] == "octahedral":
            signs = pair[:, :2] < 0
            assert row["garbage_percent"] > 5 and pair[:, 2].max() < 0, (row["operation"], pair)
            assert (signs[0] != signs[1]).any(), (row["operation"], pair)
        if row["encoding"] == "spherical":
            is_pole = np.abs(pair[:, 2]).max() > 0.9
            assert row["garbage_percent"] > 5, row
            assert is_pole or (pair[:, 0].max() < 0.1 and pair[:, 1].min() < 0 < pair[:, 1].max()), pair
    named = {row["encoding"]: row for row in rows if row["backend"] == "jax"}
    assert named["octahedral"]["filterable"] == named["spherical"]["resolvable"] == "no"
    assert re.search(r"garbage, up to \d+ degrees off: \(.*\) with \(.*\) gives \(", named["octahedral"]["why"])
    assert [named["xyz_renormalised"][name] for name in ("filterable", "blendable", "resolvable")] == ["yes"] * 3


@pytest.mark.parametrize("storage", ["rg8", "rg8_snorm", "rgb10a2"])
@pytest.mark.usefixtures("gl")
def test_device_and_model_agree_or_the_row_says_how_the_device_mixes(storage):
    """Angles agree to 0.01 degrees for the codes that the device stored. 8-bit UNORM filters use 8-bit fractions."""
    for name in ("octahedral", "xy_sign"):
        for operation, row in rows_of(f"{name}/{storage}", "glsl").items():
            is_told = operation in BY_MODEL and row["mixed_by"].startswith(OWN)
            # What is decoded and stored again may round the other way where the two halves differ by a unit.
            assert is_told or row["agree_percent"] > 99, (storage, operation, row["agree_percent"], row["mixed_by"])
            if operation in ("filter", "resolve"):
                assert row["agree_percent"] == 100 or is_told, (storage, operation, row["agree_percent"])
    assert AGREE_DEG == 0.01


@pytest.mark.usefixtures("gl")
def test_a_filters_fractions_are_probed(gl):
    """llvmpipe filters RG8 as integers with fractions of 8 bits, and half floats as floats."""
    if "llvmpipe" not in gl.renderer:
        pytest.skip("another device filters in its own way")
    ways = [rows_of(f"octahedral/{s}", "glsl", ("filter",))["filter"]["mixed_by"] for s in ("rg8", "rg16f")]
    assert ways == ["integers, fractions of 8 bits", "32-bit floats"]


def test_patches_of_an_image_are_its_neighbouring_pixels():
    playground = NORMAL_SETS["playground"](0, 0)
    given, edges = patches_of(playground, (5.0,), 64, 0)
    planes = [np.asarray(c) for load in playground.loads() for c in [np.stack(load().n, axis=1)]]
    image = np.concatenate(planes)[: playground.count].reshape(*playground.shape, 3)
    for patch in range(3):
        block = given.normals[:, patch].reshape(SIDE, SIDE, 3)
        positions = np.argwhere(np.abs(image - block[0, 0]).max(axis=-1) < 1e-6)
        squares = (image[y : y + SIDE, x : x + SIDE] for y, x in positions)
        assert any(square.shape == block.shape and np.abs(square - block).max() < 1e-6 for square in squares)
    assert given.angle_deg is None and given.count + edges.count == 64 and given.edge_deg is None
    grid = edges.normals.reshape(SIDE, SIDE, -1, 3)
    steepest = np.maximum(
        angle_deg(grid[1:], grid[:-1]).max(axis=(0, 1)), angle_deg(grid[:, 1:], grid[:, :-1]).max(axis=(0, 1))
    )
    assert steepest.min() > 20 and edges.edge_deg > 20, (steepest.min(), edges.edge_deg)


def test_octahedral_can_be_filtered_where_z_is_not_negative():
    """The seams of octahedral are at z < 0; the sentence says what goes wrong on the whole sphere."""
    sphere = NORMAL_SETS["sphere"](64, 0)
    inside = judgement(codec("octahedral/rg8"), ("filter", "blend"), sphere, "sphere").inside
    assert set(inside) == {"filter", "blend"} and "garbage, up to" in inside["filter"], inside
    assert not judgement(codec("octahedral/rg8"), ("filter", "blend", "resolve"), sphere, "hemisphere").inside


def test_an_encoding_may_survive_inside_a_surface_but_not_across_an_edge():
    """xyz / max |n| weights normals by another length; xyz is linear. Decoding first makes edges irrelevant."""
    sphere = NORMAL_SETS["sphere"](64, 0)
    verdict = judgement(codec("xyz_largest/rgba8"), ("filter", "upsample"), sphere, "sphere")
    assert not verdict.inside and set(verdict.across) == {"filter"}, verdict
    assert "an edge of 60 degrees" in verdict.across["filter"], verdict
    verdict = judgement(codec("xyz_renormalised/rgba8"), ("filter", "upsample"), sphere, "sphere")
    assert (verdict.inside, verdict.across) == ({}, {}), verdict


def test_best_fit_loses_its_advantage_if_it_is_filtered():
    """Texels of best_fit differ in length, which weights the normals. Unfiltered texels are 4 times as accurate."""
    sphere = NORMAL_SETS["sphere"](64, 0)
    own, plain = (
        judgement(codec(name), ("filter",), sphere, "sphere") for name in ("best_fit/rgba8", "xyz_largest/rgba8")
    )
    assert not own.inside and own.mean_deg > 1.5 * plain.mean_deg > 0.2, (own, plain)


@pytest.mark.parametrize("name", ["xy_sign/rg8", "octahedral/rg8", "spherical/rg8"])
def test_no_encoding_in_rg8_can_be_filtered_on_the_whole_sphere(name):
    """xy_sign is off by 6 degrees alone and by 9 after a mip; its own error does not excuse this. All encodings can
    be upsampled."""
    verdict = judgement(codec(name), ("filter", "upsample"), NORMAL_SETS["sphere"](64, 0), "sphere")
    assert set(verdict.inside) == {"filter"} and "upsample" not in verdict.across, verdict


def test_the_standard_error_matches_the_scatter_between_seeds():
    seed_rows = [on_sphere("octahedral/rg8", ("mip_4x4",), seed)[0] for seed in range(24)]
    scatter = np.std([row["garbage_percent"] for row in seed_rows], ddof=1)
    assert scatter == pytest.approx(np.mean([row["garbage_error_percent"] for row in seed_rows]), rel=0.5)
    none = error_of_percent(np.zeros(98, bool))
    # By hand: a share of 1 / 100, sqrt(0.01 x 0.99 / 101).
    assert none == pytest.approx(100 * 0.0099005, rel=1e-3)


@pytest.mark.usefixtures("gl")
def test_the_command_writes_rows_and_a_plot(run, tmp_path):
    words = ("mix", "--encoding", "xyz,xy", "--angle", "5", "--edge", "none", "--normals", "axes", "--count", "64")
    words += ("--backend", "jax")
    plot, out = tmp_path / "mix.png", tmp_path / "rows.json"
    status, _, err = run(*words, "--plot", str(plot), "-o", str(out))
    assert status == 0 and plot.read_bytes().startswith(b"\x89PNG"), err
    assert len(json.loads(out.read_text())) == 2 * len(OPERATIONS)


@pytest.mark.parametrize("storage", ["rg16", "rg16f", "rgba32f", "rgb8_12_12"])
@pytest.mark.usefixtures("gl")
def test_device_and_model_agree_or_the_row_says_how_the_device_mixes_in_wider_storages(storage):
    test_device_and_model_agree_or_the_row_says_how_the_device_mixes(storage)


@pytest.mark.usefixtures("gl", "radv")
def test_pick_leaves_out_encodings_that_do_not_survive_mixing(run):
    words = ("pick", "--encoding", "octahedral,xy_sign", "--storage", "rg8", "--count", "4096")
    status, out, _ = run(*words)
    assert status == 0 and "take octahedral" in out and "cannot be" not in out
    status, out, _ = run(*words, "--needs", "filter")
    text = " ".join(out.split())
    assert status == 1 and "no encoding qualifies (that survives filter)" in text, text
    assert "(cannot be filtered; octahedral: normals 1 degree apart on axes" in text, text
    status, out, _ = run(*words, "--needs", "filter", "--domain", "tangent")
    text = " ".join(out.split())
    assert status == 0 and "take octahedral" in text and "It survives filter, inside a surface" in text, text
    assert "Across an edge: an edge of 60 degrees" in text, text
    status, out, _ = run(*words, "--needs", "upsample")
    assert status == 0 and "take octahedral" in out and "works with every encoding" in " ".join(out.split())


def check_the_worst_mixes(*operations):
    """Check the worst mixes. The mean of octahedral codes at opposite corners of the square, both -z, is +z: it is
    180 degrees off. An encoding without a seam in its domain stays within the errors of its texels and its kinks."""
    for name, least, most in (("octahedral/rg8", 179.0, 180.0), ("hemi_octahedral/rg8", 1.0, 3.5)):
        for row in on_sphere(name, operations, worst_case=True):
            assert row["angle_max_deg"] <= row["angle_worst_deg"] and least <= row["angle_worst_deg"] <= most, row
            right, result = (np.array(literal_eval(row[f"worst_{which}"])) for which in ("right", "result"))
            assert angle_deg(right, result / np.linalg.norm(result)) == pytest.approx(row["angle_worst_deg"], abs=0.2)


def test_the_worst_mix_is_found():
    check_the_worst_mixes("filter", "blend")
    (row,) = on_sphere("octahedral/rg8", ("filter",))
    assert row["angle_worst_deg"] is None and row["angle_max_deg"] < 179, "a sample misses it"
