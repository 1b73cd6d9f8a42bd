"""Bytes of users' scene files: of limited size, never from the network, never from outside a file's own folder."""

from __future__ import annotations

import base64
import binascii
import re
from pathlib import Path
from urllib.parse import unquote

import numpy as np

from ....encodings.codecs import files

# Read before anything in them is believed.
MAX_BYTES = 2**30
# Text takes many times its size while it is taken apart.
MAX_TEXT_BYTES = 2**28
# Of all meshes in all the places they stand in.
MAX_VERTICES = MAX_TRIANGLES = 2**22
# Numbers from here on are not read: their squares are near the end of float32.
TOO_LARGE = 1e15


class SceneFileError(ValueError):
    """A file that cannot be read as a scene; the message is one line with the file, the place in it and the
    remedy."""


class MissingPackageError(SceneFileError):
    """A file that needs a package that is not installed."""


def file_bytes(path: Path, most: int = MAX_BYTES) -> bytes:
    """Return the contents of a file of at most `most` bytes.

    Raises:
        SceneFileError: the file is not a plain file (a pipe would never end), is too large, or cannot be read.
    """
    try:
        if not path.is_file():
            raise SceneFileError(f"{path}: {files.why_no_file(path)}")
        size = path.stat().st_size
        if size > most:
            raise SceneFileError(f"{path}: {size} bytes; the maximum is {most}: export fewer objects, or in binary")
        return files.file_bytes(path, most)
    except SceneFileError:
        raise
    except OSError as error:
        raise SceneFileError(f"{path}: {files.reason_of(error)}") from error
    except ValueError as error:
        raise SceneFileError(f"{path}: {error}") from error


def checked_address(path: Path, address: object, place: str) -> Path | None:
    """Return the resolved path of an address in the file `path`, without reading it; None for a data: address.

    Raises:
        SceneFileError: the address is not text, is on the network, or leaves the file's folder, also by a link.
    """
    if not isinstance(address, str):
        raise SceneFileError(f"{path}: {place}: the address is not a string; export it again")
    if address.startswith("data:"):
        return None
    shown = address if len(address) <= 60 else f"{address[:57]}..."
    if re.match(r"[A-Za-z][A-Za-z0-9+.-]*:", address) or address.startswith("//"):
        raise SceneFileError(
            f"{path}: {place}: {shown!r} is not in the file's folder; nothing is downloaded: save it next to the file"
        )
    outside = SceneFileError(f"{path}: {place}: {shown!r} is outside the file's folder; save it next to the file")
    words = re.split(r"[/\\]", unquote(address))
    if ".." in words or not words[0] or "\0" in address:
        raise outside
    try:
        folder = path.parent.resolve()
        named = folder.joinpath(*words).resolve()
    except (OSError, ValueError, RuntimeError) as error:
        raise outside from error
    if not named.is_relative_to(folder):
        raise outside
    return named


def resource(path: Path, address: object, place: str) -> bytes:
    """Return the data at an address in the file `path`: base64 after data:, or a file in the same folder.

    Raises:
        SceneFileError: see `checked_address` and `file_bytes`; or the base64 is not valid.
    """
    named = checked_address(path, address, place)
    if named is not None:
        try:
            return file_bytes(named)
        except SceneFileError as error:
            raise SceneFileError(f"{path}: {place}: {error}") from error
    head, _, data = str(address).partition(",")
    try:
        if not head.endswith(";base64"):
            raise ValueError("not base64")
        return base64.b64decode(unquote(data), validate=True)
    except (ValueError, binascii.Error) as error:
        raise SceneFileError(f"{path}: {place}: the data: address is damaged ({error}); export it again") from error


def checked_indices(path: Path, indices: np.ndarray, count: int, place: str) -> np.ndarray:
    """Return vertex indices unchanged. Raises SceneFileError unless all indices are from 0 to `count` - 1."""
    bad = np.flatnonzero((indices < 0) | (indices >= count))
    if len(bad):
        worst = indices.ravel()[bad[0]] if indices.ndim == 1 else indices.reshape(-1)[bad[0]]
        raise SceneFileError(
            f"{path}: {place}: index {bad[0]} refers to vertex {worst}, but there are {count} vertices; export it again"
        )
    return indices


def checked_numbers(path: Path, numbers: np.ndarray, place: str) -> np.ndarray:
    """Return vertex data unchanged. Raises SceneFileError if a number is NaN, infinite or too large to be squared."""
    bad = np.flatnonzero(~(np.abs(numbers) < TOO_LARGE).all(axis=1))
    if len(bad):
        raise SceneFileError(
            f"{path}: {place} of vertex {bad[0]}: {numbers[bad[0]].tolist()}; numbers must be below {TOO_LARGE:g}"
        )
    return numbers


def checked_size(path: Path, vertices: int, triangles: int, place: str) -> None:
    """Raise SceneFileError if a count exceeds the maximum; call this before anything is allocated."""
    for count, most, what in ((vertices, MAX_VERTICES, "vertices"), (triangles, MAX_TRIANGLES, "triangles")):
        if count > most:
            raise SceneFileError(f"{path}: {place}: {count} {what}; the maximum is {most} (2^22): export fewer objects")
