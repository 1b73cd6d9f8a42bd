"""How many normals a uniform set has, and how large an image may be. Imports nothing heavy: the command line's defaults
stand here."""

from __future__ import annotations

import re

from .errors import UsageError

DEFAULT_COUNT = 2**22
MAX_COUNT = 2**32


def checked_count(count: int) -> int:
    """The count itself. Raises UsageError where no set has that many."""
    if not 1 <= count <= MAX_COUNT:
        raise UsageError(f"--count {count}: a count is 1 to {MAX_COUNT} (2^32)")
    return count


def checked_sides(text: str, most: int, where: str) -> tuple[int, int]:
    """Width and height of "WxH". Raises UsageError for what is no size, or beyond the most that `where` can do."""
    match = re.fullmatch(r"(\d{1,9})x(\d{1,9})", text.strip().lower())
    if not match or not all(1 <= int(side) <= most for side in match.groups()):
        raise UsageError(f"--size {text}: WIDTHxHEIGHT, such as 640x480, each from 1 to {most} {where}")
    return int(match[1]), int(match[2])
