"""The translation of Slang, HLSL and GLSL to GLSL by Slang's own compiler.

An engine's file contains much that an encoder does not need: other stages, resources, functions from missing headers.
Therefore the compiler first reads only function heads. Functions and other declarations that it refuses are removed
repeatedly, until it accepts the rest and reports the functions in it. Then it compiles the functions that the encoder
or the decoder needs.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path

from ...ground.compilers import slang as library
from ...ground.compilers.lines import blank, with_known_directives
from ...ground.compilers.text import OTHER_FILES, RefusedError
from .items import Item, blanked, defined_in, functions_in, heads, items, marked_heads, without
from .pairs import Function
from .programs import ANY, ENGINE_TYPES, ENTRY, HALVES, Read, TranslationError, macros, program, template
from .reflection import functions_of
from .source import Source

COMPILER = "Slang's compiler"
# Tab-separated: number, severity, file, line, column, its end, and what is wrong. The span says more than the error.
_LINE = rf"\t[^\t]*{re.escape(library.GIVEN)}\t(\d+)\t(\d+)\t\d+\t\d+\t(.*)$"
_ERROR, _SPAN = re.compile(rf"^\w+\t(?:error|fatal)[^\t]*{_LINE}", re.M), re.compile(rf"^\w+\tspan{_LINE}", re.M)
_MIX, MIX = re.compile(r"\bmix(?=\()"), "normalbench_mix_0"
TYPES: Mapping[str, str] = {**ENGINE_TYPES, **dict.fromkeys(HALVES, "float")}
# What the names of a text's functions begin with where they are looked up.
MARK = "normalbench_own_"
# A directive that begins or ends a branch.
_CONDITIONAL = re.compile(r"^[ \t]*#[ \t]*(?:if|ifdef|ifndef|else|elif|endif)\b.*$", re.M)
PART = "normalbench_part_"
TARGET = (
    *("-target", "glsl", "-entry", ENTRY, "-stage", "fragment"),
    *("-profile", "glsl_450", "-line-directive-mode", "none"),
)
# Without an entry point, what a file declares is not looked at as closely.
NO_ENTRY = f"\nfloat4 {ENTRY}() : SV_Target {{ return 0; }}\n"
# NAME(, but for what says where a resource is bound.
_CALLED = re.compile(r"\b(?!register\b|packoffset\b|layout\b)([A-Za-z_]\w*)\s*\(")
# The version of GLSL, and what a stage is given and gives.
_VERSION = re.compile(r"^[ \t]*#[ \t]*version[ \t]+(\d+).*$", re.M)
_OF_A_STAGE = re.compile(
    r"^(?:layout\s*\([^)]*\)\s*)?(?:(?:flat|smooth|noperspective|centroid|highp|mediump|lowp)\s+)*"
    r"(?:in|out|varying|attribute)\b"
)
# What GLSL fills as no other language does: a matrix of one number is a diagonal.
_DIAGONAL = re.compile(r"\bmat[234](?:x[234])?\s*\(")

# Said of words that read other files.
INSTEAD = "; #include a file next to it"


class RefusedWordError(TranslationError):
    """A word in a text that must not reach a compiler.

    Attributes:
        place: the line and column of the word, and what is wrong with it.
    """

    def __init__(self, message: str, place: tuple[int, int, str]):
        super().__init__(message)
        self.place = place


def read(source: Source, folder: Path) -> Read:
    """Return the readable part of a source in HLSL or Slang. Raises TranslationError and MissingError."""
    return _readable_part(source, with_known_directives, folder, ())


def read_glsl(source: Source, folder: Path) -> Read:
    """Return the readable part of a source in GLSL, for Slang's compiler. Raises TranslationError and MissingError."""
    return _readable_part(source, _text_of_no_stage, folder, GLSL)


def _diagonals(text: str) -> Iterator[int]:
    """Yield the 1-based number of each line in which a matrix is constructed from a single value."""
    for match in _DIAGONAL.finditer(text):
        depth, commas = 1, 0
        for index in range(match.end(), len(text)):
            letter = text[index]
            depth += (letter == "(") - (letter == ")")
            commas += letter == "," and depth == 1
            if not depth:
                break
        if not commas:
            yield text.count("\n", 0, match.start()) + 1


