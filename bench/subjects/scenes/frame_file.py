"""The description of a captured frame: the files and channels that contain its depth, normals and materials."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ....encodings.codecs.files import parsed_json, reason_of
from ....gbuffer.scenes.files.source import SceneFileError, checked_address, file_bytes
from ...ground.choose import unknown_name
from ...ground.options.option import KINDS, Reading, fields_of
from ...ground.output.errors import UsageError
from ...ground.spelling import spelled
from ..normals.pixel_files import READERS

ENDING = ".json"
MOST_BYTES = 2**20
# How many letters of a name are shown that no file can have.
SHOWN = 60
# What is said of each kind of entry, and of what kind it is. Words that options have mean what these mean.
OF_NORMALS = ("channels", "unpack", "curve", "normalise", "space", "mask", "nan_share")
DEPTH: Mapping[str, type] = MappingProxyType({"file": str, "channel": str, "depths_are": str, "depth_unit": float})
NORMAL: Mapping[str, type] = MappingProxyType(
    {"file": str} | {name: fields_of(Reading)[name].kind for name in OF_NORMALS}
)
COLOUR: Mapping[str, type] = MappingProxyType({"file": str, "channels": str, "curve": str, "scale": float})
NUMBER: Mapping[str, type] = MappingProxyType({"file": str, "channel": str, "curve": str, "scale": float})
ENTRIES: Mapping[str, Mapping[str, type]] = MappingProxyType(
    {
        "depth": DEPTH,
        "normal": NORMAL,
        "base_color": COLOUR,
        "roughness": NUMBER,
        "smoothness": NUMBER,
        "metallic": NUMBER,
        "f0": NUMBER,
        "ao": NUMBER,
        "emissive": COLOUR,
    }
)
# Of a 32-bit float.
LARGEST = 3.4e38
CAMERA = ("fov", "near", "far")
# What a script says of the capture is not read.
KNOWN = (*CAMERA, "view_matrix", *ENTRIES, "capture")
# Without these there is no image; roughness may be smoothness.
NEEDED = (*CAMERA, "depth", "normal", "base_color", "roughness")


@dataclass(frozen=True)
class FrameFile:
    """A checked description of a frame; its images have not been read.

    Attributes:
        path: the file that contains the description.
        fov, near, far: the camera's vertical angle of view in degrees, and its planes.
        view_matrix: world space to view space, as text for --view-matrix; None if it is unknown.
        entries: by name, the value of each entry: options with a file, a number, or three numbers.
    """

    path: Path
    fov: float
    near: float
    far: float
    view_matrix: str | None
    entries: Mapping[str, Any]

    def error(self, name: str, message: object) -> UsageError:
        """Return a one-line error about an entry, with options written as keys of the description."""
        return UsageError(f"{self.path}: {name}: {as_keys(str(message))}")


def as_keys(text: str) -> str:
    """Return a text with options replaced by keys of a description: --no-unpack becomes "unpack": false."""
    flags = {name for name in OF_NORMALS if fields_of(Reading)[name].kind is bool}

    def key(match: re.Match[str]) -> str:
        name = match[2].replace("-", "_")
        return f'"{name}": {"false" if match[1] else "true"}' if name in flags else f'"{name}"'

    return re.sub(r"--(no-)?([a-z][a-z-]*)", key, text)


def read_frame_file(path: Path) -> FrameFile:
    """Return the description in a file. Raises UsageError, in one line, for missing, unknown or invalid entries."""
    document = _document(path)
    attributes = {
        spelled("attribute", name, KNOWN) or name: value for name, value in document.items() if value is not None
    }
    _check_names(path, "", attributes, KNOWN)
    if {"roughness", "smoothness"} <= set(attributes):
        raise UsageError(f"{path}: roughness and smoothness are the same quantity; leave one out")
    lacking = [
        name for name in NEEDED if name not in attributes and not (name == "roughness" and "smoothness" in attributes)
    ]
    if lacking:
        raise UsageError(f"{path}: missing {', '.join(lacking)}; {_how(lacking[0])}")
    fov, near, far = (_number(path, name, attributes[name]) for name in CAMERA)
    _check_camera(path, fov, near, far)
    entries = {name: _entry(path, name, attributes[name]) for name in ENTRIES if name in attributes}
    return FrameFile(path, fov, near, far, _matrix(path, attributes.get("view_matrix")), entries)


def files_of_frame(path: Path) -> list[Path]:
    """Return the existing files that a description names, sorted; empty if the description cannot be read."""
    try:
        return sorted(set(filter(Path.is_file, _named_files(read_frame_file(path)))))
    except (UsageError, OSError):
        return []


def _named_files(frame: FrameFile) -> Iterator[Path]:
    words = [entry for entry in frame.entries.values() if isinstance(entry, dict)]
    yield from (Path(entry[key]) for entry in words for key in ("file", "mask") if key in entry)
    if frame.view_matrix:
        yield Path(frame.view_matrix)


def _document(path: Path) -> dict[str, Any]:
    try:
        document = parsed_json(file_bytes(path, MOST_BYTES))
    except SceneFileError as error:
        raise UsageError(str(error)) from error
    except ValueError as error:
        raise UsageError(f"{path}: {error}") from error
    if not isinstance(document, dict):
        raise UsageError(f'{path}: not a frame description; expected {{"depth": {{"file": "depth.exr"}}, ...}}')
    return document


def _check_names(path: Path, place: str, entries: Mapping[str, Any], known: tuple[str, ...]) -> None:
    unknown = [name for name in entries if name not in known]
    if unknown:
        raise UsageError(f"{path}: {place}{unknown_name('key', unknown, known)}")


def _how(name: str) -> str:
    """Return advice on how to write a missing entry."""
    if name in CAMERA:
        return f'write "{name}": NUMBER'
    return f'write "{name}": {{"file": "FILE", "{"channel" if "channel" in ENTRIES[name] else "channels"}": "..."}}'


def _number(path: Path, name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise UsageError(f"{path}: {name} is {value!r}; it must be a number")
    if abs(value) > LARGEST:
        raise UsageError(f"{path}: {name} is {float(value):g}; write a number that a 32-bit float holds, below 3.4e38")
    return float(value)


def _check_camera(path: Path, fov: float, near: float, far: float) -> None:
    if not 1 <= fov <= 175:
        raise UsageError(f"{path}: fov is {fov:g}; use 1 to 175 degrees")
    if not 0 < near < far < 1e15:
        raise UsageError(
            f"{path}: near is {near:g} and far is {far:g}; use 0 < near < far; for reversed depth write "
            '"depths_are": "reversed_window"'
        )


def _matrix(path: Path, value: object) -> str | None:
    """Return the numbers of a matrix as comma-separated text, or the path of the file that contains them; None if
    `value` is None. Raises UsageError for any other value."""
    if value is None:
        return None
    if isinstance(value, list):
        flat = [number for row in value for number in (row if isinstance(row, list) else [row])]
        return ",".join(repr(_number(path, "view_matrix", number)) for number in flat)
    if not isinstance(value, str):
        raise UsageError(f"{path}: view_matrix is {value!r}; it must be numbers, or a text file of them")
    is_file = re.search(r"[^-+0-9.eE,;\s]", value)
    return str(_beside(path, "view_matrix", value)) if is_file else value


def _entry(path: Path, name: str, value: object) -> Any:
    """Return the value of an entry: a number, a list of three numbers for a colour, or a dictionary of options with
    paths in place of file names. Raises UsageError."""
    kinds = ENTRIES[name]
    if kinds is NUMBER and not isinstance(value, dict):
        return _number(path, name, value)
    if kinds is COLOUR and isinstance(value, list) and len(value) == 3:
        return [_number(path, name, number) for number in value]
    if not isinstance(value, dict):
        raise UsageError(f"{path}: {name} is {value!r}; {_how(name)}")
    _check_names(path, f"{name}: ", value, tuple(kinds))
    if value.get("file") is None:
        raise UsageError(f"{path}: {name}: no file; {_how(name)}")
    options = {key: _word(path, f"{name}: {key}", word, kinds[key]) for key, word in value.items() if word is not None}
    for key in ("file", "mask"):
        if key == "file" or Path(options.get(key, "")).suffix.lower() in READERS:
            options[key] = str(_beside(path, name, options[key]))
    return options


def _word(path: Path, place: str, value: object, kind: type) -> Any:
    if kind is float:
        return _number(path, place, value)
    if kind is str and isinstance(value, list):
        value = ",".join(map(str, value))
    if not isinstance(value, kind):
        raise UsageError(f"{path}: {place} is {value!r}; it must be {KINDS[kind]}")
    return value


def _beside(path: Path, name: str, address: str) -> Path:
    """Return the path of a file in a description's folder or below it. Raises UsageError if the file is elsewhere or
    does not exist."""
    try:
        file = checked_address(path, address, name)
        is_there = file is not None and file.is_file()
    except SceneFileError as error:
        raise UsageError(str(error)) from error
    except OSError as error:
        raise UsageError(f"{path}: {name}: {address[:SHOWN]}...: {reason_of(error)}") from error
    if file is None or not is_there:
        raise UsageError(f"{path}: {name}: no file {address}; file names are relative to the folder of {path.name}")
    return path.parent / os.path.relpath(file, path.parent.resolve())
