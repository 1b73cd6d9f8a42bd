"""`normalbench depth --depths`: depths of users' frames in every form, and errors for bad files."""

import numpy as np
import pytest
from test_depth_images import FAR, PLANES, SLOPE, rows_of, window
from written import png_bytes, write_exr

from normalbench.bench.ground.output.errors import UsageError

SKY = np.where(np.arange(24)[:, None] < 3, np.float32(np.inf), SLOPE)


def figures(rows: list[dict]) -> dict[tuple[str, ...], tuple[float, ...]]:
    return {
        (row["depth"], row["storage"], row["rebuilt"]): tuple(row[name] for name in ("relative_mean", "error_max"))
        for row in rows
    }


def test_a_code_is_measured_on_the_depths_of_an_image(run, tmp_path):
    """The error of 16-bit linear depth equals the error of rounding each depth to a step of far / 65535."""
    rows, err = rows_of(run, write_exr(tmp_path / "a.exr", {"Depth.Z": SKY}))
    exact = SLOPE[3:].astype(np.float64)
    again = np.round(exact / FAR * 65535) / 65535 * FAR
    (row,) = (row for row in rows if (row["depth"], row["storage"]) == ("linear", "packed16"))
    assert row["relative_mean"] == pytest.approx(np.mean(abs(again - exact) / exact), rel=0.01)
    assert row["relative_max"] == pytest.approx(np.max(abs(again - exact) / exact), rel=0.01)
    assert row["error_max"] == pytest.approx(np.max(abs(again - exact)), rel=0.01)
    assert row["error_max"] <= row["bound"] and row["half_step"] == pytest.approx(FAR / 65535 / 2)
    assert (row["depths"], row["distance"], row["count"]) == ("a.exr", None, 21 * 32)
    assert (row["background"], row["not_finite"], row["fov"], row["seed"]) == (3 * 32, 0, None, None)
    assert "without --fov its points are on the view axis" in err
    assert "12.5% of the pixels are not within --near 0.5 --far 80; depths are 8.38" in err


@pytest.mark.usefixtures("gl")
def test_the_device_gives_the_same_figures(run, tmp_path):
    path = write_exr(tmp_path / "a.exr", {"Z": SLOPE})
    rows, _ = rows_of(run, path, "--backend", "jax,glsl", "--fov", "50")
    by = {name: figures([row for row in rows if row["backend"] == name]) for name in ("jax", "glsl")}
    assert by["jax"].keys() == by["glsl"].keys()
    for key, figure in by["glsl"].items():
        assert figure == pytest.approx(by["jax"][key], rel=0.1), key


def test_positions_are_measured_at_the_pixels_if_the_field_of_view_is_known(run, tmp_path):
    """The relative error of depths stays the same; a corner's position error is scaled by the length of its ray."""
    path = write_exr(tmp_path / "a.exr", {"Z": np.full((24, 32), 40.1, np.float32)})
    (on_axis, *_), _ = rows_of(run, path)
    (seen, *_), err = rows_of(run, path, "--fov", "90")
    assert seen["relative_max"] == pytest.approx(on_axis["relative_max"], rel=1e-3) and err == ""
    ray = np.sqrt(1 + (31 / 32 * 32 / 24) ** 2 + (23 / 24) ** 2)
    assert seen["error_max"] / on_axis["error_max"] == pytest.approx(ray, rel=1e-3)
    assert (seen["fov"], on_axis["fov"]) == (90, None)


def test_integers_are_read_in_their_unit_or_as_fractions_of_one(run, tmp_path):
    """Depth cameras give millimetres; 16-bit z/w has steps that make depth16 look exact."""
    millimetres = np.round(SLOPE * 1000).astype(np.uint16)
    (tmp_path / "a.png").write_bytes(png_bytes(millimetres[..., None]))
    rows, err = rows_of(run, tmp_path / "a.png", "--depth-unit", "0.001")
    assert {row["count"] for row in rows} == {24 * 32} and "16-bit integers" in err
    stored = np.round(window(SLOPE.astype(float)) * 65535).astype(np.uint16)
    (tmp_path / "w.png").write_bytes(png_bytes(stored[..., None]))
    rows, _ = rows_of(run, tmp_path / "w.png", "--depths-are", "window", "--storage", "depth16,packed16")
    largest = {(row["depth"], row["storage"]): row["relative_max"] for row in rows}
    assert largest["window", "depth16"] < 0.02 * largest["linear", "packed16"]


def test_suspicious_images_and_images_that_favour_a_code_are_noted(run, tmp_path):
    np.save(tmp_path / "half.npy", SLOPE.astype(np.float16))
    assert "all its values are half floats" in rows_of(run, tmp_path / "half.npy")[1]
    np.save(tmp_path / "share.npy", window(SLOPE.astype(float)))
    stderr = rows_of(run, tmp_path / "share.npy", "--near", "0.01")[1]
    assert "in [0, 1]; for a depth buffer use --depths-are window, reversed_window or linear" in stderr
    lost = SLOPE.copy()
    lost[0, :5] = np.nan
    np.save(tmp_path / "nan.npy", lost)
    rows, stderr = rows_of(run, tmp_path / "nan.npy", "--count", "5")
    assert "5 values are NaN and left out" in stderr and "--count has no effect on depth images" in stderr
    assert {(row["count"], row["background"], row["not_finite"]) for row in rows} == {(24 * 32 - 5, 0, 5)}


def test_table_names_each_reconstruction_and_gates_and_python_accept_images(run, tmp_path, monkeypatch):
    import normalbench

    np.save(tmp_path / "a.npy", SLOPE)
    monkeypatch.chdir(tmp_path)
    status, out, _ = run("depth", "--depths", "a.npy", *PLANES, "--depth", "window", "--storage", "depth24")
    assert status == 0 and "inverse_projection" in out and "relative" in out and "depths a.npy" in out
    gate = '[[gate]]\ntable = "depth"\ndepths = "a.npy"\nnear = "0.5"\nfar = "80"\nstorage = "packed24"\n'
    (tmp_path / "gates.toml").write_text(gate + 'relative_max = "at most 1e-5"\n')
    monkeypatch.chdir("/")
    assert run("check", str(tmp_path / "gates.toml"))[0] == 0
    (tmp_path / "gates.toml").write_text(gate + 'relative_max = "at most 1e-9"\n')
    assert run("check", str(tmp_path / "gates.toml"))[0] == 1
    table = normalbench.depth(depths=tmp_path / "a.npy", near=0.5, far=80, depth="linear", backend="jax")
    assert set(table["depths"]) == {"a.npy"} and (table["relative_max"] < 0.01).all()
    own = normalbench.depth(depths={"mine": SLOPE}, near=0.5, far=80, depth="linear", backend="jax")
    assert set(own["depths"]) == {"mine"} and own["error_max"].tolist() == table["error_max"].tolist()
    with pytest.raises(UsageError, match=r"mine has type int64 and shape \(24, 32\); give floats or unsigned"):
        normalbench.depth(depths={"mine": SLOPE.astype(int)})


def test_pictures_show_the_frame(run, tmp_path, gl):  # noqa: ARG001 # its driver is asked for by the table
    np.save(tmp_path / "a.npy", SKY)
    words = ("--images", str(tmp_path / "pictures"), "--fov", "60")
    rows_of(run, tmp_path / "a.npy", *words)
    names = {path.name for path in (tmp_path / "pictures").iterdir()}
    assert "a.npy-0.5-80-linear-packed16-eye_ray-shaded.png" in names
