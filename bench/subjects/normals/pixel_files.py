"""Pixels from users' files by channel name: from NPY files, and from images that OpenImageIO reads.

Sizes are read from headers and checked before memory is allocated.
"""

from __future__ import annotations

import io
import json
import math
import re
import subprocess
import tempfile
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from ....gbuffer.scenes.files import ply
from ....gbuffer.scenes.files.mesh_file import Rounding
from ....gbuffer.scenes.files.source import SceneFileError, file_bytes
from ...ground.machine.children import environment, python
from ...ground.output.errors import UsageError
from . import png

# An 8K frame; and all the channels of a file together, which the library reads at once.
MAX_PIXELS = 2**25
MAX_NUMBERS = 2**29
MAX_CHANNELS = 1024
SMALLER = f"at most {MAX_PIXELS} pixels (2^25) are supported: crop the image"
SECONDS = 120
EXR = "openexr"
TIFF = rb"(II|MM)(\*\0|\0\*|\+\0|\0\+)"
# By a file's ending: OpenImageIO's name of the format, and how such a file starts.
FORMATS: Mapping[str, tuple[str, bytes]] = MappingProxyType(
    {
        ".exr": (EXR, rb"\x76\x2f\x31\x01"),
        ".png": ("png", rb"\x89PNG\r\n\x1a\n.{4}IHDR"),
        ".tif": ("tiff", TIFF),
        ".tiff": ("tiff", TIFF),
        ".dds": ("dds", rb"DDS "),
        ".hdr": ("hdr", rb"#\?"),
        ".webp": ("webp", rb"RIFF.{4}WEBP"),
    }
)
# The library's names of types of numbers.
TYPES = ("uint8", "uint16", "half", "float", "double")
# What stands for 1 of whole numbers of 8 and 10 bits, as targets have them. Floats are told to be shares of it by some
# of them, of which so many differ.
STEPS, LOOKED_AT, DIFFERENT = (255, 1023), 2**16, 8
# What a status of `pixel_process.py` says, and the remedy; any other is a damaged file.
FAILURES: Mapping[int, tuple[str, str]] = MappingProxyType(
    {
        2: ("a channel is subsampled", "save all channels at full resolution"),
        3: ("its header claims far more pixels than the file can hold", SMALLER),
    }
)

# From the names of a file's channels to those that are wanted.
Choice = Callable[[Sequence[str]], Sequence[str]]
# Raises UsageError where a file's width and height, or its count of channels, are not those that are read.
Check = Callable[[Path, tuple[int, int], int], None]


@dataclass(frozen=True, eq=False)
class Pixels:
    """Selected channels of a file.

    Attributes:
        planes: (channels, height, width) or (channels, count), float32; float64 if the file has float64.
        full: the integer that represents 1 in an integer file; None for a float file.
        roundings: the roundings that a file declares for its normals.
    """

    planes: np.ndarray
    full: int | None
    roundings: tuple[Rounding, ...] = ()

    @property
    def shape(self) -> tuple[int, ...]:
        return self.planes.shape[1:]

    @cached_property
    def steps(self) -> int | None:
        """The integer that represents 1 in the channels, including integers that were converted to floats in [0, 1];
        None for other floats."""
        return self.full or next((full for full in STEPS if _are_shares(self.planes, full)), None)


def read_pixels(path: Path, choose: Choice) -> Pixels:
    """Return the channels of a file that `choose` selects by name.

    Raises:
        UsageError: the file is damaged, too large or of an unsupported kind, or `choose` rejects it.
    """
    return {**READERS, **CLOUDS}[path.suffix.lower()](path, choose)


