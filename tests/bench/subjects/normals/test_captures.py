"""Captured frames as sets of normals: channels, packing, spaces, masks and errors."""

import json
from pathlib import Path

import numpy as np
import pytest
from damaged import in_this_process, refusal
from PIL import Image
from written import (
    given,
    planes_of,
    png_bytes,
    some_normals,
    write_exr,
)

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.normals import captures, pixel_files, pixel_process
from normalbench.bench.subjects.normals.captures import Reading, checked, chosen_channels, turns_of
from normalbench.bench.subjects.normals.normal_sets import NormalSet, playground
from normalbench.gbuffer.scenes.built_in.playground import playground as rendered

ROTATION = np.array([(2, -1, 2), (2, 2, -1), (-1, 2, 2)]) / 3


def capture(path: Path, reading: Reading) -> NormalSet:
    """Return the set without its notes."""
    return captures.capture(path, reading)[0]


def test_a_list_of_normals_is_a_set_without_an_image(tmp_path, run):
    np.save(tmp_path / "list.npy", some_normals().reshape(-1, 3))
    arguments = ("--encoding", "octahedral", "--storage", "rg8", "--backend", "jax", "--format", "json")
    status, out, err = run("quality", "--normals", f"axes,{tmp_path / 'list.npy'}", *arguments)
    assert status == 0 and err == ""
    axes, row = json.loads(out)
    assert (axes["normals"], axes["not_finite"]) == ("axes", None)
    assert (row["normals"], row["count"], row["not_finite"]) == ("list.npy", 48 * 64, 0)


NAMES = {
    "a layer N": (["N.X", "N.Y", "N.Z", "R", "G", "B"], None, ["N.X", "N.Y", "N.Z"]),
    "small letters": (["B", "G", "R", "normal.x", "normal.y", "normal.z"], None, ["normal.x", "normal.y", "normal.z"]),
    "as colours": (["A", "B", "G", "R", "WorldNormal.B", "WorldNormal.G", "WorldNormal.R"], None, "WorldNormal.{RGB}"),
    "a view layer": (["V.R", "V.G", "V.B", "V.Normal.X", "V.Normal.Y", "V.Normal.Z"], None, "V.Normal.{XYZ}"),
    "without a dot": (["Nx", "Ny", "Nz", "Px", "Py", "Pz"], None, ["Nx", "Ny", "Nz"]),
    "an underscore": (["normal_x", "normal_y", "normal_z", "depth"], None, ["normal_x", "normal_y", "normal_z"]),
    "the picture itself": (["A", "B", "G", "R", "Z"], None, ["R", "G", "B"]),
    "the only layer": (["gbuffer1.X", "gbuffer1.Y", "gbuffer1.Z", "id"], None, "gbuffer1.{XYZ}"),
    "a layer named": (["a.X", "a.Y", "a.Z", "b.R", "b.G", "b.B"], "b", ["b.R", "b.G", "b.B"]),
    "channels named": (["p", "q", "r"], "r, p,q", ["r", "p", "q"]),
    "an array's": (["0", "1", "2", "3"], None, ["0", "1", "2"]),
}


@pytest.mark.parametrize("what", NAMES)
def test_channels_with_normals_are_found(what):
    names, asked, expected = NAMES[what]
    if isinstance(expected, str):
        stem, axes = expected[:-1].split("{")
        expected = [stem + axis for axis in axes]
    assert chosen_channels(Path("f.exr"), names, asked) == expected


@pytest.mark.parametrize(
    "names, asked, said",
    [
        (["depth", "id"], None, ["it has depth, id; a normal has three channels"]),
        (["depth", "id", "mask"], None, ["it has depth, id, mask", "--channels x,y,z"]),
        (["N.X", "N.Y", "N.Z", "normal.R", "normal.G", "normal.B"], None, ["N, normal", "--channels N"]),
        (["R", "G", "B"], "N", ["no channels 'N'", "it has R, G, B"]),
        (["R", "G", "B"], "R,G", ["no channels 'R,G'"]),
        (["Y"], None, ["it has Y"]),
    ],
)
def test_channels_that_cannot_be_found_are_listed(names, asked, said):
    with pytest.raises(UsageError) as error:
        chosen_channels(Path("f.exr"), names, asked)
    assert all(part in str(error.value) for part in ("f.exr: ", *said)), error.value


