"""`normalbench depth`: output, files and messages for bad input."""

import json

import jax.numpy as jnp
import numpy as np
import pytest
from PIL import Image
from test_depth_command import QUICK

from normalbench.bench.ground.machine import devices
from normalbench.bench.tables.depth import measure as depth
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import DEPTH_ENCODINGS
from normalbench.encodings.codecs.depth_codec import DepthCodec
from normalbench.encodings.storages.depth_storage import DEPTH_STORAGES
from normalbench.gbuffer.gl.device import NoDeviceError


@pytest.mark.usefixtures("rows_are_shared")
def test_json_has_a_row_for_each_distance_and_the_whole_range(run):
    status, out, err = run(*QUICK, "--distance", "5,50", "--format", "json")
    rows = json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    assert status == 0 and err == ""
    assert all(tuple(row) == tuple(TABLES["depth"].empty()) for row in rows)
    linear = [row for row in rows if (row["depth"], row["storage"]) == ("linear", "packed16")]
    assert [row["distance"] for row in linear] == [5, 50, None]
    for row in rows:
        assert row["error_mean"] <= row["error_max"] <= row["bound"] and row["half_step"] <= row["bound"], row
        assert row["ratio"] == 100 and row["count"] == 500 and row["skipped"] is None


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize(
    "arguments, said", [(["--near", "20"], "room"), (["--images", "/proc/nowhere"], "/proc/nowhere")]
)
def test_unsupported_pictures_are_a_one_line_error(run, tmp_path, arguments, said):
    status, out, err = run("depth", "--images", str(tmp_path / "pictures"), *arguments)
    assert status == 2 and out == "" and err.count("\n") == 1 and said in err, err
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("gl")
def test_the_pictures_show_the_error_and_the_terraces(run, tmp_path):
    """The error picture uses the colours of its scale; coarse steps show as stripes on the lit surface."""
    codes = ["--depth", "linear", "--storage", "packed16,r32f", "--near", "1", "--count", "100", "--backend", "glsl"]
    status, _, err = run("depth", *codes, "--images", str(tmp_path))
    assert status == 0, err
    names = [
        f"room-1-1000-linear-{s}-eye_ray-{k}.png" for s in ("packed16", "r32f") for k in ("position_error", "shaded")
    ]
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(names)
    coarse, fine = (
        [np.asarray(Image.open(tmp_path / name)).astype(int)[24:] for name in names[i : i + 2]] for i in (0, 2)
    )
    # Viridis goes from violet to yellow: green grows with the error, here 10^-2 to 10^-7.
    assert np.median(coarse[0][..., 1]) > 100 > 40 > np.median(fine[0][..., 1])
    wall = (slice(90, 220), slice(210, 400))
    assert fine[1][wall].std() < 5 < 20 < coarse[1][wall].std(), "a wall is flat, unless its depth has steps"


# The mean error of the depth over that of the nearest, a quarter of a step: half a step, or a third. A number f cut off
# of f (scale + 1/2) is off by f/2 - t of a step for t from 0 to 1: (f^2 / 4 + (1 - f / 2)^2) / 2, a third on average.
WAYS = {"truncate": 2.0, "truncate_half": 4 / 3, "dithered": 4 / 3}


@pytest.mark.usefixtures("gl", "rows_are_shared")
@pytest.mark.parametrize(
    "code", [("linear", "packed16"), ("linear_sign", "unorm:13"), ("logarithmic", "packed16"), ("linear", "r16f")]
)
def test_numbers_are_rounded_as_requested_in_both_languages(run, code):
    words = ["--depth", code[0], "--storage", code[1], "--near", "1", "--rounding", "all", "--format", "json"]
    status, out, _ = run("depth", *words, "--count", "4096")
    by_key = {(row["rounding"], row["backend"], row["distance"]): row for row in json.loads(out)}
    roundings = list(dict.fromkeys(rounding for rounding, _, _ in by_key))
    assert status == 0 and roundings == ["nearest", "truncate"] + (["truncate_half", "dithered"] * (code[1] != "r16f"))
    for (rounding, backend, distance), row in by_key.items():
        assert row["error_max"] <= row["bound"] and not row["signs_lost"], row
        assert row["half_step"] / by_key["nearest", backend, distance]["half_step"] == pytest.approx(
            1 if rounding == "nearest" else 2, rel=0.01
        )
        assert row["error_mean"] == pytest.approx(by_key[rounding, "jax", distance]["error_mean"], rel=0.02)
    if code[0].startswith("linear"):
        nearest = by_key["nearest", "jax", None]["error_mean"]
        for rounding in roundings[1:]:
            ratio = by_key[rounding, "jax", None]["error_mean"] / nearest
            assert ratio == pytest.approx(WAYS[rounding], rel=0.05), rounding


def test_noise_preserves_a_depths_sign_and_the_mean_of_its_codes():
    """This holds even near 0, where the noise is larger than the number and the mean is slightly larger."""
    codec = DepthCodec(DEPTH_ENCODINGS["linear_sign"], DEPTH_STORAGES["packed16"], "dithered")
    noise = codec.dither.added[..., 0].ravel()
    for exact in (0.5 * codec.step, 3.25 * codec.step, 0.7):
        given = np.full_like(noise, exact)
        for sign in (1, -1):
            stored = np.asarray(codec.stored(jnp.asarray(sign * given), 0.001, 1.0, jnp.asarray(noise)), np.float64)
            assert (np.signbit(stored) == (sign < 0)).all()
            assert abs(abs(stored).mean() - exact) < 2e-3 * codec.step
            assert abs(abs(stored) - exact).max() < 1.001 * codec.step


def test_jax_rows_are_measured_without_an_opengl_driver(run, tmp_path, monkeypatch):
    """The GLSL rows say what to install; GLSL alone and pictures end with status 3."""

    def no_device():
        raise NoDeviceError("no OpenGL 4.3 device: gone; install an OpenGL driver")

    for module in (depth, devices):
        monkeypatch.setattr(module, "device", no_device)
    plot = tmp_path / "plot.png"
    status, out, err = run(*QUICK[:-2], "--format", "json", "--plot", str(plot))
    rows = json.loads(out)
    missing, written = err.splitlines()
    assert status == 0 and "install an OpenGL driver" in missing, err
    assert written == f"normalbench: the chart is in {plot}"
    assert {row["backend"] for row in rows if row["error_max"] is None} == {"glsl"}
    assert {row["backend"] for row in rows if row["error_max"] is not None} == {"jax"}
    assert plot.stat().st_size > 10_000
    for arguments in (["--backend", "glsl"], ["--images", str(tmp_path / "pictures")]):
        status, _, err = run(*QUICK[:-2], *arguments)
        assert status == 3 and err.count("\n") == 1 and "install an OpenGL driver" in err
