"""Pixels of users' files by the names of their channels: EXR, PNG, NPY.

Sizes are taken from headers and refused before anything is allocated.
"""

from __future__ import annotations

import io
import json
import math
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from ...gbuffer.scenes.files.source import SceneFileError, file_bytes
from ..output.errors import MissingError, UsageError
from . import png

# An 8K frame; and all the channels of a file together, which EXR's library reads at once.
MAX_PIXELS = 2**25
MAX_NUMBERS = 2**29
SECONDS = 120
EXR_MAGIC = b"\x76\x2f\x31\x01"
DEEP = ("deep",)

# From the names of a file's channels to those that are wanted.
Choice = Callable[[Sequence[str]], Sequence[str]]


@dataclass(frozen=True)
class Pixels:
    """Some channels of a file.

    Attributes:
        planes: (channels, height, width) or (channels, count), float32; float64 where the file has that.
        full: what stands for 1 in a file of whole numbers, None in one of floats.
    """

    planes: np.ndarray
    full: int | None

    @property
    def shape(self) -> tuple[int, ...]:
        return self.planes.shape[1:]


def read_pixels(path: Path, choose: Choice) -> Pixels:
    """The channels of a file that `choose` picks of their names.

    Raises:
        UsageError: it is damaged, too large, or of a kind that is not read; and what `choose` raises.
        MissingError: reading it needs a package that is not installed.
    """
    return READERS[path.suffix.lower()](path, choose)


def refused(path: Path, what: str, remedy: str = "save it again") -> UsageError:
    """What is wrong with a file, in one line."""
    return UsageError(f"{path}: {what}; {remedy}")


def _bytes(path: Path) -> bytes:
    try:
        return file_bytes(path)
    except SceneFileError as error:
        raise UsageError(str(error)) from error


def check_pixels(path: Path, pixels: int, channels: int) -> None:
    """Raises UsageError where an image is larger than is read."""
    if pixels > MAX_PIXELS or pixels * channels > MAX_NUMBERS:
        raise refused(
            path, f"{pixels} pixels of {channels} channels", f"at most {MAX_PIXELS} pixels (2^25) are read: crop it"
        )


# PNG


def _read_png(path: Path, choose: Choice) -> Pixels:
    data = _bytes(path)
    try:
        head = png.header(data)
        check_pixels(path, head.width * head.height, 4)
        found = png.pixels(data) if head.depth == 16 else _by_pillow(data)
    except png.PngError as error:
        raise refused(path, f"{error}") from error
    names = "LA" if found.shape[2] < 3 else "RGBA"
    chosen = [names.index(name) for name in choose(names[: found.shape[2]])]
    return Pixels(_planes(found, chosen), np.iinfo(found.dtype).max)


def _by_pillow(data: bytes) -> np.ndarray:
    from PIL import Image

    try:
        with warnings.catch_warnings():
            # It warns of metadata, and of sizes that have been looked at.
            warnings.simplefilter("ignore")
            with Image.open(io.BytesIO(data), formats=["PNG"]) as image:
                if image.mode not in ("L", "LA", "RGB", "RGBA"):
                    image = image.convert("RGBA" if image.mode == "P" else "L")
                found = np.asarray(image)
    except Exception as error:  # of a dozen kinds, by what is damaged
        raise png.PngError(f"it is damaged ({error})") from error
    return found if found.ndim == 3 else found[..., None]


def _planes(found: np.ndarray, chosen: Sequence[int]) -> np.ndarray:
    """Channels of (..., channels) as planes; of float64 and as they are where that is what they are."""
    kind = np.float64 if found.dtype.itemsize == 8 else np.float32
    with np.errstate(invalid="ignore"):
        return np.stack([found[..., channel].astype(kind) for channel in chosen])


# NPY


