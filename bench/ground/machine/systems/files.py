"""Whose a file is, how it takes the place of another one, where caches lie, and functions of the C library."""

from __future__ import annotations

import ctypes
import errno
import os
import stat
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

if sys.platform == "win32":
    # What names the folder of this user, and folders of temporary files.
    HOME, TEMPORARY = "USERPROFILE", ("TMPDIR", "TMP", "TEMP")
    # A file that somebody has open keeps its place: an indexer has it for a moment. In seconds.
    _WAITS = (0.01, 0.05, 0.2, 0.5, 1.0)

    def moved_over(partial: Path, path: Path) -> None:
        """Have a file take the place of another one, or of none. Raises OSError."""
        for wait in _WAITS:
            try:
                partial.replace(path)
                return
            except PermissionError:
                time.sleep(wait)
        partial.replace(path)

    def is_closed_pipe(error: OSError) -> bool:
        """Whether nobody reads any more what was written."""
        return error.errno in (errno.EPIPE, errno.EINVAL)

    def user() -> str:
        """What tells the user that this process acts for from others."""
        return os.environ.get("USERNAME", "")

    def is_own(_: os.stat_result) -> bool:
        """Whether a file is this user's. Windows guards a user's folder by lists, not by numbers."""
        return True

    def is_closed(_: os.stat_result) -> bool:
        """Whether a file or folder is this user's, and nobody else may write it; see `is_own`."""
        return True

    def forbids_execution(_: Path) -> bool:
        """Whether nothing is executed from the file system of a folder."""
        return False

    def cache_home() -> Path:
        """The folder that caches of this user lie in."""
        return Path(os.environ.get("LOCALAPPDATA") or Path("~/AppData/Local").expanduser())

else:
    # What names the folder of this user, and folders of temporary files.
    HOME, TEMPORARY = "HOME", ("TMPDIR",)

    def moved_over(partial: Path, path: Path) -> None:
        """Have a file take the place of another one, or of none. Raises OSError."""
        partial.replace(path)

    def is_closed_pipe(error: OSError) -> bool:
        """Whether nobody reads any more what was written."""
        return error.errno == errno.EPIPE

    def user() -> str:
        """What tells the user that this process acts for from others."""
        return str(os.geteuid())

    def is_own(found: os.stat_result) -> bool:
        """Whether a file is this user's."""
        return found.st_uid == os.geteuid()

    def is_closed(found: os.stat_result) -> bool:
        """Whether a file or folder is this user's, and nobody else may write it."""
        return is_own(found) and not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)

    def forbids_execution(folder: Path) -> bool:
        """Whether nothing is executed from the file system of a folder. Raises OSError."""
        return sys.platform == "linux" and bool(os.statvfs(folder).f_flag & os.ST_NOEXEC)

    def cache_home() -> Path:
        """The folder that caches of this user lie in."""
        return Path("~/Library/Caches" if sys.platform == "darwin" else "~/.cache").expanduser()


def c_function(name: str) -> Callable[..., Any] | None:
    """A function of the C library that this process has loaded; None where it has none of this name."""
    library = "ucrtbase" if sys.platform == "win32" else None
    return getattr(ctypes.CDLL(library), name, None)
