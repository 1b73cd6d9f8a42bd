"""The translation of a user's file, in a process that may hang or crash.

    python -m normalbench.bench.shaders.languages.child FOLDER WORD LANGUAGE KIND PART

FOLDER is an empty working folder. WORD names the file: see `user_files.py`. LANGUAGE is the reader, a name in
`BY_NAME`; empty for the file's own language. KIND is the kind of the encoded values: see `encodings.kinds`. PART
selects declarations to leave out: 3:4 is the last of four equal parts, 0:0 is none.

Prints a JSON object on one line. If PART selects any declarations, `left_out` lists them. If something is wrong with
the file: `error`, the message; `pairs`, the names of the pairs if there are several; and `alone`, the facts about an
encoder or a decoder without a partner. If a tool is missing: `missing`, what to install. Otherwise: the fields of
`Translated`.
"""

from __future__ import annotations

import json
import re
import sys
import tempfile
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from ....encodings import kinds
from ....encodings.codecs.files import called
from ....encodings.kinds import Kind
from ...ground.compilers import tools
from ...ground.compilers.tools import ToolError
from ...ground.machine import children
from ...ground.machine.systems import landlock, walls
from ...ground.machine.systems.walls import Wall
from ...ground.output.errors import MissingError, UsageError
from ...ground.user_files import UserFile
from . import hlsl, programs, slang
from .blocks import programs_of
from .items import functions_in, reached, words_of
from .language import BY_NAME, GLSLANG, Language, language_of, name_of
from .pairs import (
    IF_NAMED,
    NO_PAIR,
    NORMAL,
    Function,
    NoPairError,
    Pair,
    SeveralPairsError,
    alone,
    packed_pairs,
    pair_of,
    role,
    speaks_of_normals,
)
from .plain import NotPlainError, plain
from .programs import ANY, Read, TranslationError
from .shaped import shaped_pair
from .source import Part, Source
from .wiring import Wiring, candidates, wired, wiring_of

_A = {"uint": "a uint", "int": "an int", "float": "a float"}
# What compilers say of a name that nothing defines.
_UNKNOWN = re.compile(r"undefined identifier|unknown variable|no matching overloaded function")
_UNDEFINED = re.compile(r"undefined identifier '(\w+)'")
BY_MACRO = "; define missing macros with -D or --prelude"
WHICH = "measured: {}"
HAS_PARAMETERS = "only parameters are available"
MOST_NAMED, MOST_OTHERS = 12, 4


def answer(
    file: UserFile,
    folder: Path,
    by: str = "",
    kind: Kind = kinds.NORMAL,
    once_read: Callable[[Source], None] = lambda _: None,
    part: Part = (0, 0),
) -> dict[str, Any]:
    """Return the answer for a file (see the module). `once_read` is called before any compiler runs."""
    try:
        source = Source(file)
        source.part = part
    except UsageError as error:
        return {"error": str(error)}
    once_read(source)
    facts = _answer(source, folder, by, kind)
    return facts | {"left_out": source.left_out} if any(part) else facts


def _answer(source: Source, folder: Path, by: str, kind: Kind) -> dict[str, Any]:
    path = source.path
    try:
        return _facts_of_a_program(source, folder, by, kind)
    except (UsageError, TranslationError) as error:
        may_be_macro = _UNKNOWN.search(str(error)) and not source.missing
        return {"error": f"{error}{BY_MACRO}" if may_be_macro else str(error)}
    except SeveralPairsError as error:
        return {"error": f"{path}: {error}", "pairs": list(error.named)} | _alone(error)
    except NoPairError as error:
        return {"error": f"{path}: {error}"} | _alone(error)
    except (NotPlainError, ToolError) as error:
        return {"error": f"{path}: {error}"}
    except MissingError as error:
        return {"missing": f"{path}: {error}"}


def _alone(error: NoPairError) -> dict[str, Any]:
    return {"alone": dict(error.alone)} if error.alone else {}


