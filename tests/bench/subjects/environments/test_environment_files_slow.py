"""Environments by name and from files, and one-line errors for files that are not environments."""

import os

import numpy as np
import pytest
import test_environment_files
from test_environment_files import exr, here, light, refused
from written import png_bytes, write_image

from normalbench.bench.subjects.environments.environment_names import environment_named
from normalbench.gbuffer.environment.catalogue import ENVIRONMENTS
from normalbench.gbuffer.environment.environment import solid_angles

in_here = test_environment_files.in_here


def test_radiance_file_is_read_to_rgbe_precision(tmp_path):
    """RGBE's three colours share an exponent; the file is read in a separate process."""
    sky = environment_named(str(write_image(tmp_path / "a.hdr", light())))
    assert sky.name == "a.hdr" and sky.changes == () and sky.sun is None
    assert sky.radiance.dtype == np.float32 and sky.radiance.flags.c_contiguous
    assert np.abs(sky.radiance - light()).max() <= light().max(-1).max() / 128
    assert (np.abs(sky.radiance - light()).max(-1) <= light().max(-1) / 127).all()


def test_catalogue_names_ignore_case_and_spaces():
    for name in ENVIRONMENTS:
        assert environment_named(f" {name.upper()} ").name == name


@here
@pytest.mark.parametrize(("height", "wanted"), [(513, 512), (1024, 512), (10, 8), (30, 28)])
def test_a_larger_file_is_averaged_and_the_change_is_recorded(tmp_path, height, wanted):
    """The result is at most 1024 x 512, with a width divisible by 8; no light is lost."""
    radiance = light(height)
    sky = environment_named(str(exr(tmp_path / "a.exr", radiance)))
    assert sky.radiance.shape == (wanted, 2 * wanted, 3) and sky.radiance.dtype == np.float32
    assert sky.changes == (f"averaged from {2 * height} x {height}",)
    before, after = (
        (rgb.astype(np.float64) * solid_angles(len(rgb))[..., None]).sum((0, 1)) for rgb in (radiance, sky.radiance)
    )
    assert after == pytest.approx(before, rel=1e-6)


def test_files_that_are_not_environments_are_one_line_errors(tmp_path):
    (tmp_path / "sky.png").write_bytes(png_bytes(np.zeros((8, 16, 3), np.uint8)))
    (tmp_path / "photo.hdr").write_bytes(b"\xff\xd8\xff\xe0" + bytes(99))
    (tmp_path / "cut.hdr").write_bytes(write_image(tmp_path / "whole.hdr", light()).read_bytes()[:-900])
    (tmp_path / "scene.glb").write_bytes(b"glTF")
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder.exr").mkdir()
    os.mkfifo(tmp_path / "pipe.exr")
    for name, message in (
        ("sky.png", "it stores no light brighter than white; save the environment as .hdr or .exr"),
        ("none.jpg", "it stores no light brighter than white"),
        ("photo.hdr", "its first bytes are not those of HDR files; save it again"),
        ("cut.hdr", "it is cut off or damaged; save it again"),
        ("scene.glb", ".hdr and .exr files are supported"),
        ("folder", "it is a folder; name a file"),
        ("folder.exr", "it is a folder; name a file"),
        ("pipe.exr", "it is not a plain file"),
        ("none.hdr", "there is no such file"),
    ):
        assert message in refused(tmp_path / name), name
