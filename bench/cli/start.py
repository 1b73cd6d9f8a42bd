"""Where the process begins. An interruption while the program is imported ends it at once and says nothing."""

from __future__ import annotations

import os
import signal
from typing import NoReturn


def program() -> NoReturn:
    """The command line as a process of its own."""
    # OpenBLAS waits for work in a loop that takes a whole core. What is multiplied here is small: 3 x 3 by many.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Python's way is an exception, which in the midst of an import is a traceback, or the end of a library in C++.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    from ..machine.memory import look_for_garbage_seldom

    look_for_garbage_seldom()
    from .app import program as run

    run()
