"""Depths of users' frames: which channel they are in, what its numbers stand for, and which pixels are surface."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import jax
import numpy as np

from ....encodings.catalogue import DEPTH_ENCODINGS
from ....encodings.codecs.files import called
from ....encodings.shared.position import Camera
from ...ground.choose import choose_one, file_names
from ...ground.options.scene_names import say_notes
from ...ground.options.words import given_in
from ...ground.output.errors import UsageError, tell
from ...subjects.normals.pixel_files import READERS, Pixels, read_plane, refused
from .points import Points
from .table import DepthOptions

# View depth as it stands, and not a code of it; codes without a sign.
VIEW = "view"
CODES = tuple(name for name, encoding in DEPTH_ENCODINGS.items() if not encoding.signed)
LEAST_UNIT, MOST_UNIT = 1e-9, 1e9
# Pixels of a frame that are measured; of larger ones every second, third and so on.
MOST_PIXELS = 2**22


@dataclass(frozen=True, eq=False)
class Frame:
    """A frame's depths.

    Attributes:
        name: the file's.
        numbers: as the file has them, whole numbers of a code as shares of 1; float64 of shape (height, width).
        code: what they are: VIEW, or a depth code's name.
        channel: the one that was asked for.
        unit: what 1 is of a view depth, in the unit of the planes.
        fov: vertical, in degrees; None where nobody says.
        notes: what is to be said of them.
    """

    name: str
    numbers: np.ndarray
    code: str
    channel: str | None
    unit: float
    fov: float | None
    notes: tuple[str, ...]

    @property
    def aspect(self) -> float:
        """Width over height."""
        height, width = self.numbers.shape
        return width / height

    def depths(self, camera: Camera) -> np.ndarray:
        """View depths, float64 of shape (height, width); NaN where the file has that."""
        if self.code == VIEW:
            return self.numbers * self.unit
        encoding = DEPTH_ENCODINGS[self.code]
        with jax.enable_x64(True):
            return np.abs(np.asarray(encoding.decode(self.numbers, np.float64(camera.near), np.float64(camera.far))))

    def surface(self, camera: Camera) -> np.ndarray:
        """Depths where there is surface, 0 elsewhere: float32 of shape (height, width). The far plane is none."""
        depths = self.depths(camera)
        with np.errstate(over="ignore"):
            found = depths.astype(np.float32)
        return np.where((found >= np.float32(camera.near)) & (found < np.float32(camera.far)), found, np.float32(0))

    @property
    def not_finite(self) -> int:
        """How many numbers are NaN."""
        return int(np.isnan(self.numbers).sum())


@dataclass(frozen=True, eq=False)
class Seen:
    """A frame through a camera.

    Attributes:
        points: those that are measured: at the pixels' middles, or without an angle of view on the view axis.
        background: how many pixels are not between near and far.
        every: 1, or what share of them is measured: every second, third and so on.
    """

    points: Points
    background: int
    every: int


@lru_cache(maxsize=4)
def seen(frame: Frame, camera: Camera) -> Seen:
    """What is measured of a frame."""
    surface = frame.surface(camera)
    index = np.flatnonzero(surface)
    every = max(1, -(-len(index) // MOST_PIXELS))
    height, width = surface.shape
    row, column = np.divmod(index[::every], width)
    places = np.stack([(column + 0.5) / width * 2 - 1, 1 - (row + 0.5) / height * 2], axis=1).astype(np.float32)
    points = Points(places if frame.fov is not None else np.zeros_like(places), surface[row, column])
    return Seen(points, surface.size - len(index) - frame.not_finite, every)


def frames_named(options: DepthOptions) -> list[Frame]:
    """The frames that --depths names; none where it names none.

    Raises:
        UsageError: a file that cannot be read, or an option that does not go with it.
    """
    if options.depths is None:
        _check_unused(options)
        return []
    words = [word for word in file_names(options.depths) if word]
    options, own = _checked(words, options), given_in(options.depths)
    found = {word: _pixels_of(own[word]) if word in own else _read(Path(word), options) for word in words}
    return [_frame(word, pixels, options) for word, pixels in found.items()]


def _checked(words: Sequence[str], options: DepthOptions) -> DepthOptions:
    """The options with what the numbers are by its known name. Raises UsageError."""
    names = [Path(word).name for word in words]
    if not words:
        raise UsageError("--depths names no file")
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise UsageError(f"two files are called {twice}, which is how rows name them; rename one")
    if options.distance is not None:
        raise UsageError("--distance is of points that are made; --depths has depths of its own")
    code = choose_one("code of --depths-are", options.depths_are, (VIEW, *CODES))
    if not LEAST_UNIT <= abs(options.depth_unit) <= MOST_UNIT:
        raise UsageError(f"--depth-unit {options.depth_unit:g}: {LEAST_UNIT:g} to {MOST_UNIT:g}, or less than 0")
    if code != VIEW and options.depth_unit != DepthOptions.depth_unit:
        raise UsageError(f"--depth-unit is of view depths; --depths-are {code} has the unit of --near and --far")
    if options.count != DepthOptions.count:
        tell("--count has no effect on depth images: every pixel between near and far is measured")
    return replace(options, depths_are=code)


def _check_unused(options: DepthOptions) -> None:
    """Raises UsageError where something is said of files and there are none."""
    usual = DepthOptions()
    for flag, name in (("--channel", "channel"), ("--depths-are", "depths_are"), ("--depth-unit", "depth_unit")):
        if getattr(options, name) != getattr(usual, name):
            raise UsageError(f"{flag} is of depth images, and --depths names none")


def _pixels_of(array: np.ndarray) -> Pixels:
    """A caller's own array, (height, width), as what is read of a file."""
    return Pixels(array[None], np.iinfo(array.dtype).max if array.dtype.kind == "u" else None)


