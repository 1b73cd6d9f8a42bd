"""`normalbench renderdoc`: the script saves a G-buffer unchanged, and prints commands that measure it."""

import ast
import math
import sys
from pathlib import Path

import captured_program
import numpy as np
import OpenImageIO as oiio  # noqa: N813 # as its own documentation has it
import pytest

from normalbench.bench.door.in_renderdoc import save_gbuffer as script

TEXT = Path(script.__file__).read_text()


def test_the_script_is_written_unchanged(run, tmp_path):
    target = tmp_path / "save.py"
    assert run("renderdoc", "--script", str(target)) == (0, "", "")
    assert target.read_text() == TEXT and run("renderdoc")[:2] == (0, TEXT)
    status, _, err = run("renderdoc", "--script", str(tmp_path / "nowhere" / "save.py"))
    assert status == 2 and len(err.splitlines()) == 1


def test_the_script_is_valid_python_3_6_and_needs_only_renderdoc():
    tree = ast.parse(TEXT, feature_version=(3, 6))
    names = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
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
def test_integers_are_read_as_the_format_defines(kind, stored, shown):
    limits = np.iinfo(stored)
    numbers = RNG.integers(limits.min, limits.max, (50, 3), stored, endpoint=True)
    numbers[0] = limits.min
    planes = script.planes(numbers.tobytes(), "Regular", kind, stored().itemsize, 3)
    assert np.array_equal(np.transpose(planes), shown(numbers.astype(np.float64)))


def test_floats_are_read_exactly():
    for stored in (np.float16, np.float32):
        numbers = RNG.normal(size=(50, 2)).astype(stored)
        planes = script.planes(numbers.tobytes(), "Regular", "Float", numbers.itemsize, 2)
        assert np.array_equal(np.transpose(planes), numbers)


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
    planes = script.planes(bytes((1, 2, 3, 4)), "Regular", "UNorm", 1, 4, bgra=True)
    assert [plane[0] * 255 for plane in planes] == pytest.approx([3, 2, 1, 4])
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


def test_a_file_stores_the_exact_numbers(tmp_path):
    numbers = {name: RNG.normal(size=(5, 7)).astype(np.float32) for name in ("R", "G", "covered")}
    script.write_exr(tmp_path / "a.exr", 7, 5, {name: list(map(float, n.ravel())) for name, n in numbers.items()})
    image = oiio.ImageBuf(str(tmp_path / "a.exr"))
    pixels = image.get_pixels(oiio.FLOAT)
    for index, name in enumerate(image.spec().channelnames):
        assert np.array_equal(pixels[..., index], numbers[name]), name
    assert str(image.spec().format) == "float"


@pytest.mark.parametrize("lowest", [-1.0, 0.0])
@pytest.mark.parametrize("towards", [-1.0, 1.0])
@pytest.mark.parametrize(("near", "far"), [(0.1, 100.0), (100.0, 0.1), (0.5, math.inf), (math.inf, 0.5)])
def test_near_and_far_planes_are_found_from_the_projection(lowest, towards, near, far):
    """Projections are right- or left-handed, with depth in [-1, 1] or [0, 1], reversed, or without a far plane."""
    # (slope * d + offset) / d is `lowest` at the near plane and 1 at the far one.
    a, b = (0.0 if math.isinf(d) else 1 / d for d in (near, far))
    offset = (1 - lowest) / (b - a)
    slope = 1 - offset * b
    rows = [[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, slope * towards, offset], [0, 0, towards, 0.0]]
    assert script.planes_of_projection(rows, lowest) == pytest.approx((near, far))


def test_other_matrices_are_not_projections():
    assert script.planes_of_projection(np.eye(4).tolist(), 0.0) is None
    assert script.is_rotation(captured_program.view().tolist())
    assert not script.is_rotation((captured_program.view() * 2).tolist())


def test_the_space_of_normals_is_the_space_in_which_they_face_the_camera():
    """View space of either handedness and world space are tested, with a camera matrix of either handedness."""
    rng = np.random.default_rng(3)
    rays = np.stack(
        [*(p.ravel() for p in np.meshgrid(np.linspace(-1, 1, 32), np.linspace(1, -1, 32))), np.full(1024, -1)]
    )
    n = rng.normal(size=(3, 1024))
    n *= -np.sign((n * rays).sum(axis=0)) / np.linalg.norm(n, axis=0)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    mirror = np.diag([1.0, 1.0, -1.0])
    for to_view, matrix in ((turn, "world_to_view.txt"), (mirror @ turn, (mirror @ turn).tolist())):
        rows = np.eye(4)
        rows[:3, :3] = turn
        for facts, held in (
            ({"space": "view", "view_matrix": "world_to_view.txt"}, n),
            ({"space": "view-left-handed", "view_matrix": (mirror @ turn).tolist()}, mirror @ n),
            ({"space": "world", "view_matrix": matrix}, to_view.T @ n),
        ):
            for option, stored in (("--no-unpack", held), ("--unpack", held / 2 + 0.5)):
                matrices = {"world to view": rows.tolist()}
                guess = script.space_of(stored.tolist(), option, [1.0] * 1024, 32, 90.0, matrices)
                assert guess["space"] == facts["space"] and np.array_equal(guess["view_matrix"], facts["view_matrix"])


def test_names_in_a_capture_cannot_control_the_terminal(capsys):
    script.say("lit \x1b[2J\r\u202e.exr\nübrig")
    assert capsys.readouterr().out == "lit \\x1b[2J\\r\\u202e.exr\nübrig\n"


def test_contents_of_targets_are_guessed_only_from_unambiguous_names():
    def target(form="R8G8B8A8_UNORM", channels="RGBA", file="a.exr"):
        return {"file": file, "format": form, "channels": channels, "normals": ""}

    named = {
        "SceneAlbedo": target("R8G8B8A8_SRGB"),
        "gRoughness": target("R8_UNORM", "R", "b.exr"),
        "MetalRough": target(),
        "Emissive": target("R11G11B10_FLOAT", "RGB", "c.exr"),
        "AO": target("R8_UNORM", "R", "d.exr"),
        "Metallic": target(),
    }
    assert script.guessed(named) == {
        "base_color": {"file": "a.exr", "channels": "R,G,B", "curve": "srgb"},
        "roughness": {"file": "b.exr", "channel": "R"},
        "emissive": {"file": "c.exr", "channels": "R,G,B", "curve": "linear"},
        "ao": {"file": "d.exr", "channel": "R"},
    }
    unreal = {f"GBuffer{letter}": target(file=f"{letter}.exr") for letter in "ABC"}
    guess = script.guessed(unreal)
    assert guess["f0"] == {"file": "B.exr", "channel": "G", "scale": 0.08} and "ao" not in guess
    assert guess["base_color"] == {"file": "C.exr", "channels": "R,G,B", "curve": "srgb"}
    assert not script.guessed({"GBufferA": target(), "GBufferB": target()})
