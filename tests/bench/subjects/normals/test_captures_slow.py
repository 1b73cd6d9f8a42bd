"""Captured frames as sets of normals: channels, packing, spaces, masks and errors."""

import struct
import time
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from test_captures import capture
from written import (
    chunk,
    dds_bytes,
    given,
    packed,
    planes_of,
    png_bytes,
    some_normals,
    write_exr,
    write_image,
)

from normalbench.bench.subjects.normals.captures import Reading, chosen_channels
from normalbench.bench.subjects.normals.normal_sets import playground
from normalbench.bench.subjects.normals.pixel_files import read_pixels
from normalbench.bench.tables.quality.measure import QualityCase, measure
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.scenes.built_in.playground import CAMERA
from normalbench.gbuffer.scenes.built_in.playground import playground as rendered

RG8 = Codec(ENCODINGS["octahedral"], STORAGES["rg8"])


def figures(made, codec: Codec = RG8) -> dict:
    row = measure(QualityCase(codec, made, "jax"))
    hidden = ("normals", "not_finite", "code_space")
    return {column: value for column, value in row.items() if column not in hidden}


def test_rays_from_a_field_of_view_agree_with_the_cameras_rays(tmp_path):
    """`per_pixel_view` with the playground's normals and field of view is within 0.01 dB of the playground itself."""
    np.save(tmp_path / "frame.npy", rendered().normals)
    codec = Codec(ENCODINGS["per_pixel_view"], STORAGES["rg8"])
    frame = capture(tmp_path / "frame.npy", Reading(fov=CAMERA.fov))
    own, parallel = figures(playground(), codec)["psnr_db"], figures(replace(frame), codec)["psnr_db"]
    assert parallel == pytest.approx(own, abs=0.01)
    without = figures(capture(tmp_path / "frame.npy", Reading()), codec)["psnr_db"]
    assert abs(without - own) > 5, "parallel rays are another matter"


def test_zero_length_normals_are_background(tmp_path):
    """Zeros, values within an 8-bit step of zero and cleared packed targets are background, and never NaN."""
    n = some_normals()
    n[:5] = 0
    np.save(tmp_path / "frame.npy", n)
    stored = packed(n, np.uint8)
    stored[2:4] = (127, 128, 127)
    Image.fromarray(stored).save(tmp_path / "frame.png")
    for name in ("frame.npy", "frame.png"):
        frame = capture(tmp_path / name, Reading())
        n_made, covered = given(frame)
        assert frame.background == 5 * 64 and not covered[: 5 * 64].any() and covered[5 * 64 :].all()
        assert np.isfinite(n_made).all()


def all_of(path: Path):
    """Return every channel of a file, (channels, height, width), and the value that represents 1."""
    image = read_pixels(path, lambda names: names)
    return image.planes, image.full


# Of each format: the type of its numbers, and how OpenImageIO is to write it.
FORMATS = {
    "a.png": (np.uint16, {}),
    "b.png": (np.uint8, {}),
    "a.tif": (np.uint8, {"compression": "lzw"}),
    "b.tif": (np.uint16, {"compression": "zip"}),
    "c.tif": (np.float16, {"compression": "zip"}),
    "d.tiff": (np.float32, {"compression": "none"}),
    "e.tiff": (np.float64, {"compression": "zip", "planarconfig": "separate"}),
}


@pytest.mark.parametrize("name", FORMATS)
def test_numbers_in_every_format_are_read_unchanged(tmp_path, name):
    """Colour is neither multiplied by alpha nor converted, and 16 bits stay 16."""
    kind, how = FORMATS[name]
    pixels = np.random.default_rng(0).integers(0, 2**16, (9, 7, 4))
    pixels = pixels.astype(kind) if np.issubdtype(kind, np.integer) else (pixels / 2**16 - 0.5).astype(kind)
    pixels[0, :, 3] = 0
    planes, full = all_of(write_image(tmp_path / name, pixels, **how))
    assert np.array_equal(planes, np.moveaxis(pixels, -1, 0)), abs(planes - np.moveaxis(pixels, -1, 0)).max()
    assert full == (np.iinfo(kind).max if np.issubdtype(kind, np.integer) else None)
    assert planes.dtype == (np.float64 if kind is np.float64 else np.float32)


