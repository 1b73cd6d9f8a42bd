"""Translation of WGSL to GLSL by this project's own translator, without other tools."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from ...ground.compilers.lines import blank
from ..translator import tree
from ..translator.glsl_writer import GlslWriter
from ..translator.reduce import numbered, reduced
from ..translator.wgsl_parser import read_wgsl
from .pairs import Function, Parameter, Place
from .programs import Read, TranslationError, template
from .source import Source
from .wiring import FREE, RESULT, with_words

TOOLS = ()
SIZES = {"vec2": 2, "vec3": 3}
TYPES = {"float": "f32", "int": "i32", "uint": "u32", "bool": "bool"}
# The types of structures' fields by their names, by the structures'.
_Structs = Mapping[str, Mapping[str, str]]
# What preprocessors of engines add to the language: nothing that is imported is there.
_IMPORT = re.compile(r"^[ \t]*#(?:import|define_import_path)\b[^\n{]*(?:\{[^}]*\})?[^\n]*$", re.M)
# 3:14: y is not known here
_PLACED = re.compile(r"(\d+):(\d+): (.*)", re.S)


def read(source: Source, folder: Path) -> Read:  # noqa: ARG001 (no tool works there)
    """Return a WGSL source, with its imports blanked, and its functions. Raises TranslationError."""
    if source.settings.defines:
        raise TranslationError(f"{source.path}: WGSL has no macros; leave out -D")
    if len(source.mains) > 1:
        raise TranslationError(f"{source.path}: WGSL in two files is not supported; join the files")
    source = source.with_text(_IMPORT.sub(lambda match: blank(match[0]), source.text))
    return Read(
        source, [_function(function) for function in _checked(source, lambda: read_wgsl(source.text)).functions]
    )


def _function(defined: tree.Function) -> Function:
    given = tuple(SIZES.get(p.kind, 0) for p in defined.parameters)
    return Function(tree.plain_name(defined), SIZES.get(defined.kind, 0), given, defined.kind)


def with_places(source: Source, functions: Sequence[Function]) -> list[Function]:
    """Return functions of a source, completed with the numbers and vectors of their parameters and results. Raises
    TranslationError."""
    program = _checked(source, lambda: read_wgsl(source.text))
    structs = {struct.name: struct.kinds for struct in program.structs}
    defined = {tree.plain_name(function): function for function in program.functions}
    return [_with_places(function, defined[function.name], structs) for function in functions]


def _with_places(function: Function, defined: tree.Function, structs: _Structs) -> Function:
    parameters = [
        Parameter(p.name, p.kind, True, False, False, tuple(_places(p.name, p.kind, structs)))
        for p in defined.parameters
    ]
    return replace(function, parameters=tuple(parameters), results=tuple(_places("", defined.kind, structs)))


def _places(path: str, kind: str, structs: _Structs) -> Iterator[Place]:
    for name, inner in structs.get(kind, {}).items():
        yield from _places(f"{path}.{name}" if path else name, inner, structs)
    if tree.scalar_of(kind) in tree.SCALARS and kind == tree.vector(tree.scalar_of(kind), tree.size_of(kind)):
        yield Place(path, tree.scalar_of(kind), tree.size_of(kind))


def _free(place: Place) -> str:
    """Return the WGSL text of an unbound input's value: the value of its type in `FREE`, repeated for a vector."""
    value = FREE[place.kind]
    return value if place.size == 1 else f"vec{place.size}<{TYPES[place.kind]}>({value})"


def adapter(function: Function, name: str, given: Mapping[str, str], places: Sequence[Place | None]) -> str:
    """Return the text of an adapter in WGSL, as `wiring.adapter` does in HLSL."""
    words = {"n": "normalbench_n", "view": "normalbench_more", "vec4": "vec4f"}
    of_structs = [
        parameter for parameter in function.parameters if any("." in place.path for place in parameter.places)
    ]
    lines = [f"var wired_{parameter.name}: {parameter.kind};" for parameter in of_structs]
    lines += [f"wired_{place.path} = {_free(place)};" for parameter in of_structs for place in parameter.places]
    lines += [f"wired_{path} = {with_words(value, words)};" for path, value in given.items() if "." in path]
    values = {path: with_words(value, words) for path, value in given.items()}
    arguments = [values.get(parameter.name, f"wired_{parameter.name}") for parameter in function.parameters]
    lines.append(f"let {RESULT} = {function.name}({', '.join(arguments)});")
    parts = ["0.0" if place is None else f"{RESULT}.{place.path}".rstrip(".") for place in places]
    parts += ["0.0"] * (4 - sum(place.size if place else 1 for place in places))
    body = "\n    ".join([*lines, f"return vec4f({', '.join(parts)});"])
    return f"fn {name}({words['n']}: vec4f, {words['view']}: vec3f) -> vec4f {{\n    {body}\n}}\n"


def shader(source: Source, function: Function, folder: Path) -> str:  # noqa: ARG001 (no tool works there)
    """Return the text of a GLSL fragment shader that calls a function of a WGSL source (see `plain.py`). Raises
    TranslationError."""
    program = _checked(source, lambda: reduced(read_wgsl(source.text), {function.name: "entry"}, "wgsl", ""))
    # Names that end in a number are those that `plain.py` makes its own: none is a word of GLSL's.
    numbered(program, "wgsl")
    entry = program.functions[-1]
    given = ["wgsl_given_0", "wgsl_view_0"][: len(entry.parameters)]
    view = "layout(location = 1) in vec3 wgsl_view_0;" if len(given) > 1 else ""
    words = {"VIEW": view, "RESULT": f"vec{function.result}", "GIVEN": f"vec{function.given[0]}"}
    entry_text = template("entry.frag", FUNCTION=entry.name, ARGUMENTS=", ".join(given), **words)
    return _checked(source, lambda: GlslWriter("wgsl", {}).program(program)) + entry_text


def _checked(source: Source, make):
    """Call `make` and return its result. Raises TranslationError, at the user's line and column if known."""
    try:
        return make()
    except tree.TranslationError as error:
        placed = _PLACED.fullmatch(str(error))
        if not placed:
            raise TranslationError(f"{source.path}: {error}") from error
        raise TranslationError(source.explained(int(placed[1]), placed[3], column=int(placed[2]))) from error