def _wall_in(source: Source, folder: Path) -> None:
    """Restrict this process and its children to the compilers, the files already read and a writable folder."""
    if not landlock.is_available():
        return
    # Temporary files lie there from here on.
    tempfile.tempdir = str(folder)
    wall = walls.of_python() | Wall(tuple(map(str, source.files)), (str(folder),))
    for tool in (*hlsl.TOOLS, tools.SLANG_LIBRARY):
        with suppress(MissingError):
            wall |= walls.of_tool(tools.path_of(tool))
    wall.restrict()
    landlock.forget_variables()


def _facts_of_a_program(whole: Source, folder: Path, by: str, kind: Kind) -> dict[str, Any]:
    """Return the facts about the first program in a file that has both an encoder and its decoder. If none has both,
    raise one program's error."""
    errors: list[Exception] = []
    for source in programs_of(whole):
        try:
            if kind is not kinds.NORMAL:
                return _shaped_facts(source, whole.file.functions, folder, by, kind)
            return _translation_facts(source, whole.file.functions, folder, by)
        except (TranslationError, NoPairError) as error:
            errors.append(error)
    # What is wrong with a pair says more than that there is none.
    raise min(errors, key=lambda error: NO_PAIR in str(error))


def _translation_facts(source: Source, asked: tuple[str, str] | None, folder: Path, by: str) -> dict[str, Any]:
    path = source.path
    parsed = language_of(source.file, by).read(source, folder)
    try:
        pair, text, named = _pair_and_text(parsed, asked, path)
    except NoPairError as error:
        if not isinstance(error, SeveralPairsError):
            _check_refused(parsed, asked)
        if single_pair := alone(parsed.functions):
            with suppress(TranslationError, NotPlainError, ToolError):
                error.alone = _pair_facts(parsed, single_pair, "", folder, by)
        raise
    notes = [
        *(f"read without an include: {line}" for line in parsed.source.missing),
        *_read_with(source),
        *([WHICH.format(named)] if text or not (asked or speaks_of_normals(pair)) else []),
        *([] if asked else _others(parsed.functions, pair)),
    ]
    facts = _pair_facts(parsed, pair, text, folder, by, asked) | {"named": named}
    by_glslang = f"only {GLSLANG} can read it; {slang.COMPILER} cannot"
    return facts | {"notes": [*([by_glslang] if facts["read_by"] == GLSLANG else []), *notes]}


def _check_refused(parsed: Read, asked: tuple[str, str] | None) -> None:
    """Raise TranslationError if a refused function has a requested name, or is named like an encoder or a decoder:
    this explains why no pair was found."""
    if why := next((why for name, why in parsed.refused.items() if name in (asked or ()) or role(name)), ""):
        raise TranslationError(why) from None


def _shaped_facts(source: Source, asked: tuple[str, str] | None, folder: Path, by: str, kind: Kind) -> dict[str, Any]:
    """Return the same facts as `_translation_facts`, for an encoding of something other than normals."""
    language = language_of(source.file, by)
    parsed = language.read(source, folder)
    if asked and not all(wiring_of(text).is_plain for text in asked):
        raise NoPairError("arguments can be given only with normals; name just the two functions")
    own = functions_in(parsed.source.own_text)
    try:
        pair = shaped_pair(language.placed(parsed.source, parsed.functions), kind, asked, str(source.path), own)
    except SeveralPairsError:
        raise
    except NoPairError:
        _check_refused(parsed, asked)
        raise
    sides = pair.sides(language.adapter)
    called = {letter: function for letter, (function, _) in sides.items()}
    text = "".join(text for _, text in sides.values())

    def texts(reader: Language, part: Source, prefix: str) -> list[str]:
        adapter_text = _adapter_texts(part, reader, called, prefix, folder)
        return [adapter_text + programs.shaped(prefix, pair, is_unit) for is_unit in (False, True)]

    both = Pair(pair.encode.function, pair.decode.function)
    # An adapter's name begins as that of the function that it calls.
    facts = _facts_of_texts(
        parsed, text, [function.name for function in called.values()], _row_name(source, both, asked), by, texts
    )
    notes = [*(f"read without an include: {line}" for line in parsed.source.missing), *_read_with(source)]
    return facts | {
        "components": pair.components,
        "notes": notes,
        "functions": [(function.name, False) for function in (both.encode, both.decode)],
        "named": pair.named,
        "shaped": {"template": pair.shape.template, "settings": pair.settings, "parts": pair.parts},
    }


