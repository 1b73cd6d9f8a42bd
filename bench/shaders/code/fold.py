"""Breaking of long lines of code, so that they fit a reader's window."""

from __future__ import annotations

import re
import textwrap

from ..translator.tokens import in_a_comment

# Columns.
WIDTH = 99
INDENT = 4
OPENING, CLOSING = "([{", ")]}"
MARK = "//"
COMMA, OPERATOR = re.compile(r",(?= )"), re.compile(r" (?=(?:[|?:+*/-]|&&|\|\|) )")
BRACKET = re.compile(r"[({](?=\S)")


def folded(text: str) -> str:
    """Return the text with lines longer than WIDTH columns broken where possible. Directives and lines that end with
    a comment are not changed."""
    return "".join(f"{part}\n" for line in text.splitlines() for part in _folded_line(line))


def _folded_line(line: str) -> list[str]:
    plain = line.lstrip()
    indent = " " * (len(line) - len(plain))
    if len(line) <= WIDTH:
        return [line]
    if plain.startswith(f"{MARK} "):
        again = f"{indent}{MARK} "
        parts = textwrap.wrap(plain, WIDTH, initial_indent=indent, subsequent_indent=again, break_on_hyphens=False)
        return [*map(in_a_comment, parts)]
    if plain.startswith("#") or f"  {MARK} " in plain:
        return [line]
    return list(_broken_lines(line, indent + " " * INDENT))


def _broken_lines(line: str, indent: str) -> list[str]:
    """Return the parts of a line that is too long: the first part with the line's own indentation, the others with
    `indent`. A part that cannot be broken stays long."""
    parts: list[str] = []
    depth = 0
    while len(line) > WIDTH and (place := _best_break(line, depth)):
        parts.append(line[:place].rstrip())
        depth += _opened(line[:place])
        line = indent + line[place:].lstrip()
    return [*parts, line]


def _opened(text: str) -> int:
    return sum((letter in OPENING) - (letter in CLOSING) for letter in text)


def _best_break(line: str, depth: int) -> int:
    """Return the index at which to break a line: after a comma, else before an operator, else after a bracket, within
    as few brackets as possible, and then as late as possible; 0 if the line cannot be broken."""
    begin = len(line) - len(line.lstrip())
    for pattern in (COMMA, OPERATOR, BRACKET):
        places = [match.end() for match in pattern.finditer(line[: WIDTH + 1], begin) if match.end() <= WIDTH]
        open_at = {place: depth + _opened(line[:place]) for place in places}
        inside = [place for place in places if open_at[place] >= (pattern is COMMA)]
        if inside:
            return min(inside, key=lambda end: (open_at[end], -end))
    return 0
