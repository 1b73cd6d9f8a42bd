"""Processes for code that may do anything. On Linux they are forked from one that has imported what they need; to fork
is not safe on macOS, and Windows does not: there each process imports for itself."""

from __future__ import annotations

import subprocess
import sys

from .. import children

if sys.platform == "linux":
    from .linux_forks import finished, stop
else:

    def finished(module: str, words: list[str], seconds: float) -> subprocess.CompletedProcess[str]:
        """As `children.finished` of `children.python`: what `main(words)` of a module of this program printed, and how
        its process ended.

        Raises:
            TimeoutExpired: it took longer; it has what was printed until then.
        """
        return children.finished(children.python(module, *words), seconds)

    stop = children.stop


__all__ = ["finished", "stop"]