def test_packed_floats_are_read_with_unpack(tmp_path, run):
    np.save(tmp_path / "frame.npy", some_normals() * np.float32(0.5) + np.float32(0.5))
    err = refusal(run, tmp_path / "frame.npy")
    assert "all components are in [0" in err and "use --unpack" in err
    normals, covered = given(capture(tmp_path / "frame.npy", Reading(unpack=True)))
    assert covered.all() and np.allclose(normals, some_normals().reshape(-1, 3), atol=2e-7)


def test_floats_that_are_not_packed_are_not_read_with_unpack(tmp_path, run):
    np.save(tmp_path / "frame.npy", some_normals())
    assert "use --no-unpack" in refusal(run, tmp_path / "frame.npy", "--unpack")


def test_normals_that_are_not_unit_length_are_refused_with_their_lengths(tmp_path, run):
    np.save(tmp_path / "frame.npy", 3 * some_normals())
    err = refusal(run, tmp_path / "frame.npy")
    assert "100.0% of the normals are not unit" in err and "median 3" in err and "--normalise" in err
    normals, _ = given(capture(tmp_path / "frame.npy", Reading(normalise=True)))
    assert np.allclose(normals, some_normals().reshape(-1, 3), atol=2e-7)
    codes = some_normals()
    codes[..., 2] = 0
    np.save(tmp_path / "codes.npy", codes)
    assert "are not unit" in refusal(run, tmp_path / "codes.npy")


def test_a_few_normals_off_unit_length_are_normalised_with_a_note(tmp_path):
    n = some_normals()
    n[0, :10] *= 0.5
    np.save(tmp_path / "frame.npy", n)
    frame, notes = captures.capture(tmp_path / "frame.npy", Reading())
    assert np.allclose(given(frame)[0], some_normals().reshape(-1, 3), atol=2e-7)
    assert notes == ["0.326% of the normals are not unit length: normalised"]


def test_world_space_is_rotated_to_view_space(tmp_path):
    """The matrix has 9 numbers, or 16 with translation and scale, or is a file; left-handed frames are mirrored."""
    n = some_normals()
    np.save(tmp_path / "world.npy", n.astype(np.float64) @ ROTATION)
    four = np.eye(4)
    four[:3, :3], four[:3, 3] = ROTATION * 2, (5, 6, 7)
    np.savetxt(tmp_path / "matrix.txt", four)
    typed = [",".join(map(str, ROTATION.ravel())), " ".join(map(str, four.ravel())), str(tmp_path / "matrix.txt")]
    broken = np.load(tmp_path / "world.npy")
    broken[0, 0], broken[1, 1] = np.nan, np.inf
    np.save(tmp_path / "broken.npy", broken)
    back, covered = given(capture(tmp_path / "broken.npy", Reading(space="world", view_matrix=typed[0], nan_share=0.1)))
    assert covered.sum() == 48 * 64 - 2 and np.allclose(back[covered], n.reshape(-1, 3)[covered], atol=2e-7)
    for matrix in typed:
        back, _ = given(capture(tmp_path / "world.npy", Reading(space="world", view_matrix=matrix)))
        assert np.allclose(back, n.reshape(-1, 3), atol=2e-7), matrix
    np.save(tmp_path / "left.npy", n * np.float32([1, 1, -1]))
    back, _ = given(capture(tmp_path / "left.npy", Reading(space="view-left-handed")))
    assert np.array_equal(back, n.reshape(-1, 3))
    assert captures.capture(tmp_path / "left.npy", Reading(space="view-left-handed"))[1] == []
    (note,) = captures.capture(tmp_path / "left.npy", Reading())[1]
    assert "if z points the other way: use --space view-left-handed" in note


