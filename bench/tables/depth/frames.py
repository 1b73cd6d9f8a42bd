"""The frames of `depth --depths`: the files, the surfaces that a camera sees in them, and notes on both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from ....encodings.shared.position import Camera
from ...ground.choose import choose_one
from ...ground.options.words import Given, Names, Word
from ...ground.output.errors import UsageError, tell
from ...subjects.depths.depth_images import CODES, VIEW, DepthImage, DepthReading, depth_image, read_depths
from ...subjects.normals.pixel_files import Pixels
from ...subjects.scenes.mesh_files import say_notes
from .points import Points
from .table import DepthOptions

LEAST_UNIT, MOST_UNIT = 1e-9, 1e9
# Pixels of a frame that are measured; of larger ones every second, third and so on.
MOST_PIXELS = 2**22


@dataclass(frozen=True, eq=False)
class DepthFrame:
    """A depth image as seen through a camera.

    Attributes:
        points: the measured points: at pixel centres, or on the view axis if the angle of view is unknown.
        background: number of pixels that are not between near and far.
        every: interval between measured pixels: 1 for all, 2 for every second, and so on.
    """

    points: Points
    background: int
    every: int


@lru_cache(maxsize=4)
def seen(frame: DepthImage, camera: Camera) -> DepthFrame:
    """Return a frame's points between near and far, its number of background pixels, and the interval between
    measured pixels. The interval keeps the number of points within MOST_PIXELS."""
    surface = frame.surface(camera)
    index = np.flatnonzero(surface)
    every = max(1, -(-len(index) // MOST_PIXELS))
    height, width = surface.shape
    row, column = np.divmod(index[::every], width)
    places = np.stack([(column + 0.5) / width * 2 - 1, 1 - (row + 0.5) / height * 2], axis=1).astype(np.float32)
    points = Points(places if frame.fov is not None else np.zeros_like(places), surface[row, column])
    return DepthFrame(points, surface.size - len(index) - frame.not_finite, every)


def frames_named(options: DepthOptions) -> list[DepthImage]:
    """Return the frames that --depths names; empty if the option is not given.

    Raises:
        UsageError: a file that cannot be read, or options that cannot be used together.
    """
    if options.depths is None:
        _check_unused(options)
        return []
    words = options.depths
    options = _checked(words, options)
    names = ("channel", "depths_are", "depth_unit", "fov")
    reading = DepthReading(**{name: getattr(options, name) for name in names})
    return [depth_image(Path(str(word)), _read(word, reading), reading) for word in words]


def _read(word: Word, reading: DepthReading) -> Pixels:
    return _pixels_of(word.value) if isinstance(word, Given) else read_depths(Path(word), reading.channel)


def _checked(words: Names, options: DepthOptions) -> DepthOptions:
    """Return the options with `depths_are` in the spelling of the catalogue. Raises UsageError if no file is named,
    two files share a name, or an option does not suit depth images."""
    names = [Path(str(word)).name for word in words]
    if not words:
        raise UsageError("--depths: no file named; name at least one, such as depth.exr")
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise UsageError(f"--depths: two files are called {twice}, so their rows would have the same key; rename one")
    if options.distance is not None:
        raise UsageError("--distance applies only to generated points; it cannot be used with --depths")
    code = choose_one("code of --depths-are", options.depths_are, (VIEW, *CODES))
    if not LEAST_UNIT <= abs(options.depth_unit) <= MOST_UNIT:
        raise UsageError(
            f"--depth-unit {options.depth_unit:g}: out of range; use {LEAST_UNIT:g} to {MOST_UNIT:g}, or "
            "the negative of such a value"
        )
    if code != VIEW and options.depth_unit != DepthOptions.depth_unit:
        raise UsageError(
            f"--depth-unit cannot be used with --depths-are {code}, which uses the unit of --near and --far"
        )
    if options.count != DepthOptions.count:
        tell("--count has no effect on depth images: every pixel between near and far is measured")
    return replace(options, depths_are=code)


def _check_unused(options: DepthOptions) -> None:
    """Raise UsageError if an option for files is set and there are no files."""
    usual = DepthOptions()
    for flag, name in (("--channel", "channel"), ("--depths-are", "depths_are"), ("--depth-unit", "depth_unit")):
        if getattr(options, name) != getattr(usual, name):
            raise UsageError(f"{flag} requires --depths")


def _pixels_of(array: np.ndarray) -> Pixels:
    """Return a caller's array, of shape (height, width), in the form that reading a file gives."""
    return Pixels(array[None], np.iinfo(array.dtype).max if array.dtype.kind == "u" else None)


def check_and_say(frames: Sequence[DepthImage], cameras: Sequence[Camera]) -> None:
    """Check all frames, then print the notes on them. Raises UsageError if a camera sees nothing of a frame."""
    lines = {}
    for frame in frames:
        lines[Path(frame.name)] = [*frame.notes, *(line for camera in cameras for line in _left_out(frame, camera))]
    say_notes(lines)


def _left_out(frame: DepthImage, camera: Camera) -> list[str]:
    sample, depths = seen(frame, camera), frame.depths(camera)
    planes = f"--near {camera.near:g} --far {camera.far:g}"
    finite = depths[np.isfinite(depths)]
    reach = f"{finite.min():.4g} to {finite.max():.4g}" if len(finite) else "not finite"
    if not len(sample.points.depths):
        remedy = "--depth-unit -1 negates them" if len(finite) and finite.max() <= 0 else "see --depths-are"
        raise UsageError(f"{frame.name}: no depth is within {planes}; depths are {reach}; {remedy}")
    notes = [f"1 pixel in {sample.every} is measured"] * (sample.every > 1)
    if sample.background:
        notes.append(f"{sample.background / depths.size:.1%} of the pixels are not within {planes}; depths are {reach}")
    return notes + [f"{frame.not_finite} values are NaN and left out"] * bool(frame.not_finite)
