"""The languages that are translated: a line each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from . import hlsl, pairs, slang, tools, wgsl
from .pairs import Function
from .source import Source
from .words import TRANSLATED


@dataclass(frozen=True)
class Language:
    """A shading language.

    Attributes:
        tools: the compilers that it needs.
        preprocessed: a source, and a folder to work in, to its text without macros.
        functions: that text to the functions of vectors in it.
        shader: a source, a function of it and a folder to work in, to a fragment shader in GLSL: input 0 is what the
            function is given, input 1 the view-space position, output 0 the result.
    """

    tools: tuple[str, ...]
    preprocessed: Callable[[Source, Path], str]
    functions: Callable[[str], list[Function]]
    shader: Callable[[Source, Function, Path], str]


BY_NAME: Mapping[str, Language] = MappingProxyType(
    {
        "HLSL": Language(hlsl.TOOLS, hlsl.preprocessed, pairs.functions, hlsl.shader),
        "Slang": Language(slang.TOOLS, slang.preprocessed, pairs.functions, slang.shader),
        "WGSL": Language(wgsl.TOOLS, wgsl.preprocessed, wgsl.functions, wgsl.shader),
    }
)


# Languages that the compiler of another one reads as well.
ALSO_READ_BY: Mapping[str, str] = MappingProxyType({"HLSL": "Slang"})


def language_of(path: Path, by: str = "") -> Language:
    """The language of a file by its ending, or by the name of the one whose compiler is to read it."""
    return BY_NAME[by or TRANSLATED[path.suffix.lower()]]


def also_read_by(path: Path) -> str:
    """Another language whose compiler reads a file; empty where there is none."""
    return ALSO_READ_BY.get(TRANSLATED[path.suffix.lower()], "")


def require_language(name: str) -> None:
    """Raises MissingError where a compiler that a language needs is not there."""
    for tool in BY_NAME[name].tools:
        tools.path_of(tool)