def test_encoders_get_normals_in_the_space_that_the_engine_encodes_in(tmp_path):
    """A world-space frame of an engine that encodes in world space is measured unchanged, with or without the matrix;
    a view-space frame is rotated back. Rays are rotated with the normals."""
    n, matrix = some_normals(), ",".join(map(str, ROTATION.ravel()))
    world = (n.astype(np.float64) @ ROTATION).astype(np.float32)
    for name, frame in (("world", world), ("view", n), ("left", n * np.float32([1, 1, -1]))):
        np.save(tmp_path / f"{name}.npy", frame)
    spaces = {"world": "world", "view": "view", "left": "view-left-handed"}
    for name, space in spaces.items():
        reading = Reading(space=space, code_space="world", view_matrix=matrix, fov=60)
        taken = capture(tmp_path / f"{name}.npy", reading)
        assert np.allclose(given(taken)[0], world.reshape(-1, 3), atol=2e-7) and taken.code_space == "world"
        seen = capture(tmp_path / "view.npy", Reading(fov=60))
        ours, views = (np.stack([np.asarray(c) for c in next(s.loads())().view], 1) for s in (taken, seen))
        assert np.allclose(ours, views @ ROTATION, atol=2e-7) and seen.code_space == "view"
    taken = capture(tmp_path / "world.npy", Reading(space="world", code_space="world"))
    assert np.array_equal(given(taken)[0], world.reshape(-1, 3))
    assert playground().code_space is None


def test_code_space_is_in_the_row_and_in_the_hint(run, tmp_path):
    """For the same frame, the octahedral map has different errors in world space and in view space."""
    n = rendered().normals[1::4, 1::4]
    np.save(tmp_path / "world.npy", n.astype(np.float64) @ ROTATION)
    matrix = ",".join(map(str, ROTATION.ravel()))
    words = ["quality", "--encoding", "octahedral", "--storage", "rg8", "--backend", "jax", "--format", "json"]
    words += ["--normals", str(tmp_path / "world.npy")]
    means = {}
    for space in ("view", "world"):
        more = ["--space", "world", "--code-space", space, "--view-matrix", matrix]
        (row,) = json.loads(run(*words, *more)[1])
        assert row["code_space"] == space
        means[space] = row["angle_mean_deg"]
    assert means["view"] != pytest.approx(means["world"], rel=1e-4)
    (row,) = json.loads(run(*words, "--space", "world", "--code-space", "world")[1])
    assert row["angle_mean_deg"] == means["world"]
    err = run(*words)[2]
    assert "--space world --view-matrix" in err and "--space world --code-space world" in err


def test_encodings_that_need_the_view_ray_need_it_in_their_own_space(run, tmp_path):
    np.save(tmp_path / "world.npy", some_normals())
    words = ("quality", "--normals", str(tmp_path / "world.npy"), "--space", "world", "--code-space", "world")
    status, out, err = run(*words, "--encoding", "per_pixel_view", "--storage", "rg8")
    assert (status, out, err.count("\n")) == (2, "", 1) and "require --view-matrix with --code-space world" in err
    status, out, err = run(*words, "--encoding", "octahedral", "--storage", "rg8", "--fov", "60")
    assert (status, out, err.count("\n")) == (2, "", 1) and "--fov gives rays in view space" in err


@pytest.mark.parametrize(
    "space, matrix, said",
    [
        ("world", None, "needs --view-matrix"),
        ("screen", None, "unknown space 'screen'; known: view, view-left-handed, world"),
        ("view", "1,0,0,0,1,0,0,0,1", "--view-matrix cannot be used with --space view"),
        ("world", "1,0,0,0,1,0", "6 numbers; expected 9 or 16"),
        ("world", "1,0,0,0,2,0,0,0,1", "not a rotation"),
        ("world", "0,0,0,0,0,0,0,0,0", "not a rotation"),
        ("world", "nan,0,0,0,1,0,0,0,1", "neither numbers nor a text file"),
        ("world", "missing.txt", "neither numbers nor a text file of numbers: there is no such file"),
    ],
)
def test_invalid_space_is_a_one_line_error(tmp_path, monkeypatch, space, matrix, said):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError, match=said) as error:
        turns_of(checked(Reading(space=space, view_matrix=matrix)))
    assert "\n" not in str(error.value)


