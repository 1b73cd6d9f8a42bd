"""The tokens of a shader's text after preprocessing, with macros without arguments and conditional parts."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice

from .tree import Place, TranslationError

# In this order: what is longer first.
TOKEN = re.compile(
    r"(?P<comment>//[^\n]*|/\*.*?\*/)"
    r"|(?P<number>0[xX][0-9a-fA-F]+[uUi]?|(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?(?:[uUfFhHi]\b|lf\b)?)"
    r"|(?P<word>[A-Za-z_]\w*)"
    r"|(?P<mark><<=|>>=|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||\^\^|[-+*/%&|^]=|[-+*/%&|^~!<>=?:;,.(){}\[\]@])",
    re.DOTALL,
)
BLANK = re.compile(r"[ \t\r]+|\\\n")
# One that has no end goes to the end of the text.
COMMENT = re.compile(r"//[^\n]*|/\*.*?(?:\*/|\Z)", re.DOTALL)
# Of a file that people wrote.
MOST_TOKENS = 200_000
MOST_DEPTH = 32
TOO_LONG = f"more than {MOST_TOKENS} tokens; shorten the file"


@dataclass(frozen=True)
class Token:
    """A word, a number or a mark; `above` holds the comments before it, `behind` the comment after it on its line."""

    kind: str
    text: str
    place: Place
    above: tuple[str, ...] = ()
    behind: str = ""


END = Token("end", "the end of the file", Place(0, 0))


def said(comment: str) -> list[str]:
    """Return the lines of a comment without its marks; empty lines of a block comment are left out."""
    if comment.startswith("//"):
        return [in_a_comment(comment.removeprefix("//").strip())]
    lines = (line.strip().removeprefix("*").strip() for line in comment[2:-2].splitlines())
    return [in_a_comment(line) for line in lines if line]


def in_a_comment(text: str) -> str:
    """Return a text that is safe as a one-line comment in any language: it neither ends the line nor continues it."""
    line = "".join(letter if letter.isprintable() else " " for letter in text)
    return re.sub(r"(\\|\?\?/)\s*$", r"\1.", line)


def tokens(text: str, first: int = 1) -> list[Token]:
    """Return the tokens of a text without preprocessor lines, each with the comments above and behind it; a comment
    followed by an empty line belongs to no token.

    Args:
        text: the text.
        first: the number of its first line.

    Raises:
        TranslationError: a character begins no token, or there are too many tokens.
    """
    stream: list[Token] = []
    above: list[str] = []
    position, line, begin = 0, first, 0
    newlines = 0
    while position < len(text):
        if text[position] == "\n":
            position, line, begin, newlines = position + 1, line + 1, position + 1, newlines + 1
            if newlines > 1:
                above = []
            continue
        if blank := BLANK.match(text, position):
            position = blank.end()
            continue
        match = TOKEN.match(text, position)
        place = Place(line, position - begin + 1)
        if not match:
            raise TranslationError(f"{line}:{place.column}: unexpected character {text[position]!r}")
        piece, kind = match[0], str(match.lastgroup)
        if kind == "comment":
            is_behind = newlines == 0 and stream and not piece.startswith("/*")
            if is_behind:
                stream[-1] = replace(stream[-1], behind=said(piece)[0])
            else:
                above += said(piece)
                newlines = 0
            line += piece.count("\n")
        else:
            stream.append(Token(kind, piece, place, tuple(above)))
            above, newlines = [], 0
        position = match.end()
        if len(stream) > MOST_TOKENS:
            raise TranslationError(TOO_LONG)
    return stream


class Preprocessor:
    """A preprocessor for macros without arguments and conditions on whole numbers. Macros for numbers remain names.

    Attributes:
        constants: the tokens of the macros that stand for a number or an array of numbers, by name.
    """

    def __init__(self) -> None:
        self._macros: dict[str, list[Token]] = {}
        self.constants: dict[str, list[Token]] = {}

    def tokens(self, text: str) -> list[Token]:
        """Return the tokens of a text, without directives and the branches that they exclude, and with macros
        expanded, except those for numbers. Raises TranslationError."""
        kept: list[str] = []
        including: list[tuple[bool, bool]] = []  # whether this branch counts, and whether one has
        # Directives are what stands in no comment.
        lines, bare = text.split("\n"), COMMENT.sub(_blanked_comment, text).split("\n")
        while len(kept) < len(lines):
            number = len(kept) + 1
            directive = re.match(r"\s*#\s*(\w*)\s*(.*)", bare[number - 1])
            counts = all(is_on for is_on, _ in including)
            if not directive:
                kept.append(lines[number - 1] if counts else "")
                continue
            rest = directive[2]
            while rest.endswith("\\") and len(kept) + 1 < len(lines):
                kept.append("")
                rest = f"{rest[:-1]} {bare[len(kept)]}"
            kept.append(_open_comment(lines[len(kept)], bare[len(kept)]))
            self._obey(directive[1], rest, number, including, counts)
        if including:
            raise TranslationError("#if without #endif")
        every = (each for token in tokens("\n".join(kept)) for each in self._expanded_tokens(token))
        expanded = list(islice(every, MOST_TOKENS + 1))
        if len(expanded) > MOST_TOKENS:
            raise TranslationError(TOO_LONG)
        return expanded

    def _obey(self, word: str, rest: str, line: int, including: list[tuple[bool, bool]], counts: bool) -> None:
        if word in ("if", "ifdef", "ifndef"):
            is_on = counts and self._holds(word, rest, line)
            including.append((is_on, is_on))
        elif word in ("elif", "else", "endif") and not including:
            raise TranslationError(f"{line}:1: #{word} without #if")
        elif word == "endif":
            including.pop()
        elif word in ("elif", "else"):
            _, was_on = including.pop()
            around = all(is_on for is_on, _ in including)
            is_on = around and not was_on and (word == "else" or self._holds("if", rest, line))
            including.append((is_on, was_on or is_on))
        elif word == "define" and counts:
            self._define(rest, line)

    def _define(self, rest: str, line: int) -> None:
        match = re.match(r"([A-Za-z_]\w*)(\(?)\s*(.*)", rest)
        if not match or match[2]:
            raise TranslationError(f"{line}:1: macros with arguments are not supported: {rest[:60]}")
        self._macros[match[1]] = [replace(token, above=(), behind="") for token in tokens(match[3], line)]
        if _is_number(self._macros[match[1]]):
            self.constants[match[1]] = self._macros.pop(match[1])

    def _holds(self, word: str, rest: str, line: int) -> bool:
        """Whether the branch after a conditional directive is active.

        Args:
            word: "if", "ifdef" or "ifndef".
            rest: the text after it.

        Raises:
            TranslationError: the condition of an #if is not a single name or number."""
        if word != "if":
            name = rest.split()[0] if rest.split() else ""
            return (name in self._macros or name in self.constants) == (word == "ifdef")
        numbers = [self._whole_number(token, line) for token in tokens(rest.split("//")[0], line)]
        if len(numbers) != 1:
            raise TranslationError(f"{line}:1: only `#if NAME` is supported, not {rest[:60]}")
        return numbers[0] != 0

    def _whole_number(self, token: Token, line: int) -> int:
        stands = self.constants.get(token.text, [token])
        if len(stands) != 1 or not stands[0].text.isdigit():
            raise TranslationError(f"{line}:1: {token.text} is not a whole number")
        return int(stands[0].text)

    def _expanded_tokens(self, token: Token) -> Iterator[Token]:
        """Yield a token or, if it names a macro, the macro's tokens at its place."""
        if token.kind != "word" or token.text not in self._macros:
            yield token
            return
        above = token.above
        for replacement in self._words(token, 0):
            yield replace(replacement, place=token.place, above=above)
            above = ()

    def _words(self, token: Token, depth: int) -> Iterator[Token]:
        """Yield the tokens to which a token expands, one at a time: nested macros may expand to too many tokens."""
        if token.kind != "word" or token.text not in self._macros:
            yield token
            return
        if depth > MOST_DEPTH:
            raise TranslationError(f"{token.place.line}:{token.place.column}: {token.text} is defined as itself")
        for each in self._macros[token.text]:
            yield from self._words(each, depth + 1)


