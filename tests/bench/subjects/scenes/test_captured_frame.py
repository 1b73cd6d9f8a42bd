"""Captured frames as scenes, compared with the image and figures of the scenes that they were written from."""

import json
from pathlib import Path

import numpy as np
import pytest

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.run.measuring import companions
from normalbench.bench.subjects.scenes import captured_frame as reading
from normalbench.bench.subjects.scenes.frame_file import read_frame_file
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.mesh import rotation
from normalbench.gbuffer.scenes.pixels import PixelSurfaces, pixel_scene
from normalbench.gbuffer.scenes.setting import Setting


def frame(folder: Path, **changes) -> Path:
    """Write a 24 x 16 slope facing the camera, with some entries of its description changed; return the path."""
    shape = (16, 24)
    arrays = {
        "depth": np.linspace(2.0, 8.0, 16 * 24).reshape(shape),
        "normal": np.broadcast_to((0.0, 0.6, 0.8), (*shape, 3)),
        "base_color": np.linspace(0.0, 1.0, 16 * 24 * 3).reshape(*shape, 3),
        "roughness": np.linspace(0.1, 0.9, 16 * 24).reshape(shape),
        "small": np.ones((8, 12)),
        "holes": np.full(shape, np.nan),
    }
    for name, array in arrays.items():
        np.save(folder / f"{name}.npy", array.astype(np.float32))
    entries = {name: {"file": f"{name}.npy"} for name in ("depth", "normal", "base_color", "roughness")}
    entries |= {"fov": 60, "near": 1, "far": 10} | changes
    path = folder / "frame.json"
    path.write_text(json.dumps({name: entry for name, entry in entries.items() if entry != "left out"}))
    return path


def read(path: Path) -> reading.CapturedFrame:
    return reading.captured_frame(read_frame_file(path))


def pixels_of(path: Path) -> PixelSurfaces:
    return reading._Reader(read_frame_file(path)).pixels()


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"roughnes": 0.5}, ("unknown key 'roughnes'", "did you mean roughness?")),
        ({"depth": {"file": "depth.npy", "are": "window"}}, ("depth: unknown key 'are'", "depths_are")),
        ({"normal": "left out"}, ("missing normal", '"normal": {"file": "FILE", "channels"')),
        ({"roughness": None, "near": None}, ("missing near, roughness", '"near": NUMBER')),
        ({"smoothness": 0.5}, ("roughness and smoothness are the same quantity",)),
        ({"base_color": {"file": "gone.npy"}}, ("no file gone.npy", "relative to the folder of frame.json")),
        ({"base_color": {"file": "../away.npy"}}, ("base_color", "is outside the file's folder")),
        ({"base_color": 0.5}, ("base_color is 0.5", '"channels"')),
        ({"roughness": {"channel": "R"}}, ("roughness: no file",)),
        ({"roughness": {"file": "small.npy"}}, ("roughness", "small.npy", "12 x 8", "24 x 16", "the same size")),
        ({"normal": {"file": "small.npy"}}, ("normal", "small.npy")),
        ({"roughness": {"file": "holes.npy"}}, ("384 of 384 pixels are NaN", "row 0, column 0", "mask")),
        ({"roughness": {"file": "base_color.npy"}}, ("no channel is named; it has 0, 1, 2", 'name one with "channel"')),
        ({"roughness": {"file": "base_color.npy", "channel": "A"}}, ("no channel 'A'", "it has 0, 1, 2")),
        (
            {"base_color": {"file": "base_color.npy", "channels": "R,G,B"}},
            ("no channels R,G,B", 'name three with "channels"'),
        ),
        ({"roughness": {"file": "depth.npy"}}, ("roughness: its values are 2 to 8", "0 to 1", '"scale"')),
        ({"metallic": -1}, ("metallic: its values are -1 to -1",)),
        ({"emissive": [0, 0, -1]}, ("emissive: its values are -1 to 0", "light")),
        ({"base_color": {"file": "base_color.npy", "curve": "srbg"}}, ("unknown curve 'srbg'", "srgb")),
        ({"depth": {"file": "depth.npy", "depths_are": "window"}}, ("depth", "2 to 8", '"depths_are" view')),
        ({"depth": {"file": "depth.npy", "depth_unit": 100}}, ("no depth is between near and far", "200 to 800")),
        ({"depth": {"file": "depth.npy", "depth_unit": "m"}}, ("depth_unit is 'm'", "a number")),
        ({"normal": {"file": "normal.npy", "space": "world"}}, ('"space" world requires "view_matrix"',)),
        ({"normal": {"file": "normal.npy", "unpack": "yes"}}, ("unpack is 'yes'", "true or false")),
        ({"normal": {"file": "normal.npy", "unpack": True}}, ("normal", 'use "unpack": false')),
        ({"view_matrix": [1, 2, 3]}, ("view_matrix", "3 numbers; expected 9 or 16")),
        ({"fov": 0}, ("fov is 0", "1 to 175")),
        ({"near": 10, "far": 1}, ("near is 10 and far is 1", "reversed_window")),
        ({"far": "infinite"}, ("far is 'infinite'", "a number")),
        ({"base_color": [1e300, 0, 0]}, ("base_color is 1e+300", "a 32-bit float holds")),
        ({"roughness": {"file": "roughness.npy", "scale": -1e39}}, ("roughness: scale is -1e+39", "a 32-bit float")),
        ({"view_matrix": [1, 0, 0, 0, 1, 0, 0, 0, 10**300]}, ("view_matrix is 1e+300", "a 32-bit float")),
    ],
)
def test_invalid_entry_is_a_one_line_error(tmp_path, changes, said):
    with pytest.raises(UsageError) as refusal:
        read(frame(tmp_path, **changes))
    line = str(refusal.value)
    assert line.startswith(f"{tmp_path}/frame.json: ") and "\n" not in line
    assert all(part in line for part in said), line


