"""A user's file with what it includes, and where each of its lines stands."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ....encodings.codecs.files import MOST_TEXT, file_text
from ...ground.output.errors import UsageError

# One that has no end goes to the end of the text, so that every letter is looked at once.
_COMMENT = re.compile(r'"[^"\n]*"|//[^\n]*|/\*.*?(?:\*/|\Z)', re.S)
_INCLUDE = re.compile(r'[ \t]*#[ \t]*include[ \t]+(?:"([^"]+)"|<([^>]+)>)[ \t]*')
# Directives with lines that go on joined, and comments gone.
_ANY_INCLUDE = re.compile(r"^[ \t]*#[ \t]*include\b", re.M)


class Line(NamedTuple):
    """A line of a program: its text, where it was written, and what is wrong with it if that is known."""

    text: str
    path: Path
    number: int
    wrong: str = ""


def without_comments(text: str) -> str:
    """A text with blanks for its comments; every line and every column stays where it is.

    A comment without an end stays as it is.
    """
    return _COMMENT.sub(_blank, text)


def _blank(match: re.Match[str]) -> str:
    is_whole = match[0].startswith("//") or (len(match[0]) > 3 and match[0].endswith("*/"))
    return re.sub(r"[^\n]", " ", match[0]) if is_whole else match[0]


class Source:
    """A file and what it includes, each file once: from its own folder and the folders below, and from nowhere else.

    An include of a file that is elsewhere, or not there, becomes an #error: in a branch that is left out it does no
    harm.

    Raises:
        UsageError: a file cannot be read, they are too large together, or they include each other too deep.
    """

    def __init__(self, path: Path):
        self.path = path
        self.files: dict[Path, Path] = {}
        self._root, self._left = path.absolute().parent.resolve(), MOST_TEXT
        try:
            self.lines = list(self._expanded(path))
        except RecursionError:
            raise UsageError(f"{path}: its #includes are nested too deep") from None
        self.text = "".join(f"{line.text}\n" for line in self.lines)

    def _expanded(self, path: Path) -> Iterator[Line]:
        text = self._read(path)
        bare = without_comments(text)
        if "/*" in bare:
            line = bare.count("\n", 0, bare.index("/*")) + 1
            raise UsageError(f"{path}:{line}: a comment that begins with /* is not closed")
        lines = bare.split("\n")
        found = [_INCLUDE.fullmatch(line) for line in lines]
        if len(_ANY_INCLUDE.findall(bare.replace("\\\n", ""))) != sum(map(bool, found)):
            raise UsageError(f'{path}: an #include is written as #include "FILE", in one line')
        for number, (line, match) in enumerate(zip(lines, found, strict=True), 1):
            if match:
                yield from self._included(path, number, match[1] or match[2])
            else:
                yield Line(line.rstrip(), path, number)

    def _read(self, path: Path) -> str:
        self.files[path.absolute().resolve()] = path
        try:
            text = file_text(path)
        except (OSError, ValueError) as error:
            raise UsageError(f"{path}: {error}") from error
        self._left -= len(text)
        if self._left < 0:
            raise UsageError(f"{self.path}: with what it includes it is larger than {MOST_TEXT >> 20} MiB")
        return text

    def _included(self, path: Path, number: int, name: str) -> Iterator[Line]:
        targets = [folder / name for folder in dict.fromkeys((path.parent, self.path.parent))]
        there = [target for target in targets if target.is_file()]
        target = next((one for one in there if one.absolute().resolve().is_relative_to(self._root)), None)
        if target is None:
            why = f"lies outside the folder of {self.path.name}; copy it" if there else f"is not next to {path.name}"
            yield Line("#error not read", path, number, f"{name} {why}")
        elif target.absolute().resolve() not in self.files:
            yield from self._expanded(target)

    def place(self, number: int) -> tuple[Path, int]:
        """The file and the line of a line of `text`, counted from 1; beyond its end, its last."""
        line = self._line(number)
        return line.path, line.number

    def _line(self, number: int) -> Line:
        return self.lines[min(max(number, 1), len(self.lines)) - 1]

    def explained(self, number: int, said: str, token: str = "", column: int = 0) -> str:
        """What a compiler says of a line of `text`, with the user's file, line and column.

        Args:
            token: what the compiler quotes; its column is added where it stands once in that line.
            column: as the compiler says; 0 where it does not.
        """
        path, line = self.place(number)
        if wrong := self._line(number).wrong:
            return f"{path}:{line}: {wrong}"
        if number > len(self.lines):
            return f"{path}:{line}: at the end of the file: {said}"
        column = column or self._column(number, token)
        return f"{path}:{line}{f':{column}' if column else ''}: {said}"

    def _column(self, number: int, token: str) -> int:
        """Where a word stands in a line, counted from 1; 0 where it does not, or not once."""
        found = list(re.finditer(rf"(?<!\w){re.escape(token)}(?!\w)", self._line(number).text)) if token else []
        return found[0].start() + 1 if len(found) == 1 else 0
