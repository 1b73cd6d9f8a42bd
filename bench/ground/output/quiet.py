"""Suppression of unwanted output from C libraries."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..machine.systems.files import c_function


@contextmanager
def without_their_output() -> Iterator[None]:
    """Discard the output of C code to standard output within the context. Earlier output from Python is flushed
    first."""
    sys.stdout.flush()
    kept = os.dup(1)
    try:
        with Path(os.devnull).open("w", encoding="utf-8") as nowhere:
            os.dup2(nowhere.fileno(), 1)
            yield
            # C keeps lines until later where standard output is a file.
            if flush := c_function("fflush"):
                flush(None)
    finally:
        os.dup2(kept, 1)
        os.close(kept)