@pytest.mark.parametrize("number", ["9" * 310, "-" + "9" * 5000, "1e999", "NaN", "-Infinity"])
def test_number_beyond_float_range_is_a_one_line_error_with_its_location(run, tmp_path, number):
    path = frame(tmp_path, roughness={"file": "roughness.npy", "scale": 7.25})
    path.write_text(path.read_text().replace("7.25", number))
    status, out, err = run("budget", "--bytes", "12", "--scene", str(path))
    message = "roughness.scale is not a finite number; write one below 1e308"
    assert (status, out, err) == (2, "", f"normalbench: {path}: {message}\n")


@pytest.mark.parametrize("text", ["[]", "{", '"depth"', "\udcff"])
def test_malformed_description_is_a_one_line_error(tmp_path, text):
    path = tmp_path / "a.json"
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(
        UsageError,
        match=r"a\.json: (line 1, column 2: this is not JSON|it is not text in UTF-8|not a frame description)",
    ):
        read(path)


def test_numbers_may_replace_images_and_smoothness_may_replace_roughness(tmp_path):
    smooth = {"roughness": None, "smoothness": {"file": "roughness.npy"}, "metallic": 1, "emissive": [0, 0.5, 2]}
    pixels = pixels_of(frame(tmp_path, **smooth, f0={"file": "roughness.npy", "scale": 0.08}))
    rough = np.load(tmp_path / "roughness.npy")
    assert np.allclose(pixels.roughness, 1 - rough) and np.allclose(pixels.f0, 0.08 * rough)
    assert (pixels.metallic == 1).all() and (pixels.emissive == (0, 0.5, 2)).all() and (pixels.ao == 1).all()
    (line,) = read(frame(tmp_path, **smooth)).notes
    assert line.startswith("it has no f0 (0.04), ao (1)")


def test_depth_and_normals_define_the_background(tmp_path):
    """Pixels beyond the far plane or without a normal are background, whatever the other images hold there."""
    path = frame(tmp_path)
    depth, normal, rough = (np.load(tmp_path / f"{name}.npy") for name in ("depth", "normal", "roughness"))
    depth[0], normal[1], rough[:2] = 20.0, 0.0, np.nan
    for name, pixels in (("depth", depth), ("normal", normal), ("roughness", rough)):
        np.save(tmp_path / f"{name}.npy", pixels)
    pixels = pixels_of(path)
    assert not pixels.depth[:2].any() and (pixels.depth[2:] > 0).all()
    meshes = [part.mesh for part in read(path).scene.parts]
    assert sum(len(mesh.triangles) for mesh in meshes) == 2 * 14 * 24


def test_large_frames_are_subsampled(tmp_path, monkeypatch):
    """Rows and columns are sampled at regular steps without averaging, and the camera keeps its field of view."""
    monkeypatch.setattr(reading, "MOST_PIXELS", 100)
    path = frame(tmp_path)
    captured = read(path)
    assert (
        captured.sides == (12, 8)
        and "drawn: one row and one column in 2 (12 x 8 pixels), without averaging" in captured.notes
    )
    (part,) = captured.scene.parts
    rough = captured.scene.materials[0].rough_metal_map
    assert np.array_equal(rough.texels[..., 1], np.load(tmp_path / "roughness.npy")[1::2, 1::2])
    assert len(part.mesh.positions) == 4 * 12 * 8 and captured.scene.view.fov == pytest.approx(60)
    monkeypatch.setattr(reading, "MOST_PIXELS", 45)
    assert read(path).sides == (8, 5)


@pytest.mark.parametrize("up", [0, 1, 2])
@pytest.mark.parametrize("hand", [1.0, -1.0])
def test_worlds_with_any_axes_are_converted_to_y_up(up, hand):
    """For a slightly tilted camera in a world of either handedness, world axes are mapped to world axes."""
    level = np.roll(np.eye(3), up - 1, axis=0) * (1, 1, hand)
    turn = rotation(0.7, 0.3, 0.1)
    matrix = reading.upright(level @ turn)
    assert np.linalg.det(matrix) == pytest.approx(1) and matrix[1, 1] > 0.9
    moved = matrix @ np.linalg.inv(level @ turn)
    assert np.allclose(abs(moved).max(axis=0), 1) and np.allclose(moved @ moved.T, np.eye(3))
    if (up, hand) == (1, 1.0):
        assert np.allclose(matrix, turn)


def test_many_reflectances_are_rounded_and_few_are_not(tmp_path):
    few = pixel_scene(pixels_of(frame(tmp_path, f0=0.05)), SCENES["ramps"].make(Setting()).view)
    assert [material.reflectance for material in few.materials] == [pytest.approx(0.05)]
    many = read(frame(tmp_path, f0={"file": "roughness.npy", "scale": 0.1})).scene
    reflectances = np.array([material.reflectance for material in many.materials])
    assert 200 < len(reflectances) <= 256 and np.diff(reflectances).min() > 0
    assert reflectances[[0, -1]] == pytest.approx((0.01, 0.09)) and len(many.parts) == len(reflectances)


def test_images_count_as_inputs_of_a_measurement(tmp_path):
    """A changed image is a changed input, and workers receive the images."""
    matrix = tmp_path / "view.txt"
    matrix.write_text("1 0 0 0 1 0 0 0 1")
    path = frame(tmp_path, view_matrix="view.txt", metallic=0)
    assert [file.name for file in companions(path)] == [
        *("base_color.npy", "depth.npy", "normal.npy", "roughness.npy", "view.txt")
    ]
    path.write_text("{")
    assert companions(path) == []