def _text_of_no_stage(text: str) -> str:
    """Return GLSL text without directives for a GLSL compiler, and without the inputs and outputs of a stage."""
    text = with_known_directives(_VERSION.sub(r"#define __VERSION__ \1", text))
    return without(text, [item for item in items(text) if _OF_A_STAGE.match(text[item.start : item.end].lstrip())])


GLSL = ("-allow-glsl",)


def _readable_part(source: Source, first: Callable[[str], str], folder: Path, options: tuple[str, ...]) -> Read:
    """Return the active part of a source without refused items, and the functions in it. Function bodies are not
    checked.

    Args:
        first: a function from the source's text to the text to read.
    """
    source = source.without_missing()
    source = _live_part(source.with_text(first(source.text)), folder, options).without_part()
    refused: dict[str, str] = {}
    lost: dict[str, str] = {}
    while bad := _refused_now(source, options, folder):
        left = source.with_text(without(source.text, bad))
        refused |= {name: why for item, why in bad.items() for name in _names_in_head(source.text, item)}
        texts = {source.text[item.start : item.end]: why for item, why in bad.items() if not item.function}
        lost |= {name: why for text, why in texts.items() for name in (*defined_in(text), *_any_name(why))}
        source = left
    # The library ends the process where it is asked for a function that has the name of one of its own.
    compiled = _compiled(source, marked_heads(source.text, MARK) + NO_ENTRY, (*options, *TARGET), folder)
    tops = {item.function for item in items(source.text) if item.function}
    names = {name: _marked(name) if name in tops else name for name in functions_in(source.text)}
    return Read(source, functions_of(compiled, names), refused, lost)


def _refused_now(source: Source, options: tuple[str, ...], folder: Path) -> dict[Item, str]:
    """Return the items of a source that the compiler refuses, each with its first message; empty if the text compiles
    without function bodies. Raises TranslationError if the refused text is not in an item."""
    try:
        compiled = _compiled(source, heads(source.text) + NO_ENTRY, (*options, *TARGET), folder)
    except RefusedWordError as error:
        messages, explained = [error.place], error
    else:
        if not compiled.failed:
            return {}
        messages, explained = list(_messages(compiled.said)), TranslationError(_explanation(source, compiled.said))
    bad = _items_at(source, messages)
    if without(source.text, bad) == source.text:
        raise explained
    return bad


def _marked(name: str) -> str:
    space, mark, last = name.rpartition("::")
    return f"{space}{mark}{MARK}{last}"


def _live_part(source: Source, folder: Path, options: tuple[str, ...]) -> Source:
    """Return a source without conditional directives and inactive branches; line numbers do not change."""
    parts, ends = _CONDITIONAL.split(source.text), [*_CONDITIONAL.findall(source.text), ""]
    if len(parts) == 1:
        return source
    # Of a part that is looked at, the compiler says the warning; it is given directives alone.
    marked = (
        f"#warning {PART}{i}.\n{blanked(part)}{end}" for i, (part, end) in enumerate(zip(parts, ends, strict=True))
    )
    live = set(re.findall(rf"{PART}\d+\.", _compiled(source, "\n".join(marked), options, folder).said))
    kept = (part if f"{PART}{i}." in live else blank(part) for i, part in enumerate(parts))
    return source.with_text("".join(part + blank(end) for part, end in zip(kept, ends, strict=True)))


def _names_in_head(text: str, item: Item) -> list[str]:
    """Return the function names that an item may define: its function's name, or else all names before "("."""
    before, brace, _ = text[item.start : item.end].partition("{")
    if item.function:
        return [item.name]
    return _CALLED.findall(before) if brace or "=" not in before else []


def _any_name(why: str) -> list[str]:
    """Return [ANY] if the reason says that the removed text reads another file, whose names are unknown; else []."""
    return [ANY] if why.endswith(INSTEAD) else []


