"""The programs in an engine's material file: blocks of HLSL that are compiled separately."""

from __future__ import annotations

import re

from .embedded import only
from .source import Source

_BLOCK = re.compile(r"^[ \t]*(?:HLSL|CG)(PROGRAM|INCLUDE)[ \t]*$(.*?)^[ \t]*END(?:HLSL|CG)[ \t]*$", re.M | re.S)
COMMON = "INCLUDE"


def programs_of(source: Source) -> list[Source]:
    """Return a source for each program block in a file, with the block and the common blocks at their original lines.
    If the file has no blocks, return only its own source."""
    matches = list(_BLOCK.finditer(source.text))
    if not matches:
        return [source]
    common = [match for match in matches if match[1] == COMMON]
    alone = [match for match in matches if match[1] != COMMON]
    several = [sorted([*common, match], key=re.Match.start) for match in alone] or [common]
    return [source.with_text(only(source.text, [match.span(2) for match in blocks])) for blocks in several]
