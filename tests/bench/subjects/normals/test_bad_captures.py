"""Bad captures, each refused with a one-line error that does not end the process."""

import io
import os
import sys
import zlib

import numpy as np
import pytest
from damaged import refusal
from written import chunk, dds_bytes, packed, planes_of, png_bytes, some_normals, write_exr, write_image

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.normals import pixel_files
from normalbench.bench.subjects.normals.captures import Reading, capture


def npy(shape: tuple, data: bytes = b"", kind: str = "<f4") -> bytes:
    stream = io.BytesIO()
    header = {"descr": kind, "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(stream, header)
    return stream.getvalue() + data


def huge_png(side: int = 2**15) -> bytes:
    head = side.to_bytes(4, "big") * 2 + bytes([16, 2, 0, 0, 0])
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(bytes(2**20)))


def a_png() -> bytes:
    return png_bytes(packed(some_normals(), np.uint16))


def huge_dds() -> bytes:
    data = dds_bytes(np.zeros((4, 4, 4), np.uint8))
    return data[:12] + (2**15).to_bytes(4, "little") * 2 + data[20:]


def objects() -> bytes:
    stream = io.BytesIO()
    np.save(stream, np.array([[{}, 1, 2]], object), allow_pickle=True)
    return stream.getvalue()


BAD = {
    "an empty PNG": ("a.png", b"", ["its first bytes are not those of PNG files"]),
    "a PNG cut off": ("a.png", a_png()[:-40], ["cut off or damaged"]),
    "a PNG with a changed byte": ("a.png", a_png()[:90] + b"?" + a_png()[91:], ["damaged"]),
    "a PNG of a billion pixels": ("a.png", huge_png(), ["far more pixels than the file can hold", "2^25"]),
    "a PNG of 67 million": ("a.png", huge_png(2**13), ["67108864 pixels of 3 channels", "2^25"]),
    "a photograph by another name": (
        "a.png",
        b"\xff\xd8\xff\xe0" + bytes(99),
        ["its first bytes are not those of PNG files"],
    ),
    "a TIFF of another kind": ("a.png", b"II*\0" + bytes(99), ["its first bytes are not those of PNG files"]),
    "no TIFF": ("a.tif", b"tiff" + bytes(99), ["its first bytes are not those of TIF files"]),
    "a TIFF cut off": ("a.tif", b"II*\0" + bytes(99), ["cut off or damaged"]),
    "no DDS": ("a.dds", b"", ["its first bytes are not those of DDS files"]),
    "a DDS of a billion": ("a.dds", huge_dds(), ["far more pixels", "2^25"]),
    "no HDR": ("a.hdr", b"hdr", ["its first bytes are not those of HDR files"]),
    "an HDR of a billion": (
        "a.hdr",
        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32768 +X 32768\n" + bytes(99),
        ["far more pixels", "2^25"],
    ),
    "no WebP": ("a.webp", b"RIFF", ["its first bytes are not those of WEBP files"]),
    "a PNG that unpacks to more": (
        "a.png",
        a_png()[:33] + chunk(b"IDAT", zlib.compress(bytes(10**7))) + chunk(b"IEND", b""),
        ["more rows than its header says"],
    ),
    "a PNG that says it is interlaced": (
        "a.png",
        png_bytes(packed(some_normals(), np.uint16), interlaced=1),
        ["cut off or damaged"],
    ),
    "a grey PNG": ("a.png", png_bytes(np.full((4, 4, 1), 9, np.uint8)), ["it has Y"]),
    "a black PNG": ("a.png", png_bytes(np.zeros((4, 4, 3), np.uint8)), ["every pixel is background"]),
    "a photograph": ("a.png", png_bytes(np.full((4, 4, 3), (200, 180, 90), np.uint8)), ["not unit", "lengths"]),
    "no NPY": ("a.npy", b"numpy", ["its NPY header cannot be read"]),
    "an NPY of objects": ("a.npy", objects(), ["numbers of type object"]),
    "an NPY of complex numbers": ("a.npy", npy((4, 3), bytes(96), "<c8"), ["type complex64"]),
    "an NPY cut off": ("a.npy", npy((4, 4, 3), bytes(100)), ["needs 192 bytes; the file has 100"]),
    "an NPY that promises": ("a.npy", npy((10**9, 10**9, 3)), ["it is truncated"]),
    "an NPY of one dimension": ("a.npy", npy((9,), bytes(36)), ["shape (9,)", "(height, width, 3)"]),
    "an NPY of four dimensions": ("a.npy", npy((1, 2, 2, 3), bytes(48)), ["shape (1, 2, 2, 3)"]),
    "an NPY of planes": ("a.npy", npy((3, 8, 8), bytes(4 * 192)), ["np.moveaxis"]),
    "an NPY of pairs": ("a.npy", npy((8, 8, 2), bytes(4 * 128)), ["it has 0, 1"]),
    "an NPY with nothing": ("a.npy", npy((0, 3)), ["shape (0, 3)"]),
    "an NPY with a bad header": ("a.npy", b"\x93NUMPY\x01\x00\x10\x00" + b"(" * 16, ["its NPY header cannot be read"]),
    "no EXR": ("a.exr", b"exr", ["its first bytes are not those of EXR files"]),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_file_is_a_one_line_error(tmp_path, run, what):
    name, data, parts = BAD[what]
    (tmp_path / name).write_bytes(data)
    err = refusal(run, tmp_path / name)
    assert all(part in err for part in parts), err


def test_pipe_folder_or_missing_file_is_a_one_line_error(tmp_path, run):
    os.mkfifo(tmp_path / "pipe.npy")
    (tmp_path / "folder.png").mkdir()
    for name, message in (
        ("pipe.npy", "not a plain file"),
        ("folder.png", "it is a folder; name a file"),
        ("none.npy", "no such file"),
    ):
        assert message in refusal(run, tmp_path / name)


def test_unsupported_number_type_is_a_one_line_error(tmp_path):
    path = write_image(tmp_path / "a.tif", np.ones((4, 4, 3), np.int16))
    with pytest.raises(UsageError, match="numbers of type int16; supported: uint8, uint16, half, float, double"):
        capture(path, Reading())


def test_parts_of_different_sizes_are_a_one_line_error(tmp_path):
    n = some_normals()
    path = write_exr(tmp_path / "a.exr", {"large": {"X": n[..., 0]}, "small": planes_of(n[:9], ("x", "Y", "Z"))})
    with pytest.raises(UsageError, match=r"large.X, small.Y, small.Z are in parts of different sizes or types"):
        capture(path, Reading(channels="large.X,small.Y,small.Z"))


def test_library_crash_is_a_one_line_error(tmp_path, monkeypatch):
    (tmp_path / "python").write_text("#!/bin/sh\nkill -SEGV $$\n")
    (tmp_path / "python").chmod(0o700)
    path = write_exr(tmp_path / "frame.exr", planes_of(some_normals()))
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    with pytest.raises(UsageError, match=r"frame.exr: it is cut off or damaged; save it again"):
        capture(path, Reading())


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["--normals", "sphere", "--unpack"], "options for captures are given, but --normals sphere names no capture"),
        (["--normals", "frame.tga"], "unknown normal set 'frame.tga'; known: all, sphere"),
        (["--normals", "frame.tga"], "or a file ending in .exr, .png, .tif, .tiff, .dds, .hdr, .webp, .npy, .glb"),
        (["--normals", "a.npy", "--nan-share", "2"], "out of range; use 0 to 1"),
        (["--normals", "a.npy", "--fov", "0"], "use 1 to 175"),
        (["--normals", "a.glb", "--size", "1x99999"], "each from 1 to 16384"),
        (["--normals", "a.glb", "--size", "16000x16000"], "2^25"),
    ],
)
def test_bad_usage_is_a_one_line_error(run, arguments, said):
    status, out, err = run("quality", "--backend", "jax", *arguments)
    assert (status, out) == (2, "") and err.count("\n") == 1 and said in err, err


def test_reading_an_exr_times_out(tmp_path, monkeypatch):
    path = write_exr(tmp_path / "frame.exr", planes_of(some_normals()))
    monkeypatch.setattr(pixel_files, "SECONDS", 0.001)
    with pytest.raises(UsageError, match="not read within"):
        capture(path, Reading())
