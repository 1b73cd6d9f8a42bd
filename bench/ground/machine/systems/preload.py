"""Libraries that a process loads before all others."""

from __future__ import annotations

import os
from pathlib import Path

# What the loader of libraries reads of a process's variables.
LOADERS_VARIABLES = "LD_"
PRELOAD = "LD_PRELOAD"


def preloaded(path: Path) -> dict[str, str]:
    """Return the environment variables that make a process load a library before the libraries preloaded here, by
    name."""
    others = filter(None, [os.environ.get(PRELOAD, "")])
    return {PRELOAD: os.pathsep.join([str(path), *others])}
