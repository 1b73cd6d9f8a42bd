"""Where the process begins. An interruption while the program is imported ends it at once and says nothing."""

from __future__ import annotations

import signal
from typing import NoReturn


def program() -> NoReturn:
    """The command line as a process of its own."""
    # Python's way is an exception, which in the midst of an import is a traceback, or the end of a library in C++.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    from .app import program as run

    run()
