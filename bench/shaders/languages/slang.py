"""Slang to GLSL, by its own compiler."""

from __future__ import annotations

import re
from pathlib import Path

from . import tools
from .pairs import Function
from .programs import ENGINE_TYPES, ENTRY, HALVES, TranslationError, macros, program, template
from .source import Source

TOOLS = (tools.SLANG,)
GIVEN = "given.slang"
# Tab-separated: number, severity, file, line, column, its end, and what is wrong. The span says more than the error.
_ERROR = re.compile(rf"^\w+\t(?:error|fatal)[^\t]*\t{re.escape(GIVEN)}\t(\d+)\t(\d+)\t\d+\t\d+\t(.*)$", re.M)
_SPAN = re.compile(rf"^\w+\tspan\t{re.escape(GIVEN)}\t(\d+)\t(\d+)\t\d+\t\d+\t(.*)$", re.M)
_MIX, MIX = re.compile(r"\bmix(?=\()"), "normalbench_mix_0"
_OTHER_FILES = re.compile(r"(?<!\w)(?:__)?(?:import|include|implementing)\s+[\w\"]")
TYPES = {**ENGINE_TYPES, **dict.fromkeys(HALVES, "float")}


def preprocessed(source: Source, folder: Path) -> str:
    """A source after its preprocessor. Raises TranslationError, ToolError and MissingError."""
    said = _compiled(source, source.text, ["-E"], folder)
    if found := _OTHER_FILES.search(said):
        raise TranslationError(f"{source.path}: {found[0].split()[0]} is not read; #include a file next to it")
    return said


def shader(source: Source, function: Function, folder: Path) -> str:
    """A function of a source as a fragment shader in GLSL: see `plain.py`.

    Raises:
        TranslationError: it does not compile.
        ToolError: the compiler crashes or does not end.
        MissingError: it is not there.
    """
    options = ["-target", "glsl", "-entry", ENTRY, "-stage", "fragment", "-profile", "glsl_450"]
    made = _compiled(source, program(source, function), [*options, "-line-directive-mode", "none"], folder)
    # The suffix is one that `plain.py` takes for a name of Slang's.
    return template("mix.glsl", MIX=MIX) + _MIX.sub(MIX, made) if _MIX.search(made) else made


def _compiled(source: Source, text: str, options: list[str], folder: Path) -> str:
    (folder / GIVEN).write_text(text, encoding="utf-8")
    defined = [word for macro in macros(source, TYPES) for word in ("-D", macro)]
    words = ["-enable-machine-readable-diagnostics", *defined, *options, GIVEN]
    status, out, err = tools.run_apart(tools.SLANG, words, folder)
    check(source, err, status)
    return out


def check(source: Source, said: str, status: int) -> None:
    """Raises TranslationError where Slang's compiler ended with a status and said this."""
    if status:
        raise TranslationError(_explained(source, said, status))


def _explained(source: Source, said: str, status: int) -> str:
    """The first error, at the user's line and column."""
    error = _ERROR.search(said)
    if not error:
        first = " ".join(said.split())[:300] or f"status {status} without a word"
        return f"{source.path}: {tools.SLANG}: {first}"
    span = _SPAN.search(said, error.end())
    number, column, what = (span if span and span[1] == error[1] else error).groups()
    return source.explained(int(number), what.strip(), column=int(column))