def test_dds_webp_and_radiance_files_are_read(tmp_path):
    """Integers are exact, even under an alpha of 0; Radiance values are exact to their 8 bits."""
    pixels = np.random.default_rng(0).integers(0, 256, (9, 7, 4), np.uint8)
    (tmp_path / "a.dds").write_bytes(dds_bytes(pixels))
    Image.fromarray(pixels).save(tmp_path / "a.webp", lossless=True, exact=True)
    for name in ("a.dds", "a.webp"):
        planes, full = all_of(tmp_path / name)
        assert np.array_equal(planes, np.moveaxis(pixels, -1, 0)) and full == 255, name
    exact = pixels[..., :3].astype(np.float32) / 256
    exact[..., 2] = np.maximum(exact[..., 2], 0.5)
    planes, full = all_of(write_image(tmp_path / "a.hdr", exact))
    assert np.array_equal(planes, np.moveaxis(exact, -1, 0)) and full is None


def test_pages_of_a_file_are_layers(tmp_path):
    pages = [np.random.default_rng(seed).integers(1, 256, (9, 7, 3), np.uint8) for seed in range(2)]
    Image.fromarray(pages[0]).save(tmp_path / "a.tif", save_all=True, append_images=[Image.fromarray(pages[1])])
    seen = []
    image = read_pixels(tmp_path / "a.tif", lambda names: seen.extend(names) or ["2.R", "G"])
    assert seen == ["R", "G", "B", "2.R", "2.G", "2.B"]
    assert np.array_equal(image.planes, [pages[1][..., 0], pages[0][..., 1]])
    assert chosen_channels(tmp_path / "a.tif", seen, None) == ["R", "G", "B"]


def test_integers_in_an_exr_are_not_scaled(tmp_path):
    """An object's id is not a fraction of 2^32."""
    objects = np.arange(63, dtype=np.uint32).reshape(9, 7)
    planes, full = all_of(write_exr(tmp_path / "a.exr", {"id": objects}))
    assert np.array_equal(planes, [objects]) and full is None


@pytest.mark.parametrize("size", [(9, 13), (1, 1), (3, 2)])
def test_an_interlaced_png_is_read(tmp_path, size):
    """The file has seven passes in order, each encoded as a separate image."""
    pixels = np.random.default_rng(0).integers(0, 2**16, (*size, 3), np.uint16)
    passes = [(0, 0, 8, 8), (0, 4, 8, 8), (4, 0, 8, 4), (0, 2, 4, 4), (2, 0, 4, 2), (0, 1, 2, 2), (1, 0, 2, 1)]
    parts = [pixels[y::down, x::across].astype(">u2") for y, x, down, across in passes]
    rows = b"".join(b"\0" + row.tobytes() for part in parts if part.size for row in part)
    head = struct.pack(">IIBBBBB", size[1], size[0], 16, 2, 0, 0, 1)
    body = chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    (tmp_path / "a.png").write_bytes(b"\x89PNG\r\n\x1a\n" + body)
    assert np.array_equal(all_of(tmp_path / "a.png")[0], np.moveaxis(pixels, -1, 0))


def test_playground_read_from_a_file_has_the_playgrounds_own_figures(tmp_path):
    """EXR in float and NPY in float32 and float64 agree to the bit, including the counts."""
    n = rendered().normals
    write_exr(tmp_path / "frame.exr", planes_of(n))
    np.save(tmp_path / "frame32.npy", n)
    np.save(tmp_path / "frame64.npy", np.asfortranarray(n.astype(np.float64)))
    expected = figures(playground())
    for name in ("frame.exr", "frame32.npy", "frame64.npy"):
        assert figures(capture(tmp_path / name, Reading())) == expected, name


