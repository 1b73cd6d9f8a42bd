"""C99: compiled by the system's compiler, without fused or reordered arithmetic, to a program that limits itself."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import numpy as np

from .....gbuffer.gl.shader import ShaderError, read_shader
from ....ground.compilers import tools
from ....ground.compilers.text import Text, own
from ....ground.machine import children
from ....ground.machine.systems import walls
from ....ground.machine.systems.walls import Wall
from ....ground.output.errors import MissingError
from ...judged import judged_text
from .interface import MADE, Interface, Ran, Run, Runner, ran_of, rows_of
from .sources import compile_with, folder, run_apart

WRAPPER, MAIN = Path(__file__).with_suffix(".c"), Path(__file__).with_name("main.c")
EXACT = ("-O2", "-ffp-contract=off")
LIMITS = {"RUN_SECONDS": children.SECONDS, "RUN_MEMORY": f"{children.MEMORY}ull", "RUN_FILE": f"{children.FILE}ull"}
# POSIX's calls for the program around the file; the file itself is C99.
LANGUAGE = ("-std=c99", "-D_GNU_SOURCE", "-iquote", ".")
PROGRAM = "code"


def compiler() -> Path:
    """Return the path of the C compiler. Raises MissingError if it is not installed."""
    return tools.path_of(tools.C)


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """Compile a C file to a program, and yield a function that runs it on rows. Raises MissingError, ShaderError."""
    with built(path, interface, tools.C, [*EXACT, *macros(LIMITS)]) as run:
        yield run


@contextmanager
def built(path: Path, interface: Interface, tool: str, options: Sequence[str]) -> Iterator[Run]:
    """Compile a C file with a compiler and its options, and yield a function that runs it on rows. Raises
    MissingError, ShaderError."""
    text = read_shader(path)
    with folder() as place:
        files = {
            "code.h": judged_text(text, "c"),
            "run.c": defined(_macros(interface)) + own(WRAPPER),
            "main.c": own(MAIN),
        }
        # The tables that it includes lie next to it.
        tables = [path.with_name(name) for name in re.findall(r'^#include "(\w+_tables\.h)"$', text, re.M)]
        files |= {table.name: judged_text(read_shader(table), "c") for table in tables}
        words = [*LANGUAGE, *options, "run.c", "main.c", "-lm"]
        wall = None if interface.is_ours else compilers_wall(tool, place)
        yield called(compiled(tool, words, place, files, path, wall), path, interface)


def _macros(interface: Interface) -> dict[str, object]:
    prefix, words = interface.prefix, interface.words
    kinds = {"RUN_VEC4": 4, "RUN_CODE": interface.size, "RUN_KIND": interface.result}
    types = {name: "float" if size == 1 else f"{prefix}_vec{size}" for name, size in kinds.items()}
    types["RUN_KIND"] = interface.structure or types["RUN_KIND"]
    types["RUN_TEXEL"] = f"{prefix}_uvec{words}" if words > 1 else "uint32_t"
    return interface.defines_with(lambda places: _listed(places, prefix), "({}){{{}}}", _scalars) | types


def _scalars(path: str, size: int) -> list[str]:
    return [f"{path}.{field}" for field in "xyzw"[:size]] if size > 1 else [path]


def _listed(places: Sequence[str], prefix: str) -> str:
    """Return the C text of inputs, separated by commas: n.xy becomes a structure of n.x and n.y."""
    return ", ".join(_given(place, prefix) for place in places)


def _given(place: str, prefix: str) -> str:
    row, _, fields = place.partition(".")
    if len(fields) < 2:
        return place
    return f"({prefix}_vec{len(fields)}){{{', '.join(f'{row}.{field}' for field in fields)}}}"


def defined(values: Mapping[str, object], language: str = "c") -> Text:
    """Return lines that define macros, as a text for compilers of a language. The text is checked, because values
    contain names from a file. Raises ShaderError."""
    return judged_text("".join(f"#define {name} {value}\n" for name, value in values.items()), language)


def macros(values: Mapping[str, object]) -> list[str]:
    """Return the options that define macros for a C compiler: -DNAME=VALUE."""
    return [f"-D{name}={value}" for name, value in values.items()]


def compilers_wall(tool: str, place: Path) -> Wall:
    """Return the wall for a compiler of a user's text: the compiler may use only its own parts and a folder.

    Raises:
        MissingError: walls are not available, or programs cannot be compiled and run behind a wall.
    """
    walls.require()
    path = str(tools.path_of(tool))
    if failure := _failure_behind_wall(tool, path):
        raise MissingError(failure)
    return walls.of_c_compiler(path) | Wall(writes=(str(place),))


def programs_wall(program: Path) -> Wall:
    """Return the wall for a program made from a user's text: it may use the system's libraries and its own folder."""
    return walls.of_program(program) | Wall(writes=(str(program.parent),))


@cache
def _failure_behind_wall(tool: str, path: str) -> str:
    """Return why a compiler or its program fails behind a wall, for example because `cc` is a script; else empty."""
    with folder() as place:
        try:
            wall = walls.of_c_compiler(path) | Wall(writes=(str(place),))
            files = {"tried.c": judged_text("int main(void) { return 0; }\n", "c")}
            program = compiled(tool, ["tried.c"], place, files, place / "tried.c", wall)
            run_apart(program, [str(program)], programs_wall(program))
        except (ShaderError, OSError, subprocess.TimeoutExpired) as error:
            return f"C generated from your files is not run here: with Landlock, {error}"
    return ""


def compiled(
    tool: str, words: Sequence[str], place: Path, files: Mapping[str, Text], path: Path, wall: Wall | None = None
) -> Path:
    """Compile texts and return the path of the program. Messages about the first text name `path`.

    Raises:
        MissingError: the compiler is not installed.
        ShaderError: the compiler refuses the texts.
    """
    compile_with(tool, [*words, "-o", PROGRAM], place, files, lambda text: re.sub(r"^0(?=:)", str(path), text), wall)
    return place / PROGRAM


def called(program: Path, path: Path, interface: Interface) -> Run:
    """Return a function that runs a program on rows (see main.c). Each run is a separate process, behind a wall
    unless the text is the catalogue's."""
    wall = None if interface.is_ours else programs_wall(program)

    def run(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
        place, count = program.parent, len(n)
        rows_of(n, view, texels).tofile(place / "given.bin")
        try:
            run_apart(path, [str(program), str(place), str(count)], wall)
        except PermissionError as error:
            where = place.parent
            raise MissingError(
                f"C cannot be run: programs cannot be executed in {where}; set TMPDIR to a folder that allows it"
            ) from error
        rows, words = (np.fromfile(place / name, kind) for name, kind in (("made.bin", "<f4"), ("words.bin", "<u4")))
        return ran_of(rows.reshape(MADE * count, 4), words.reshape(count, 4), interface)

    return run


def how() -> str:
    """Return the C compiler's version and the options for exact arithmetic, as text. Raises MissingError."""
    return f"{tools.first_line(tools.C)}, {' '.join(EXACT)}"


RUNNER = Runner(prepared, how)
