"""Which systems the program runs on. Imports nothing that one of them lacks."""

from __future__ import annotations

import sys

from ..output.errors import MissingError

WINDOWS = (
    "Windows is not supported yet; install normalbench in WSL2 (`wsl --install` sets that up). "
    "The laboratory of a report.html runs in any browser on any system"
)
UNSUPPORTED = {"win32": WINDOWS, "cygwin": WINDOWS}


def require_supported_system() -> None:
    """Raises MissingError on a system that the program does not run on yet."""
    if sys.platform in UNSUPPORTED:
        raise MissingError(UNSUPPORTED[sys.platform])
