"""Ownership and replacement of files, cache folders, and functions of the C library."""

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
        """Move a file to a path, in place of any file there. Retry for a while if the file there is in use. Raises
        OSError."""
        for wait in _WAITS:
            try:
                partial.replace(path)
                return
            except PermissionError:
                time.sleep(wait)
        partial.replace(path)

    def is_closed_pipe(error: OSError) -> bool:
        """Whether an error means that nobody reads from a pipe any more."""
        return error.errno in (errno.EPIPE, errno.EINVAL)

    def user() -> str:
        """Return this user's name; empty if the system does not give one."""
        return os.environ.get("USERNAME", "")

    def is_own(_: os.stat_result) -> bool:
        """Whether a file belongs to this user: always True. Windows protects a user's folder by access lists, not by
        user ids."""
        return True

    def is_closed(_: os.stat_result) -> bool:
        """Whether a file or folder belongs to this user, and nobody else may write to it: always True, see
        `is_own`."""
        return True

    def is_guarded(_: Path) -> bool:
        """Whether nobody else can put another file at a path: always True, see `is_own`."""
        return True

    def forbids_execution(_: Path) -> bool:
        """Whether the file system of a folder forbids execution: always False on Windows."""
        return False

    def cache_home() -> Path:
        """Return the folder for this user's caches."""
        return Path(os.environ.get("LOCALAPPDATA") or Path("~/AppData/Local").expanduser())

else:
    import functools
    import grp
    import pwd

    # What names the folder of this user, and folders of temporary files.
    HOME, TEMPORARY = "HOME", ("TMPDIR",)

    def moved_over(partial: Path, path: Path) -> None:
        """Move a file to a path, in place of any file there. Raises OSError."""
        partial.replace(path)

    def is_closed_pipe(error: OSError) -> bool:
        """Whether an error means that nobody reads from a pipe any more."""
        return error.errno == errno.EPIPE

    def user() -> str:
        """Return the effective user id of this process as text."""
        return str(os.geteuid())

    def is_own(status: os.stat_result) -> bool:
        """Whether a file is this user's."""
        return status.st_uid == os.geteuid()

    def is_closed(status: os.stat_result) -> bool:
        """Whether a file or folder belongs to this user, and nobody else may write to it."""
        return is_own(status) and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)

    def is_guarded(path: Path) -> bool:
        """Whether only this user and root can put a different file at a path without links: every existing part of
        the path belongs to one of them, and nobody else may write to its folders, except to sticky folders such as
        /tmp. Raises OSError.

        Write permission of a group counts, except for this user's own group without other members, which some systems
        give each user together with folders that the group may write to. Access lists by which the user admitted
        others do not count.
        """
        return all(_is_kept_by_its_owner(place.lstat()) for place in (path, *path.parents) if os.path.lexists(place))

    def _is_kept_by_its_owner(status: os.stat_result) -> bool:
        if status.st_uid not in (0, os.geteuid()) or stat.S_ISLNK(status.st_mode):
            return False
        if stat.S_ISDIR(status.st_mode) and status.st_mode & stat.S_ISVTX:
            return True
        is_closed_to_groups = not status.st_mode & stat.S_IWGRP or _is_of_this_user_alone(status.st_gid)
        return is_closed_to_groups and not status.st_mode & stat.S_IWOTH

    @functools.cache
    def _is_of_this_user_alone(group: int) -> bool:
        """Whether a group has this user's name, is the primary group of this user and of nobody else, and lists no
        other member."""
        try:
            person, group_entry = pwd.getpwuid(os.geteuid()), grp.getgrgid(group)
        except KeyError:
            return False
        if person.pw_gid != group or group_entry.gr_name != person.pw_name:
            return False
        members = {other.pw_name for other in pwd.getpwall() if other.pw_gid == group} | {*group_entry.gr_mem}
        return members <= {person.pw_name}

    def forbids_execution(folder: Path) -> bool:
        """Whether the file system of a folder forbids execution; False except on Linux. Raises OSError."""
        return sys.platform == "linux" and bool(os.statvfs(folder).f_flag & os.ST_NOEXEC)

    def cache_home() -> Path:
        """Return the folder for this user's caches."""
        return Path("~/Library/Caches" if sys.platform == "darwin" else "~/.cache").expanduser()


def c_function(name: str) -> Callable[..., Any] | None:
    """Return a function of the C library that this process has loaded; None if the library has no such function."""
    library = "ucrtbase" if sys.platform == "win32" else None
    return getattr(ctypes.CDLL(library), name, None)


def state_of(path: Path) -> list[int] | None:
    """Return the size of a file or folder in bytes and its modification time in nanoseconds; None if it is gone."""
    try:
        status = path.stat()
    except OSError:
        return None
    return [status.st_size, status.st_mtime_ns]
