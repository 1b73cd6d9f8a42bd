"""Preparation of the user's environment, before anything else is used. Imports nothing heavy."""

from __future__ import annotations

import os
import stat
import tempfile
from pathlib import Path

from .systems.files import HOME, is_closed, user


def prepare() -> None:
    """Set a home folder if the system does not know the user's; called before anything else is used."""
    try:
        Path.home()
    except RuntimeError:
        # An unknown user id, as containers have it. Caches and settings of libraries lie in the home folder.
        os.environ[HOME] = str(_home_for_the_unknown())


def _home_for_the_unknown() -> Path:
    """Return a folder that only this user can have written to; if that fails, a new folder for each process."""
    from ..output.cache import PRIVATE

    home = Path(tempfile.gettempdir()) / f"normalbench-home-{user()}"
    try:
        home.mkdir(PRIVATE, exist_ok=True)
        status = home.lstat()
    except OSError:
        return Path(tempfile.mkdtemp(prefix="normalbench-home-"))
    return (
        home
        if stat.S_ISDIR(status.st_mode) and is_closed(status)
        else Path(tempfile.mkdtemp(prefix="normalbench-home-"))
    )
