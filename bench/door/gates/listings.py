"""Differences between two instruction listings, line by line."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher

# A reader of a message has no use for more.
MOST_LINES = 40
# Which register holds a number, and where a jump goes to, is no difference: v3, s[2:5], g17.1, R8, BRA 0x230.
_PLACE = re.compile(r"\b(v|s|g|r|R|UR|P|UP)(?:\d+(?:\.\d+)?|\[\d+(?::\d+)?\])|(?<=BRA )0x[0-9a-f]+")
# The address of an instruction before its text, as NVIDIA's listings have it.
_ADDRESS = re.compile(r"^\s*/\*[0-9a-f]{4,}\*/\s*")
# The bytes of an instruction, behind its text.
_BYTES = re.compile(r"\s*;?\s*/\*\s*0x[0-9a-f]+\s*\*/\s*$|\s*;[\s0-9a-f]*$")
# What fills the space behind a kernel's end.
_PADDING = "NOP"


def lines_of(listing: str) -> list[str]:
    """Return the instructions and labels of a listing as lines that a baseline keeps, without comments, addresses,
    bytes and blank lines."""
    lines = (" ".join(_ADDRESS.sub("", _BYTES.sub("", line)).split()) for line in listing.splitlines())
    return [line for line in lines if line and line != _PADDING and not line.startswith((";", "//", "#"))]


def differences(before: Sequence[str], after: Sequence[str]) -> Iterator[str]:
    """Yield the added lines, marked +, and the removed lines, marked -. After MOST_LINES lines, yield only a
    count."""
    lines = list(_changed(before, after))
    yield from lines[:MOST_LINES]
    if len(lines) > MOST_LINES:
        yield f"... and {len(lines) - MOST_LINES} more lines"


def _changed(before: Sequence[str], after: Sequence[str]) -> Iterator[str]:
    plain = [[_PLACE.sub(r"\1", line) for line in lines] for lines in (before, after)]
    for what, a, b, c, d in SequenceMatcher(None, *plain, autojunk=False).get_opcodes():
        if what != "equal":
            yield from (f"- {line}" for line in before[a:b])
            yield from (f"+ {line}" for line in after[c:d])
