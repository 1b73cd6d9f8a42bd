"""Where the process begins. An interruption while the program is imported ends it at once and says nothing."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from typing import NoReturn


def program() -> NoReturn:
    """The command line as a process of its own."""
    open_missing_streams()
    # Python's way is an exception, which in the midst of an import is a traceback, or the end of a library in C++.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    from ...ground.machine.system import prepare

    prepare()
    # OpenBLAS waits for work in a loop that takes a whole core. What is multiplied here is small: 3 x 3 by many.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Mesa says on standard error that it cannot make its folder, in GL and in Vulkan; it does without one anyway.
    chosen = os.environ.get("MESA_SHADER_CACHE_DIR") or os.environ.get("XDG_CACHE_HOME")
    if not _takes_files(Path(chosen or Path(os.environ.get("HOME", ""), ".cache"))):
        os.environ.setdefault("MESA_SHADER_CACHE_DISABLE", "true")
    from ...ground.machine.memory import look_for_garbage_seldom

    look_for_garbage_seldom()
    from .app import program as run

    run()


def open_missing_streams() -> None:
    """Open what goes nowhere in place of standard streams that are closed, for child processes too: the next file
    would take their numbers. Python prints what is for a closed standard error to standard output."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            # It takes the lowest number that is free.
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)
    sys.stderr = sys.stderr or Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 # until the process ends


def _takes_files(folder: Path) -> bool:
    """Whether files can be made in a folder, or the folder itself where it is not there."""
    try:
        there = next(path for path in (folder.absolute(), *folder.absolute().parents) if os.path.lexists(path))
    except OSError:  # the working folder is gone
        return False
    # Path.is_dir raises where a link leads to what may not be looked at.
    return os.path.isdir(there) and os.access(there, os.W_OK)  # noqa: PTH112
