"""Preparation of shader text for checks and compilers: joins lines and removes comments and unknown directives."""

from __future__ import annotations

import re

# Lines that go on in the next one, also behind spaces: some compilers join those.
_JOINED, _JOIN = re.compile(r"^(?:[^\n]*\\[^\S\n]*(?:\n|\Z))+(?:[^\n]*)", re.M), re.compile(r"\\[^\S\n]*(?:\n|\Z)")
# A comment without an end goes to the end of the text: each letter is looked at once. A long one takes no memory.
_COMMENT = re.compile(r'"[^"\n]*"|//[^\n]*|/\*.*?(?:\*/|\Z)', re.S)
# WGSL has no strings, comments in comments, and further ends of lines.
_OF_WGSL, _NESTED = re.compile(r"//[^\n\v\f\x85\u2028\u2029]*|/\*"), re.compile(r"/\*|\*/")
# What compilers skip as they skip a space, and whoever reads line by line may take for an end.
_FEEDS = re.compile(r"[\v\f\x1c-\x1f\x85\u2028\u2029\u00a0]")
DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(\w*)(.*)$", re.M)
# What a preprocessor may be told, in every language.
KNOWN = frozenset(["define", "undef", "if", "ifdef", "ifndef", "elif", "else", "endif", "error", "warning"])
# What says nothing of the functions of a file.
_LEFT_OUT = frozenset(["line", "pragma", "version", "extension"])


def joined(text: str) -> str:
    """Return a text with continued lines joined and followed by empty lines, so that the other lines keep their
    numbers."""
    return _JOINED.sub(lambda match: _JOIN.sub("", match[0]) + "\n" * match[0].count("\n"), text)


def blank(text: str) -> str:
    """Return a text with spaces in place of all characters except line feeds."""
    return "\n".join(" " * len(line) for line in text.split("\n"))


def without_comments(text: str) -> str:
    """Return a text with spaces in place of comments and unusual whitespace. The rest keeps its lines and columns.

    An unterminated comment is unchanged.
    """
    return _COMMENT.sub(_blank, _FEEDS.sub(" ", text))


def bare(text: str, is_wgsl: bool = False) -> str:
    """Return a text as compilers receive it: without comments and, except in WGSL, with continued lines joined."""
    return _without_nested_comments(text) if is_wgsl else without_comments(joined(text))


def _without_nested_comments(text: str) -> str:
    """Return a WGSL text without comments, like `without_comments`; comments in WGSL can be nested."""
    pieces, place = [], 0
    while (match := _OF_WGSL.search(text, place)) and (end := _end_of_comment(text, match)):
        pieces += [text[place : match.start()], blank(text[match.start() : end])]
        place = end
    return _FEEDS.sub(" ", "".join([*pieces, text[place:]]))


def _end_of_comment(text: str, match: re.Match[str]) -> int:
    """Return the index after the WGSL comment that a match begins; 0 if the comment does not end."""
    depth = 1
    for mark in _NESTED.finditer(text, match.end()) if match[0] == "/*" else ():
        depth += 1 if mark[0] == "/*" else -1
        if not depth:
            return mark.end()
    return 0 if match[0] == "/*" else match.end()


def _blank(match: re.Match[str]) -> str:
    if match[0].startswith('"'):
        # What a string says is no matter to any function; a compiler that sees no string there sees no comment either.
        return re.sub(r"//|/\*|\*/", "  ", match[0])
    is_whole = match[0].startswith("//") or (len(match[0]) > 3 and match[0].endswith("*/"))
    return blank(match[0]) if is_whole else match[0]


def with_known_directives(text: str, kept: re.Pattern[str] | None = None) -> str:
    """Return a text without #line, #pragma, #version and #extension. Replace any other unknown directive by an
    #error, which is harmless in a branch that is not compiled.

    Args:
        text: whole lines without comments.
        kept: a pattern for lines that stay unchanged.
    """

    def known(match: re.Match[str]) -> str:
        name = match[1]
        if name in KNOWN or (kept and kept.fullmatch(match[0].strip())):
            return match[0]
        return "" if name in _LEFT_OUT or not match[0].strip("# \t") else f"#error #{name} is not supported"

    return DIRECTIVE.sub(known, text)
