"""Tuned encodings: fits that agree with theory, and gains on held-out normals."""

import itertools
import json
import math
from dataclasses import replace

import numpy as np
import pytest
from test_tune import all_of
from typed import codecs_named

from normalbench.bench.subjects.normals.normal_sets import playground, sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.tune.halves import Normals, halves_of
from normalbench.bench.tables.tune.tuning import Values, fitted
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.normals import best_fit
from normalbench.encodings.storages.rules import storage_of
from normalbench.encodings.storages.storage import STORAGES

FINE = "rgb8_12_12"


def codec_of(encoding: str, storage: str) -> Codec:
    named_storage = storage_of(storage)
    assert named_storage
    return Codec(ENCODINGS[encoding], named_storage)


def tuned(codec: Codec, normals: Normals, goal: str) -> Values:
    return fitted(codec, normals, goal, list(codec.encoding.published))


def seen(n: np.ndarray, view: np.ndarray) -> Normals:
    """Return the unit normals that face the eye along their rays, with these rays."""
    faces = np.sum(n * view, axis=1) < 0
    return Normals(n[faces].astype(np.float32), view[faces].astype(np.float32))


def ball_that_fills_the_view(fov_deg: float, count: int) -> Normals:
    """Return the visible normals of a sphere of radius 1 straight ahead whose outline touches a round view."""
    n = all_of(sphere(count)).n.astype(np.float64)
    return seen(n, n - [0, 0, 1 / math.sin(math.radians(fov_deg / 2))])


def anything_in_the_view(fov_deg: float, count: int) -> Normals:
    """Return normals of surfaces of every slope on rays all over a round view, half of them at its edge."""
    random = np.random.default_rng(1)
    edge = math.cos(math.radians(fov_deg / 2))
    z = np.where(random.uniform(size=count) < 0.5, edge, random.uniform(edge, 1, count))
    around, r = random.uniform(0, 2 * math.pi, count), np.sqrt(1 - z * z)
    return seen(all_of(sphere(count)).n, np.stack([r * np.cos(around), r * np.sin(around), -z], axis=1))


@pytest.mark.parametrize(
    "view, farthest_deg",
    # The outline of a ball that fills a view of 60 degrees is where rays, 30 degrees off the axis, touch it.
    # Whatever else is in such a view may turn 90 degrees from a ray that is 30 degrees off the axis itself.
    [(ball_that_fills_the_view, 90 - 30), pytest.param(anything_in_the_view, 90 + 30, marks=pytest.mark.drawn(3))],
)
def test_the_stereographic_scale_matches_theory(view, farthest_deg):
    """tan(t / 2) for normals up to t from the axis: 0.577 for a ball in a view of 60 degrees, 1.732 for anything.

    The tuned scale is lower by at most as much as clipping costs less than wider steps: at the disk's edge a step is
    cos^2(t / 2) of a step at its centre, whose worst normal is off by sqrt(2) half steps.
    """
    normals = view(60.0, 2**18)
    farthest = math.degrees(math.acos(normals.n[:, 2].min()))
    assert farthest == pytest.approx(farthest_deg, abs=0.5), "and no sample is farther than theory says"
    theory = math.tan(math.radians(farthest_deg / 2))
    scale = tuned(codec_of("stereographic", FINE), normals, "max")["scale"]
    assert scale == pytest.approx(theory, rel=0.01), (scale, theory)
    # With 8 bits that is up to 6 half steps of 1 / 255, and what the farthest sample is short of the edge.
    coarse = tuned(codec_of("stereographic", "rg8"), normals, "max")["scale"]
    assert theory * (1 - 7 / 255) <= coarse <= theory * (1 + 1 / 255), (coarse, theory)


def test_mean_errors_never_need_a_larger_scale_than_theory():
    """Every step of stereographic is as wide as the scale, so nothing is gained beyond the last normal."""
    for goal, view in itertools.product(("psnr", "mean"), (ball_that_fills_the_view, anything_in_the_view)):
        normals = view(60.0, 2**16)
        edge = math.tan(math.acos(normals.n[:, 2].min()) / 2)
        scale = tuned(codec_of("stereographic", "rg8"), normals, goal)["scale"]
        assert 0.6 * edge < scale < 1.005 * edge, (goal, scale, edge)


def test_the_scale_published_in_2010_is_nearly_the_best():
    """On the scene of 2010, with arms that were added here, the tuned scale is no worse than 1.7777 and less than one
    decibel better."""
    chosen = halves_of(playground(), 0, by_tiles=False)
    codec = codec_of("stereographic", "rg8")
    parameters = tuned(codec, chosen.fitting, "psnr")
    before, after = (
        quality.measure(quality.QualityCase(replace(codec, encoding=e), chosen.held_out, "jax"))["psnr_db"]
        for e in (codec.encoding, codec.encoding.with_parameters(parameters))
    )
    assert before <= after < before + 1.0, parameters


def rows_of(run, *arguments: str) -> tuple[dict[str, dict], str]:
    status, out, err = run("tune", *arguments, "--format", "json")
    assert status == 0, err
    return {row["quantity"]: row for row in json.loads(out)}, err


