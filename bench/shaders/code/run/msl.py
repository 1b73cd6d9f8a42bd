"""Metal's shading language: run by clang with a small Metal library of our own, not by Metal.

Where Apple's compiler `metal` is on the path as well, it checks the file's syntax first.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from .....gbuffer.gl.shader import read_shader
from ....ground.machine.systems.people import how_to_install
from .c import EXACT, LIMITS, MAIN, called, compiled, macros
from .interface import Interface, Run, Runner
from .sources import compile_with, first_line, folder, required

WRAPPER, LIBRARY = Path(__file__).with_suffix(".cpp"), Path(__file__).with_name("metal_stdlib.h")
# Metal has no double: a number without a letter is a float.
OPTIONS = ("-std=c++17", *EXACT, "-w", "-Xclang", "-cl-single-precision-constant")
INSTALL = f"no clang: clang++ is not on the path; install it ({how_to_install('clang')})"
METAL = "metal"
# A texture's name where there is no table.
NONE = "run_none"


def compiler() -> str:
    """clang. Raises MissingError."""
    return required(shutil.which("clang++"), INSTALL)


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """The file as a program. Raises MissingError, ShaderError."""
    clang, text = compiler(), read_shader(path)
    if metal := shutil.which(METAL):
        compile_with([metal, "-x", "metal", "-fsyntax-only", str(path)])
    with folder() as place:
        (place / "code.metal").write_text(text, encoding="utf-8", newline="\n")
        (place / "metal_stdlib").write_text(f'#include "{LIBRARY}"\n', encoding="utf-8", newline="\n")
        defines = macros(interface.defines_with(", ".join, "{}{{{}}}") | _table_macros(text, interface))
        defines += macros({**LIMITS, "RUN_TABLE_COUNT": len(interface.tables), "_GNU_SOURCE": 1})
        command = [clang, *OPTIONS, "-I", str(place), *defines, str(WRAPPER), str(MAIN)]
        _write(interface.tables, place)
        yield called(compiled(command, place / "code", {str(place / "code.metal"): str(path)}), path, interface)


def _table_macros(text: str, interface: Interface) -> dict[str, object]:
    """Macros that name the tables, and those that the encoder and the decoder take behind their other arguments."""
    names = sorted(interface.tables) or [NONE]
    pointers = ", ".join(f"&{name}" for name in names)
    taken = {
        f"RUN_{side.upper()}_TABLES": _table_arguments(text, f"{interface.prefix}_{side}", names) for side in SIDES
    }
    return {"RUN_TABLES": ", ".join(names), "RUN_POINTERS": pointers, **taken}


SIDES = ("encode", "decode")


def _table_arguments(text: str, function: str, tables: list[str]) -> str:
    """The tables that a function takes, as further arguments of its call."""
    declared = re.search(rf"\b\w+\s+{function}\s*\(([^)]*)\)\s*\{{", text)
    words = re.findall(r"\w+", declared[1]) if declared else []
    return "".join(f", {name}" for name in tables if name in words)


def _write(tables: Mapping[str, np.ndarray], place: Path) -> None:
    """The tables as the program reads them, in the order of their names."""
    for at, name in enumerate(sorted(tables)):
        height, width, channels = tables[name].shape
        texels = np.zeros((height, width, 4), "<f4")
        texels[..., :channels] = tables[name]
        texels.tofile(place / f"table{at}.bin")
        np.array([width, height], "<u4").tofile(place / f"table{at}.size")


def how() -> str:
    """clang, and that it is not Metal. Raises MissingError."""
    checked = f"syntax by {first_line(METAL, '--version')}, " if shutil.which(METAL) else ""
    return f"{checked}{first_line(compiler(), '--version')}, not by Metal"


RUNNER = Runner(prepared, how)