def _adapter_texts(
    source: Source, language: Language, called: Mapping[str, Function], prefix: str, folder: Path
) -> str:
    """Return the GLSL text of the adapters, functions named by the prefix and the letter of each adapter."""
    return "".join(
        plain(language.shader(source, function, folder), f"{prefix}_{letter}", "vec4", HAS_PARAMETERS)
        for letter, function in called.items()
    )


def _pair_facts(
    parsed: Read, pair: Pair, text: str, folder: Path, by: str, asked: tuple[str, str] | None = None
) -> dict[str, Any]:
    """Return the fields of `Translated` for two functions, or for one function without a partner.

    Args:
        text: the text to append to the user's text.
    """

    def texts(reader: Language, part: Source, prefix: str) -> list[str]:
        return _function_texts(part, reader, pair, prefix, folder)

    names = (pair.encode.name, pair.decode.name)
    return _facts_of_texts(parsed, text, names, _row_name(parsed.source, pair, asked), by, texts) | {
        "components": pair.components,
        "packed": pair.encode.kind if pair.is_packed else "",
        "functions": [(function.name, function.takes_view) for function in (pair.encode, pair.decode)],
        "named": pair.named,
    }


# A reader, what it is given, and what names begin with, to the functions in GLSL.
_Texts = Callable[[Language, Source, str], list[str]]


def _facts_of_texts(
    parsed: Read, text: str, names: Collection[str], name: str, by: str, texts: _Texts
) -> dict[str, Any]:
    """Return the fields of `Translated` for functions, except those that depend on the kind of the encoding.

    Args:
        text: the text to append to the user's text.
        names: the names of the functions to call.
        name: the encoding's name in rows.
    """
    prefix = "user_" + re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")
    source = parsed.source.with_text(reached(parsed.source.text + text, names))
    # Where an overload that is refused was meant, another one or a built-in function would do something else.
    used = words_of(source.text) if parsed.refused else set()
    if why := next((why for name, why in parsed.refused.items() if name in used), ""):
        raise TranslationError(why)
    try:
        by, glsl_texts = _texts_by_whoever_reads_it(source, by, texts, prefix)
    except TranslationError as error:
        # What was cut out for another reason is not defined for that one.
        unknown = _UNDEFINED.search(str(error))
        why = parsed.lost.get(unknown[1], parsed.lost.get(ANY, "")) if unknown else ""
        raise TranslationError(why or str(error)) from None
    return {
        "name": name,
        "prefix": prefix,
        "packed": "",
        "notes": [],
        "texts": glsl_texts,
        "text": source.text,
        "read_by": by,
        "shaped": {},
    }


def _pair_and_text(parsed: Read, asked: tuple[str, str] | None, path: Path) -> tuple[Pair, str, str]:
    """Return the pair to measure, the HLSL text of its functions if they are wired from other functions (else empty),
    and the name by which the pair is requested. Raises NoPairError."""
    first, other = wirings = [wiring_of(text) for text in asked] if asked else (Wiring(""), Wiring(""))
    names = (first.function, other.function) if asked else None
    if not (first.is_plain and other.is_plain):
        return _wired_pair(wirings, parsed)
    own = functions_in(parsed.source.own_text)
    try:
        pair = pair_of(parsed.functions, names, str(path), own)
        # The file's own come before those that it includes.
        several = [] if names or {pair.encode.name, pair.decode.name} & set(own) else _own_candidates(parsed, own)
        if not several:
            return pair, "", pair.named
    except SeveralPairsError:
        raise
    except NoPairError:
        several = candidates([function for function in parsed.functions if not names or function.name in names])
        if not several:
            raise
    if len(several) == 1:
        return _wired_pair(several[0], parsed)
    raise SeveralPairsError(str(path), [":".join(map(str, wirings)) for wirings in several])


def _own_candidates(parsed: Read, own: Collection[str]) -> list[tuple[Wiring, Wiring]]:
    return candidates([function for function in parsed.functions if function.name in own])


def _wired_pair(wirings: Sequence[Wiring], parsed: Read) -> tuple[Pair, str, str]:
    text, pair = wired(wirings, parsed.functions)
    return pair, text, ":".join(map(str, wirings))