def test_the_gain_is_measured_on_the_held_out_half(run):
    """Both codecs, by the names in the rows, have the same figures if they are measured again on that half."""
    rows, err = rows_of(run, "spherical", "--storage", "rg8", "--seed", "5")
    assert rows["psnr_db"]["gain"] > 2.5 and rows["psnr_db"]["unit"] == "dB", rows
    held = halves_of(playground(), 5, by_tiles=False).held_out
    assert held.count == rows["psnr_db"]["held_out"]
    for side, encoding in (("published", "encoding"), ("tuned", "tuned_encoding")):
        (codec,) = codecs_named(rows["psnr_db"][encoding], rows["psnr_db"]["storage"], "nearest")
        row = quality.measure(quality.QualityCase(codec, held, "jax"))
        for figure in ("psnr_db", "angle_mean_deg", "angle_max_deg"):
            assert rows[figure][side] == pytest.approx(row[figure], rel=1e-9), (figure, side)
    mean = rows["angle_mean_deg"]
    assert mean["gain"] == pytest.approx(100 * (1 - mean["tuned"] / mean["published"]))
    assert f"--encoding {rows['psnr_db']['tuned_encoding']}" in err


def test_zero_gain_is_reported(run):
    """The published table is the best for its storage."""
    rows, err = rows_of(run, "best_fit", "--normals", "sphere", "--count", "65536")
    assert rows["psnr_db"]["gain"] == 0
    assert "no gain on the held-out half" in err


def test_tuning_twice_gives_the_same_result(run):
    arguments = ("stereographic", "--normals", "hemisphere", "--count", "65536", "--storage", "rg8")
    assert rows_of(run, *arguments) == rows_of(run, *arguments)


def test_the_scale_for_a_hemisphere_is_nearly_1(run):
    """Clipping the last ring of normals for finer steps lowers the scale by at most a few half steps of 1 / 255."""
    rows, _ = rows_of(run, "stereographic", "--normals", "hemisphere", "--count", "65536", "--parameter", "scale")
    assert 1 - 9 / 255 < rows["scale"]["tuned"] <= 1 + 1 / 255, rows["scale"]
    assert rows["psnr_db"]["gain"] > 4
    assert rows["scale"]["glsl"] == "STEREOGRAPHIC_SCALE"


@pytest.mark.parametrize("storage", ["rgba8", "rgba8_snorm"])
def test_a_lookup_table_has_the_best_scale_for_its_normals(storage):
    """Every scale is tried on the normals of one texel, each rounded to the storage's numbers."""
    numbers = STORAGES[storage].numbers(0)
    centre = np.float64([100.5 / 1024 * 700.5 / 1024, 700.5 / 1024, 1.0])
    n = centre + np.random.default_rng(2).uniform(-5e-5, 5e-5, (16, 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    errors = {}
    for scale in numbers[numbers > 0]:
        code = numbers[np.abs(n[:, :, None] / n[:, 2:, None] * scale - numbers).argmin(axis=2)]
        across = np.linalg.norm(np.cross(n, code), axis=1) / np.linalg.norm(code, axis=1)
        errors[np.float32(scale)] = np.mean(across**2)
    best = best_fit.fit(n, len(numbers), 0.0)[100, 700, 0]
    assert errors[best] <= min(errors.values()) * 1.001, (best, errors[best], min(errors.values()))


def test_a_lookup_table_is_fitted_to_other_storages(run, tmp_path):
    """The published table is for UNORM8; for SNORM8 a fitted table gains more than 5 dB. The fitted table is written,
    read and measured again."""
    path = tmp_path / "scales.npy"
    rows, err = rows_of(run, "best_fit", "--storage", "rgba8_snorm", "--table", str(path))
    assert rows["psnr_db"]["gain"] > 5, rows["psnr_db"]
    assert rows["texels_changed"]["tuned"] > 10**5
    (codec,) = codecs_named(f"best_fit:table={path}", "rgba8_snorm", "nearest")
    held = halves_of(playground(), 0, by_tiles=True).held_out
    assert quality.measure(quality.QualityCase(codec, held, "jax"))["psnr_db"] == pytest.approx(
        rows["psnr_db"]["tuned"]
    )
    assert f"best_fit:table={path}" in err


@pytest.mark.usefixtures("gl")
def test_tuned_encodings_are_the_same_in_both_languages(tmp_path):
    np.save(tmp_path / "scales.npy", np.sqrt(best_fit.centres()))
    names = f"spherical:bias=0.35:scale=0.7,stereographic:scale=1.31,best_fit:table={tmp_path}/scales.npy"
    for codec in codecs_named(names, "rgba8,rg8_7_9,rgb8_13_11_snorm", "nearest"):
        if codec.fits:
            db = {b: quality.measure(quality.QualityCase(codec, playground(), b))["psnr_db"] for b in ("jax", "glsl")}
            plain = replace(codec, encoding=ENCODINGS[codec.encoding.prefix])
            assert abs(db["jax"] - db["glsl"]) <= 0.02, (codec.name, db)
            assert abs(db["jax"] - quality.measure(quality.QualityCase(plain, playground(), "jax"))["psnr_db"]) > 0.1


@pytest.mark.usefixtures("gl")
def test_tuned_encodings_are_rendered(run):
    status, out, err = run(
        *(
            "render",
            "--encoding",
            "stereographic,stereographic:scale=1.31,stereographic:scale=1.5",
            "--size",
            "160x120",
        ),
        *("--repeats", "1", "--format", "json"),
    )
    assert status == 0, err
    assert len({row["normal_psnr_db"] for row in json.loads(out)}) == 3, out
