"""The languages that can be translated, and how each is read and translated."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from ....encodings.codecs.files import file_text
from ...ground.compilers import tools
from ...ground.compilers.lines import without_comments
from ...ground.user_files import GLSL, TRANSLATED, UserFile
from . import hlsl, slang, wgsl, wiring
from .pairs import Function
from .programs import Read
from .shaped import Adapter
from .source import Source

GLSL_NAME = "GLSL"
# What stands in no other language that files of several endings have: a type, a function, a module.
_SIGNS = (
    (GLSL_NAME, r"\b[iub]?vec[234]\b(?!<)"),
    ("WGSL", r"\bfn\s+\w+\s*\("),
    ("Slang", r"^[ \t]*(?:import|module)\s"),
)


@dataclass(frozen=True)
class Language:
    """A shading language.

    Attributes:
        tools: the compilers that the language needs.
        read: (source, working folder) -> the part of the source that a compiler reads.
        shader: (source, function, working folder) -> the function as a GLSL fragment shader: input 0 is its
            own input, input 1 the view-space position, output 0 the result.
        adapter: a function that writes an adapter, which calls a function of the same program.
        placed: (source, functions) -> the functions with the places of their inputs and outputs.
        others: other compilers, for sources that the language's own refuses, or to check what it has read.
    """

    tools: tuple[str, ...]
    read: Callable[[Source, Path], Read]
    shader: Callable[[Source, Function, Path], str]
    others: tuple[str, ...] = ()
    adapter: Adapter = wiring.adapter
    placed: Callable[[Source, Sequence[Function]], Sequence[Function]] = lambda _, functions: functions


# A second reader of HLSL, which has the functions of the first.
GLSLANG = "glslang"
BY_NAME: Mapping[str, Language] = MappingProxyType(
    {
        "HLSL": Language((tools.SLANG_LIBRARY,), slang.read, slang.shader, hlsl.TOOLS),
        GLSLANG: Language((tools.SLANG_LIBRARY, *hlsl.TOOLS), slang.read, hlsl.shader),
        "Slang": Language((tools.SLANG_LIBRARY,), slang.read, slang.shader),
        "GLSL": Language((tools.SLANG_LIBRARY,), slang.read_glsl, slang.shader_of_glsl),
        "WGSL": Language(wgsl.TOOLS, wgsl.read, wgsl.shader, adapter=wgsl.adapter, placed=wgsl.with_places),
    }
)


def language_of(file: UserFile, by: str = "") -> Language:
    """Return the language of a file; if `by` is given, the language of that name in `BY_NAME`."""
    return BY_NAME[by or name_of(file)]


def name_of(file: UserFile) -> str:
    """Return the name of a file's language: the user's choice, or by the file's extension, or by its text if several
    languages share the extension; "HLSL" if the text does not show the language."""
    ending = file.path.suffix.lower()
    language = file.settings.language or TRANSLATED.get(ending, GLSL_NAME if ending == GLSL else "")
    if language:
        return language
    try:
        text = without_comments(file_text(file.path))
    except (OSError, ValueError):
        return "HLSL"
    return next((name for name, sign in _SIGNS if re.search(sign, text, re.M)), "HLSL")


def require_language(name: str) -> None:
    """Raise MissingError if a compiler that a language needs is not installed."""
    for tool in BY_NAME[name].tools:
        tools.path_of(tool)
