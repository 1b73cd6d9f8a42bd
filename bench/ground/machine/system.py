"""Which systems the program runs on, and what it needs of a user there. Imports nothing that one of them lacks."""

from __future__ import annotations

import os
import stat
import sys
import tempfile
from pathlib import Path

from ..output.errors import MissingError

WINDOWS = (
    "Windows is not supported yet; install normalbench in WSL2 (`wsl --install` sets that up). "
    "The laboratory of a report.html runs in any browser on any system"
)
UNSUPPORTED = {"win32": WINDOWS, "cygwin": WINDOWS}


def prepare() -> None:
    """Before anything else is used.

    Raises:
        MissingError: a system that the program does not run on yet.
    """
    if sys.platform in UNSUPPORTED:
        raise MissingError(UNSUPPORTED[sys.platform])
    try:
        Path.home()
    except RuntimeError:
        # An unknown user id, as containers have it. Caches and settings of libraries lie in the home folder.
        os.environ["HOME"] = str(_home_for_the_unknown())


def _home_for_the_unknown() -> Path:
    """A folder that this user alone can have written into; another one for each process where there is none."""
    from ..output.cache import PRIVATE, is_closed
    from .posix.processes import owner

    home = Path(tempfile.gettempdir()) / f"normalbench-home-{owner()}"
    try:
        home.mkdir(PRIVATE, exist_ok=True)
        found = home.lstat()
    except OSError:
        return Path(tempfile.mkdtemp(prefix="normalbench-home-"))
    return (
        home if stat.S_ISDIR(found.st_mode) and is_closed(found) else Path(tempfile.mkdtemp(prefix="normalbench-home-"))
    )