def _blanked_comment(comment: re.Match[str]) -> str:
    return re.sub(r"[^\n]", " ", comment[0])


def _open_comment(line: str, bare: str) -> str:
    """Return the comment in a directive's line that begins before the line or ends after it; empty without one."""
    only = "".join(" " if left == letter else letter for letter, left in zip(line, bare, strict=True))
    return only if only.count("/*") != only.count("*/") else ""


def _is_number(words: Sequence[Token]) -> bool:
    """Whether tokens are a single number, with or without a minus sign, or an array of numbers."""
    texts = [word.text for word in words if word.text != "-"]
    # Without numbers in brackets behind it, `float[4]` is a type.
    is_array = len(texts) > 1 and texts[0] in ("float", "int") and texts[1] == "[" and "(" in texts
    return is_array or (len(texts) == 1 and words[-1].kind == "number")


def suffixed(text: str) -> tuple[str, str]:
    """Return (type, text) of a GLSL or HLSL number: "int", "uint" or "float", and its text without suffix. Octal
    numbers become decimal; hexadecimal numbers stay hexadecimal.

    Raises:
        ValueError: the text is not such a number.
    """
    lower = text.lower()
    if lower.startswith("0x"):
        return ("uint" if lower.endswith("u") else "int"), text.rstrip("uUi")
    if lower.endswith("u"):
        return "uint", _decimal_text(lower.rstrip("u"))
    is_float = any(mark in lower for mark in ".efh")
    return ("float", with_a_point(lower.rstrip("lfh"))) if is_float else ("int", _decimal_text(lower.rstrip("i")))


def _decimal_text(text: str) -> str:
    """Return the decimal text of a whole number; a number with a leading zero is octal."""
    return str(int(text, 8)) if text.startswith("0") else text


def with_a_point(text: str) -> str:
    """Return a number's text with a decimal point and digits on both sides of it; an exponent is kept."""
    mantissa, mark, exponent = text.partition("e")
    whole, _, rest = mantissa.partition(".")
    return f"{whole or 0}.{rest or 0}{mark}{exponent}"
