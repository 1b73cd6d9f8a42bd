"""Whose a file is, where caches lie, and functions of the C library that this process has loaded."""

from __future__ import annotations

import ctypes
import os
import stat
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

if sys.platform == "win32":

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
