"""The functions that Slang's compiler finds in a text, with their inputs and outputs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ...ground.compilers.slang import Compiled, api
from .pairs import PACKED, Function, Parameter, Place

# SlangTypeKind, SlangScalarType and SlangModifierID of slang.h.
STRUCTURE, VECTOR, SCALAR = 1, 4, 5
SCALARS = {1: "void", 2: "bool", 3: "int", 4: "uint", 7: "half", 8: "float", 9: "double"}
OUT, INOUT = 9, 10
FLOATS, NUMBERS = ("half", "float"), ("float", "uint", "int", "bool")


def functions_of(compiled: Compiled, names: Mapping[str, str]) -> list[Function]:
    """Return the functions with these names, including all overloads. Names that exist only in a branch that is not
    compiled are skipped.

    Args:
        names: the functions' names in the compiled text, by their own names; the library does not tolerate its own
            functions' names.
    """
    reflection = api().reflection(compiled.request)
    handles = [(name, api().find(reflection, spelled.encode())) for name, spelled in names.items()]
    each = ((name, overload) for name, several in handles if several for overload in _overloads(several))
    return list(dict.fromkeys(_function(name, overload) for name, overload in each))


def _overloads(function: int) -> list[int]:
    library = api()
    if not library.is_overloaded(function):
        return [function]
    overloads = (library.overload(function, i) for i in range(library.overloads(function)))
    return [overload for overload in overloads if overload]


def _function(name: str, function: int) -> Function:
    library = api()
    parameters = [_parameter(library.parameter(function, i)) for i in range(library.parameters(function))]
    # What has a value of its own need not be given.
    given = [parameter for parameter in parameters if not parameter.has_default]
    result = library.result(function)
    sizes = tuple(0 if parameter.is_made else size_of(parameter.places) for parameter in given)
    takes = given[0].kind if given and not given[0].is_made else ""
    results = tuple(_places("", result))
    return Function(
        name,
        size_of(results),
        sizes,
        _kind(result),
        takes if takes in PACKED else "",
        tuple(parameters),
        results,
    )


def size_of(places: Sequence[Place]) -> int:
    """Return the number of components if the places are a single vector of two or three floats, else 0."""
    whole = places[0] if len(places) == 1 and "." not in places[0].path else None
    return whole.size if whole and whole.kind == "float" and whole.size in (2, 3) else 0


def _parameter(variable: int) -> Parameter:
    library = api()
    name, kind = (library.variable_name(variable) or b"").decode(), library.type_of(variable)
    is_out, is_inout = (bool(library.modifier(variable, mark)) for mark in (OUT, INOUT))
    places = tuple(_places(name, kind))
    return Parameter(
        name, _kind(kind), is_inout or not is_out, is_out or is_inout, bool(library.has_default(variable)), places
    )


def _places(path: str, kind: int) -> Iterator[Place]:
    """Yield the numbers and vectors of a type as places; for a structure, those of each field, as PATH.FIELD."""
    library = api()
    scalar = SCALARS.get(library.scalar(kind), "")
    scalar = "float" if scalar in FLOATS else scalar
    if library.kind(kind) in (VECTOR, SCALAR) and scalar in NUMBERS:
        yield Place(path, scalar, int(library.count(kind)) if library.kind(kind) == VECTOR else 1)
    elif library.kind(kind) == STRUCTURE:
        for field in (library.field(kind, i) for i in range(library.fields(kind))):
            inner = (library.variable_name(field) or b"").decode()
            yield from _places(f"{path}.{inner}" if path else inner, library.type_of(field))


def _kind(kind: int) -> str:
    """Return the HLSL name of a type, given the library's handle for the type."""
    library = api()
    scalar = SCALARS.get(library.scalar(kind), "")
    if library.kind(kind) == VECTOR and scalar:
        return f"{scalar}{library.count(kind)}"
    return scalar if library.kind(kind) == SCALAR and scalar else (library.type_name(kind) or b"").decode()
