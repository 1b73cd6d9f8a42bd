"""C source as a library of this process: compiled for this machine, and kept in the user's cache folder."""

from __future__ import annotations

import contextlib
import ctypes
import hashlib
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np

from ..machine.children import finished
from ..machine.devices import processor_kind
from ..machine.systems.people import how_to_install
from ..output import cache as kept

# Sums keep their order, and NaN and -0 are what they are. Integers wrap around, as JAX's do.
FLAGS = ("-O3", "-march=native", "-funroll-loops", "-fno-math-errno", "-fno-trapping-math", "-fwrapv")
FLAGS += ("-fPIC", "-shared", "-w")
# GCC would follow a number that is limited from above and below on each of its ways, and what is computed of it twice.
# Clang has no such option, and passes over the line.
STRAIGHT = '#pragma GCC optimize ("no-thread-jumps")'
HEADERS = ("stddef.h", "stdint.h", "string.h", "tgmath.h")
# The bits of a number as a number of another type.
VIEWED = """#define VIEWED(source, target, value) \\
    ({ source from_ = (value); target to_; memcpy(&to_, &from_, sizeof to_); to_; })
"""
COMPILING_S = 30
# From so many normals on the C compiler's code fills sets and measures them. It rounds a few products otherwise than
# XLA, which shows in the printed digits of 32 of 430 codecs, so smaller sets, which take seconds by either, have one
# arithmetic. What one compiler fills the other one reads more slowly, so both begin at the same size.
LARGE = 2**26
NONE = f"no C compiler: install one that is called cc ({how_to_install('gcc')})"
DIGEST = hashlib.sha256().digest_size


class NoCompilerError(Exception):
    """There is no C compiler, or it cannot compile."""


@cache
def compiler() -> str:
    """What the C compiler calls itself; empty where there is none."""
    if not shutil.which("cc"):
        return ""
    try:
        return (_said("--version").splitlines() or [""])[0]
    except NoCompilerError:
        return ""


def source(file: Path, function: str, given: Sequence[str], **numbers: int) -> str:
    """A file as C source that `library` can compile.

    Args:
        file: its C, below what this adds.
        function: what it calls, as `c_function` writes it.
        given: the types of what the function takes of the array `given`.
        numbers: further macros.
    """
    known = {name.upper(): str(number) for name, number in numbers.items()}
    known["GIVEN"] = "".join(f", ({kind})given[{at}]" for at, kind in enumerate(given))
    lines = [
        STRAIGHT,
        *(f"#include <{header}>" for header in HEADERS),
        *(f"#define {name} {what}" for name, what in known.items()),
    ]
    return "\n".join((*lines, VIEWED, function, file.read_text(encoding="utf-8")))


def library(text: str, *functions: str) -> ctypes.CDLL:
    """C source, compiled.

    Args:
        text: the source.
        functions: what it must define.

    Raises:
        NoCompilerError: it cannot be compiled here.
    """
    made = _made(text, functions)
    if isinstance(made, str):
        raise NoCompilerError(made)
    return made


@cache
def _made(text: str, functions: tuple[str, ...]) -> ctypes.CDLL | str:
    """A library, or why there is none: what failed is not tried again."""
    if not compiler():
        return NONE
    path = kept.folder() / "native" / f"{kept.key_of(text, *FLAGS, compiler(), *processor_kind())}.so"
    try:
        if not kept.is_off() and _is_whole(path):
            return _loaded(path, functions)
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            made = _compiled(text, Path(folder))
            found = _loaded(made, functions)
            if not kept.is_off():
                # A folder that cannot be written is no error.
                with contextlib.suppress(OSError):
                    kept.put(path, made.read_bytes())
            return found
    except (NoCompilerError, OSError) as error:
        return str(error)


def _compiled(text: str, folder: Path) -> Path:
    """The library, followed by the digest of its bytes: linkers pass over what follows."""
    written, path = folder / "library.c", folder / "library.so"
    written.write_text(text, encoding="utf-8", newline="\n")
    _said(*FLAGS, str(written), "-o", str(path), "-lm")
    data = path.read_bytes()
    path.write_bytes(data + hashlib.sha256(data).digest())
    return path


def _is_whole(path: Path) -> bool:
    """Whether a library is there as this user wrote it. A damaged one would end the process that loads it, and one of
    another user would do as it likes."""
    if not kept.is_private(path):
        return False
    try:
        data = path.read_bytes()
    except OSError:
        return False
    return hashlib.sha256(data[:-DIGEST]).digest() == data[-DIGEST:]


def _loaded(path: Path, functions: Sequence[str]) -> ctypes.CDLL:
    """A library, which its file need not outlive. Raises NoCompilerError where it lacks a function, and OSError."""
    try:
        found = ctypes.CDLL(str(path))
    except OSError:
        found = _loaded_elsewhere(path)
    if missing := [name for name in functions if not hasattr(found, name)]:
        raise NoCompilerError(f"cc: {', '.join(missing)} is not in what it made")
    return found


def _loaded_elsewhere(path: Path) -> ctypes.CDLL:
    """A copy of a library that lies where nothing may be executed, as some mount their home or their /tmp.

    Raises:
        OSError: it is not a library, or no folder will do.
    """
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        try:
            return ctypes.CDLL(shutil.copy(path, folder))
        except OSError:
            if kept.is_off():
                raise
    kept.make_folder(kept.folder())
    with tempfile.TemporaryDirectory(dir=kept.folder(), ignore_cleanup_errors=True) as folder:
        return ctypes.CDLL(shutil.copy(path, folder))


# Set once the compiler did not end.
_hangs: list[str] = []


def _said(*arguments: str) -> str:
    """What the C compiler prints. Raises NoCompilerError where it fails, and from then on where it did not end."""
    if _hangs:
        raise NoCompilerError(_hangs[0])
    try:
        done = finished(["cc", *arguments], COMPILING_S)
    except subprocess.TimeoutExpired as error:
        _hangs.append(f"cc did not end within {COMPILING_S} s")
        raise NoCompilerError(_hangs[0]) from error
    except OSError as error:
        raise NoCompilerError(f"cc: {error}") from error
    if done.returncode:
        said = [*done.stderr.splitlines(), f"exit status {done.returncode}"]
        raise NoCompilerError(f"cc: {next((line for line in said if 'error' in line), said[-1])}")
    return done.stdout


def address(array: np.ndarray) -> ctypes.c_void_p:
    """Where an array lies, for a function of a library; the array must outlive the call."""
    return ctypes.c_void_p(array.__array_interface__["data"][0])
