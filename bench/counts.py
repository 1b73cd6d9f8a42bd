"""How many normals a uniform set has. Imports nothing heavy: the command line's defaults stand here."""

from __future__ import annotations

from .errors import UsageError

DEFAULT_COUNT = 2**22
MAX_COUNT = 2**32


def checked_count(count: int) -> int:
    """The count itself. Raises UsageError where no set has that many."""
    if not 1 <= count <= MAX_COUNT:
        raise UsageError(f"--count {count}: a count is 1 to {MAX_COUNT} (2^32)")
    return count
