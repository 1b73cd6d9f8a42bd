"""Reading of users' files: in full, up to a maximum size and without blocking; and the errors that can occur."""

from __future__ import annotations

import errno
import json
import math
import os
import re
import stat
import tomllib
from collections.abc import Callable, Mapping
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
# Whole numbers of more letters may be larger than any float; Python reads none of thousands of digits.
LONG_NUMBER = 308
# How many letters of a place in a document are shown, whose names may have any length.
SHOWN_PLACE = 200
TOO_LONG = re.compile(r"(?<![\w.])[-+]?\d[\d_]{4300,}")


class FileError(OSError):
    """The error for a file that cannot be read. Its text is only the reason; callers name the file."""

    def __str__(self) -> str:
        return self.strerror or super().__str__()


class CatalogueError(Exception):
    """The error for an encoding that cannot be imported or does not match the catalogue; it names the file."""


def file_bytes(path: Path, most: int) -> bytes:
    """Return the contents of a file of at most `most` bytes.

    Raises:
        FileError: the file cannot be read, is larger, or is not a regular file: a pipe may never end.
        ValueError: no file can have this name.
    """
    try:
        return _bytes(path, most)
    except OSError as error:
        raise FileError(error.errno, reason_of(error)) from error
    except ValueError as error:
        raise ValueError("no file can have this name") from error


def _bytes(path: Path, most: int) -> bytes:
    # Without O_NONBLOCK, opening a pipe waits for whoever writes to it.
    with os.fdopen(os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0)), "rb") as file:
        status = os.fstat(file.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, NOT_PLAIN)
        data = file.read(min(status.st_size, most) + 1)
    if len(data) > most:
        raise OSError(errno.EFBIG, f"it is larger than {most >> 20} MiB")
    if data.startswith(LFS):
        raise OSError(errno.EINVAL, LFS_POINTER)
    return data


def reason_of(error: OSError) -> str:
    """Return why the system could not read a file, for messages that name the file themselves."""
    return REASONS.get(error.errno or 0, error.strerror or str(error))


def why_no_file(path: Path) -> str:
    """Return why a path is not a regular file (a folder, a special file or missing), without opening anything."""
    return FOLDER if path.is_dir() else NOT_PLAIN if path.exists() else MISSING


def file_text(path: Path) -> str:
    """Return the text of a UTF-8 file without its byte-order mark, with every line ending converted to a line feed.

    Raises:
        FileError: see file_bytes.
        ValueError: the file is not UTF-8 text.
    """
    try:
        text = file_bytes(path, MOST_TEXT).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError("it is not text in UTF-8") from error
    return text.replace("\r\n", "\n").replace("\r", "\n")


def file_toml(path: Path) -> dict[str, Any]:
    """Return the contents of a TOML file.

    Raises:
        FileError: see file_bytes.
        ValueError: the file is not TOML, is nested too deeply, or contains a number that is not finite.
    """
    text = file_text(path)
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(_not_toml(str(error))) from error
    except ValueError as error:
        raise ValueError(_too_many_digits(text)) from error
    except RecursionError as error:
        raise ValueError(TOO_DEEP) from error
    return _with_finite_numbers(document)


def _too_many_digits(text: str) -> str:
    long = TOO_LONG.search(text)
    where = f"line {text.count(chr(10), 0, long.start()) + 1}: " if long else ""
    return f"{where}a number has too many digits; write a smaller one"


# What tomllib says of a key or a table that stands twice.
TWICE = ("overwrite", "twice", "immutable", "redefine")


def _not_toml(message: str) -> str:
    """Return a short reason, with its place, for a `tomllib` message such as `Cannot overwrite a value (at line 3,
    column 22)`: the text is not valid TOML, or a key or table is given twice."""
    place = re.search(r"line (\d+), column (\d+)", message)
    where = f"line {place[1]}, column {place[2]}" if place else "its end"
    what = "a key or a table is given twice" if any(word in message for word in TWICE) else "this is not TOML"
    return f"{where}: {what}"


def file_json(path: Path) -> Any:
    """Return the contents of a JSON file.

    Raises:
        FileError: see file_bytes.
        ValueError: see parsed_json.
    """
    return parsed_json(file_text(path))


Pairs = Callable[[list[tuple[str, Any]]], dict[str, Any]]


def parsed_json(data: str | bytes, pairs: Pairs | None = None) -> Any:
    """Return the value of external JSON, given as text or UTF-8 bytes; all numbers in it are finite.

    Args:
        pairs: function that makes an object from its names and values; its exceptions pass through.

    Raises:
        ValueError: the data is not JSON, is nested too deeply, or contains a number that is not finite; the message
            gives the position.
    """
    try:
        text = data if isinstance(data, str) else data.decode("utf-8-sig")
        return _with_finite_numbers(json.loads(text, object_pairs_hook=pairs, parse_int=_whole))
    except UnicodeDecodeError as error:
        raise ValueError("it is not text in UTF-8") from error
    except json.JSONDecodeError as error:
        raise ValueError(f"line {error.lineno}, column {error.colno}: this is not JSON") from error
    except RecursionError as error:
        raise ValueError(TOO_DEEP) from error


def _whole(digits: str) -> int | float:
    """Return the whole number in a text as an int. If the text is longer than LONG_NUMBER, return a float, which may
    be infinite: Python refuses to convert very long texts to an int."""
    return int(digits) if len(digits) <= LONG_NUMBER else float(digits)


def _with_finite_numbers(document: Any) -> Any:
    """Return a document unchanged. Raises ValueError if one of its numbers is NaN or larger than a float can be."""
    left = [("", document)]
    while left:
        place, value = left.pop()
        if isinstance(value, dict):
            left += [(f"{place}.{name}" if place else name, inner) for name, inner in value.items()]
        elif isinstance(value, list):
            left += [(f"{place}[{index}]", inner) for index, inner in enumerate(value)]
        elif isinstance(value, int | float) and not _is_finite(value):
            raise ValueError(f"{place[:SHOWN_PLACE] or 'it'} is not a finite number; write one below 1e308")
    return document


def _is_finite(value: float) -> bool:
    """Whether a number is finite as a float; False for an int that is too large for a float."""
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def called(name: str) -> str:
    """Return a file's name with bytes that are not UTF-8 as escapes, because no UTF-8 file could contain them."""
    return name.encode(errors="backslashreplace").decode()
