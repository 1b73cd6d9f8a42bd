"""Metal's shading language: run by clang with a small Metal library of our own, not by Metal.

Where Apple's compiler `metal` is on the path as well, it checks the file's syntax first.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from .....gbuffer.gl.shader import read_shader
from ....ground.compilers import tools
from ....ground.compilers.text import own
from ....ground.output.errors import MissingError
from ...judged import judged_text
from .c import EXACT, LIMITS, MAIN, called, compiled, compilers_wall, defined, macros
from .interface import Interface, Run, Runner
from .sources import compile_with, folder

WRAPPER, LIBRARY = Path(__file__).with_suffix(".cpp"), Path(__file__).with_name("metal_stdlib.h")
# Metal has no double: a number without a letter is a float.
OPTIONS = ("-std=c++17", *EXACT, "-w", "-Xclang", "-cl-single-precision-constant")
# A texture's name where there is no table.
NONE = "run_none"


def compiler() -> Path:
    """Return clang. Raises MissingError."""
    return tools.path_of(tools.CLANG)


def _has_metal() -> bool:
    try:
        return bool(tools.path_of(tools.METAL))
    except MissingError:
        return False


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """The file as a program. Raises MissingError, ShaderError."""
    text = read_shader(path)
    with folder() as place:
        files = {"code.metal": judged_text(text, "msl")}
        if _has_metal():
            compile_with(tools.METAL, ["-x", "metal", "-fsyntax-only", "code.metal"], place, files)
        files |= {"metal_stdlib": own(LIBRARY), "main.c": own(MAIN)}
        named = interface.defines_with(", ".join, "{}{{{}}}") | _table_macros(text, interface)
        files["run.cpp"] = defined(named, "msl") + own(WRAPPER)
        defines = macros({**LIMITS, "RUN_TABLE_COUNT": len(interface.tables), "_GNU_SOURCE": 1})
        _write(interface.tables, place)
        words = [*OPTIONS, "-I", ".", *defines, "run.cpp", "main.c"]
        wall = None if interface.is_ours else compilers_wall(tools.CLANG, place)
        yield called(compiled(tools.CLANG, words, place, files, path, wall), path, interface)


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
    checked = f"syntax by {tools.first_line(tools.METAL)}, " if _has_metal() else ""
    return f"{checked}{tools.first_line(tools.CLANG)}, not by Metal"


RUNNER = Runner(prepared, how)