def _texts_by_whoever_reads_it(source: Source, by: str, texts: _Texts, prefix: str) -> tuple[str, list[str]]:
    """Return the compiler that read the functions (empty for their language's own) and the GLSL texts from `texts`.
    If Slang fails on HLSL, glslang is tried."""
    try:
        return by, texts(language_of(source.file, by), source, prefix)
    except TranslationError:
        if by or name_of(source.file) != "HLSL":
            raise
        with suppress(TranslationError, NotPlainError, ToolError, MissingError):
            return GLSLANG, texts(BY_NAME[GLSLANG], source, prefix)
        raise


def _others(functions: Sequence[Function], pair: Pair) -> list[str]:
    """Return a note on each other pair that has a 32-bit code or needs wiring, at most MOST_OTHERS notes in all."""
    others = [] if pair.is_packed else packed_pairs(functions)
    packed = {other.named: f", which packs into {_A[other.encode.kind]}," for other in others}
    wired = dict.fromkeys(f"{first.function}:{other.function}" for first, other in candidates(_but(functions, pair)))
    named = {**dict.fromkeys(wired, ""), **packed}
    measured = {pair.encode.name.removesuffix("_wired"), pair.decode.name.removesuffix("_wired")}
    left = {
        pair_name: what
        for pair_name, what in named.items()
        if not measured & set(pair_name.replace("::", "_").split(":"))
    }
    return [f"{pair_name}{what} {IF_NAMED}" for pair_name, what in list(left.items())[:MOST_OTHERS]]


def _but(functions: Sequence[Function], pair: Pair) -> list[Function]:
    return [function for function in functions if function.name not in (pair.encode.name, pair.decode.name)]


def _read_with(source: Source) -> list[str]:
    """Return a list with a one-line note on the other files and macros read with a file; empty without them."""
    others = [str(path) for path in source.files.values() if path not in source.mains]
    more = f" and {len(others) - MOST_NAMED} others" if len(others) > MOST_NAMED else ""
    macros = [f"-D {macro}" for macro in source.settings.defines]
    extras = ", ".join([*macros, *others[:MOST_NAMED]])
    return [f"read with {extras}{more}"] if extras else []


def _row_name(source: Source, pair: Pair, asked: tuple[str, str] | None) -> str:
    """Return an encoding's name for rows: NAME of NAME_encode and NAME_decode, or the file's; with macros."""
    names = [pair.encode.name.removesuffix("_encode"), pair.decode.name.removesuffix("_decode")]
    file = source.path.name
    function = wiring_of(asked[0]).function if asked else pair.encode.name
    if len(source.mains) > 1:
        return called(":".join((f"{file}:{function}", source.mains[1].name, *source.settings.defines)))
    own = names[0] if names[0] == names[1] else f"{file}:{function}" if asked else file
    return called(":".join((own, *source.settings.defines)))


def _function_texts(source: Source, language: Language, pair: Pair, prefix: str, folder: Path) -> list[str]:
    """Return a pair's GLSL text twice, for codes in [-1, 1] and for codes in [0, 1]; both are equal for a packed
    code."""
    sides = {f"{prefix}_e": pair.encode, f"{prefix}_d": pair.decode}
    text = "".join(
        plain(language.shader(source, side, folder), name, side.takes or f"vec{side.given[0]}")
        if side.name
        else f"vec{side.result} {name}_main(vec{side.given[0]} a, vec3 view) {{ return vec{side.result}(0.0); }}\n"
        for name, side in sides.items()
    )
    mains = (replace(side, name=f"{name}_main", given=(side.given[0], NORMAL)) for name, side in sides.items())
    encoder, decoder = mains
    if pair.is_packed:
        return [text + programs.packed_pair(prefix, encoder, decoder)] * 2
    return [text + programs.pair(prefix, pair.components, encoder, decoder, is_unit) for is_unit in (False, True)]


if __name__ == "__main__":
    children.limit_this_process()
    work, word, language, name, left = sys.argv[1:]
    number, count = map(int, left.split(":"))
    found = answer(
        UserFile(word), Path(work), language, kinds.BY_NAME[name], lambda s: _wall_in(s, Path(work)), (number, count)
    )
    print(json.dumps(found))
