"""The error of a codec in each direction: an equal-area map of the sphere, stored as a small array.

Normals are in view space. Lambert's azimuthal equal-area projection maps each half of the sphere to a disc: z >= 0,
which faces the viewer, to the first and z <= 0 to the second, with x to the right and y up in both. A disc of radius
1 holds a hemisphere; at a distance r from its centre |z| = 1 - r^2, so every cell represents the same solid angle.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import jax
import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.vec import Vec3
from ....gbuffer.codecs.codec_passes import CodecPasses
from ....gbuffer.gl.device import device
from ...ground.output.arrays import DamagedError, read_npz
from ...ground.output.writing import whole_file
from ...measures.metrics.meter import angle_between, readable
from ...shaders.code.twin import has_twin
from .measure import UNMEASURABLE, rgba, round_trip

# Cells across a disc, and directions along each side of a cell.
CELLS, FINE = 96, 5
# Of an image of directions.
WIDTH = 2048
WHOLE_SPHERE = "sphere"


class SphereMap(NamedTuple):
    """Angles between input and decode in degrees, float32 of shape (halves, cells, cells), row 0 at the top, the half
    that faces the viewer first; NaN for cells outside the disc or in a half that the encoding cannot represent.

    Attributes:
        mean_deg, max_deg: mean and largest angle over the directions in each cell.
        directions: number of directions in a whole cell.
    """

    mean_deg: np.ndarray
    max_deg: np.ndarray
    directions: int


@cache
def _grid() -> tuple[np.ndarray, np.ndarray]:
    """Return the directions in both discs, float32 of shape (halves, pixels, pixels, 3), and a mask of the pixels
    inside a disc."""
    pixels = CELLS * FINE
    across = (np.arange(pixels) + 0.5) / pixels * 2 - 1
    u, v = np.meshgrid(across, -across)
    squared = u * u + v * v
    inside = squared <= 1
    # Lambert (1772): (x, y) = (u, v) sqrt(2 - r^2), z = 1 - r^2.
    stretch, z = np.sqrt(np.maximum(2 - squared, 0)), 1 - squared
    halves = np.stack([np.stack([u * stretch, v * stretch, side * z], axis=-1) for side in (1, -1)])
    return halves.astype(np.float32), inside


def sphere_map(codec: Codec) -> SphereMap:
    """Return a codec's errors over the sphere, measured by JAX, or by GLSL if the encoding exists only in shaders. If
    an encoding does not represent the whole sphere, the half that faces away from the viewer is NaN."""
    halves, inside = _grid()
    held = 2 if codec.encoding.domain == WHOLE_SPHERE else 1
    n = Vec3(*(np.ascontiguousarray(plane) for plane in np.moveaxis(halves[:held, inside], -1, 0)))
    degrees = np.full((2, *inside.shape), np.nan, np.float32)
    angles = _angles if has_twin(codec.encoding) else _angles_by_glsl
    degrees[:held, inside] = np.asarray(angles(codec, n))
    cells = degrees.reshape(2, CELLS, FINE, CELLS, FINE).transpose(0, 1, 3, 2, 4).reshape(2, CELLS, CELLS, -1)
    some = ~np.isnan(cells).all(axis=-1)
    mean, largest = (np.full(some.shape, np.nan, np.float32) for _ in range(2))
    mean[some], largest[some] = np.nanmean(cells[some], axis=-1), np.nanmax(cells[some], axis=-1)
    return SphereMap(mean, largest, FINE * FINE)


def _angles(codec: Codec, n: Vec3) -> Any:
    """Return the angular errors for normals given as planes of shape (halves, pixels), computed by the program that
    measures the table."""
    given = np.stack([plane.ravel() for plane in n], axis=1)
    ahead = np.broadcast_to(np.array([0.0, 0.0, -1.0], np.float32), given.shape)
    decoded = round_trip(codec, given, ahead).T.reshape(3, *n.x.shape)
    return _angles_apart(n, Vec3(*decoded))


@jax.jit
def _angles_apart(n: Vec3, decoded: Vec3) -> Any:
    return angle_between(n, readable(n, decoded)[0])


def _angles_by_glsl(codec: Codec, n: Vec3) -> np.ndarray:
    """Return what `_angles` returns, decoded by GLSL. Raises one of UNMEASURABLE."""
    count = n.x.size
    # As an image that every device has room for, the last direction repeated to fill it.
    given = Vec3(*(np.pad(plane.reshape(-1), (0, -count % WIDTH), mode="edge") for plane in n))
    ahead = Vec3(np.zeros_like(given.x), np.zeros_like(given.x), np.full_like(given.x, -1.0))
    images = (rgba(planes, len(given.x) // WIDTH, WIDTH) for planes in (given, ahead))
    with CodecPasses(device(), codec) as passes:
        decoded = Vec3(*np.ascontiguousarray(passes.round_trip(*images).normals.reshape(-1, 3).T))
    angles = angle_between(given, readable(given, decoded)[0])
    return np.asarray(angles)[:count].reshape(n.x.shape)


def file_name(encoding: str, storage: str, rounding: str) -> str:
    """Return the file name of a codec's map."""
    name = "-".join([encoding, storage, *([] if rounding == "nearest" else [rounding])])
    return name.replace("/", "_in_") + ".npz"


def write_maps(codecs: Iterable[Codec], folder: Path) -> None:
    """Write a map file for each codec that can be measured. Raises UsageError if a file cannot be written."""
    for codec in dict.fromkeys(codecs):
        try:
            error_map = sphere_map(codec)
        except UNMEASURABLE:
            continue
        path = folder / file_name(codec.encoding.name, codec.storage.name, codec.rounding)
        with whole_file(path) as partial, partial.open("wb") as file:
            np.savez_compressed(file, **error_map._asdict())


def read_map(path: Path) -> SphereMap | None:
    """Read a map that `write_maps` wrote; return None if the file is missing or damaged."""
    try:
        mean, largest, directions = read_npz(path, SphereMap._fields)
    except (OSError, DamagedError):
        return None
    fits = mean.shape == largest.shape and mean.ndim == 3 and len(mean) == 2 and directions.shape == ()
    numeric = mean.dtype == largest.dtype == np.float32 and np.issubdtype(directions.dtype, np.integer)
    return SphereMap(mean, largest, int(directions)) if fits and numeric else None
