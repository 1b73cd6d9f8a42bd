"""Texts that may be passed to compilers. Two functions create them: `judged`, if any part comes from a user, and
`own`.

The checked text is compiled byte for byte: no compiler joins its lines, skips comments in it or reads another file
for it. The check and the compiler therefore read the same text.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from .lines import DIRECTIVE, KNOWN

PACKAGE = Path(__file__).resolve().parents[3]
# The folders that normalbench is made of.
ROOMS = ("encodings", "gbuffer", "bench", "reports")


class RefusedError(Exception):
    """A text may not be passed to a compiler.

    Attributes:
        line: the line, counted from 1; 0 if unknown.
        why: the problem, in words.
        word: the word that is not allowed; empty if the problem is not a word.
    """

    def __init__(self, line: int, why: str, word: str = ""):
        super().__init__(f"line {line}: {why}" if line else why)
        self.line, self.why, self.word = line, why, word


@dataclass(frozen=True)
class Text:
    """A text for a compiler. Only this module creates instances.

    Attributes:
        content: the text itself.
        is_own: whether all of the text is part of this program.
    """

    content: str
    is_own: bool

    def __add__(self, other: Text) -> Text:
        return Text(f"{self.content}\n{other.content}", self.is_own and other.is_own)


NOTHING = re.compile(r"(?!)")


class Rules(NamedTuple):
    """Rules for texts in one language, in addition to the rules for all texts.

    Attributes:
        heads: a pattern for lines of a program's header; other unknown directives are rejected.
        words: the allowed words that begin with two underscores; None if words are not checked.
        refused: words that read other files, or write text into the compiled program.
        marks: characters that a text may not contain.
        is_native: whether a text becomes machine code.
    """

    heads: re.Pattern[str] = NOTHING
    words: Collection[str] | None = ()
    refused: Collection[str] = ()
    marks: str = ""
    is_native: bool = False


# Words of Slang's that read other files, and that write what stands in a string into the program that is made. Those
# that begin with two underscores are refused anyway, but for those of `_HARMLESS` and names of the user's.
OTHER_FILES = ("import", "__import", "__include", "implementing", "__exported")
_OTHER_TEXT = ("spirv_asm", "DllImport", "DllExport", "TorchEntryPoint", "CudaKernel", "syntax", "attribute_syntax")
# Attributes of vk:: that put an instruction, its operands or an extension of a file's choice into SPIR-V.
_OTHER_TEXT += ("spirv_instruction", *(f"ext_{word}" for word in ("instruction", "capability", "extension")))
_OTHER_TEXT += tuple(f"ext_{word}" for word in ("decorate", "decorate_id", "decorate_string", "literal", "reference"))
_HARMLESS = (
    *("__generic", "__init", "__subscript", "__extension", "__ref", "__constref", "__prefix", "__postfix"),
    *("__BuiltinType", "__BuiltinArithmeticType", "__BuiltinFloatingPointType", "__BuiltinIntegerType"),
    *("__BuiltinLogicalType", "__BuiltinRealType", "__BuiltinSignedArithmeticType", "__readNone", "__NoSideEffect"),
)
# A file in quotes is one that is put next to the program.
_C_HEADS = re.compile(
    r'#include (<(math|stdbool|stddef|stdint|string)\.h>|"(code|\w+_tables)\.h")'
    "|#pragma STDC FP_CONTRACT OFF|#ifdef __clang__"
)
_GLSL_HEADS = re.compile(
    r"#version (310 es|430|450)|#extension GL_EXT_(shader_explicit_arithmetic_types(_float16)?|shader_16bit_storage"
    r"|control_flow_attributes|samplerless_texture_functions) : require"
)
# Native code: no quotes, and no letter that spells another one.
_NATIVE = Rules(refused=("asm", "_Pragma", "_Generic", "typeof"), marks="\"'`\\", is_native=True)
RULES: Mapping[str, Rules] = MappingProxyType(
    {
        "slang": Rules(words=_HARMLESS, refused=(*OTHER_FILES, *_OTHER_TEXT)),
        "hlsl": Rules(words=None),
        "glsl": Rules(heads=_GLSL_HEADS, words=None),
        "wgsl": Rules(marks="#\"'`\\"),
        "c": _NATIVE._replace(heads=_C_HEADS),
        "cuda": _NATIVE._replace(heads=re.compile(r"#pragma unroll"), words=("__constant__", "__forceinline__")),
    }
)
# What ends a line that goes on, begins a comment, or is another way to write # or \.
_ODD = re.compile(r"\\[^\S\n]*$|//|/\*|%:|\?\?", re.M)
# Of native code: what begins an attribute of C++ and of C.
_ATTRIBUTE = re.compile(r"\[\s*\[|<:|\b__attribute")
_REASONS = {"/": "a comment", "\\": "a line continuation", "%": "a digraph", "?": "a trigraph"}
# A # in a line that is no directive, or a second one in a directive that is no macro and no message.
_INNER = re.compile(r"^[ \t]*[^\s#][^\n#]*#|^[ \t]*#[ \t]*(?!define\b|error\b|warning\b)[^\n#]*#", re.M)
_WORD = re.compile(r"[^\W\d]\w*")
_PROBE = re.compile(r"\b__has_\w+")


def judged(
    text: str,
    language: str,
    expanded: Callable[[Text], str] | None = None,
    knows: Callable[[str], bool] = lambda _: True,
) -> Text:
    """Check a text, and return it as a text that compilers of a language may be given.

    Args:
        text: the complete input of the compiler: whole lines, without comments.
        language: a key of RULES.
        expanded: returns the text as the compiler's own preprocessor expands it, for languages whose macros can
            spell a word that is not in the text. If None, the text itself is checked, and it may have no macro
            that joins words.
        knows: whether the compiler may know a word that begins with two underscores. Other such words are names
            that the user defined.

    Raises:
        RefusedError: the text may not be given to the compiler.
    """
    rules = RULES[language]
    _check_letters(text, rules)
    _check_directives(text, rules)
    plain = Text(text, is_own=False)
    if rules.words is not None and expanded is None and "##" in text:
        raise _refusal_at(text, text.index("##"), "a ## macro that joins words is not supported here")
    if rules.words is not None:
        words = _WORD.findall(_without_heads(text, rules) if expanded is None else expanded(plain))
        _check_words(text, dict.fromkeys(words), rules, knows)
    return plain


def own(*files: Path, **numbers: int | str) -> Text:
    """Return files of this program as one text that begins with macro definitions.

    Raises:
        ValueError: a file does not belong to this program, or a macro is neither a number nor a name.
    """
    if strange := [path for path in files if not is_own_file(path)]:
        raise ValueError(f"{strange[0]} is not a file of normalbench")
    if odd := [value for value in numbers.values() if not re.fullmatch(r"-?[\w.]+", str(value))]:
        raise ValueError(f"{odd[0]!r} is neither a number nor a name")
    macros = [f"#define {name} {value}" for name, value in numbers.items()]
    return Text("\n".join([*macros, *(path.read_text(encoding="utf-8") for path in files)]), is_own=True)


def is_own_file(path: Path) -> bool:
    """Whether a file belongs to this program, after its links are resolved."""
    return any(path.resolve().is_relative_to(PACKAGE / room) for room in ROOMS)


def _check_letters(text: str, rules: Rules) -> None:
    if not text.replace("\n", "").replace("\t", "").isprintable():
        place = next(i for i, letter in enumerate(text) if not (letter.isprintable() or letter in "\n\t"))
        raise _refusal_at(text, place, f"the character U+{ord(text[place]):04X} is not supported")
    for match in _ODD.finditer(text):
        raise _refusal_at(text, match.start(), f"{_REASONS[match[0][0]]} is not supported here")
    bare = _without_heads(text, rules) if rules.marks else ""
    for mark in rules.marks:
        if mark in bare:
            raise _refusal_at(bare, bare.index(mark), f"the character {mark} is not supported here")


def _without_heads(text: str, rules: Rules) -> str:
    return DIRECTIVE.sub(lambda match: "" if rules.heads.fullmatch(match[0].strip()) else match[0], text)


def _check_directives(text: str, rules: Rules) -> None:
    for match in DIRECTIVE.finditer(text):
        if match[1] not in KNOWN and not rules.heads.fullmatch(match[0].strip()):
            raise _refusal_at(text, match.start(), f"#{match[1]} is not supported")
    for match in _INNER.finditer(text):
        raise _refusal_at(text, match.end() - 1, "a # inside a line is not supported")
    for match in (*_PROBE.finditer(text), *_ATTRIBUTE.finditer(text)) if rules.is_native else ():
        raise _refusal_at(text, match.start(), f"{match[0]} is not supported")


def _check_words(text: str, words: Iterable[str], rules: Rules, knows: Callable[[str], bool]) -> None:
    for word in words:
        is_marked = word.startswith("__") and word not in (rules.words or ())
        if word in rules.refused or (is_marked and knows(word)):
            raise RefusedError(_line_of(text, word), f"{word} is not supported", word)


def _line_of(text: str, word: str) -> int:
    """Return the number, from 1, of the first line that contains a word; if a macro spells the word, of the first
    line with a macro that joins words; 0 if no line matches."""
    match = re.search(rf"\b{re.escape(word)}\b", text) or re.search(r"##", text)
    return text.count("\n", 0, match.start()) + 1 if match else 0


def _refusal_at(text: str, place: int, why: str) -> RefusedError:
    return RefusedError(text.count("\n", 0, place) + 1, why)
