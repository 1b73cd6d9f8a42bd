"""Depths from users' images: their channel, the meaning of its values, and the pixels that show a surface."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import jax
import numpy as np

from ....encodings.catalogue import DEPTH_ENCODINGS
from ....encodings.codecs.files import called
from ....encodings.shared.position import Camera
from ...ground.output.errors import UsageError
from ..normals.pixel_files import READERS, Pixels, read_plane, refused

# View depth as it stands, and not a code of it; codes without a sign.
VIEW = "view"
CODES = tuple(name for name, encoding in DEPTH_ENCODINGS.items() if not encoding.signed)


@dataclass(frozen=True, kw_only=True)
class DepthReading:
    """Options for reading an image of depths.

    Attributes:
        channel: the name of the channel; None for the channel that is named like depths, or the only channel.
        depths_are: VIEW, or one of CODES.
        depth_unit: the length of 1 in a view depth, in the unit of the planes.
        fov: the vertical angle of view in degrees; None if it is unknown.
    """

    channel: str | None = None
    depths_are: str = VIEW
    depth_unit: float = 1.0
    fov: float | None = None


@dataclass(frozen=True, eq=False)
class DepthImage:
    """The depths in a frame.

    Attributes:
        name: the file's name.
        numbers: the values in the file, with integer codes as fractions of 1; float64 of shape (height, width).
        code: the meaning of the values: VIEW, or a depth encoding's name.
        channel: the requested channel.
        unit: the length of 1 in a view depth, in the unit of the planes.
        fov: the vertical angle of view in degrees; None if it is unknown.
        notes: remarks on the depths.
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
        """Return view depths, float64 of shape (height, width); NaN where the file has NaN."""
        if self.code == VIEW:
            return self.numbers * self.unit
        encoding = DEPTH_ENCODINGS[self.code]
        with jax.enable_x64(True):
            return np.abs(np.asarray(encoding.decode(self.numbers, np.float64(camera.near), np.float64(camera.far))))

    def surface(self, camera: Camera) -> np.ndarray:
        """Return depths at pixels that show a surface, 0 elsewhere; float32 of shape (height, width). The far plane
        does not count as a surface."""
        depths = self.depths(camera)
        with np.errstate(over="ignore"):
            float_depths = depths.astype(np.float32)
        return np.where(
            (float_depths >= np.float32(camera.near)) & (float_depths < np.float32(camera.far)),
            float_depths,
            np.float32(0),
        )

    @property
    def not_finite(self) -> int:
        """The number of NaN values."""
        return int(np.isnan(self.numbers).sum())


def read_depths(path: Path, channel: str | None) -> Pixels:
    """Read the depth channel of an image as Pixels with one plane, of shape (1, height, width). If `channel` is None,
    the channel is chosen by its name. Raises UsageError."""
    if path.suffix.lower() not in READERS:
        raise UsageError(f"{path}: not an image of depths; supported: {', '.join(READERS)}")
    return read_plane(path, lambda names: [_channel(path, names, channel)])


def depth_image(path: Path, pixels: Pixels, reading: DepthReading) -> DepthImage:
    """Return a DepthImage of a file's pixels, scaled to [0, 1] unless they are view depths, and not yet converted to
    depths. Raises UsageError if they do not match `reading`."""
    code = reading.depths_are
    numbers = pixels.planes[0].astype(np.float64)
    if code != VIEW:
        numbers = numbers / (pixels.full or 1)
        _check_code(path, numbers, code)
    notes = _notes(numbers, pixels, reading)
    return DepthImage(called(path.name), numbers, code, reading.channel, reading.depth_unit, reading.fov, tuple(notes))


def _check_code(path: Path, numbers: np.ndarray, code: str) -> None:
    """Raise UsageError if values are outside the range of a depth encoding, [0, 1]."""
    valid_numbers = numbers[~np.isnan(numbers)]
    if len(valid_numbers) and not 0 <= valid_numbers.min() <= valid_numbers.max() <= 1:
        what = f"its values are {valid_numbers.min():.3g} to {valid_numbers.max():.3g}, but {code} ranges from 0 to 1"
        raise refused(path, what, "use --depths-are view for distances")


def _channel(path: Path, names: Sequence[str], asked: str | None) -> str:
    """Return the name of the depth channel: the requested channel, the channel named like depths, or the only
    channel. Raises UsageError if the requested channel is missing, or if several channels may contain depths."""
    shown = ", ".join(names[:40])
    if asked is not None:
        if asked not in names:
            raise refused(path, f"no channel {asked!r}; it has {shown}", "name one with --channel")
        return asked
    likely = [name for name in names if _is_called_like_depths(name, names)] or list(names)
    if len(likely) == 1:
        return likely[0]
    raise refused(path, f"any of {', '.join(likely[:40])} may hold depths", f"choose one with --channel {likely[0]}")


def _is_called_like_depths(name: str, names: Sequence[str]) -> bool:
    """Whether a channel is named like depths, such as Z or ViewLayer.Depth.Z, but is not the Z of X, Y and Z."""
    *_, last = words = re.split(r"[._ ]", name.lower())
    has_axes = f"{name[:-1]}{'X' if name[-1:] == 'Z' else 'x'}" in names
    return any("depth" in word for word in words) or (last == "z" and not has_axes)


def _notes(numbers: np.ndarray, pixels: Pixels, reading: DepthReading) -> list[str]:
    finite = numbers[np.isfinite(numbers)]
    notes = []
    if pixels.full is not None:
        bits = pixels.full.bit_length()
        notes.append(f"{bits}-bit integers: encodings with the same steps look better than they are")
    elif len(finite) and np.array_equal(finite, _half_floats(finite)):
        notes.append("all its values are half floats: r16f looks better than it is")
    is_as_stored = reading.depths_are == VIEW and pixels.full is None and reading.depth_unit == 1
    if is_as_stored and len(finite) and 0 <= finite.min() <= finite.max() <= 1:
        codes = "window, reversed_window or linear"
        notes.append(f"all its values are in [0, 1]; for a depth buffer use --depths-are {codes}")
    if reading.fov is None:
        notes.append("without --fov its points are on the view axis, and errors are in depth only")
    return notes


def _half_floats(numbers: np.ndarray) -> np.ndarray:
    with np.errstate(over="ignore"):
        return numbers.astype(np.float16).astype(np.float64)
