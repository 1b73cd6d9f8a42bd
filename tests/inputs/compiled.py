"""Where what compilers make is kept for all tests, their processes, the next run and other checkouts."""

import os
from pathlib import Path

COMPILED = Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "normalbench-tests"
