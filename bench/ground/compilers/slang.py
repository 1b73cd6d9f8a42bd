"""Slang's compiler as a library: the results of compiling a text.

The C interface is that of slang.h, which is the same in every build: in the wheels `slangpy` and `slangtorch`, and in
the folders around a `slangc` on the path. A text that the compiler cannot handle ends the process, so call the
compiler in a child process.
"""

from __future__ import annotations

import ctypes as c
import importlib.util
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from mmap import ACCESS_READ, mmap
from pathlib import Path
from weakref import finalize

from ..output.errors import MissingError
from .text import RefusedError, Text, judged

MISSING = "no Slang: its compiler is not installed; install it (pip install slangpy)"
# Packages with the library in one of these folders. None of them is imported: they need what is not installed.
WHEELS, FOLDERS = ("slangpy", "slangtorch"), ("", "bin", "lib")
NAMES = ("libslang-compiler.so*", "slang-compiler.dll", "libslang-compiler*.dylib", "libslang.so*", "slang.dll")
# SlangLanguageVersion of 2025.
LANGUAGE = 2025
# What a text is called in messages.
GIVEN = "given.slang"


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
    """Return the path of Slang's library.

    Raises:
        MissingError: the library is not found; the message is one line that says what to install.
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


class Api:
    """The functions of slang.h that are used here, as Python calls them."""

    def __init__(self) -> None:
        self._library = c.CDLL(str(path_of_library()))
        make = self.function("slang_createGlobalSession2", c.c_int, c.POINTER(_Description), c.POINTER(c.c_void_p))
        self.session = c.c_void_p()
        if make(c.byref(_Description(c.sizeof(_Description), 0, LANGUAGE, True)), c.byref(self.session)):
            raise MissingError(f"{path_of_library()}: Slang's compiler does not start; reinstall it")
        text, pointer, number = c.c_char_p, c.c_void_p, c.c_uint
        self.request = self.function("spCreateCompileRequest", pointer, pointer)
        self.destroy = self.function("spDestroyCompileRequest", None, pointer)
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

    def function(self, name: str, result: type | None, *given: type) -> Callable:
        """Return a library function by its C name, given the ctypes of its result and its arguments."""
        return c.CFUNCTYPE(result, *given)((name, self._library))


@cache
def api() -> Api:
    """Return the functions of Slang's library, loaded once per process. Raises MissingError without the library."""
    return Api()


@cache
def knows(word: str) -> bool:
    """Whether the compiler may know a word, judging by its library, which contains keywords and function names as
    text."""
    with path_of_library().open("rb") as file, mmap(file.fileno(), 0, access=ACCESS_READ) as library:
        # Of a build that packs its text nothing is known.
        return library.find(word.encode()) >= 0 or library.find(b"__intrinsic_asm") < 0


class Compiled:
    """The compiler's result for a text. Its memory, 1 MB or more, is freed with the object.

    Attributes:
        request: for reflection, see `Api`; anything obtained from the request is valid as long as the object exists.
        failed: whether the compiler rejected the text.
        said: the compiler's messages.
    """

    def __init__(self, words: Sequence[str]):
        self.request = api().request(api().session)
        finalize(self, api().destroy, self.request)
        given = (c.c_char_p * len(words))(*[word.encode() for word in words])
        self.failed = bool(api().take(self.request, given, len(words)) or api().compile(self.request))
        self.said = (api().said(self.request) or b"").decode(errors="replace")

    @property
    def code(self) -> str:
        """The text of the only entry point."""
        return (api().code(self.request, 0) or b"").decode(errors="replace")


def compiled(text: str, options: Sequence[str], folder: Path) -> Compiled:
    """Return the compiler's result for a text, even if the compiler rejects the text.

    Args:
        options: the compiler's options for the target, and macros.
        folder: an empty folder to work in.

    Raises:
        RefusedError: the compiler may not be given the text.
    """
    given = folder / GIVEN
    words = [str(given), "-enable-machine-readable-diagnostics", *options]

    def expanded(plain: Text) -> str:
        given.write_text(plain.content, encoding="utf-8", newline="\n")
        return _expanded(words)

    try:
        judged(text, "slang", expanded, knows)
    except _NotExpandedError as error:
        return error.compiled
    return Compiled(words)


class _NotExpandedError(Exception):
    """A text that the preprocessor refuses."""

    def __init__(self, compiled: Compiled):
        super().__init__(compiled.said)
        self.compiled = compiled


def _expanded(words: Sequence[str]) -> str:
    """Return the preprocessor's output for a file, as printed by the library.

    Raises:
        _NotExpandedError: the preprocessor rejects the file.
        RefusedError: the output cannot be captured here, so that nothing would be checked.
    """
    if not _is_seen(Path(words[0]).with_name("seen.slang")):
        raise RefusedError(0, "Slang's compiler does not print the output of its preprocessor")
    return _printed(words)


@cache
def _is_seen(probe: Path) -> bool:
    probe.write_text(probe.stem, encoding="utf-8", newline="\n")
    return probe.stem in _printed([str(probe)])


def _printed(words: Sequence[str]) -> str:
    """Return the preprocessed text, which the library prints to descriptor 1. Raises _NotExpandedError if
    preprocessing fails."""
    with tempfile.TemporaryFile() as file:
        own = os.dup(1)
        os.dup2(file.fileno(), 1)
        try:
            done = Compiled([*words, "-E"])
        finally:
            os.dup2(own, 1)
            os.close(own)
        if done.failed:
            raise _NotExpandedError(done)
        file.seek(0)
        return file.read().decode(errors="replace")
