"""Bad captures: each is refused in one line, and the process lives on."""

import io
import os
import subprocess
import sys
import time
import zlib
from pathlib import Path

import numpy as np
import pytest
import written
from damaged import mutated, refusal
from written import chunk, given, needs_exr, packed, planes_of, png_bytes, some_normals, write_exr

from normalbench.bench.normals import pixel_files
from normalbench.bench.normals.captures import Reading, capture
from normalbench.bench.output.errors import UsageError


def npy(shape: tuple, data: bytes = b"", kind: str = "<f4") -> bytes:
    stream = io.BytesIO()
    header = {"descr": kind, "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(stream, header)
    return stream.getvalue() + data


def huge_png() -> bytes:
    head = (2**15).to_bytes(4, "big") * 2 + bytes([16, 2, 0, 0, 0])
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(bytes(2**20)))


def a_png() -> bytes:
    return png_bytes(packed(some_normals(), np.uint16))


def objects() -> bytes:
    stream = io.BytesIO()
    np.save(stream, np.array([[{}, 1, 2]], object), allow_pickle=True)
    return stream.getvalue()


BAD = {
    "an empty PNG": ("a.png", b"", ["no PNG header"]),
    "a PNG cut off": ("a.png", a_png()[:-40], ["cut off or damaged"]),
    "a PNG with a changed byte": ("a.png", a_png()[:90] + b"?" + a_png()[91:], ["damaged"]),
    "a PNG of a billion pixels": ("a.png", huge_png(), ["1073741824 pixels", "2^25"]),
    "a PNG that unpacks to more": (
        "a.png",
        a_png()[:33] + chunk(b"IDAT", zlib.compress(bytes(10**7))) + chunk(b"IEND", b""),
        ["more than"],
    ),
    "an interlaced PNG": ("a.png", png_bytes(packed(some_normals(), np.uint16), interlaced=1), ["interlaced"]),
    "a grey PNG": ("a.png", png_bytes(np.full((4, 4, 1), 9, np.uint8)), ["it has L"]),
    "a black PNG": ("a.png", png_bytes(np.zeros((4, 4, 3), np.uint8)), ["every pixel is background"]),
    "a photograph": ("a.png", png_bytes(np.full((4, 4, 3), (200, 180, 90), np.uint8)), ["not unit", "lengths"]),
    "no NPY": ("a.npy", b"numpy", ["no NPY header"]),
    "an NPY of objects": ("a.npy", objects(), ["numbers of type object"]),
    "an NPY of complex numbers": ("a.npy", npy((4, 3), bytes(96), "<c8"), ["type complex64"]),
    "an NPY cut off": ("a.npy", npy((4, 4, 3), bytes(100)), ["needs 192 bytes, the file has 100"]),
    "an NPY that promises": ("a.npy", npy((10**9, 10**9, 3)), ["cut off"]),
    "an NPY of one dimension": ("a.npy", npy((9,), bytes(36)), ["shape (9,)", "(height, width, 3)"]),
    "an NPY of four dimensions": ("a.npy", npy((1, 2, 2, 3), bytes(48)), ["shape (1, 2, 2, 3)"]),
    "an NPY of planes": ("a.npy", npy((3, 8, 8), bytes(4 * 192)), ["np.moveaxis"]),
    "an NPY of pairs": ("a.npy", npy((8, 8, 2), bytes(4 * 128)), ["it has 0, 1"]),
    "an NPY with nothing": ("a.npy", npy((0, 3)), ["shape (0, 3)"]),
    "an NPY with a bad header": ("a.npy", b"\x93NUMPY\x01\x00\x10\x00" + b"(" * 16, ["no NPY header"]),
    "no EXR": ("a.exr", b"exr", ["no EXR file"]),
}


@pytest.mark.parametrize("what", BAD)
def test_a_bad_file_is_one_line(tmp_path, run, what):
    name, data, said = BAD[what]
    if name.endswith(".exr"):
        pytest.importorskip("OpenEXR")
    (tmp_path / name).write_bytes(data)
    err = refusal(run, tmp_path / name)
    assert all(part in err for part in said), err


def test_what_is_no_plain_file_is_one_line(tmp_path, run):
    os.mkfifo(tmp_path / "pipe.npy")
    (tmp_path / "folder.png").mkdir()
    for name, said in (
        ("pipe.npy", "not a plain file"),
        ("folder.png", "not a plain file"),
        ("none.npy", "no such file"),
    ):
        assert said in refusal(run, tmp_path / name)


@needs_exr
@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 0.9, 0.999])
def test_a_truncated_exr_is_one_line(tmp_path, capfd, share):
    """The library drops the part and writes to both outputs; neither is seen."""
    path = write_exr(tmp_path / "frame.exr", planes_of(some_normals()))
    data = path.read_bytes()
    path.write_bytes(data[: max(int(share * len(data)), 4)])
    with pytest.raises(UsageError, match=r"frame.exr: .*cut off or damaged; save it again"):
        capture(path, Reading())
    assert capfd.readouterr() == ("", "")


@needs_exr
def test_an_exr_that_is_too_large_or_of_another_kind_is_one_line(tmp_path):
    """The window in the header is changed to 2^15 squared; nothing of that size is allocated."""
    path = write_exr(tmp_path / "frame.exr", planes_of(some_normals()))
    window = np.array([0, 0, 63, 47], "<i4").tobytes()
    assert path.read_bytes().count(window) == 2
    path.write_bytes(path.read_bytes().replace(window, np.array([0, 0, 2**15 - 1, 2**15 - 1], "<i4").tobytes()))
    with pytest.raises(UsageError, match=r"1073741824 pixels of 3 channels; at most 33554432 pixels"):
        capture(path, Reading())


