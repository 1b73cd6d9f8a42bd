"""`normalbench depth --depths`: depths of users' frames in every form, and errors for bad files."""

import json

import numpy as np
import pytest
from written import write_exr

from normalbench.bench.tables.depth import frames

NEAR, FAR = 0.5, 80.0


# A slope with a sky behind its first rows.
SLOPE = np.linspace(1.0, 60.0, 24 * 32).reshape(24, 32).astype(np.float32)


PLANES = ("--near", f"{NEAR:g}", "--far", f"{FAR:g}")


QUICK = ("--depth", "linear,window", "--storage", "packed16,depth24", "--backend", "jax", "--format", "json")


def rows_of(run, path, *words) -> tuple[list[dict], str]:
    status, out, err = run("depth", "--depths", str(path), *PLANES, *QUICK, *words)
    assert status == 0, err
    return json.loads(out), err


def window(depths) -> np.ndarray:
    return (depths - NEAR) * FAR / (depths * (FAR - NEAR))


STORED = {
    "view depth in an array": (lambda at: np.save(at / "a.npy", SLOPE), "a.npy", ()),
    "z/w": (lambda at: np.save(at / "a.npy", window(SLOPE.astype(float))), "a.npy", ("--depths-are", "window")),
    "reversed z/w": (
        lambda at: np.save(at / "a.npy", 1 - window(SLOPE.astype(float))),
        "a.npy",
        ("--depths-are", "reversed_window"),
    ),
    "shares of far": (
        lambda at: write_exr(at / "a.exr", {"R": SLOPE / np.float32(FAR)}),
        "a.exr",
        ("--depths-are", "linear"),
    ),
    "against the view axis": (lambda at: np.save(at / "a.npy", -SLOPE), "a.npy", ("--depth-unit", "-1")),
    "another unit": (lambda at: np.save(at / "a.npy", SLOPE * 100), "a.npy", ("--depth-unit", "0.01")),
    "beside normals": (
        lambda at: write_exr(at / "a.exr", dict.fromkeys(("N.X", "N.Y", "N.Z"), 1 / SLOPE) | {"View.Depth.Z": SLOPE}),
        "a.exr",
        (),
    ),
    "a named channel": (
        lambda at: write_exr(at / "a.exr", {"R": 1 / SLOPE, "G": SLOPE}),
        "a.exr",
        ("--channel", "G"),
    ),
}


@pytest.mark.parametrize("how", STORED)
def test_every_form_gives_the_same_depths(tmp_path, monkeypatch, how):
    from normalbench.bench.tables.depth.table import DepthOptions
    from normalbench.encodings.shared.position import Camera

    write, name, words = STORED[how]
    monkeypatch.chdir(tmp_path)
    write(tmp_path)
    given = dict(zip((word[2:].replace("-", "_") for word in words[::2]), words[1::2], strict=True))
    if "depth_unit" in given:
        given["depth_unit"] = float(given["depth_unit"])
    (frame,) = frames.frames_named(DepthOptions(depths=name, **given))
    surface = frame.surface(Camera(NEAR, FAR, 60.0, 1.0))
    assert surface == pytest.approx(SLOPE, rel=1e-5)


def test_every_second_pixel_of_a_large_frame_is_measured(run, tmp_path, monkeypatch):
    monkeypatch.setattr(frames, "MOST_PIXELS", 24 * 16)
    np.save(tmp_path / "large.npy", SLOPE)
    rows, err = rows_of(run, tmp_path / "large.npy")
    assert {row["count"] for row in rows} == {24 * 16} and "1 pixel in 2 is measured" in err


def test_wide_arrays_are_images(run, tmp_path):
    """Columns of a (height, width) array are not taken for channels, of which at most 1024 are allowed."""
    np.save(tmp_path / "wide.npy", np.full((2, 2000), 5, np.float32))
    assert rows_of(run, tmp_path / "wide.npy")[0][0]["count"] == 4000


BAD = {
    "no such file": (("--depths", "lost.exr"), "lost.exr: there is no such file"),
    "no name": (("--depths", ","), "--depths: no file named"),
    "a mesh": (("--depths", "scene.glb"), "scene.glb: not an image of depths; supported: .exr"),
    "damaged": (("--depths", "cut.exr"), "cut.exr: "),
    "several channels": (
        ("--depths", "rgb.exr"),
        "rgb.exr: any of B, G, R may hold depths; choose one with --channel B",
    ),
    "an unknown channel": (("--depths", "rgb.exr", "--channel", "Z"), "rgb.exr: no channel 'Z'; it has B, G, R"),
    "two of one name": (("--depths", "a.npy,there/a.npy"), "two files are called a.npy"),
    "an unknown code": (("--depths", "a.npy", "--depths-are", "zbuffer"), "'zbuffer'"),
    "a code with a sign": (("--depths", "a.npy", "--depths-are", "linear_sign"), "'linear_sign'"),
    "not that code": (
        ("--depths", "a.npy", "--depths-are", "window"),
        "its values are 1 to 60, but window ranges from 0",
    ),
    "no unit": (("--depths", "a.npy", "--depth-unit", "0"), "--depth-unit 0: out of range; use 1e-09 to 1e+09"),
    "a unit of a code": (
        ("--depths", "a.npy", "--depths-are", "linear", "--depth-unit", "2"),
        "--depth-unit cannot be used with --depths-are",
    ),
    "nothing within": (
        ("--depths", "a.npy", "--near", "70"),
        "a.npy: no depth is within --near 70 --far 80; depths are 1",
    ),
    "behind": (("--depths", "behind.npy"), "--depth-unit -1 negates them"),
    "a list": (("--depths", "cube.npy"), "cube.npy: an array of shape (2, 2, 2, 2)"),
    "NaN alone": (("--depths", "nan.npy"), "nan.npy: no depth is within"),
    "distances": (("--depths", "a.npy", "--distance", "5"), "--distance applies only to generated points"),
    "a plot": (("--depths", "a.npy", "--plot", "a.png"), "--plot cannot be used with --depths"),
    "pictures": (("--depths", "a.npy", "--images", "p"), "--images requires --fov for depth images"),
    "a channel of nothing": (("--channel", "Z"), "--channel requires --depths"),
    "a code of nothing": (("--depths-are", "window"), "--depths-are requires --depths"),
    "a unit of nothing": (("--depth-unit", "2"), "--depth-unit requires --depths"),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_input_is_a_one_line_error(run, tmp_path, monkeypatch, what):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there").mkdir()
    for name, array in (("a", SLOPE), ("there/a", SLOPE), ("behind", -SLOPE), ("cube", np.ones((2, 2, 2, 2)))):
        np.save(tmp_path / f"{name}.npy", array)
    np.save(tmp_path / "nan.npy", np.full((2, 2), np.nan))
    (tmp_path / "scene.glb").write_bytes(b"glTF")
    write_exr(tmp_path / "rgb.exr", dict.fromkeys("RGB", SLOPE))
    (tmp_path / "cut.exr").write_bytes((tmp_path / "rgb.exr").read_bytes()[:200])
    words, message = BAD[what]
    status, out, err = run("depth", "--backend", "jax", *PLANES, *words)
    assert (status, out) == (2, "") and len(err.splitlines()) == 1 and message in err, err