def test_invalid_code_space_is_an_error():
    with pytest.raises(UsageError, match="unknown code space 'screen'; known: view, world"):
        checked(Reading(code_space="screen"))
    with pytest.raises(UsageError, match="--space view --code-space world needs --view-matrix"):
        turns_of(checked(Reading(code_space="world")))
    with pytest.raises(UsageError, match=r"--space world needs --view-matrix.*or use --code-space world"):
        turns_of(checked(Reading(space="world")))


def test_masks_come_from_a_file_or_a_channel(tmp_path, monkeypatch):
    """Garbage under the mask is ignored."""
    monkeypatch.setattr(pixel_files, "_in_a_process", in_this_process)
    n, surface = some_normals(), np.zeros((48, 64), bool)
    surface[10:30, 5:60] = True
    n[~surface] = np.nan
    n[0, 0] = (5, 5, 5)
    write_exr(tmp_path / "frame.exr", planes_of(n) | {"A": surface.astype(np.float16)})
    (tmp_path / "mask.png").write_bytes(png_bytes(surface[..., None].astype(np.uint16) * 7))
    Image.fromarray(surface).save(tmp_path / "one.png")
    np.save(tmp_path / "mask.npy", surface)
    write_exr(tmp_path / "mask.exr", {"mask": surface.astype(np.float32)})
    for mask in ("A", *(str(tmp_path / name) for name in ("mask.png", "one.png", "mask.npy", "mask.exr"))):
        frame = capture(tmp_path / "frame.exr", Reading(mask=mask))
        assert np.array_equal(given(frame)[1], surface.ravel()), mask
        assert (frame.background, frame.not_finite) == (48 * 64 - 20 * 55, 0), mask
    np.save(tmp_path / "small.npy", surface[:5])
    for mask, message in ((str(tmp_path / "small.npy"), "5 x 64, normals are 48 x 64"), ("B", "no channel 'B'")):
        with pytest.raises(UsageError, match=message):
            capture(tmp_path / "frame.exr", Reading(mask=mask))


def test_nan_is_refused_or_masked_and_counted_as_requested(tmp_path, run):
    n = some_normals()
    n[3, 4:7] = [(np.nan,) * 3, (np.inf, 0, 0), (0, 0, np.nan)]
    n[5, :10] = 0
    np.save(tmp_path / "frame.npy", n)
    err = refusal(run, tmp_path / "frame.npy")
    assert "3 of 3062 normals are NaN or infinite, the first at row 3, column 4" in err
    (share,) = [word for word in err.split() if word.startswith("0.0")]
    arguments = ("--encoding", "octahedral", "--storage", "rg8", "--backend", "jax", "--format", "json")
    status, out, _ = run("quality", "--normals", str(tmp_path / "frame.npy"), *arguments, "--nan-share", share)
    (row,) = json.loads(out)
    assert status == 0 and (row["not_finite"], row["background"], row["count"]) == (3, 10, 48 * 64 - 13)
    assert row["angle_max_deg"] < 1 and row["invalid"] == 0
    assert "--nan-share 0.001 masks" not in refusal(run, tmp_path / "frame.npy", "--nan-share", "0.0005")


@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_png_with_every_filter_and_bit_depth_is_read(tmp_path, kind, channels):
    """The files are written byte by byte from the specification; noise on a ramp exercises every predictor."""
    rng = np.random.default_rng(0)
    ramp = np.arange(21 * 17 * channels).reshape(21, 17, channels) * (np.iinfo(kind).max // 4000)
    pixels = (ramp + rng.integers(0, np.iinfo(kind).max // 3, ramp.shape)).astype(kind)
    (tmp_path / "a.png").write_bytes(png_bytes(pixels, [4, 3, 2, 1, 0, 4, 4]))
    names = [["Y"], ["Y", "A"], list("RGB"), list("RGBA")][channels - 1]
    planes = pixel_process.read_pixels("png", str(tmp_path / "a.png"), names)
    assert planes.dtype == kind and np.array_equal(planes, np.moveaxis(pixels, -1, 0))