def test_exr_without_its_package_says_what_to_install(tmp_path, run, monkeypatch):
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    (tmp_path / "a.exr").write_bytes(pixel_files.EXR_MAGIC)
    status, out, err = run("quality", "--normals", str(tmp_path / "a.exr"))
    assert (status, out) == (3, "") and err.count("\n") == 1 and "pip install OpenEXR" in err


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["--normals", "sphere", "--unpack"], "options of captures are given, but --normals sphere names none"),
        (["--normals", "frame.tga"], "unknown normal set 'frame.tga'; known: all, sphere"),
        (["--normals", "frame.tga"], "or a file that ends in .exr, .png, .npy, .glb, .gltf, .obj, .ply"),
        (["--normals", "a.npy", "--nan-share", "2"], "a share is 0 to 1"),
        (["--normals", "a.npy", "--fov", "0"], "1 to 175 degrees"),
        (["--normals", "a.glb", "--size", "1x99999"], "each from 1 to 16384"),
        (["--normals", "a.glb", "--size", "16000x16000"], "2^25"),
    ],
)
def test_bad_usage_is_one_line(run, arguments, said):
    status, out, err = run("quality", "--backend", "jax", *arguments)
    assert (status, out) == (2, "") and err.count("\n") == 1 and said in err, err


# Fuzzing


@pytest.mark.parametrize("kind", ["png16", "png8", "npy"])
def test_damaged_images_are_read_or_refused_and_nothing_else(tmp_path, kind):
    """200 seeded changes each; half of them keep the checksums right, so that what is inside is met."""
    n = some_normals()[:12, :16]
    stream = io.BytesIO()
    np.save(stream, n)
    whole = {
        "png16": png_bytes(packed(n, np.uint16)),
        "png8": png_bytes(packed(n, np.uint8)),
        "npy": stream.getvalue(),
    }[kind]
    path = tmp_path / f"a.{kind[:3]}"
    counts, slowest = {True: 0, False: 0}, 0.0
    for seed in range(200):
        rng = np.random.default_rng(seed)
        path.write_bytes(resealed(whole, rng) if kind != "npy" and seed % 2 else mutated(whole, rng))
        start = time.process_time()
        try:
            made, _ = capture(path, Reading(nan_share=1.0, normalise=True))
            assert np.isfinite(given(made)[0]).all(), seed
            counts[True] += 1
        except UsageError as error:
            assert str(error).startswith(str(path)) and "\n" not in str(error), (seed, str(error))
            counts[False] += 1
        slowest = max(slowest, time.process_time() - start)
    assert slowest < 2, f"{slowest:.1f} s"
    assert min(counts.values()) > 5, f"changes must be both harmless and harmful: {counts}"


def resealed(data: bytes, rng: np.random.Generator) -> bytes:
    """A PNG whose header or rows are changed, each chunk with the checksum of what it then holds."""
    head, rows = bytearray(data[16:29]), bytearray(zlib.decompress(data[41:-16]))
    if rng.random() < 0.3:
        head[rng.integers(3, 13)] = rng.integers(256)
    for _ in range(4):
        rows[rng.integers(len(rows))] = rng.integers(256)
    body = chunk(b"IHDR", bytes(head)) + chunk(b"IDAT", zlib.compress(bytes(rows))) + chunk(b"IEND", b"")
    return data[:8] + body


EXR_LOOP = """
import sys, numpy as np
from damaged import mutated
from normalbench.bench.normals import exr_process
data, found = open(sys.argv[1], "rb").read(), {"read": 0, "refused": 0}
for seed in range(300):
    rng = np.random.default_rng(seed)
    changed = data[:4] + mutated(data[4:400], rng) + data[400:] if seed % 2 else data[:400] + mutated(data[400:], rng)
    open(sys.argv[2], "wb").write(changed)
    try:
        exr_process.read_pixels(sys.argv[2], ["N.X"])
        found["read"] += 1
    except Exception:
        found["refused"] += 1
print("", *found.values(), file=sys.stderr)
"""


@needs_exr
def test_damaged_exr_files_are_read_or_refused_and_nothing_else(tmp_path):
    """300 seeded changes by one process, which must neither die nor hang; six by the whole way."""
    whole = write_exr(tmp_path / "whole.exr", planes_of(some_normals()))
    command = [sys.executable, "-c", EXR_LOOP, str(whole), str(tmp_path / "a.exr")]
    environment = os.environ | {"PYTHONPATH": str(Path(written.__file__).parent)}
    done = subprocess.run(command, capture_output=True, text=True, timeout=100, env=environment)
    assert done.returncode == 0, done.stderr[-500:]
    read, refused = map(int, done.stderr.splitlines()[-1].split())
    assert read > 5 and refused > 100, (read, refused)
    for seed in range(6):
        path = tmp_path / "one.exr"
        path.write_bytes(mutated(whole.read_bytes(), np.random.default_rng(seed)))
        try:
            capture(path, Reading(nan_share=1.0, normalise=True))
        except UsageError as error:
            assert str(error).startswith(str(path)) and "\n" not in str(error)


@needs_exr
def test_an_exr_that_is_never_done_is_given_up(tmp_path, monkeypatch):
    path = write_exr(tmp_path / "frame.exr", planes_of(some_normals()))
    monkeypatch.setattr(pixel_files, "SECONDS", 0.001)
    with pytest.raises(UsageError, match="not read within"):
        capture(path, Reading())
