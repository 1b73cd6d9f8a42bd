"""Diagnoses of captures: only frames read incorrectly are reported, each with the option that corrects it."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from written import given, packed, png_bytes

from normalbench.bench.ground.options.option import Reading
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.normals.captures import capture, typed
from normalbench.encodings.storages.rounding import from_srgb, to_srgb
from normalbench.gbuffer.scenes.built_in.playground import CAMERA, playground


def turned(yaw: float, pitch: float) -> np.ndarray:
    """Return the rotation of a camera's view matrix, given in degrees, (3, 3) for column vectors."""
    (c, s), (d, e) = ((math.cos(a), math.sin(a)) for a in map(math.radians, (yaw, pitch)))
    return np.array([(1, 0, 0), (0, d, -e), (0, e, d)]) @ np.array([(c, 0, -s), (0, 1, 0), (s, 0, c)])


M = turned(140, 25)
FOUR = np.eye(4)
FOUR[:3, :3], FOUR[:3, 3] = M, (3, -1, 7)
PROJECTION = np.array([(1, 0, 0, 0), (0, 1.7, 0, 0), (0, 0, -1.1, -0.2), (0, 0, -1, 0)])
WORLD = Reading(space="world", view_matrix=typed(M))
N = playground().normals[1::4, 1::4]


def room(width: int, height: int, fov: float, view: np.ndarray) -> np.ndarray:
    """Return view-space normals of a room of 4 x 3 x 6 seen from its centre, per pixel, (height, width, 3)."""
    half = math.tan(math.radians(fov) / 2)
    x = ((np.arange(width) + 0.5) / width * 2 - 1) * half * width / height
    y = (1 - (np.arange(height) + 0.5) / height * 2) * half
    rays = np.stack([*np.meshgrid(x, y), np.full((height, width), -1.0)], -1) @ view
    wall = np.argmin(np.array([2, 1.5, 3]) / np.abs(rays), -1)
    n = -np.eye(3)[wall] * np.sign(np.take_along_axis(rays, wall[..., None], -1))
    return (n @ view.T).astype(np.float32)


def bumpy(n: np.ndarray) -> np.ndarray:
    """Return normals as a normal map perturbs them, by up to some 20 degrees."""
    n = n + np.random.default_rng(0).normal(0, 0.1, n.shape)
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def of_8_bits(path: Path, n: np.ndarray, curve: Callable = lambda x: x) -> Path:
    path = path.with_suffix(".png")
    Image.fromarray(np.rint(np.asarray(curve(n * 0.5 + 0.5)) * 255).astype(np.uint8)).save(path)
    return path


def floats(path: Path, n: np.ndarray) -> Path:
    path = path.with_suffix(".npy")
    np.save(path, n.astype(np.float32))
    return path


@dataclass(frozen=True)
class Wrong:
    """A file, a wrong way to read it, the expected message (an error if it cannot be measured) and the correction."""

    write: Callable[[Path], Path]
    said: str
    reading: Reading
    mended: Reading
    within: float = 1e-6


