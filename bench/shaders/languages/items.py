"""The top-level items of a text in a C-like language, in order: functions, structures and globals.

Only braces and semicolons are understood; the rest is left to the compiler. A namespace is not an item, but its
contents are.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from typing import NamedTuple

from ...ground.compilers.lines import blank

# What is in quotes may have braces.
_QUOTED = re.compile(r"\"[^\"\n]*\"|'[^'\n]*'")
# What belongs to a function that stands behind it.
_ATTRIBUTE = re.compile(r"[\]>]\s*$")
_DIRECTIVE = re.compile(r"^[ \t]*#.*$", re.M)
# NAME(...) at the end of what stands before a body, with a semantic or not; `cbuffer NAME : register(b0)` is none.
_NAME = re.compile(r"\b(?!register\b)([A-Za-z_]\w*)\s*\((?:[^()]|\([^()]*\))*\)\s*(?::\s*\w+\s*|->\s*[\w<>]+\s*)?$")
_SPACE, _STRUCTURE = re.compile(r"\bnamespace\s+([\w:]+)\s*$"), re.compile(r"\bstruct\s+(\w+)\s*\{(.*)\}[^{}]*$", re.S)
_WORD, _PASTED = re.compile(r"\w+"), re.compile(r"(\w*)\s*##\s*(\w*)")


class Item(NamedTuple):
    """An item.

    Attributes:
        start: the index of its start.
        end: the index of its end.
        function: the name of the function that the item defines, as NAME or SPACE::NAME; empty if it defines none.
        body: the index of the function's opening brace; `end` if the item defines no function.
    """

    start: int
    end: int
    function: str
    body: int

    @property
    def name(self) -> str:
        """The name of the item's function without the namespace."""
        return self.function.rpartition("::")[2]


def items(text: str) -> list[Item]:
    """Return the items of a text without comments, in order. Together with the braces of namespaces, the items cover
    the whole text without gaps."""
    parts: list[Item] = []
    spaces: list[str] = []
    bare = _QUOTED.sub(lambda match: blank(match[0]), _without_directives(text))
    depth = start = body = 0
    for match in re.finditer(r"[{};]", bare):
        mark, end = match[0], match.end()
        if mark == "{" and not depth and (space := _SPACE.search(bare, start, match.start())):
            spaces.append(f"{space[1]}::")
            start = end
        elif mark == "{":
            body = body if depth else match.start()
            depth += 1
        elif mark == "}" and not depth:
            start = end
            del spaces[-1:]
        else:
            depth -= mark == "}"
            if not depth:
                parts += _items(bare, start, end, body if mark == "}" else end, "".join(spaces))
                start = end
    return [*parts, Item(start, len(text), "", len(text))]


def _items(bare: str, start: int, end: int, body: int, space: str) -> list[Item]:
    """Return the items from `start` to `end`: one item, or a function and, before it, lines such as a macro."""
    match = _NAME.search(bare[start:body].rstrip()) if body < end else None
    if not match:
        return [Item(start, end, "", end)]
    line = bare.rfind("\n", start, start + match.start()) + 1
    has_type = bool(bare[line : start + match.start()].strip())
    before = bare[start:line]
    if line <= start or not has_type or not before.strip() or _ATTRIBUTE.search(before):
        return [Item(start, end, space + match[1], body)]
    return [Item(start, line, "", line), Item(line, end, space + match[1], body)]


def functions_in(text: str) -> list[str]:
    """Return the distinct names of the functions that a text defines; SPACE::NAME in a namespace or structure."""
    return list(dict.fromkeys(_functions_in(text, "")))


def _functions_in(text: str, space: str) -> Iterator[str]:
    for item in items(text):
        if item.function:
            yield space + item.function
        elif match := _STRUCTURE.search(_without_directives(text[item.start : item.end])):
            yield from _functions_in(match[2], f"{space}{match[1]}::")


def words_of(text: str) -> set[str]:
    """Return the set of words in a text, except in function heads."""
    bodies = _rewritten(text, ((item.start, item.body, "") for item in items(text) if item.function))
    return set(_WORD.findall(bodies))


def defined_in(text: str) -> Iterator[str]:
    """Yield the names that a text defines at its top level: functions, types, globals, namespaces."""
    for item in items(text):
        head = re.split(r"[{=(:;[]", _without_directives(text[item.start : item.end]), maxsplit=1)[0]
        yield from (match[1] for part in head.split(",") if (match := re.search(r"(\w+)\s*$", part)))


def heads(text: str) -> str:
    """Return a text with each function's body replaced by a semicolon; line numbers do not change."""
    return _rewritten(text, ((item.body, item.end, ";") for item in items(text) if item.function))


def marked_heads(text: str, mark: str) -> str:
    """Return a text as `heads` does, with a mark before each function name, so that no name clashes with the
    language's own names."""
    functions = [item for item in items(text) if item.function]
    names = (re.search(rf"\b{item.name}\s*\(", text[item.start : item.body]) for item in functions)
    places = (item.start + name.start() for item, name in zip(functions, names, strict=True) if name)
    bodies = ((item.body, item.end, ";") for item in functions)
    return _rewritten(text, [*((place, place, mark) for place in places), *bodies])


def without(text: str, some: Iterable[Item]) -> str:
    """Return a text with some of its items blanked, except directives in them; line numbers do not change."""
    return _rewritten(text, ((item.start, item.end, "") for item in some))


def reached(text: str, names: Collection[str]) -> str:
    """Return a text with only the functions that are needed for these names or for the text outside functions."""
    every = items(text)
    words = set(_WORD.findall(" ".join(_DIRECTIVE.findall(text))))
    words |= {name.rpartition("::")[2] for name in names}
    words |= {word for item in every if not item.function for word in _WORD.findall(text[item.start : item.end])}
    parts = {part for pair in _PASTED.findall(text) for part in pair if part}
    left = [item for item in every if item.function]
    while now := {item for item in left if item.name in words or _may_be_pasted(item.name, parts)}:
        words |= {word for item in now for word in _WORD.findall(text[item.body : item.end])}
        left = [item for item in left if item not in now]
    return without(text, left)


def _may_be_pasted(name: str, parts: Collection[str]) -> bool:
    """Whether a name begins or ends with any of these parts, so that a macro may have pasted it together."""
    return any(name.startswith(part) or name.endswith(part) for part in parts)


def _rewritten(text: str, parts: Iterable[tuple[int, int, str]]) -> str:
    """Return a text with some of its parts replaced by words and padded with blanks. A part is (start, end, words),
    and parts do not overlap."""
    pieces, last = [], 0
    for start, end, words in sorted(parts):
        pieces += [text[last:start], words, blanked(text[start:end])[len(words) :]]
        last = end
    return "".join([*pieces, text[last:]])


def blanked(text: str) -> str:
    """Return a text with everything blanked except its preprocessor directives; line numbers do not change."""
    kept: Iterator[str] = iter(_DIRECTIVE.findall(text))
    parts = _DIRECTIVE.split(text)
    return "".join(blank(part) + next(kept, "") for part in parts)


def _without_directives(text: str) -> str:
    """Return a text with its preprocessor directives blanked; line numbers do not change."""
    return _DIRECTIVE.sub(lambda match: blank(match[0]), text)
