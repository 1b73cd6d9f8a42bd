"""Locks, so that only one process at a time writes a file."""

from __future__ import annotations

import sys
from contextlib import suppress
from io import FileIO
from pathlib import Path

from .files import moved_over

if sys.platform == "win32":
    import msvcrt
    import os

    # Windows keeps others from reading what is locked as well: one byte that no file reaches.
    _FAR = 0x7FFF_0000

    def lock(file: FileIO) -> None:
        """Lock a file until it is closed or this process ends, without waiting for the lock.

        Raises:
            OSError: another process has locked the file, or the file system has no locks.
        """
        place = file.tell()
        file.seek(_FAR)
        try:
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        finally:
            file.seek(place, os.SEEK_SET)

    def put_in_place(path: Path, old: FileIO, partial: Path, new: FileIO) -> FileIO:
        """Replace a file by another locked file. Return the file that is open and locked afterwards.

        A file cannot be replaced while it is open or locked, so that another process may lock it for a moment.

        Raises:
            OSError: the file cannot be replaced, or another process was faster. Both files are closed.
        """
        new.close()
        old.close()
        moved_over(partial, path)
        new = path.open("r+b", buffering=0)
        lock(new)
        return new

    def remove(path: Path, file: FileIO) -> None:
        """Close a file that is open and locked, and delete it, unless another process has opened it by then."""
        file.close()
        with suppress(PermissionError):
            path.unlink(missing_ok=True)

else:
    import fcntl

    def lock(file: FileIO) -> None:
        """Lock a file until it is closed or this process ends, without waiting for the lock.

        Raises:
            OSError: another process has locked the file, or the file system has no locks.
        """
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def put_in_place(path: Path, old: FileIO, partial: Path, new: FileIO) -> FileIO:
        """Replace a file by another locked file. Return the file that is open and locked afterwards.

        Raises:
            OSError: the file cannot be replaced.
        """
        moved_over(partial, path)
        old.close()
        return new

    def remove(path: Path, file: FileIO) -> None:
        """Delete a file that is open and locked, and close it. Raises OSError."""
        path.unlink(missing_ok=True)
        file.close()
