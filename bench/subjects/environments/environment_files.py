"""Environments from equirectangular .hdr and .exr files, reduced to a useful size."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ....encodings.codecs.files import called
from ....gbuffer.environment.averaged import averaged
from ....gbuffer.environment.environment import Environment
from ...ground.output.errors import UsageError
from ..normals.pixel_files import check_sides, read_image, refused

ENDINGS = (".hdr", ".exr")
# Widths that are read, and the largest that is lit by: a texel of it is a third of a degree.
LEAST_WIDTH, MOST_WIDTH, WIDTH = 16, 8192, 1024
# Coarse levels are a quarter as high: heights are multiples of that.
MULTIPLE = 8
COLOURS = ("R", "G", "B")


def environment_of(path: Path) -> Environment:
    """Return the environment in a file, averaged to at most 1024 x 512 texels and to a width that is a multiple of 8.

    Raises:
        UsageError: the file cannot be read, is not equirectangular, or has invalid radiance. The message is one line
            with a remedy.
    """

    def choose(names: Sequence[str]) -> Sequence[str]:
        return _colours(path, names)

    with np.errstate(over="ignore"):
        planes = read_image(path, choose, _check).planes.astype(np.float32)
    _check_light(path, planes)
    height, width = planes.shape[1:]
    radiance, name = np.moveaxis(planes, 0, -1), called(path.name)
    wanted = min(WIDTH, width - width % MULTIPLE)
    if width == wanted:
        return Environment(name, np.ascontiguousarray(radiance))
    return Environment(name, averaged(radiance, wanted // 2), changes=(f"averaged from {width} x {height}",))


def _colours(path: Path, names: Sequence[str]) -> Sequence[str]:
    """Return the names of the red, green and blue channels. Raises UsageError if any of these channels is missing."""
    channels = {name.upper(): name for name in reversed(names)}
    if not set(COLOURS) <= set(channels):
        raise refused(path, f"it has {', '.join(names[:40])}", "it must have channels R, G and B; save it in colour")
    return [channels[colour] for colour in COLOURS]


def _check(path: Path, sides: tuple[int, int], channels: int) -> None:
    """Raise UsageError if an image does not have the width and height of an environment."""
    width, height = sides
    if width != 2 * height:
        remedy = "an equirectangular environment must be twice as wide as high; export it in that size"
        raise refused(path, f"{width} x {height} pixels", remedy)
    if width > MOST_WIDTH:
        raise refused(
            path, f"{width} x {height} pixels", f"at most {MOST_WIDTH} x {MOST_WIDTH // 2} are supported: shrink it"
        )
    if width < LEAST_WIDTH:
        raise refused(path, f"{width} x {height} pixels", f"at least {LEAST_WIDTH} x {LEAST_WIDTH // 2} are required")
    check_sides(path, sides, channels)


def _check_light(path: Path, planes: np.ndarray) -> None:
    """Raise UsageError for radiance that is negative or not finite, with the position of the first such value."""
    wrong = ~(np.isfinite(planes) & (planes >= 0))
    if wrong.any():
        raise _no_light(path, planes, wrong)


def _no_light(path: Path, planes: np.ndarray, wrong: np.ndarray) -> UsageError:
    row, column = (int(index) for index in np.argwhere(wrong.any(0))[0])
    channel = int(wrong[:, row, column].argmax())
    what = f"{COLOURS[channel]} is {planes[channel, row, column]:g} at column {column}, row {row}, counted from 0"
    return refused(path, f"{what} ({wrong.any(0).sum()} pixels in total)", "radiance must be finite and not negative")
