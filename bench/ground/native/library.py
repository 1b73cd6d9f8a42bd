"""C source as a library in this process: compiled for this machine, and kept in the user's cache folder."""

from __future__ import annotations

import contextlib
import ctypes
import hashlib
import shutil
import tempfile
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np

from ..compilers import tools
from ..compilers.text import Text, judged, own
from ..machine.systems.system_files import processor_kind
from ..output import cache as kept
from ..output.errors import MissingError

# Sums keep their order, products are rounded before they are added, and NaN and -0 are what they are. Integers wrap
# around, as JAX's do.
FLAGS = ("-O3", "-march=native", "-funroll-loops", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math")
FLAGS += ("-fwrapv", "-fPIC", "-shared", "-w")
HEAD = Path(__file__).with_suffix(".h")
COMPILING_S = 30
NONE = tools.MISSING[tools.C]
DIGEST = hashlib.sha256().digest_size


class NoCompilerError(Exception):
    """A C compiler is missing, or cannot compile."""


def compiler() -> str:
    """Return the first line of the C compiler's version, as text; empty if the compiler is missing."""
    try:
        return tools.first_line(tools.C)
    except MissingError:
        return ""


def source(file: Path, function: str, given: Sequence[str], **numbers: int) -> Text:
    """Return C source that `library` can compile: macros, a function and the file that calls it.

    Args:
        file: the C file, which follows the text that is added here.
        function: the function that the file calls, as `c_function` writes it.
        given: the types of the arguments that the function takes from the array `given`.
        numbers: other macros.
    """
    taken = "".join(f", ({kind})given[{i}]" for i, kind in enumerate(given))
    called = judged(f"#define GIVEN{taken and ' '}{taken}\n{function}", "c")
    return own(HEAD, **{name.upper(): number for name, number in numbers.items()}) + called + own(file)


def library(text: Text, *functions: str) -> ctypes.CDLL:
    """Compile C source, and return the loaded library.

    Args:
        text: the source.
        functions: the functions that the source must define.

    Raises:
        NoCompilerError: the source cannot be compiled here.
    """
    outcome = _made(text, functions)
    if isinstance(outcome, str):
        raise NoCompilerError(outcome)
    return outcome


@cache
def _made(text: Text, functions: tuple[str, ...]) -> ctypes.CDLL | str:
    """Return a library, or text on why it is missing. Failures are kept too, so that no compilation is tried
    again."""
    if not compiler():
        return NONE
    path = kept.folder() / "native" / f"{kept.key_of(text.content, *FLAGS, compiler(), *processor_kind())}.so"
    try:
        if not kept.is_off() and (own := _whole(path)):
            return _loaded(own, functions)
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            library_path = _compiled(text, Path(folder))
            handle = _loaded(library_path, functions)
            if not kept.is_off() and kept.keeps_code():
                # A folder that cannot be written is no error.
                with contextlib.suppress(OSError):
                    kept.put(path, library_path.read_bytes())
            return handle
    except (NoCompilerError, OSError) as error:
        return str(error)


def _compiled(text: Text, folder: Path) -> Path:
    """Compile a library and append the digest of its bytes, which linkers ignore. Return its path."""
    _compile(text, folder)
    path = folder / "library.so"
    data = path.read_bytes()
    path.write_bytes(data + hashlib.sha256(data).digest())
    return path


def _whole(path: Path) -> Path | None:
    """Return the path of an undamaged library that this user wrote, without links; None if there is no such file. A
    damaged library would end the process that loads it, and another user's library could do anything."""
    if not (own := kept.loadable(path)):
        return None
    try:
        data = own.read_bytes()
    except OSError:
        return None
    return own if hashlib.sha256(data[:-DIGEST]).digest() == data[-DIGEST:] else None


def _loaded(path: Path, functions: Sequence[str]) -> ctypes.CDLL:
    """Return a loaded library, which keeps working after its file is deleted. Raises NoCompilerError if the library
    lacks a function, and OSError if it cannot be loaded."""
    try:
        handle = ctypes.CDLL(str(path))
    except OSError:
        handle = _loaded_elsewhere(path)
    if missing := [name for name in functions if not hasattr(handle, name)]:
        raise NoCompilerError(f"cc: the compiled library lacks {', '.join(missing)}")
    return handle


def _loaded_elsewhere(path: Path) -> ctypes.CDLL:
    """Load a copy of a library whose folder forbids execution, as home folders or /tmp do on some systems.

    Raises:
        OSError: the file is not a library, or no folder allows execution.
    """
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        try:
            return ctypes.CDLL(shutil.copy(path, folder))
        except OSError:
            if kept.is_off() or not kept.keeps_code():
                raise
    kept.make_folder(kept.folder())
    with tempfile.TemporaryDirectory(dir=kept.folder(), ignore_cleanup_errors=True) as folder:
        return ctypes.CDLL(shutil.copy(path, folder))


# Set once the compiler did not end.
_hangs: list[str] = []


def _compile(text: Text, folder: Path) -> None:
    """Compile a text to library.so in a folder. Raises NoCompilerError if that fails, and on every later call if
    the compiler crashed or did not end."""
    if _hangs:
        raise NoCompilerError(_hangs[0])
    words = [*FLAGS, "library.c", "-o", "library.so", "-lm"]
    try:
        done = tools.run(tools.C, words, folder, {"library.c": text}, COMPILING_S)
    except tools.ToolError as error:
        _hangs.append(str(error))
        raise NoCompilerError(_hangs[0]) from error
    except MissingError as error:
        raise NoCompilerError(str(error)) from error
    if done.status:
        lines = [*done.err.splitlines(), f"exit status {done.status}"]
        raise NoCompilerError(f"cc: {next((line for line in lines if 'error' in line), lines[-1])}")


def address(array: np.ndarray) -> ctypes.c_void_p:
    """Return the address of an array, for a function of a library; the array must outlive the call."""
    return ctypes.c_void_p(array.__array_interface__["data"][0])
