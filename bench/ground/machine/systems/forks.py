"""Processes for untrusted code. On Linux they are forked from a process that has already imported the modules they
need. Forking is not safe on macOS and does not exist on Windows; there each process imports the modules itself."""

from __future__ import annotations

import subprocess
import sys

from .. import children

if sys.platform == "linux":
    from .linux_forks import finished, stop
else:

    def finished(module: str, words: list[str], seconds: float) -> subprocess.CompletedProcess[str]:
        """Run `main(words)` of a module of this program in a process, and return its output and status.

        Raises:
            TimeoutExpired: the process took longer; the error has the output until then.
        """
        return children.finished(children.python(module, *words), seconds)

    stop = children.stop


__all__ = ["finished", "stop"]
