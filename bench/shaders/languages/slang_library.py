"""Slang's compiler as a library: what it makes of a text, and which functions it finds in it.

Its C interface is that of slang.h, which every build of it has: the wheels `slangpy` and `slangtorch`, and the folders
around a `slangc` on the path. A text that it cannot bear ends the process: it is called in a child.
"""

from __future__ import annotations

import ctypes as c
import importlib.util
import shutil
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path

from ...ground.output.errors import MissingError
from .pairs import PACKED, Function, Parameter, Place

MISSING = "no Slang: its compiler is not there; install it (pip install slangpy)"
# Packages with the library in one of these folders. None of them is imported: they need what is not installed.
WHEELS, FOLDERS = ("slangpy", "slangtorch"), ("", "bin", "lib")
NAMES = ("libslang-compiler.so*", "slang-compiler.dll", "libslang-compiler*.dylib", "libslang.so*", "slang.dll")
# SlangLanguageVersion of 2025.
LANGUAGE = 2025
# SlangTypeKind, SlangScalarType and SlangModifierID.
STRUCTURE, VECTOR, SCALAR = 1, 4, 5
SCALARS = {1: "void", 2: "bool", 3: "int", 4: "uint", 7: "half", 8: "float", 9: "double"}
OUT, INOUT = 9, 10
FLOATS, NUMBERS = ("half", "float"), ("float", "uint", "int", "bool")


class _Description(c.Structure):
    """SlangGlobalSessionDesc."""

    _fields_ = (
        ("structure_size", c.c_uint32),
        ("api_version", c.c_uint32),
        ("language_version", c.c_uint32),
        ("has_glsl", c.c_bool),
        ("reserved", c.c_uint32 * 16),
    )


@cache
def path_of_library() -> Path:
    """Where the library is.

    Raises:
        MissingError: one line that says what to install.
    """
    for folder in _folders():
        for name in NAMES:
            for path in sorted(folder.glob(name)):
                return path
    raise MissingError(MISSING)


def _folders() -> Iterator[Path]:
    for wheel in WHEELS:
        spec = importlib.util.find_spec(wheel)
        for folder in (spec and spec.submodule_search_locations) or ():
            yield from (Path(folder) / inner for inner in FOLDERS)
    if program := shutil.which("slangc"):
        own = Path(program).resolve().parent
        yield from (own, own.parent / "lib")


class _Api:
    """The functions of slang.h that are used here, as Python calls them."""

    def __init__(self) -> None:
        self._library = c.CDLL(str(path_of_library()))
        make = self.function("slang_createGlobalSession2", c.c_int, c.POINTER(_Description), c.POINTER(c.c_void_p))
        described = _Description(c.sizeof(_Description), 0, LANGUAGE, True)
        self.session = c.c_void_p()
        if make(c.byref(described), c.byref(self.session)):
            raise MissingError(f"{path_of_library()}: Slang's compiler does not start; install it anew")
        text, pointer, number = c.c_char_p, c.c_void_p, c.c_uint
        self.request = self.function("spCreateCompileRequest", pointer, pointer)
        self.take = self.function("spProcessCommandLineArguments", c.c_int, pointer, c.POINTER(text), c.c_int)
        self.compile = self.function("spCompile", c.c_int, pointer)
        self.said = self.function("spGetDiagnosticOutput", text, pointer)
        self.code = self.function("spGetEntryPointSource", text, pointer, c.c_int)
        self.reflection = self.function("spGetReflection", pointer, pointer)
        self.find = self.function("spReflection_FindFunctionByName", pointer, pointer, text)
        self.is_overloaded = self.function("spReflectionFunction_isOverloaded", c.c_bool, pointer)
        self.overloads = self.function("spReflectionFunction_getOverloadCount", number, pointer)
        self.overload = self.function("spReflectionFunction_getOverload", pointer, pointer, number)
        self.result = self.function("spReflectionFunction_GetResultType", pointer, pointer)
        self.parameters = self.function("spReflectionFunction_GetParameterCount", number, pointer)
        self.parameter = self.function("spReflectionFunction_GetParameter", pointer, pointer, number)
        self.variable_name = self.function("spReflectionVariable_GetName", text, pointer)
        self.fields = self.function("spReflectionType_GetFieldCount", number, pointer)
        self.field = self.function("spReflectionType_GetFieldByIndex", pointer, pointer, number)
        self.type_of = self.function("spReflectionVariable_GetType", pointer, pointer)
        self.modifier = self.function("spReflectionVariable_FindModifier", pointer, pointer, number)
        self.has_default = self.function("spReflectionVariable_HasDefaultValue", c.c_bool, pointer)
        self.kind = self.function("spReflectionType_GetKind", number, pointer)
        self.count = self.function("spReflectionType_GetElementCount", c.c_size_t, pointer)
        self.scalar = self.function("spReflectionType_GetScalarType", number, pointer)
        self.type_name = self.function("spReflectionType_GetName", text, pointer)

    def function(self, name: str, result: type | None, *given: type) -> c._NamedFuncPointer:
        """A function of the library with its types."""
        found = self._library[name]
        found.restype, found.argtypes = result, given
        return found


