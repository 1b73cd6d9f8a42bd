"""Files that one process at a time may write."""

from __future__ import annotations

import fcntl
from io import FileIO


def lock(file: FileIO) -> None:
    """Keep others from locking a file, until it is closed or this process ends.

    Raises:
        OSError: another process has locked it, or the file system has no locks.
    """
    fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