def _items_at(source: Source, messages: Iterable[tuple[int, int, str]]) -> dict[Item, str]:
    """Return the items to which messages refer, each with its first message. Messages about directives are ignored.

    Args:
        messages: the line, the column and the text of each message.
    """
    starts = [0, *(match.end() for match in re.finditer("\n", source.text))]
    known = items(source.text)
    refusals: dict[Item, str] = {}
    for number, column, what in messages:
        line = starts[min(number, len(starts)) - 1]
        item = known[bisect_right(known, line + column - 1, key=lambda item: item.start) - 1]
        if item.end > line + column - 1 and not source.text.startswith("#", line):
            refusals.setdefault(item, source.explained(number, what, column=column))
    return refusals


def shader(source: Source, function: Function, folder: Path, options: tuple[str, ...] = ()) -> str:
    """Return the text of a GLSL fragment shader that calls a function of a source (see `plain.py`).

    Raises:
        TranslationError: the source does not compile.
        MissingError: the compiler is not installed.
    """
    compiled = _compiled(source, program(source, function), (*options, *TARGET), folder)
    if compiled.failed:
        raise TranslationError(_explanation(source, compiled.said))
    # The suffix is one that `plain.py` takes for a name of Slang's.
    code = compiled.code
    return template("mix.glsl", MIX=MIX) + _MIX.sub(MIX, code) if _MIX.search(code) else code


def shader_of_glsl(source: Source, function: Function, folder: Path) -> str:
    """Return a GLSL fragment shader for a function of a GLSL source, as `shader` does. Also raises TranslationError
    for a matrix constructed from a single value."""
    if line := next(_diagonals(source.text), 0):
        what = "a matrix constructed from one value differs from GLSL's; write out its elements"
        raise TranslationError(source.explained(line, what))
    return shader(source, function, folder, GLSL)


def _compiled(source: Source, text: str, options: tuple[str, ...], folder: Path) -> library.Compiled:
    """Compile a text made from a source with Slang's compiler, and return the result, which may be a failure. Raises
    TranslationError if the text is refused before it is compiled."""
    defined = [word for macro in macros(source, TYPES) for word in ("-D", macro)]
    # A text without an entry point is checked, and nothing is written of it.
    target = () if "-target" in options else ("-target", "glsl")
    try:
        return library.compiled(text, [*defined, *options, *target], folder)
    except RefusedError as error:
        # Lines that mark the parts of a text are none of the user's; before each but the first stands an empty one.
        marks = sum(line.startswith(f"#warning {PART}") for line in text.split("\n")[: error.line])
        error.line -= max(2 * marks - 1, 0)
        if not error.line:
            raise TranslationError(refusal(source, error)) from None
        line = text.split("\n")[error.line - 1]
        place = (error.line, line.find(error.word) + 1, _explained(error))
        raise RefusedWordError(refusal(source, error), place) from None


def refusal(source: Source, error: RefusedError) -> str:
    """Return a message on why a source's text is refused, with the user's file and line."""
    why = _explained(error)
    return source.explained(error.line, why) if error.line else f"{source.path}: {why}"


def _explained(error: RefusedError) -> str:
    return error.why + (INSTEAD if error.word in OTHER_FILES else "")


def check(source: Source, printed: str, status: int) -> None:
    """Raise TranslationError if Slang's compiler ended with an error status; `printed` is its output."""
    if status:
        raise TranslationError(_explanation(source, printed))


def _explanation(source: Source, printed: str) -> str:
    """Return the first error message, at the user's line and column, with a missing include as a possible cause."""
    behind = f" ({source.missing[0]})" if source.missing else ""
    for number, column, what in _messages(printed):
        return source.explained(number, what, column=column) + behind
    return f"{source.path}: {COMPILER}: {' '.join(printed.split())[:300] or 'it ended without a message'}"


def _messages(printed: str) -> Iterator[tuple[int, int, str]]:
    """Yield the line, column and message of each error, except errors about a missing entry point."""
    errors = list(_ERROR.finditer(printed))
    starts = [error.start() for error in errors]
    for error, end in zip(errors, [*starts[1:], len(printed)], strict=False):
        span = _SPAN.search(printed, error.end(), end)
        number, column, what = (span if span and span[1] == error[1] else error).groups()
        if ENTRY not in what:
            yield int(number), int(column), what.strip().rstrip(".")