@cache
def _api() -> _Api:
    return _Api()


class Compiled:
    """What the compiler made of a text.

    Attributes:
        failed: whether it refused the text.
        said: its messages.
    """

    def __init__(self, words: Sequence[str]):
        api = _api()
        self._request = api.request(api.session)
        given = (c.c_char_p * len(words))(*[word.encode() for word in words])
        self.failed = bool(api.take(self._request, given, len(words)) or api.compile(self._request))
        self.said = (api.said(self._request) or b"").decode(errors="replace")

    @property
    def code(self) -> str:
        """The text of the only entry point."""
        return (_api().code(self._request, 0) or b"").decode(errors="replace")

    def functions(self, names: Sequence[str]) -> list[Function]:
        """The functions of these names, overloads each; a name that only another branch of the text has gives none.

        Args:
            names: what the text itself defines: the library does not bear names of its own.
        """
        api = _api()
        reflection = api.reflection(self._request)
        found = [(name, api.find(reflection, name.encode())) for name in names]
        each = ((name, one) for name, several in found if several for one in _overloads(several))
        return list(dict.fromkeys(_function(name, one) for name, one in each))


def _overloads(function: int) -> list[int]:
    api = _api()
    if not api.is_overloaded(function):
        return [function]
    found = (api.overload(function, at) for at in range(api.overloads(function)))
    return [one for one in found if one]


def _function(name: str, function: int) -> Function:
    api = _api()
    parameters = [_parameter(api.parameter(function, at)) for at in range(api.parameters(function))]
    # What has a value of its own need not be given.
    given = [one for one in parameters if not one.has_default]
    result = api.result(function)
    sizes = tuple(0 if one.is_made else size_of(one.places) for one in given)
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
    """How many numbers a vector of two or three floats has; 0 of another type."""
    whole = places[0] if len(places) == 1 and "." not in places[0].path else None
    return whole.size if whole and whole.kind == "float" and whole.size in (2, 3) else 0


def _parameter(variable: int) -> Parameter:
    api = _api()
    name, kind = (api.variable_name(variable) or b"").decode(), api.type_of(variable)
    is_out, is_inout = (bool(api.modifier(variable, mark)) for mark in (OUT, INOUT))
    places = tuple(_places(name, kind))
    return Parameter(
        name, _kind(kind), is_inout or not is_out, is_out or is_inout, bool(api.has_default(variable)), places
    )


def _places(path: str, kind: int) -> Iterator[Place]:
    """The numbers and vectors of a type; those of a structure one by one."""
    api = _api()
    scalar = SCALARS.get(api.scalar(kind), "")
    scalar = "float" if scalar in FLOATS else scalar
    if api.kind(kind) in (VECTOR, SCALAR) and scalar in NUMBERS:
        yield Place(path, scalar, int(api.count(kind)) if api.kind(kind) == VECTOR else 1)
    elif api.kind(kind) == STRUCTURE:
        for field in (api.field(kind, at) for at in range(api.fields(kind))):
            inner = (api.variable_name(field) or b"").decode()
            yield from _places(f"{path}.{inner}" if path else inner, api.type_of(field))


def _kind(kind: int) -> str:
    """A type as HLSL writes it."""
    api = _api()
    scalar = SCALARS.get(api.scalar(kind), "")
    if api.kind(kind) == VECTOR and scalar:
        return f"{scalar}{api.count(kind)}"
    return scalar if api.kind(kind) == SCALAR and scalar else (api.type_name(kind) or b"").decode()
