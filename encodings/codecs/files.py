"""Files that people name: whole, of a bounded size, and never waited for."""

from __future__ import annotations

import errno
import os
import stat
import tomllib
from pathlib import Path
from typing import Any

# No text that people write is larger.
MOST_TEXT = 16 << 20


class FileError(OSError):
    """A file that cannot be read. Its text is the reason alone, for messages that name the file themselves."""

    def __str__(self) -> str:
        return self.strerror or super().__str__()


def file_bytes(path: Path, most: int) -> bytes:
    """What a file of at most so many bytes holds.

    Raises:
        FileError: it cannot be read, is larger, or is not a plain file: a pipe may never end.
        ValueError: no file can have such a name.
    """
    try:
        return _bytes(path, most)
    except OSError as error:
        raise FileError(error.errno, error.strerror) from error


def _bytes(path: Path, most: int) -> bytes:
    # Without O_NONBLOCK, opening a pipe waits for whoever writes to it.
    with os.fdopen(os.open(path, os.O_RDONLY | os.O_NONBLOCK), "rb") as file:
        found = os.fstat(file.fileno())
        if not stat.S_ISREG(found.st_mode):
            raise OSError(errno.EINVAL, "it is not a plain file")
        data = file.read(min(found.st_size, most) + 1)
    if len(data) > most:
        raise OSError(errno.EFBIG, f"it is larger than {most >> 20} MiB")
    return data


def file_text(path: Path) -> str:
    """The text of a file in UTF-8; a byte-order mark is no part of it.

    Raises:
        FileError: see file_bytes.
        ValueError: it is no such text.
    """
    text = file_bytes(path, MOST_TEXT).decode("utf-8-sig")
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
    except tomllib.TOMLDecodeError:
        raise
    except ValueError as error:
        raise ValueError("a number has too many digits") from error
    except RecursionError as error:
        raise ValueError("it is nested too deep") from error


def called(name: str) -> str:
    """A file's name as text: bytes that are no UTF-8 become escapes, as no file in UTF-8 could hold them."""
    return name.encode(errors="backslashreplace").decode()
