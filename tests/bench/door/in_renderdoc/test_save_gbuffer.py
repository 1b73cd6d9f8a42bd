"""`normalbench renderdoc`: the script saves a G-buffer as it is, and names commands that measure it."""

import ast
import json
import math
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import captured_program
import numpy as np
import OpenImageIO as oiio  # noqa: N813 # as its own documentation has it
import pytest

from normalbench.bench.door.in_renderdoc import save_gbuffer as script

TEXT = Path(script.__file__).read_text()


def test_it_is_written_as_it_is(run, tmp_path):
    target = tmp_path / "save.py"
    assert run("renderdoc", "--script", str(target)) == (0, "", "")
    assert target.read_text() == TEXT and run("renderdoc")[:2] == (0, TEXT)
    status, _, err = run("renderdoc", "--script", str(tmp_path / "nowhere" / "save.py"))
    assert status == 2 and len(err.splitlines()) == 1


def test_it_is_python_3_6_and_needs_nothing():
    tree = ast.parse(TEXT, feature_version=(3, 6))
    names = {one.name for node in ast.walk(tree) if isinstance(node, ast.Import) for one in node.names}
    names |= {str(node.module) for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert names - {"renderdoc"} <= sys.stdlib_module_names and "__future__" not in names


RNG = np.random.default_rng(7)


@pytest.mark.parametrize(
    ("kind", "stored", "shown"),
    [
        ("UNorm", np.uint8, lambda n: n / 255),
        ("UNorm", np.uint16, lambda n: n / 65535),
        ("SNorm", np.int8, lambda n: np.maximum(n / 127, -1)),
        ("SNorm", np.int16, lambda n: np.maximum(n / 32767, -1)),
        ("UNormSRGB", np.uint8, lambda n: n / 255),
        ("UInt", np.uint16, lambda n: n),
        ("SInt", np.int8, lambda n: n),
    ],
)
def test_integers_are_read_as_the_format_means_them(kind, stored, shown):
    limits = np.iinfo(stored)
    numbers = RNG.integers(limits.min, limits.max, (50, 3), stored, endpoint=True)
    numbers[0] = limits.min
    found = script.planes(numbers.tobytes(), "Regular", kind, stored().itemsize, 3)
    assert np.array_equal(np.transpose(found), shown(numbers.astype(np.float64)))


def test_floats_are_read_as_they_are():
    for stored in (np.float16, np.float32):
        numbers = RNG.normal(size=(50, 2)).astype(stored)
        found = script.planes(numbers.tobytes(), "Regular", "Float", numbers.itemsize, 2)
        assert np.array_equal(np.transpose(found), numbers)


def test_packed_formats_are_read_by_their_bits():
    parts = RNG.integers(0, 1024, (40, 3), np.uint32)
    alpha = RNG.integers(0, 4, 40, np.uint32)
    words = parts[:, 0] | parts[:, 1] << 10 | parts[:, 2] << 20 | alpha << 30
    *colour, a = script.planes(words.tobytes(), "R10G10B10A2", "UNorm", 0, 4)
    assert np.allclose(np.transpose(colour), parts / 1023) and np.allclose(a, alpha / 3)
    # 1, 0.5 and the smallest subnormal number; the largest; an infinity.
    words = np.array([15 << 6 | 14 << 17 | 1 << 22, (30 << 6) + 63, 31 << 6], np.uint32)
    red, green, blue = script.planes(words.tobytes(), "R11G11B10", "Float", 0, 3)
    assert red == [1.0, 65024.0, math.inf] and green[0] == 0.5 and blue[0] == 2.0**-19
    blue, green, red, _ = (np.full(1, n, np.uint8) for n in (1, 2, 3, 4))
    found = script.planes(bytes((1, 2, 3, 4)), "Regular", "UNorm", 1, 4, bgra=True)
    assert [plane[0] * 255 for plane in found] == pytest.approx([3, 2, 1, 4])
    with pytest.raises(ValueError, match="BC7"):
        script.planes(b"", "BC7", "UNorm", 1, 4)


def test_depths_are_read_without_their_stencil():
    shares = np.array([0.0, 0.25, 1.0])
    whole = np.round(shares * (2**24 - 1)).astype(np.uint32)
    assert script.depths((whole << 8 | 7).tobytes(), 3, "D24", True) == pytest.approx(shares, abs=1e-7)
    assert script.depths((whole | 7 << 24).tobytes(), 3, "D24", False) == pytest.approx(shares, abs=1e-7)
    assert script.depths(np.round(shares * 65535).astype(np.uint16).tobytes(), 3, "D16", False)[2] == 1
    pairs = np.stack([shares.astype(np.float32), np.full(3, 9, np.float32)], 1)
    assert script.depths(pairs.tobytes(), 3, "D32", False) == list(shares)
    assert script.depths(shares.astype(np.float32).tobytes(), 3, "D32", True) == list(shares)
    assert script.covered([1.0, 1.0, 0.5, 0.0]) == [0, 0, 1, 1] and script.covered([0.0, 0.0, 1.0]) == [0, 0, 1]


def test_a_file_has_its_numbers_to_the_bit(tmp_path):
    numbers = {name: RNG.normal(size=(5, 7)).astype(np.float32) for name in ("R", "G", "covered")}
    script.write_exr(tmp_path / "a.exr", 7, 5, {name: list(map(float, n.ravel())) for name, n in numbers.items()})
    image = oiio.ImageBuf(str(tmp_path / "a.exr"))
    pixels = image.get_pixels(oiio.FLOAT)
    for at, name in enumerate(image.spec().channelnames):
        assert np.array_equal(pixels[..., at], numbers[name]), name
    assert str(image.spec().format) == "float"


@pytest.mark.parametrize("lowest", [-1.0, 0.0])
@pytest.mark.parametrize("towards", [-1.0, 1.0])
@pytest.mark.parametrize(("near", "far"), [(0.1, 100.0), (100.0, 0.1), (0.5, math.inf), (math.inf, 0.5)])
def test_planes_are_those_of_the_projection(lowest, towards, near, far):
    """Right- and left-handed, with depth in [-1, 1] and [0, 1], reversed, and without a far plane."""
    # (slope * d + offset) / d is `lowest` at the near plane and 1 at the far one.
    a, b = (0.0 if math.isinf(d) else 1 / d for d in (near, far))
    offset = (1 - lowest) / (b - a)
    slope = 1 - offset * b
    rows = [[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, slope * towards, offset], [0, 0, towards, 0.0]]
    assert script.planes_of_projection(rows, lowest) == pytest.approx((near, far))


def test_other_matrices_are_no_projections():
    assert script.planes_of_projection(np.eye(4).tolist(), 0.0) is None
    assert script.is_rotation(captured_program.view().tolist())
    assert not script.is_rotation((captured_program.view() * 2).tolist())


def lacking():
    """Why no capture can be made here; empty where it can."""
    if not Path("/usr/bin/python3").exists() or not shutil.which("Xvfb"):
        return "no Xvfb; install it (Debian: apt-get install xvfb)"
    has = subprocess.run(["/usr/bin/python3", "-c", "import renderdoc"], capture_output=True).returncode == 0
    return "" if has else "no RenderDoc for Python; install it (Debian: apt-get install python3-renderdoc)"


@pytest.fixture
def display():
    """A display of an X server of its own, which RenderDoc replays OpenGL on."""
    if why := lacking():
        pytest.skip(why)
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24"]
    with subprocess.Popen(command, pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
        os.close(write)
        with os.fdopen(read) as said:
            number = said.readline().strip()
        yield f":{number}"
        server.terminate()


@pytest.mark.slow
@pytest.mark.usefixtures("gl")
def test_a_captured_program_is_measured(display, run, tmp_path, monkeypatch):
    """Captured and replayed by RenderDoc: its normals are those of its sphere, its camera's planes and angle are found,
    and the commands that the script prints run."""
    monkeypatch.chdir(tmp_path)
    shown = {**os.environ, "DISPLAY": display}
    program = [sys.executable, captured_program.__file__, str(tmp_path / "frame")]
    subprocess.run(program, env={**shown, "LD_PRELOAD": "librenderdoc.so"}, check=True)
    (capture,) = tmp_path.glob("*.rdc")
    assert run("renderdoc", "--script", "save.py")[0] == 0
    words = ["/usr/bin/python3", "save.py", str(capture)]
    done = subprocess.run(words, env=shown, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    kept = json.loads(Path("gbuffer/gbuffer.json").read_text())
    formats = {name: one["format"] for name, one in kept["targets"].items()}
    assert (
        list(formats.values()) == ["R8G8B8A8_UNORM", "R10G10B10A2_UNORM", "R16_FLOAT"] and "GBuffer normal" in formats
    )
    assert [bool(one["normals"]) for one in kept["targets"].values()] == [False, True, False]
    assert np.allclose(np.loadtxt("gbuffer/view_matrix.txt"), captured_program.view())
    check_pixels()
    quality, world, depth = kept["commands"]
    assert "--near 0.1 --far 100 --fov 60" in depth and "--fov 60" in quality and done.stdout.endswith(f"{depth}\n")
    (row, *_) = rows_of(run, quality)
    assert row["count"] > 2000 and 45 < row["psnr_db"] < 55
    turned = rows_of(run, quality + world.partition("add:")[2])
    assert turned[0]["psnr_db"] == pytest.approx(row["psnr_db"], abs=1e-3), "the camera does not turn"
    assert all(row["relative_max"] < 1e-3 for row in rows_of(run, depth))


def rows_of(run, command):
    status, out, err = run(*shlex.split(command)[1:], "--backend", "jax", "--format", "json")
    assert status == 0, err
    return json.loads(out)


def check_pixels():
    """Upright, to a step of RGB10 A2, and where the depth says that the sphere is."""
    image = oiio.ImageBuf("gbuffer/gbuffer_normal.exr")
    names = list(image.spec().channelnames)
    pixels = image.get_pixels(oiio.FLOAT)
    normals = pixels[..., [names.index(name) for name in "RGB"]] * 2 - 1
    mask = pixels[..., names.index("covered")] == 1
    height, width = mask.shape
    top, bottom = normals[height // 4, width // 2], normals[3 * height // 4, width // 2]
    assert top[1] > 0.5 and bottom[1] < -0.5 and mask[height // 2, width // 2] and not mask[0, 0]
    assert np.abs(np.linalg.norm(normals[mask], axis=-1) - 1).max() < 0.003
