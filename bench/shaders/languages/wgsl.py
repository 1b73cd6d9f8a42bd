"""WGSL to GLSL, by this project's own translator: no tool is needed."""

from __future__ import annotations

import re
from pathlib import Path

from ..translator import tree
from ..translator.glsl_writer import GlslWriter
from ..translator.reduce import numbered, reduced
from ..translator.wgsl_parser import read_wgsl
from .items import blank
from .pairs import Function
from .programs import Read, TranslationError, template
from .source import Source

TOOLS = ()
SIZES = {"vec2": 2, "vec3": 3}
# What preprocessors of engines add to the language: nothing that is imported is there.
_IMPORT = re.compile(r"^[ \t]*#(?:import|define_import_path)\b[^\n{]*(?:\{[^}]*\})?[^\n]*$", re.M)
# 3:14: y is not known here
_PLACED = re.compile(r"(\d+):(\d+): (.*)", re.S)


def read(source: Source, folder: Path) -> Read:  # noqa: ARG001 (no tool works there)
    """A source with its functions. Raises TranslationError."""
    if source.settings.defines:
        raise TranslationError(f"{source.path}: WGSL has no macros; leave out -D")
    if len(source.mains) > 1:
        raise TranslationError(f"{source.path}: WGSL in two files is not read; join them")
    source = source.with_text(_IMPORT.sub(lambda match: blank(match[0]), source.text))
    return Read(source, [_function(one) for one in _checked(source, lambda: read_wgsl(source.text)).functions])


def _function(defined: tree.Function) -> Function:
    given = tuple(SIZES.get(p.kind, 0) for p in defined.parameters)
    return Function(tree.plain_name(defined), SIZES.get(defined.kind, 0), given, defined.kind)


def shader(source: Source, function: Function, folder: Path) -> str:  # noqa: ARG001 (no tool works there)
    """A function of a source as a fragment shader in GLSL: see `plain.py`. Raises TranslationError."""
    program = _checked(source, lambda: reduced(read_wgsl(source.text), {function.name: "entry"}, "wgsl", ""))
    # Names that end in a number are those that `plain.py` makes its own: none is a word of GLSL's.
    numbered(program, "wgsl")
    entry = program.functions[-1]
    given = ["wgsl_given_0", "wgsl_view_0"][: len(entry.parameters)]
    view = "layout(location = 1) in vec3 wgsl_view_0;" if len(given) > 1 else ""
    words = {"VIEW": view, "RESULT": f"vec{function.result}", "GIVEN": f"vec{function.given[0]}"}
    made = template("entry.frag", FUNCTION=entry.name, ARGUMENTS=", ".join(given), **words)
    return _checked(source, lambda: GlslWriter("wgsl", {}).program(program)) + made


def _checked(source: Source, made):
    """What is made. Raises TranslationError, at the user's line and column."""
    try:
        return made()
    except tree.TranslationError as error:
        placed = _PLACED.fullmatch(str(error))
        if not placed:
            raise TranslationError(f"{source.path}: {error}") from error
        raise TranslationError(source.explained(int(placed[1]), placed[3], column=int(placed[2]))) from error