COVERED = playground().covered[1::4, 1::4]
ON_SURFACE = COVERED[..., None]
WORLD_FILE: Callable[[Path], Path] = lambda path: floats(path, N @ M)  # noqa: E731
WRONG = {
    "a matrix for row vectors": Wrong(
        WORLD_FILE,
        f"in the last row, for row vectors; use --view-matrix {typed(M)}",
        Reading(space="world", view_matrix=typed(FOUR.T)),
        WORLD,
    ),
    "a transposed matrix": Wrong(
        WORLD_FILE,
        f"if the matrix is transposed (it may be for row vectors, or transform view space to world space): use "
        f"--space world --view-matrix {typed(M)}",
        Reading(space="world", view_matrix=typed(M.T)),
        WORLD,
    ),
    "a left-handed matrix": Wrong(
        WORLD_FILE,
        f"left-handed view space, z into the screen: use --space world --view-matrix {typed(M)}",
        Reading(space="world", view_matrix=typed(np.diag([1, 1, -1]) @ M)),
        WORLD,
    ),
    "a left-handed and transposed matrix": Wrong(
        WORLD_FILE,
        f"transposed and left-handed: use --space world --view-matrix {typed(M)}",
        Reading(space="world", view_matrix=typed((np.diag([1, 1, -1]) @ M).T)),
        WORLD,
    ),
    "a scaled matrix": Wrong(
        WORLD_FILE,
        "the rows of --view-matrix have length 2.5: the scale is ignored",
        Reading(space="world", view_matrix=typed(2.5 * M)),
        WORLD,
    ),
    "a matrix with a projection": Wrong(
        WORLD_FILE,
        "as with a projection; give only the view matrix",
        Reading(space="world", view_matrix=typed(PROJECTION @ FOUR)),
        WORLD,
    ),
    "world space read as view space": Wrong(
        WORLD_FILE,
        "if they are in world space, use --space world --view-matrix to transform them; if the engine encodes "
        "world-space normals, use --space world --code-space world",
        Reading(),
        WORLD,
    ),
    "view space read as world space": Wrong(
        lambda path: floats(path, N), "in view space already: use --space view", WORLD, Reading()
    ),
    "left-handed view space": Wrong(
        lambda path: floats(path, N * [1, 1, -1]),
        "z points the other way: use --space view-left-handed",
        Reading(),
        Reading(space="view-left-handed"),
    ),
    "y down, z into the screen": Wrong(
        lambda path: floats(path, N * [1, -1, -1]),
        "y points down and z into the screen: use --space world --view-matrix 1,0,0,0,-1,0,0,0,-1",
        Reading(fov=CAMERA.fov),
        Reading(fov=CAMERA.fov, space="world", view_matrix="1,0,0,0,-1,0,0,0,-1"),
    ),
    "y down": Wrong(
        lambda path: floats(path, N * [1, -1, 1]),
        "y points down, or rows run from the bottom up: use --space world --view-matrix 1,0,0,0,-1,0,0,0,1",
        Reading(fov=CAMERA.fov),
        Reading(fov=CAMERA.fov, space="world", view_matrix="1,0,0,0,-1,0,0,0,1"),
    ),
    "red and blue swapped": Wrong(
        lambda path: floats(path, N[..., ::-1]),
        "red and blue are swapped: use --channels 2,1,0",
        Reading(),
        Reading(channels="2,1,0"),
    ),
    "another angle of view": Wrong(
        lambda path: floats(path, N),
        "at --fov 10, 0% at about 60: check --fov, which is the vertical angle",
        Reading(fov=10),
        Reading(fov=60),
    ),
    "an sRGB curve on 8 bits": Wrong(
        lambda path: of_8_bits(path, N, to_srgb), "use --curve srgb", Reading(), Reading(curve="srgb"), 0.02
    ),
    "an sRGB curve on floats": Wrong(
        lambda path: floats(path, np.where(ON_SURFACE, to_srgb(N * 0.5 + 0.5), 0)),
        "use --curve srgb --unpack",
        Reading(),
        Reading(curve="srgb", unpack=True),
        1e-5,
    ),
    "an sRGB curve taken off": Wrong(
        lambda path: of_8_bits(path, N, from_srgb),
        "use --curve srgb-removed",
        Reading(),
        Reading(curve="srgb-removed"),
        0.06,
    ),
    "[0, 1] read as [-1, 1]": Wrong(
        lambda path: floats(path, np.where(ON_SURFACE, N * 0.5 + 0.5, 0)),
        "use --unpack",
        Reading(),
        Reading(unpack=True),
    ),
    "[-1, 1] read as [0, 1]": Wrong(lambda path: floats(path, N), "use --no-unpack", Reading(unpack=True), Reading()),
}


def besides_bits(notes: list[str]) -> list[str]:
    """Return the notes except notes about a file's own 8 bits, which are not a fault."""
    return [note for note in notes if not note.startswith("8 bits per channel")]


def said_of(path: Path, reading: Reading) -> list[str]:
    """Return the notes of a capture, or its error."""
    try:
        return capture(path, reading)[1]
    except UsageError as error:
        return [str(error)]


@pytest.mark.parametrize("what", WRONG)
def test_incorrectly_read_frame_is_reported_with_the_option_that_corrects_it(tmp_path, what):
    """One line names the option; with that option the frame equals the written frame, and no note remains."""
    wrong = WRONG[what]
    path = wrong.write(tmp_path / "frame")
    (line,) = besides_bits(said_of(path, wrong.reading))
    assert line.endswith(wrong.said), line
    frame, notes = capture(path, wrong.mended)
    assert besides_bits(notes) == []
    n, covered = given(frame)
    off = np.abs(n - N.reshape(-1, 3))[covered & COVERED.ravel()].max()
    assert off < wrong.within, off