def _are_shares(planes: np.ndarray, full: int) -> bool:
    """Whether sampled finite values are multiples of 1 / full in [0, 1], with enough distinct values to tell."""
    flat = planes.reshape(-1)[:: max(1, planes.size // LOOKED_AT)]
    numbers = np.unique(flat[np.isfinite(flat)]).astype(np.float64) * full
    # A float32 is that close to what it stands for.
    is_near = np.abs(numbers - np.rint(numbers)) < full * 1e-7
    return bool(len(numbers) >= DIFFERENT and numbers[0] >= 0 and numbers[-1] <= full and is_near.all())


def has_normals_alone(path: Path) -> bool:
    """Whether a file is an image, a list of normals, or a point cloud with normals. Raises UsageError."""
    ending = path.suffix.lower()
    try:
        return ending in READERS or (ending in CLOUDS and path.is_file() and ply.is_cloud(path))
    except SceneFileError as error:
        raise UsageError(str(error)) from error


def refused(path: Path, what: str, remedy: str = "save it again") -> UsageError:
    """Return an error that describes the problem with a file, and the remedy, in one line."""
    return UsageError(f"{path}: {what}; {remedy}")


def _bytes(path: Path) -> bytes:
    try:
        return file_bytes(path)
    except SceneFileError as error:
        raise UsageError(str(error)) from error


def check_sides(path: Path, sides: tuple[int, int], channels: int) -> None:
    """Raise UsageError if an image has too many pixels or channels."""
    check_pixels(path, math.prod(sides), channels)


def check_pixels(path: Path, pixels: int, channels: int) -> None:
    """Raise UsageError if there are too many pixels or channels."""
    if channels > MAX_CHANNELS:
        raise refused(path, f"{channels} channels", f"at most {MAX_CHANNELS} are supported")
    if pixels > MAX_PIXELS or pixels * channels > MAX_NUMBERS:
        raise refused(path, f"{pixels} pixels of {channels} channels", SMALLER)


# Images


def read_image(path: Path, choose: Choice, check: Check = check_sides) -> Pixels:
    """Return the channels of an image that `choose` selects by name; `check` tests the header before pixels are read.

    Raises:
        UsageError: the image is damaged, too large or of an unsupported kind, or `choose` or `check` rejects it.
    """
    kind, start = FORMATS[path.suffix.lower()]
    data = _bytes(path)
    if not re.match(start, data, re.DOTALL):
        raise refused(path, f"its first bytes are not those of {path.suffix[1:].upper()} files")
    if kind == "png" and max(png.sides(data)) > png.MAX_SIDE:
        width, height = png.sides(data)
        raise refused(path, f"{width} x {height} pixels", f"at most {png.MAX_SIDE} per side are supported")
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        _in_a_process(path, kind, out, "header")
        parts = json.loads(out.read_text(encoding="utf-8"))
        chosen = list(choose(_checked_parts(path, kind, parts, check)))
        _check_alike(path, kind, parts, chosen)
        _in_a_process(path, kind, out, "pixels", *chosen)
        planes = np.load(out, allow_pickle=False)
    if kind == "png" and png.has_surplus(data):
        raise refused(path, "it has more rows than its header says: it is damaged")
    # Whole numbers of an EXR file are identities and counts.
    full = np.iinfo(planes.dtype).max if planes.dtype.kind == "u" and kind != EXR else None
    return Pixels(_planes(np.moveaxis(planes, 0, -1), range(len(planes))), full)


def _in_a_process(path: Path, kind: str, out: Path, mode: str, *names: str) -> None:
    """Run `pixel_process.py` on a file and write its answer to `out`. Raises UsageError if the file cannot be read.

    Args:
        mode: "header" for the header's data on each part; otherwise the channels in `names` are read."""
    command = [*python(f"{__package__}.pixel_process"), mode, kind, str(path.resolve()), str(out), *names]
    try:
        done = subprocess.run(command, capture_output=True, timeout=SECONDS, env=environment())
    except subprocess.TimeoutExpired as error:
        raise refused(path, f"not read within {SECONDS} seconds") from error
    if done.returncode:
        # What the library says of a damaged file is another matter each time, and mostly of an index.
        raise refused(path, *FAILURES.get(done.returncode, ("it is cut off or damaged",)))


def _checked_parts(path: Path, kind: str, parts: list[dict[str, Any]], check: Check) -> list[str]:
    """Return the names of all channels. Raises UsageError if a part is too large or of an unsupported kind."""
    for part in parts:
        where = f"part {part['name']!r}: " if len(parts) > 1 else ""
        if part["deep"]:
            raise refused(path, f"{where}deep samples are not supported", "flatten the image")
        width, height, depth = part["sides"]
        if depth != 1 or min(width, height) < 1:
            raise refused(path, f"{where}an image of {width} x {height} x {depth}", "save it with a depth of 1")
        check(path, (width, height), len(part["names"]))
        other = [word for word in part["types"] if word not in (*TYPES, *(["uint"] if kind == EXR else []))]
        if other:
            raise refused(path, f"{where}numbers of type {other[0]}", f"supported: {', '.join(TYPES)}")
    names = [name for part in parts for name in part["names"]]
    if not names or len(set(names)) < len(names):
        raise refused(path, "no channels, or two with the same name")
    return names


def _check_alike(path: Path, kind: str, parts: list[dict[str, Any]], chosen: Sequence[str]) -> None:
    """Raise UsageError if chosen channels are in parts of different positions, sizes or values that represent 1."""
    used = [part for part in parts if set(chosen) & set(part["names"])]
    layouts = [(part["place"], part["sides"], kind == EXR or part["types"]) for part in used]
    if any(layout != layouts[0] for layout in layouts):
        raise refused(path, f"{', '.join(chosen)} are in parts of different sizes or types")


def _planes(array: np.ndarray, chosen: Sequence[int]) -> np.ndarray:
    """Return the chosen channels of an array (..., channels) as planes: float64 for 8-byte values, else float32."""
    kind = np.float64 if array.dtype.itemsize == 8 else np.float32
    with np.errstate(invalid="ignore"):
        return np.stack([array[..., channel].astype(kind) for channel in chosen])


# PLY


def _read_cloud(path: Path, choose: Choice) -> Pixels:
    try:
        cloud = ply.read_cloud(path)
    except SceneFileError as error:
        raise UsageError(str(error)) from error
    assert cloud.normals is not None
    check_pixels(path, *cloud.normals.shape)
    chosen = [ply.NORMAL.index(name) for name in choose(ply.NORMAL)]
    return Pixels(_planes(cloud.normals, chosen), None, cloud.roundings)


# NPY


def _read_npy(path: Path, choose: Choice) -> Pixels:
    array = _npy_array(path)
    shape = array.shape
    if len(shape) == 3 and shape[0] in (3, 4) < (shape[-1],):
        raise refused(path, f"an array of shape {shape}", "channels come last: save np.moveaxis(array, 0, -1)")
    return _npy_pixels(path, array, choose)


def read_plane(path: Path, choose: Choice) -> Pixels:
    """Read one channel of an image, like `read_pixels`; an array of shape (height, width) counts as one channel.

    Raises:
        UsageError: see `read_pixels`.
    """
    if path.suffix.lower() != ".npy":
        return read_pixels(path, choose)
    array = _npy_array(path)
    return _npy_pixels(path, array if array.ndim == 3 else array[..., None], choose)


def _npy_pixels(path: Path, array: np.ndarray, choose: Choice) -> Pixels:
    """Return the chosen channels of an array (..., channels), whose channels are named by index: "0", "1", ..."""
    check_pixels(path, math.prod(array.shape[:-1]), array.shape[-1])
    names = [str(channel) for channel in range(array.shape[-1])]
    chosen = [names.index(name) for name in choose(names)]
    return Pixels(_planes(array, chosen), np.iinfo(array.dtype).max if array.dtype.kind == "u" else None)


def _npy_array(path: Path) -> np.ndarray:
    """Return the array in an NPY file, which has two or three dimensions and shares the file's bytes."""
    stream = io.BytesIO(_bytes(path))
    shape, in_columns, kind = _npy_header(path, stream)
    if kind.kind not in "fub" or kind.itemsize > 8 or (kind.kind == "u" and kind.itemsize > 2):
        signed = f"; save array / {np.iinfo(kind).max} as float32" if kind.kind == "i" else ""
        raise refused(path, f"numbers of type {kind}", f"supported: float16, float32, float64, uint8, uint16{signed}")
    if len(shape) not in (2, 3) or min(shape) < 1:
        raise refused(path, f"an array of shape {shape}", "expected (height, width, 3) or (count, 3)")
    count = math.prod(shape)
    left = len(stream.getbuffer()) - stream.tell()
    if count * kind.itemsize > left:
        raise refused(path, f"shape {shape} needs {count * kind.itemsize} bytes; the file has {left}: it is truncated")
    flat = np.frombuffer(stream.getbuffer(), kind, count, stream.tell())
    return flat.reshape(shape, order="F" if in_columns else "C")


def _npy_header(path: Path, stream: io.BytesIO) -> tuple[tuple[int, ...], bool, np.dtype]:
    readers = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            version = np.lib.format.read_magic(stream)
            shape, in_columns, kind = readers[version](stream)
    except Exception as error:  # numpy, ast and tokenize raise a dozen kinds
        raise refused(path, "its NPY header cannot be read", "save it with np.save") from error
    if not all(type(side) is int for side in shape):
        raise refused(path, f"an array of shape {shape}")
    return shape, in_columns, kind


READERS: Mapping[str, Callable[[Path, Choice], Pixels]] = MappingProxyType(
    dict.fromkeys(FORMATS, read_image) | {".npy": _read_npy}
)
# Files that are meshes otherwise.
CLOUDS: Mapping[str, Callable[[Path, Choice], Pixels]] = MappingProxyType({".ply": _read_cloud})
