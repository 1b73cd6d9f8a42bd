"""C99: compiled to a library by the system's compiler, without fused or reordered arithmetic."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from ....gbuffer.gl.shader import ShaderError, read_shader
from .interface import MADE, Interface, Ran, Run, Runner, ran_of, rows_of
from .sources import compile_with, first_line, folder, on_path

WRAPPER = Path(__file__).with_suffix(".c")
EXACT = ("-O2", "-ffp-contract=off", "-fPIC", "-shared")
INSTALL = "Debian: apt-get install gcc"


def compiler() -> str:
    """The C compiler. Raises MissingError."""
    return on_path("cc", INSTALL)


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """The file as a library. Raises MissingError, ShaderError."""
    with folder() as place:
        (place / "code.h").write_text(read_shader(path), encoding="utf-8")
        options = ("-std=c99", *EXACT, "-iquote", str(place), "-iquote", str(path.parent), *_macros(interface))
        command, names = [compiler(), *options, str(WRAPPER), "-lm"], {str(place / "code.h"): str(path)}
        yield called(loaded(command, place / "code.so", names), interface)


def _macros(interface: Interface) -> list[str]:
    prefix, words = interface.prefix, interface.words
    types = {"RUN_VEC3": f"{prefix}_vec3", "RUN_VEC4": f"{prefix}_vec4", "RUN_CODE": f"{prefix}_vec{interface.size}"}
    types["RUN_TEXEL"] = f"{prefix}_uvec{words}" if words > 1 else "uint32_t"
    return macros(interface.defines | types)


def macros(values: dict[str, object]) -> list[str]:
    """Options that define macros for a compiler of C."""
    return [f"-D{name}={value}" for name, value in values.items()]


def loaded(command: Sequence[str], made: Path, names: Mapping[str, str]) -> ctypes.CDLL:
    """The library that a compiler makes. Raises ShaderError, whose message has other names for some files."""
    try:
        compile_with([*command, "-o", str(made)])
    except ShaderError as error:
        said = str(error)
        for old, new in names.items():
            said = said.replace(old, new)
        raise ShaderError(said) from error
    return ctypes.CDLL(str(made))


def called(library: ctypes.CDLL, interface: Interface) -> Run:
    """What a library does with rows, by its function `run_six`."""
    six = library.run_six
    six.argtypes, six.restype = [ctypes.c_size_t, *[ctypes.c_void_p] * 3], None

    def run(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
        given, count = rows_of(n, view, texels), len(n)
        rows, words = np.zeros((MADE * count, 4), np.float32), np.zeros((count, 4), np.uint32)
        six(count, given.ctypes.data, rows.ctypes.data, words.ctypes.data)
        return ran_of(rows, words, interface)

    return run


def how() -> str:
    """The compiler. Raises MissingError."""
    return f"{first_line(compiler(), '--version')}, {' '.join(EXACT[:2])}"


RUNNER = Runner(prepared, how)
