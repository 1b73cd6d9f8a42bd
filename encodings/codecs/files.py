"""Files that people name: whole, of a bounded size, and never waited for; and what can be wrong with any file here."""

from __future__ import annotations

import errno
import json
import os
import re
import stat
import tomllib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

# No text that people write is larger.
MOST_TEXT = 16 << 20
MISSING, FOLDER, NOT_PLAIN = "there is no such file", "it is a folder; name a file", "it is not a plain file"
# What stands in a repository for a file that lies elsewhere.
LFS, LFS_POINTER = b"version https://git-lfs.github.com/spec/", "it is a Git LFS pointer: git lfs pull"
# Why the system does not give a file.
REASONS: Mapping[int, str] = MappingProxyType(
    {
        errno.ENOENT: MISSING,
        errno.ENOTDIR: MISSING,
        errno.EISDIR: FOLDER,
        errno.EACCES: "you have no permission to read it",
        errno.ELOOP: "it is a link that leads back to itself",
        errno.ENAMETOOLONG: "its name is too long",
    }
)
TOO_DEEP = "it is nested too deep"


class FileError(OSError):
    """A file that cannot be read. Its text is the reason alone, for messages that name the file themselves."""

    def __str__(self) -> str:
        return self.strerror or super().__str__()


class CatalogueError(Exception):
    """An encoding that cannot be imported or is not what the catalogue calls it; one line with its file."""


def file_bytes(path: Path, most: int) -> bytes:
    """What a file of at most so many bytes holds.

    Raises:
        FileError: it cannot be read, is larger, or is not a plain file: a pipe may never end.
        ValueError: no file can have such a name.
    """
    try:
        return _bytes(path, most)
    except OSError as error:
        raise FileError(error.errno, REASONS.get(error.errno or 0, error.strerror)) from error
    except ValueError as error:
        raise ValueError("no file can have this name") from error


def _bytes(path: Path, most: int) -> bytes:
    # Without O_NONBLOCK, opening a pipe waits for whoever writes to it.
    with os.fdopen(os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0)), "rb") as file:
        found = os.fstat(file.fileno())
        if not stat.S_ISREG(found.st_mode):
            raise OSError(errno.EINVAL, NOT_PLAIN)
        data = file.read(min(found.st_size, most) + 1)
    if len(data) > most:
        raise OSError(errno.EFBIG, f"it is larger than {most >> 20} MiB")
    if data.startswith(LFS):
        raise OSError(errno.EINVAL, LFS_POINTER)
    return data


def why_no_file(path: Path) -> str:
    """Which of a folder, not plain or missing a path is that names no plain file; nothing is opened."""
    return FOLDER if path.is_dir() else NOT_PLAIN if path.exists() else MISSING


def file_text(path: Path) -> str:
    """The text of a file in UTF-8; a byte-order mark is no part of it.

    Raises:
        FileError: see file_bytes.
        ValueError: it is no such text.
    """
    try:
        text = file_bytes(path, MOST_TEXT).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError("it is not text in UTF-8") from error
    return text.replace("\r\n", "\n").replace("\r", "\n")


def file_toml(path: Path) -> dict[str, Any]:
    """What a TOML file holds.

    Raises:
        FileError: see file_bytes.
        ValueError: it is not TOML, or is nested too deep.
    """
    text = file_text(path)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(_not_toml(str(error))) from error
    except ValueError as error:
        raise ValueError("a number has too many digits") from error
    except RecursionError as error:
        raise ValueError(TOO_DEEP) from error


# What tomllib says of a key or a table that stands twice.
TWICE = ("overwrite", "twice", "immutable", "redefine")


def _not_toml(said: str) -> str:
    """What is wrong with TOML, from what the library says: `Cannot overwrite a value (at line 3, column 22)`."""
    place = re.search(r"line (\d+), column (\d+)", said)
    where = f"line {place[1]}, column {place[2]}" if place else "its end"
    what = "a key or a table is given twice" if any(word in said for word in TWICE) else "this is not TOML"
    return f"{where}: {what}"


def file_json(path: Path) -> Any:
    """What a JSON file holds.

    Raises:
        FileError: see file_bytes.
        ValueError: it is not JSON, or is nested too deep.
    """
    text = file_text(path)
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(not_json(error)) from error


def not_json(error: ValueError | RecursionError) -> str:
    """What is wrong with JSON, from what the library raised."""
    if isinstance(error, RecursionError):
        return TOO_DEEP
    is_placed = isinstance(error, json.JSONDecodeError)
    return f"line {error.lineno}, column {error.colno}: this is not JSON" if is_placed else "it is not JSON"


def called(name: str) -> str:
    """A file's name as text: bytes that are no UTF-8 become escapes, as no file in UTF-8 could hold them."""
    return name.encode(errors="backslashreplace").decode()
