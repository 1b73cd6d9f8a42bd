"""A run's image sets of normals, for the laboratory on its page: small images, as stored in the run.

A pixel's normal is stored in two numbers of 12 bits each. It is first rotated about an axis that no encoding uses, so
that the normals that a page puts through a codec are not on the codec's own grid.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.normals.octahedral import encode
from ....encodings.vec import Vec3
from ...ground.output.arrays import DamagedError, read_npz
from ...ground.output.writing import files_of, whole_file

Record = dict[str, Any]
FIELDS = ("codes", "covered", "slope")
# Pixels on the longer side, levels of a number, and bytes of a file.
SIDE, LEVELS, MOST_BYTES = 320, 4095, 2**20
# Rows of a rotation by 1 radian around the direction (1, 2, 3) (O. Rodrigues, 1840).
_AXIS = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
_ACROSS = np.cross(np.eye(3), _AXIS)
ROTATION = np.eye(3) + np.sin(1.0) * _ACROSS + (1.0 - np.cos(1.0)) * _ACROSS @ _ACROSS


def write_scene(name: str, n: np.ndarray, view: np.ndarray, covered: np.ndarray, folder: Path) -> None:
    """Write a set of normals as a small image, NAME.npz in a folder, with at most SIDE pixels per side. Raises
    UsageError if the file cannot be written.

    Args:
        name: the name of the set and of its file.
        n, view: unit normals and positions in view space, float32 of shape (height, width, 3).
        covered: bool of shape (height, width).
    """
    step = -(-max(covered.shape) // SIDE)
    turned = Vec3(*np.moveaxis(np.nan_to_num(n[::step, ::step]).astype(np.float64) @ ROTATION.T, -1, 0))
    numbers = np.stack([np.asarray(number) for number in encode(turned, turned)], axis=-1)
    codes = np.rint((np.clip(np.nan_to_num(numbers), -1.0, 1.0) * 0.5 + 0.5) * LEVELS).astype(np.uint16)
    with whole_file(folder / f"{name}.npz") as partial, partial.open("wb") as file:
        np.savez_compressed(file, codes=codes, covered=covered[::step, ::step], slope=_slope(view))


def _slope(view: np.ndarray) -> np.ndarray:
    """Return x / -z of the ray through the image's right edge, and y / -z through its upper edge: float32 of shape
    (2,). A slope that is not finite is 0."""
    height, width = view.shape[:2]
    with np.errstate(divide="ignore", invalid="ignore"):
        across, up = (np.nanmax(np.abs(view[..., axis] / view[..., 2])) for axis in range(2))
    # The outermost pixels' middles lie half a pixel inside.
    edges = np.array([across * width / (width - 1), up * height / (height - 1)], np.float32)
    return np.where(np.isfinite(edges), edges, np.float32(0))


def read_scenes(folder: Path) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Yield the name of each image in a run's folder, its pixels as uint8 of shape (height, width, 4), and its slope,
    float32 of shape (2,). Damaged files are skipped.

    The first 12 bits of a pixel are the first number, the next 12 bits the second number; the fourth byte is 255 on a
    surface.
    """
    for name, path in sorted(files_of(folder).items()):
        if path.suffix != ".npz":
            continue
        try:
            codes, covered, slope = read_npz(path, FIELDS, MOST_BYTES)
        except (OSError, DamagedError):
            continue
        fits = codes.ndim == 3 and codes.shape[2] == 2 and covered.shape == codes.shape[:2] and slope.shape == (2,)
        kinds = (codes.dtype, covered.dtype, slope.dtype) == (np.uint16, np.bool_, np.float32)
        if fits and kinds and max(codes.shape) <= SIDE and np.isfinite(slope).all():
            yield name.removesuffix(".npz"), _pixels(codes, covered), slope


def _pixels(codes: np.ndarray, covered: np.ndarray) -> np.ndarray:
    x, y = np.moveaxis(codes, -1, 0)
    planes = (x >> 4, (x & 15) << 4 | y >> 8, y & 255, covered * 255)
    return np.where(covered[..., None], np.stack(planes, axis=-1), 0).astype(np.uint8)


def unpacking() -> Mapping[str, Any]:
    """Return the data that a page needs to decode the pixels: levels, and the rows of the inverse rotation."""
    return {"levels": LEVELS, "back": ROTATION.T.tolist()}