def _read_npy(path: Path, choose: Choice) -> Pixels:
    stream = io.BytesIO(_bytes(path))
    shape, in_columns, kind = _npy_header(path, stream)
    if kind.kind not in "fub" or kind.itemsize > 8 or (kind.kind == "u" and kind.itemsize > 2):
        raise refused(path, f"numbers of type {kind}", "float16, float32, float64, uint8 and uint16 are read")
    if len(shape) not in (2, 3) or min(shape) < 1:
        raise refused(path, f"an array of shape {shape}", "(height, width, 3) or (count, 3) is read")
    count = math.prod(shape)
    left = len(stream.getbuffer()) - stream.tell()
    if count * kind.itemsize > left:
        raise refused(path, f"shape {shape} needs {count * kind.itemsize} bytes, the file has {left}: it is cut off")
    check_pixels(path, math.prod(shape[:-1]), shape[-1])
    flat = np.frombuffer(stream.getbuffer(), kind, count, stream.tell())
    found = flat.reshape(shape, order="F" if in_columns else "C")
    names = [str(channel) for channel in range(shape[-1])]
    if len(shape) == 3 and shape[0] in (3, 4) < (shape[-1],):
        raise refused(path, f"an array of shape {shape}", "channels come last: save np.moveaxis(array, 0, -1)")
    chosen = [names.index(name) for name in choose(names)]
    return Pixels(_planes(found, chosen), np.iinfo(kind).max if kind.kind == "u" else None)


def _npy_header(path: Path, stream: io.BytesIO) -> tuple[tuple[int, ...], bool, np.dtype]:
    readers = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            version = np.lib.format.read_magic(stream)
            shape, in_columns, kind = readers[version](stream)
    except Exception as error:  # numpy, ast and tokenize raise a dozen kinds
        raise refused(path, "no NPY header that can be read", "save it with np.save") from error
    if not all(type(side) is int for side in shape):
        raise refused(path, f"an array of shape {shape}")
    return shape, in_columns, kind


# EXR


def _read_exr(path: Path, choose: Choice) -> Pixels:
    if find_spec("OpenEXR") is None:
        raise MissingError(f"reading {path.name} needs OpenEXR: pip install OpenEXR, or normalbench[exr]")
    if not _bytes(path).startswith(EXR_MAGIC):
        raise refused(path, "no EXR file, by its first bytes")
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        _in_a_process(path, out, "header")
        parts = json.loads(out.read_text(encoding="utf-8"))
        names = _checked_parts(path, parts)
        chosen = list(choose(names))
        _check_windows(path, parts, chosen)
        _in_a_process(path, out, "pixels", *chosen)
        with np.load(out, allow_pickle=False) as stored:
            planes = [stored[key] for key in stored.files]
    return Pixels(_planes(np.stack(planes, axis=-1), range(len(planes))), None)


def _in_a_process(path: Path, out: Path, mode: str, *names: str) -> None:
    """Runs `exr_process.py`. Raises UsageError where it cannot read the file."""
    script = Path(__file__).with_name("exr_process.py")
    command = [sys.executable, "-P", str(script), mode, str(path.resolve()), str(out), *names]
    try:
        done = subprocess.run(command, capture_output=True, timeout=SECONDS)
    except subprocess.TimeoutExpired as error:
        raise refused(path, f"not read within {SECONDS} seconds") from error
    if done.returncode:
        # What the library says of it is another matter each time, and mostly of an index.
        raise refused(path, "it is cut off or damaged")


def _checked_parts(path: Path, parts: list[dict[str, Any]]) -> list[str]:
    """The names of all channels. Raises UsageError for what is too large or of a kind that is not read."""
    for part in parts:
        where = f"part {part['name']!r}: " if len(parts) > 1 else ""
        if any(word in part["kind"].lower() for word in DEEP):
            raise refused(path, f"{where}deep samples", "flatten it")
        if part["subsampled"]:
            raise refused(
                path, f"{where}channel {part['subsampled'][0]!r} has fewer samples than pixels", "save it in full"
            )
        sides = [high - low + 1 for low, high in zip(part["low"], part["high"], strict=True)]
        if min(sides) < 1:
            raise refused(path, f"{where}a data window of {sides[0]} x {sides[1]}")
        check_pixels(path, math.prod(sides), len(part["names"]))
    names = [name for part in parts for name in part["names"]]
    if not names or len(set(names)) < len(names):
        raise refused(path, "no channels, or two of one name")
    return names


def _check_windows(path: Path, parts: list[dict[str, Any]], chosen: Sequence[str]) -> None:
    windows = {(*part["low"], *part["high"]) for part in parts if set(chosen) & set(part["names"])}
    if len(windows) > 1:
        raise refused(path, f"{', '.join(chosen)} lie in parts of different sizes")


READERS: Mapping[str, Callable[[Path, Choice], Pixels]] = MappingProxyType(
    {".exr": _read_exr, ".png": _read_png, ".npy": _read_npy}
)
