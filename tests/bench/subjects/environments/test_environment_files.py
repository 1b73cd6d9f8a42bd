"""Environments by name and from files, and one-line errors for files that are not environments."""

import numpy as np
import pytest
from damaged import in_this_process
from written import write_exr

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.ground.output.kept_arrays import kept_arrays
from normalbench.bench.subjects.environments.environment_names import environment_named
from normalbench.bench.subjects.normals import pixel_files
from normalbench.gbuffer.environment.averaged import averaged
from normalbench.gbuffer.environment.environment import solid_angles
from normalbench.gbuffer.environment.prefilter import prefiltered


@pytest.fixture
def in_here(monkeypatch):
    """Reading of files in this process, because starting a process for each file takes half a second."""
    monkeypatch.setattr(pixel_files, "_in_a_process", in_this_process)


here = pytest.mark.usefixtures("in_here")


def light(height=16, seed=2):
    return np.exp(2 * np.random.default_rng(seed).normal(size=(height, 2 * height, 3))).astype(np.float32)


def exr(path, radiance, **more):
    return write_exr(path, {name: radiance[..., channel] for channel, name in enumerate("RGB")} | more)


@here
@pytest.mark.parametrize("kind", [np.float16, np.float32])
def test_exr_file_is_read_bit_for_bit(tmp_path, kind):
    """Alpha is neither read nor multiplied, and other layers are ignored."""
    radiance = light().astype(kind)
    aside = np.full(radiance.shape[:2], np.nan, kind)
    path = exr(tmp_path / "A.EXR", radiance, A=np.full_like(aside, 0.5), depth=aside)
    assert np.array_equal(environment_named(str(path)).radiance, radiance.astype(np.float32))


@here
def test_large_radiance_is_not_clamped(tmp_path):
    radiance = light()
    radiance[3, 4] = 72704
    assert environment_named(str(exr(tmp_path / "a.exr", radiance))).radiance.max() == 72704


def test_averages_are_over_the_area_of_each_texel():
    """Reduction by 2 averages two columns, and two rows by area; reduction by 1.5 weights texels by overlap."""
    radiance, area = light(8).astype(np.float64), solid_angles(8)[..., None]
    blocks = (radiance * area).reshape(4, 2, 8, 2, 3).sum((1, 3)) / (2 * area.reshape(4, 2, 1, 1).sum(1))
    assert averaged(radiance, 4) == pytest.approx(blocks, rel=1e-6)
    assert averaged(np.ones((24, 48, 3)), 16) == pytest.approx(np.ones((16, 32, 3)))
    by_column = np.broadcast_to(np.arange(48.0)[:, None], (24, 48, 3))
    assert averaged(by_column, 16)[3, :2, 0] == pytest.approx([(0 + 0.5) / 1.5, (0.5 + 2) / 1.5])


def with_value(value, row=5, column=7, channel=1):
    radiance = light()
    radiance[row, column, channel] = value
    return radiance


BAD = {
    "NaN": (with_value(np.nan), "G is nan at column 7, row 5, counted from 0 (1 pixels in total)"),
    "infinite": (with_value(np.inf), "G is inf at column 7, row 5"),
    "negative": (with_value(-0.25), "G is -0.25 at column 7, row 5"),
    "square": (np.ones((16, 16, 3), np.float32), "16 x 16 pixels; an equirectangular environment must be"),
    "a cube's cross": (np.ones((24, 32, 3), np.float32), "32 x 24 pixels; an equirectangular"),
    "small": (light(7), "14 x 7 pixels; at least 16 x 8 are required"),
}


@here
@pytest.mark.parametrize("what", BAD)
def test_invalid_environment_is_a_one_line_error(tmp_path, what):
    radiance, message = BAD[what]
    path = exr(tmp_path / "bad.exr", radiance)
    assert refused(path).startswith(f"{path}: {message}")


def refused(path):
    with pytest.raises(UsageError) as error:
        environment_named(str(path))
    message = str(error.value)
    assert "\n" not in message and str(path) in message and ("; " in message or ": " in message)
    return message


def test_file_that_is_too_wide_is_refused_from_its_header(tmp_path):
    """The file has no pixels, so nothing but the header can be read."""
    path = tmp_path / "wide.hdr"
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4100 +X 8200\n" + bytes(8200 * 4))
    assert "8200 x 4100 pixels; at most 8192 x 4096 are supported: shrink it" in refused(path)


@here
def test_grey_and_normal_images_are_refused_because_of_their_channels(tmp_path):
    grey = write_exr(tmp_path / "grey.exr", {"Y": np.ones((8, 16), np.float32)})
    assert "it has Y; it must have channels R, G and B" in refused(grey)
    normals = write_exr(tmp_path / "n.exr", {f"N.{axis}": np.ones((8, 16), np.float32) for axis in "XYZ"})
    assert "it has N.X, N.Y, N.Z; it must have" in refused(normals)


def test_unknown_name_is_an_error_that_lists_the_known_names():
    with pytest.raises(
        UsageError, match=r"did you mean studio\? known: studio, sky, strips, lamp; or a file ending in .hdr, .exr"
    ):
        environment_named("studoi")


@here
def test_prefiltered_levels_of_a_file_are_computed_once(own_cache, monkeypatch, tmp_path):
    monkeypatch.delenv("NORMALBENCH_NO_CACHE", raising=False)
    path = exr(tmp_path / "a.exr", light(8))
    first = prefiltered(environment_named(str(path)), kept_arrays)
    (kept,) = (own_cache / "normalbench" / "arrays").glob("*.npz")
    written = kept.stat().st_mtime_ns
    second = prefiltered(environment_named(str(path)), kept_arrays)
    assert np.array_equal(first.fine, second.fine) and np.array_equal(first.coarse, second.coarse)
    assert kept.stat().st_mtime_ns == written
    exr(path, light(8, seed=3))
    prefiltered(environment_named(str(path)), kept_arrays)
    assert len(list(kept.parent.glob("*.npz"))) == 2, "a file that has changed is another one"
