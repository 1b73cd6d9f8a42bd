"""Captured frames as sets of normals: channels, packing, spaces, masks, and what bad files get."""

import time

import numpy as np
import pytest
from PIL import Image
from test_captures import all_of, capture, figures
from written import (
    given,
    packed,
    planes_of,
    png_bytes,
    some_normals,
    write_exr,
)

from normalbench.bench.subjects.normals.captures import Reading
from normalbench.bench.subjects.normals.normal_sets import playground
from normalbench.gbuffer.scenes.built_in.playground import playground as rendered


def test_the_playground_through_a_file_has_the_playgrounds_own_figures(tmp_path):
    """To the bit, by EXR in float and NPY in float32 and float64; the counts are its own too."""
    n = rendered().normals
    write_exr(tmp_path / "frame.exr", planes_of(n))
    np.save(tmp_path / "frame32.npy", n)
    np.save(tmp_path / "frame64.npy", np.asfortranarray(n.astype(np.float64)))
    expected = figures(playground())
    for name in ("frame.exr", "frame32.npy", "frame64.npy"):
        assert figures(capture(tmp_path / name, Reading())) == expected, name


@pytest.mark.parametrize("how, angle", [("half", 0.03), ("half npy", 0.03), ("png16", 0.002), ("png8", 0.4)])
def test_coarser_files_are_as_far_off_as_their_numbers_are_coarse(tmp_path, how, angle):
    """Half steps of half floats are 2^-12 beside 1, of 16 bits 2^-16, of 8 bits 1/255; up to sqrt 3 of that is lost."""
    n = rendered().normals
    if how == "half":
        path = write_exr(tmp_path / "frame.exr", planes_of(n.astype(np.float16)))
    elif how == "half npy":
        path = tmp_path / "frame.npy"
        np.save(path, n.astype(np.float16))
    else:
        path = tmp_path / "frame.png"
        path.write_bytes(png_bytes(packed(n, np.uint16 if how == "png16" else np.uint8)))
    made, covered = given(capture(path, Reading()))
    assert np.array_equal(covered, rendered().covered.ravel())
    dot = np.sum(made[covered].astype(np.float64) * n.reshape(-1, 3)[covered], axis=1)
    cross = np.linalg.norm(np.cross(made[covered].astype(np.float64), n.reshape(-1, 3)[covered]), axis=1)
    off = np.degrees(np.arctan2(cross, dot))
    assert off.max() < angle and off.max() > angle / 20, f"{off.max():.4f} degrees"
    assert abs(np.linalg.norm(made[covered].astype(np.float64), axis=1) - 1).max() < 2e-6


def test_pictures_are_drawn_of_a_capture(tmp_path, run):
    (tmp_path / "frame.png").write_bytes(png_bytes(packed(some_normals(), np.uint16)))
    arguments = ("--encoding", "octahedral", "--storage", "rg8", "--backend", "jax", "--images", str(tmp_path / "p"))
    assert run("quality", "--normals", str(tmp_path / "frame.png"), *arguments)[0] == 0
    with Image.open(tmp_path / "p" / "frame.png-octahedral-rg8-decoded.png") as image:
        shown = np.asarray(image).astype(int)
    assert shown.shape == (48, 64, 3) and abs(shown - (some_normals() * 0.5 + 0.5) * 255).max() < 4


def test_layers_and_parts_of_an_exr_by_name(tmp_path):
    n, other = some_normals(), some_normals(seed=1)
    planes = planes_of(other, ("R", "G", "B")) | planes_of(n.astype(np.float16), ("Nx", "Ny", "Nz"))
    write_exr(tmp_path / "layers.exr", planes, compression="piz")
    assert np.allclose(given(capture(tmp_path / "layers.exr", Reading()))[0], n.reshape(-1, 3), atol=1e-3)
    made = given(capture(tmp_path / "layers.exr", Reading(channels="B,G,R")))[0]
    assert np.array_equal(made, other.reshape(-1, 3)[:, ::-1])
    write_exr(tmp_path / "parts.exr", {"beauty": planes_of(other, tuple("XYZ")), "normal": planes_of(n, tuple("XYZ"))})
    assert np.array_equal(given(capture(tmp_path / "parts.exr", Reading()))[0], n.reshape(-1, 3))
    made = given(capture(tmp_path / "parts.exr", Reading(channels="beauty")))[0]
    assert np.array_equal(made, other.reshape(-1, 3))


@pytest.mark.parametrize("shape", [(1080, 1920, 3), (1, 262144, 3), (262144, 1, 3)])
def test_16_bits_of_any_shape_are_read_in_seconds(tmp_path, shape):
    n = np.random.default_rng(0).integers(0, 2**16, shape, np.uint16)
    (tmp_path / "a.png").write_bytes(png_bytes(n))
    start = time.perf_counter()
    assert np.array_equal(all_of(tmp_path / "a.png")[0], np.moveaxis(n, -1, 0))
    assert time.perf_counter() - start < 10