def _read(path: Path, options: DepthOptions) -> Pixels:
    if path.suffix.lower() not in READERS:
        raise UsageError(f"{path}: not an image of depths; {', '.join(READERS)} are read")
    return read_plane(path, lambda names: [_channel(path, names, options.channel)])


def _frame(word: str, pixels: Pixels, options: DepthOptions) -> Frame:
    path, code = Path(word), options.depths_are
    numbers = pixels.planes[0].astype(np.float64)
    if code != VIEW:
        numbers = numbers / (pixels.full or 1)
        _check_code(path, numbers, code)
    notes = _notes(numbers, pixels, code, options)
    return Frame(called(path.name), numbers, code, options.channel, options.depth_unit, options.fov, tuple(notes))


def _check_code(path: Path, numbers: np.ndarray, code: str) -> None:
    """Raises UsageError where numbers are not those of a code, which are in [0, 1]."""
    found = numbers[~np.isnan(numbers)]
    if len(found) and not 0 <= found.min() <= found.max() <= 1:
        what = f"its numbers are {found.min():.3g} to {found.max():.3g}, and those of {code} 0 to 1"
        raise refused(path, what, "--depths-are view takes distances")


def _channel(path: Path, names: Sequence[str], asked: str | None) -> str:
    """The channel of depths: the one asked for, the one that is called like depths, or the only one."""
    shown = ", ".join(names[:40])
    if asked is not None:
        if asked not in names:
            raise refused(path, f"no channel {asked!r}; it has {shown}", "--channel takes one by name")
        return asked
    likely = [name for name in names if _is_called_like_depths(name, names)] or list(names)
    if len(likely) == 1:
        return likely[0]
    raise refused(path, f"any of {', '.join(likely[:40])} may be depths", f"--channel {likely[0]} names one")


def _is_called_like_depths(name: str, names: Sequence[str]) -> bool:
    """Z, Depth, ViewLayer.Depth.Z; but not the Z of three axes."""
    *_, last = words = re.split(r"[._ ]", name.lower())
    has_axes = f"{name[:-1]}{'X' if name[-1:] == 'Z' else 'x'}" in names
    return any("depth" in word for word in words) or (last == "z" and not has_axes)


def _notes(numbers: np.ndarray, pixels: Pixels, code: str, options: DepthOptions) -> list[str]:
    found = numbers[np.isfinite(numbers)]
    notes = []
    if pixels.full is not None:
        bits = pixels.full.bit_length()
        notes.append(f"whole numbers of {bits} bits: codes of the same steps look better than they are")
    elif len(found) and np.array_equal(found, _half_floats(found)):
        notes.append("all its numbers are those of half floats: r16f looks better than it is")
    is_as_stored = code == VIEW and pixels.full is None and options.depth_unit == 1
    if is_as_stored and len(found) and 0 <= found.min() <= found.max() <= 1:
        codes = "window, reversed_window or linear"
        notes.append(f"all its numbers are in [0, 1]: --depths-are {codes} reads a depth buffer's")
    if options.fov is None:
        notes.append("without --fov its points lie on the view axis, and errors are of depth alone")
    return notes


def _half_floats(numbers: np.ndarray) -> np.ndarray:
    with np.errstate(over="ignore"):
        return numbers.astype(np.float16).astype(np.float64)


def check_and_say(frames: Sequence[Frame], cameras: Sequence[Camera]) -> None:
    """Say what is to be said of frames, once each is seen. Raises UsageError where a camera sees nothing of one."""
    lines = {}
    for frame in frames:
        lines[Path(frame.name)] = [*frame.notes, *(line for camera in cameras for line in _left_out(frame, camera))]
    say_notes(lines)


def _left_out(frame: Frame, camera: Camera) -> list[str]:
    found, depths = seen(frame, camera), frame.depths(camera)
    planes = f"--near {camera.near:g} --far {camera.far:g}"
    finite = depths[np.isfinite(depths)]
    reach = f"{finite.min():.4g} to {finite.max():.4g}" if len(finite) else "not finite"
    if not len(found.points.depths):
        remedy = "--depth-unit -1 turns them around" if len(finite) and finite.max() <= 0 else "see --depths-are"
        raise UsageError(f"{frame.name}: no depth lies within {planes}; they are {reach}: {remedy}")
    said = [f"1 pixel in {found.every} is measured"] * (found.every > 1)
    if found.background:
        said.append(f"{found.background / depths.size:.1%} of its pixels are not within {planes}; it has {reach}")
    return said + [f"{frame.not_finite} numbers are NaN and left out"] * bool(frame.not_finite)
