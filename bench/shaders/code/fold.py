"""Lines of code that fit a reader's window: long ones are broken."""

from __future__ import annotations

import re
import textwrap

from ..translator.tokens import in_a_comment

# Columns.
WIDTH = 99
INDENT = 4
OPENING, CLOSING, QUOTES = "([{", ")]}", '"""'
COMMA, OPERATOR = re.compile(r",(?= )"), re.compile(r" (?=(?:[|?:+*/-]|&&|\|\|) )")
BRACKET = re.compile(r"[({](?=\S)")


def folded(text: str, mark: str) -> str:
    """The text with long lines broken; comments begin with `mark`. Where that is Python's, only within brackets."""
    return "".join(f"{one}\n" for line in text.splitlines() for one in _folded_line(line, mark))


def _folded_line(line: str, mark: str) -> list[str]:
    plain = line.lstrip()
    indent = " " * (len(line) - len(plain))
    if len(line) <= WIDTH:
        return [line]
    if plain.startswith((f"{mark} ", QUOTES)):
        again = f"{indent}{mark} " if plain.startswith(mark) else indent
        parts = textwrap.wrap(plain, WIDTH, initial_indent=indent, subsequent_indent=again, break_on_hyphens=False)
        return [*map(in_a_comment, parts)] if plain.startswith(mark) else parts
    if plain.startswith("#") or f"  {mark} " in plain:
        return [line]
    return list(_broken_lines(line, indent + " " * INDENT, least=mark == "#"))


def _broken_lines(line: str, indent: str, least: int) -> list[str]:
    """The lines of one that is broken where at least so many brackets are open."""
    found: list[str] = []
    depth = 0
    while len(line) > WIDTH and (at := _best_break(line, depth, least)):
        found.append(line[:at].rstrip())
        depth += _opened(line[:at])
        line = indent + line[at:].lstrip()
    return [*found, line]


def _opened(text: str) -> int:
    return sum((letter in OPENING) - (letter in CLOSING) for letter in text)


def _best_break(line: str, depth: int, least: int) -> int:
    """Where a line is broken, behind a comma, before an operator or else behind a bracket: within as few
    brackets as there can be, and as late there; 0 where it cannot be."""
    begin = len(line) - len(line.lstrip())
    for pattern in (COMMA, OPERATOR, BRACKET):
        places = [one.end() for one in pattern.finditer(line[: WIDTH + 1], begin) if one.end() <= WIDTH]
        open_at = {at: depth + _opened(line[:at]) for at in places}
        inside = [at for at in places if open_at[at] >= max(least, pattern is COMMA)]
        if inside:
            return min(inside, key=lambda at: (open_at[at], -at))
    return 0
