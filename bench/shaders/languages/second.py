"""A second way to run a translated encoder, which shares neither reader nor writer with the first where two exist.

HLSL and Slang go through Slang's compiler to C++, WGSL through naga to Vulkan. What they give is compared with what is
measured, by OpenGL: a translation that compiles can still be wrong.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...ground.machine import children
from ...ground.machine.systems.people import how_to_install
from ...ground.machine.systems.processes import DIVIDED_BY_ZERO, signal_name
from ...ground.output.errors import MissingError
from . import slang, tools
from .language import GLSL_NAME, name_of
from .programs import LARGEST, TranslationError, macros, template
from .source import Source
from .tools import ToolError
from .translated import Translated

# Of one step: compiling, or running.
SECONDS = 30.0
MISSING = "WGSL needs"
GIVEN, MADE, PROGRAM = "given.bin", "made.bin", "program"
ENTRY, MAIN = "normalbench_second", Path(__file__).with_suffix(".cpp")
# Normals and codes of shape (count, 3) and a view of three numbers to codes and normals, (count, 3).
Way = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


class UndefinedError(Exception):
    """What a program does that its language leaves undefined; one line."""


class NoSecondWayError(Exception):
    """Why there is none here; one line.

    Attributes:
        is_of_the_file: whether a compiler that is there refuses the file.
    """

    def __init__(self, why: str, is_of_the_file: bool = False):
        super().__init__(why)
        self.is_of_the_file = is_of_the_file


def second_way(path: Path, encoder: Translated, folder: Path) -> Way:
    """The second way of a file.

    Args:
        encoder: its translation.
        folder: an empty one to work in.

    Raises:
        NoSecondWayError: a compiler is missing or refuses the file.
    """
    make = _naga_runner if name_of(path) == "WGSL" else _cpp_runner
    run = make(Source(path), encoder, folder)

    def way(n: np.ndarray, codes: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        given = np.zeros((len(n), 3, 4), "<f4")
        given[:, 0, :3], given[:, 1, :3], given[:, 2, :3] = n, view, codes
        given.tofile(folder / GIVEN)
        run(len(n))
        made = np.fromfile(folder / MADE, "<f4").reshape(len(n), 2, 4)
        return made[:, 0, :3], made[:, 1, :3]

    return way


def _program_text(name: str, encoder: Translated) -> str:
    """The program around a file, which calls its two functions."""
    if encoder.packed and name == "second.hlsl":
        return _of_halves(encoder)
    size = encoder.components
    words = {"CODE": "xyz"[:size], "ZEROS_E": "0.0, 0.0" if size == 2 else "0.0"}
    for side, (function, takes_view) in zip(("ENCODE", "DECODE"), encoder.functions, strict=True):
        words |= {side: function, f"VIEW_{side[0]}": ", normalbench_view.xyz" if takes_view else ""}
    return template(name, **words)


def _of_halves(encoder: Translated) -> str:
    """The same of two functions whose code is one value of 32 bits."""
    (pack, is_viewed), (unpack, is_viewed_back) = encoder.functions
    words = {
        "PACK": pack,
        "UNPACK": unpack,
        "asVALUE": f"as{encoder.packed}",
        "VIEW": ", float3 view",
        "LARGEST": LARGEST,
    }
    words |= {"GIVEN_E": ", view" * is_viewed, "GIVEN_D": ", view" * is_viewed_back}
    plain = replace(encoder, packed="", functions=[("normalbench_encode", True), ("normalbench_decode", True)])
    return template("packed.hlsl", **words) + _program_text("second.hlsl", plain)


def _cpp_runner(source: Source, encoder: Translated, folder: Path) -> Callable[[int], None]:
    """Slang's C++ as a program."""
    compiler = shutil.which("c++") or shutil.which("clang++")
    if not compiler:
        raise NoSecondWayError(f"no compiler of C++ is on the path ({how_to_install('g++')})")
    (folder / slang.GIVEN).write_text(
        encoder.text + _program_text("second.hlsl", encoder), encoding="utf-8", newline="\n"
    )
    of_language = list(slang.GLSL) if name_of(source.word) == GLSL_NAME else []
    used = macros(source.with_text(encoder.text), slang.TYPES)
    defined = [*of_language, *(word for macro in used for word in ("-D", macro))]
    defined.append("-enable-machine-readable-diagnostics")
    options = ["-target", "cpp", "-entry", ENTRY, "-stage", "compute", "-line-directive-mode", "none"]
    try:
        status, out, err = tools.run_apart(tools.SLANG, [*defined, *options, slang.GIVEN], folder)
    except (MissingError, ToolError) as error:
        raise NoSecondWayError(str(error)) from error
    if status:
        raise NoSecondWayError(_refusal_text(source, err), is_of_the_file=True)
    (folder / "made.cpp").write_text(out + MAIN.read_text(encoding="utf-8"), encoding="utf-8", newline="\n")
    _run([compiler, "-std=c++17", "-O0", "-w", "-ffp-contract=off", "made.cpp", "-o", PROGRAM], folder)
    return lambda count: _run([str(folder / PROGRAM), str(count)], folder)


def _refusal_text(source: Source, said: str) -> str:
    try:
        slang.check(source, said, 1)
    except TranslationError as error:
        return f"{tools.SLANG} does not read it: {error}"
    return f"{tools.SLANG} does not read it"


def _naga_runner(_: Source, encoder: Translated, folder: Path) -> Callable[[int], None]:
    """The text itself on a Vulkan device, in a process that naga may end."""
    (folder / "given.wgsl").write_text(
        encoder.text + _program_text("second.wgsl", encoder), encoding="utf-8", newline="\n"
    )
    words = children.python("normalbench.bench.shaders.languages.by_naga", str(folder))
    return lambda _: _run(words, folder, is_of_the_file=True)


def _run(command: list[str], folder: Path, is_of_the_file: bool = False) -> None:
    """A command that ends well. Raises NoSecondWayError, UndefinedError."""
    try:
        done = children.finished(command, SECONDS, folder)
    except subprocess.TimeoutExpired as error:
        raise NoSecondWayError(f"{Path(command[0]).name} did not end within {SECONDS:g} s") from error
    except OSError as error:
        raise NoSecondWayError(f"{Path(command[0]).name} cannot be run: {error.strerror}") from error
    if done.returncode == DIVIDED_BY_ZERO:
        raise UndefinedError("it divides a whole number by 0, of some normal")
    if done.returncode:
        lines = [line.strip() for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        ended = signal_name(done.returncode) or f"status {done.returncode}"
        why = lines[-1][:200] if lines else f"it ended with {ended}"
        raise NoSecondWayError(why, is_of_the_file and MISSING not in why)
