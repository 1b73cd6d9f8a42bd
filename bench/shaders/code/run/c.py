"""C99: compiled to a program by the system's compiler, without fused or reordered arithmetic, which limits itself."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from .....gbuffer.gl.shader import ShaderError, read_shader
from ....ground.machine import children
from ....ground.machine.systems.people import how_to_install
from ....ground.output.errors import MissingError
from .interface import MADE, Interface, Ran, Run, Runner, ran_of, rows_of
from .sources import compile_with, first_line, folder, required, run_apart

WRAPPER, MAIN = Path(__file__).with_suffix(".c"), Path(__file__).with_name("main.c")
EXACT = ("-O2", "-ffp-contract=off")
LIMITS = {"RUN_SECONDS": children.SECONDS, "RUN_MEMORY": f"{children.MEMORY}ull", "RUN_FILE": f"{children.FILE}ull"}
INSTALL = f"no C: cc is not on the path; install it ({how_to_install('gcc')})"


def compiler() -> str:
    """The C compiler. Raises MissingError."""
    return required(shutil.which("cc"), INSTALL)


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """The file as a program. Raises MissingError, ShaderError."""
    with built(path, interface, compiler(), [*EXACT, *macros(LIMITS)]) as run:
        yield run


@contextmanager
def built(path: Path, interface: Interface, tool: str, options: Sequence[str]) -> Iterator[Run]:
    """The file as a program of a compiler and its options. Raises ShaderError."""
    with folder() as place:
        (place / "code.h").write_text(read_shader(path), encoding="utf-8", newline="\n")
        # POSIX's calls for the program around the file; the file itself is C99.
        includes = ("-std=c99", "-D_GNU_SOURCE", "-iquote", str(place), "-iquote", str(path.parent))
        command = [tool, *includes, *options, *_macros(interface), str(WRAPPER), str(MAIN), "-lm"]
        yield called(compiled(command, place / "code", {str(place / "code.h"): str(path)}), path, interface)


def _macros(interface: Interface) -> list[str]:
    prefix, words = interface.prefix, interface.words
    kinds = {"RUN_VEC4": 4, "RUN_CODE": interface.size, "RUN_KIND": interface.result}
    types = {name: "float" if size == 1 else f"{prefix}_vec{size}" for name, size in kinds.items()}
    types["RUN_KIND"] = interface.structure or types["RUN_KIND"]
    types["RUN_TEXEL"] = f"{prefix}_uvec{words}" if words > 1 else "uint32_t"
    return macros(interface.defines_with(lambda places: _listed(places, prefix), "({}){{{}}}", _scalars) | types)


def _scalars(path: str, size: int) -> list[str]:
    return [f"{path}.{field}" for field in "xyzw"[:size]] if size > 1 else [path]


def _listed(places: Sequence[str], prefix: str) -> str:
    """What is given, of structures: n.xy is a structure of n.x and n.y."""
    return ", ".join(_given(place, prefix) for place in places)


def _given(place: str, prefix: str) -> str:
    row, _, fields = place.partition(".")
    if len(fields) < 2:
        return place
    return f"({prefix}_vec{len(fields)}){{{', '.join(f'{row}.{field}' for field in fields)}}}"


def macros(values: dict[str, object]) -> list[str]:
    """Options that define macros for a compiler of C."""
    return [f"-D{name}={value}" for name, value in values.items()]


def compiled(command: Sequence[str], made: Path, names: Mapping[str, str]) -> Path:
    """The program that a compiler makes. Raises ShaderError, whose message has other names for some files."""
    try:
        compile_with([*command, "-o", str(made)])
    except ShaderError as error:
        said = str(error)
        for old, new in names.items():
            said = said.replace(old, new)
        raise ShaderError(said) from error
    return made


def called(program: Path, path: Path, interface: Interface) -> Run:
    """What a program does with rows: see main.c. Each run is a process of its own."""

    def run(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
        place, count = program.parent, len(n)
        rows_of(n, view, texels).tofile(place / "given.bin")
        try:
            run_apart(path, [str(program), str(place), str(count)])
        except PermissionError as error:
            where = place.parent
            raise MissingError(
                f"C cannot be run: {where} runs no programs; set TMPDIR to a folder that does"
            ) from error
        made, words = (np.fromfile(place / name, kind) for name, kind in (("made.bin", "<f4"), ("words.bin", "<u4")))
        return ran_of(made.reshape(MADE * count, 4), words.reshape(count, 4), interface)

    return run


def how() -> str:
    """The compiler. Raises MissingError."""
    return f"{first_line(compiler(), '--version')}, {' '.join(EXACT)}"


RUNNER = Runner(prepared, how)