LEVEL, UP, DOWN = (turned(30, pitch) for pitch in (0, 12, -30))
RIGHT = {
    "the playground": (lambda path: floats(path, N), Reading()),
    "at its angle of view": (lambda path: floats(path, N), Reading(fov=CAMERA.fov)),
    "in 8 bits": (lambda path: of_8_bits(path, N), Reading()),
    "in 16 bits": (lambda path: png(path, N), Reading()),
    "in world space": (WORLD_FILE, WORLD),
    "in a left-handed world": (
        lambda path: floats(path, N * [1, 1, -1] @ M),
        Reading(space="world", view_matrix=typed(np.diag([1, 1, -1]) @ M)),
    ),
    "a room": (lambda path: floats(path, room(320, 180, 60, LEVEL)), Reading()),
    "a room, looking up": (lambda path: floats(path, room(320, 180, 60, UP)), Reading()),
    "a room, looking down, at its angle": (lambda path: floats(path, room(320, 180, 90, DOWN)), Reading(fov=90)),
    "a room seen widely": (lambda path: floats(path, room(320, 180, 110, UP)), Reading()),
    "with a normal map": (lambda path: floats(path, bumpy(room(320, 180, 60, UP))), Reading(fov=60)),
    "a wall": (lambda path: floats(path, np.broadcast_to([0, 0, 1], (90, 160, 3))), Reading()),
    "a floor that is seen flatly": (lambda path: floats(path, room(320, 40, 20, turned(0, -2))), Reading()),
    "a list of the sphere": (
        lambda path: floats(path, np.random.default_rng(0).permutation(N.reshape(-1, 3)[COVERED.ravel()])),
        Reading(),
    ),
}


def png(path: Path, n: np.ndarray) -> Path:
    path = path.with_suffix(".png")
    path.write_bytes(png_bytes(packed(n, np.uint16)))
    return path


@pytest.mark.parametrize("what", RIGHT)
def test_correctly_read_frame_has_no_notes(tmp_path, what):
    write, reading = RIGHT[what]
    assert besides_bits(said_of(write(tmp_path / "frame"), reading)) == []


def test_bottom_up_rows_are_distinguished_from_another_field_of_view(tmp_path):
    (line,) = said_of(floats(tmp_path / "frame", N[::-1]), Reading(fov=CAMERA.fov))
    assert "if y points down, or rows run from the bottom up" in line


def test_8_bit_frame_has_a_note_on_the_encodings_it_favours(tmp_path):
    """8-bit normals are already rounded to RGBA8, which adds no error; 16 bits and floats favour no storage."""
    (line,) = said_of(of_8_bits(tmp_path / "frame", N), Reading())
    assert line.startswith("8 bits per channel, with errors of about 0.2 degrees")
    assert said_of(png(tmp_path / "frame", N), Reading()) == []


def test_grey_background_of_packed_normals_is_treated_as_background(tmp_path):
    packed_floats = np.where(ON_SURFACE, N * 0.5 + 0.5, 0.5)
    path = floats(tmp_path / "frame", packed_floats)
    (line,) = said_of(path, Reading())
    assert line.endswith("use --unpack")
    frame, notes = capture(path, Reading(unpack=True))
    assert notes == [] and np.array_equal(given(frame)[1], COVERED.ravel())


def test_note_on_normalised_captures_names_the_right_curve(tmp_path):
    path = of_8_bits(tmp_path / "frame", N, to_srgb)
    (line,) = besides_bits(said_of(path, Reading(normalise=True)))
    assert line.endswith("normalised; with --curve srgb they would be unit length")


@pytest.mark.parametrize("option", ["curve", "space"])
def test_reading_option_names_ignore_case_and_separators(tmp_path, option):
    path = floats(tmp_path / "frame", N * [1, 1, -1])
    assert said_of(path, Reading(space="View_Left-Handed")) == []
    (line,) = said_of(path, replace(Reading(), **{option: "srbg-removed"}))
    assert line.startswith(f"unknown {option} 'srbg-removed';")