@pytest.mark.parametrize("how, angle", [("half", 0.03), ("half npy", 0.03), ("png16", 0.002), ("png8", 0.4)])
def test_error_of_coarser_files_matches_their_number_format(tmp_path, how, angle):
    """Half steps near 1 are 2^-12 in half floats, 2^-16 in 16 bits, 1/255 in 8; errors reach sqrt(3) half steps."""
    n = rendered().normals
    if how == "half":
        path = write_exr(tmp_path / "frame.exr", planes_of(n.astype(np.float16)))
    elif how == "half npy":
        path = tmp_path / "frame.npy"
        np.save(path, n.astype(np.float16))
    else:
        path = tmp_path / "frame.png"
        path.write_bytes(png_bytes(packed(n, np.uint16 if how == "png16" else np.uint8)))
    normals, covered = given(capture(path, Reading()))
    assert np.array_equal(covered, rendered().covered.ravel())
    dot = np.sum(normals[covered].astype(np.float64) * n.reshape(-1, 3)[covered], axis=1)
    cross = np.linalg.norm(np.cross(normals[covered].astype(np.float64), n.reshape(-1, 3)[covered]), axis=1)
    off = np.degrees(np.arctan2(cross, dot))
    assert off.max() < angle and off.max() > angle / 20, f"{off.max():.4f} degrees"
    assert abs(np.linalg.norm(normals[covered].astype(np.float64), axis=1) - 1).max() < 2e-6


def test_images_are_written_for_a_capture(tmp_path, run):
    (tmp_path / "frame.png").write_bytes(png_bytes(packed(some_normals(), np.uint16)))
    arguments = ("--encoding", "octahedral", "--storage", "rg8", "--backend", "jax", "--images", str(tmp_path / "p"))
    assert run("quality", "--normals", str(tmp_path / "frame.png"), *arguments)[0] == 0
    with Image.open(tmp_path / "p" / "frame.png-octahedral-rg8-decoded.png") as image:
        shown = np.asarray(image).astype(int)
    assert shown.shape == (48, 64, 3) and abs(shown - (some_normals() * 0.5 + 0.5) * 255).max() < 4


def test_layers_and_parts_of_an_exr_are_selected_by_name(tmp_path):
    n, other = some_normals(), some_normals(seed=1)
    planes = planes_of(other, ("R", "G", "B")) | planes_of(n.astype(np.float16), ("Nx", "Ny", "Nz"))
    write_exr(tmp_path / "layers.exr", planes, compression="piz")
    assert np.allclose(given(capture(tmp_path / "layers.exr", Reading()))[0], n.reshape(-1, 3), atol=1e-3)
    normals = given(capture(tmp_path / "layers.exr", Reading(channels="B,G,R")))[0]
    assert np.array_equal(normals, other.reshape(-1, 3)[:, ::-1])
    write_exr(tmp_path / "parts.exr", {"beauty": planes_of(other, tuple("XYZ")), "normal": planes_of(n, tuple("XYZ"))})
    assert np.array_equal(given(capture(tmp_path / "parts.exr", Reading()))[0], n.reshape(-1, 3))
    normals = given(capture(tmp_path / "parts.exr", Reading(channels="beauty")))[0]
    assert np.array_equal(normals, other.reshape(-1, 3))


@pytest.mark.parametrize("shape", [(1080, 1920, 3), (1, 262144, 3), (262144, 1, 3)])
def test_16_bit_images_of_any_shape_are_read_in_seconds(tmp_path, shape):
    n = np.random.default_rng(0).integers(0, 2**16, shape, np.uint16)
    (tmp_path / "a.png").write_bytes(png_bytes(n))
    start = time.perf_counter()
    assert np.array_equal(all_of(tmp_path / "a.png")[0], np.moveaxis(n, -1, 0))
    assert time.perf_counter() - start < 10
