"""Shaders embedded in other files: GLSL in JavaScript strings, and the blocks of Stride's shader classes."""

from __future__ import annotations

import re

from ...ground.compilers.lines import blank, without_comments

SCRIPTS = (".js", ".mjs", ".ts")
# `...` behind /* glsl */, and one that is all of a file.
_MARKED = re.compile(r"/\*\s*glsl\s*\*/\s*`([^`]*)`", re.I)
_BEFORE = r"\s*(?:export\s+default|(?:export\s+)?(?:const|let|var)\s+\w+\s*=)\s*"
_WHOLE = re.compile(_BEFORE + r"`([^`]*)`\s*;?\s*(?:export[^`]*)?")
_CLASS = re.compile(r"^[ \t]*(?:(?:public|internal|partial|abstract)\s+)*shader\s+\w+[^{};]*\{", re.M)
# What Stride's functions have in front, and other languages do not.
_OF_STRIDE = re.compile(r"^([ \t]*)((?:(?:override|abstract|stage|clone|static)\s+)+)", re.M)


def shader_text(text: str, ending: str) -> str:
    """Return the shader in a file's text, at its original lines. For file types that embed no shaders, return the
    text unchanged.

    Args:
        ending: the file's extension, in lower case.
    """
    if ending in SCRIPTS:
        whole = _WHOLE.fullmatch(without_comments(text))
        return only(text, [match.span(1) for match in ([whole] if whole else _MARKED.finditer(text))])
    if ending == ".sdsl" and (blocks := [_block(text, match.end()) for match in _CLASS.finditer(text)]):
        return _OF_STRIDE.sub(lambda match: match[1] + blank(match[2]), only(text, blocks))
    return text


def _block(text: str, start: int) -> tuple[int, int]:
    """Return (start, end) of the text inside braces, where `start` is the index after the opening brace."""
    depth, bare = 1, without_comments(text)
    for mark in re.finditer(r"[{}]", bare[start:]):
        depth += 1 if mark[0] == "{" else -1
        if not depth:
            return start, start + mark.start()
    return start, len(text)


def only(text: str, spans: list[tuple[int, int]]) -> str:
    """Return a text with everything outside the spans blanked; line numbers do not change. A span is (start, end)."""
    parts, last = [], 0
    for start, end in spans:
        parts += [blank(text[last:start]), text[start:end]]
        last = end
    return "".join([*parts, blank(text[last:])])
