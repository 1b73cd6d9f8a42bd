"""A second way to run a translated encoder. If possible, it shares neither reader nor writer with the first way.

HLSL, Slang and GLSL go through Slang's compiler to SPIR-V, WGSL through naga to Vulkan. The results are compared with
the measured results, which come from GLSL on OpenGL, because a translation that compiles can still be wrong. Users'
files run only as shaders.
"""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...ground.compilers import tools
from ...ground.compilers.lines import bare
from ...ground.compilers.slang import GIVEN as TEXT
from ...ground.compilers.text import RefusedError, judged
from ...ground.compilers.tools import ToolError
from ...ground.machine import children
from ...ground.machine.systems.processes import signal_name
from ...ground.output.errors import MissingError
from ...ground.user_files import UserFile
from . import by_spirv, slang
from .language import GLSL_NAME, name_of
from .programs import LARGEST, TranslationError, macros, template
from .source import Source
from .translated import Translated

# Of one step: compiling, or running.
SECONDS = 30.0
MISSING = "WGSL needs"
GIVEN, MADE = "given.bin", "made.bin"
# Slang's own writer of SPIR-V alone: above -O0 it asks for spirv-opt. Nothing is fused that the file does not fuse.
SPIRV = ("-target", "spirv", "-entry", "normalbench_second", "-stage", "compute", "-O0", "-fp-mode", "precise")
# Normals and codes of shape (count, 3) and a view of three numbers to codes and normals, (count, 3).
Way = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


class UndefinedError(Exception):
    """A program that does something undefined in its language; the message is one line."""


class NoSecondWayError(Exception):
    """The second way is not available here; the one-line message states the reason.

    Attributes:
        is_of_the_file: whether an installed compiler refuses the file.
    """

    def __init__(self, why: str, is_of_the_file: bool = False):
        super().__init__(why)
        self.is_of_the_file = is_of_the_file


def second_way(file: UserFile, encoder: Translated, folder: Path) -> Way:
    """Return a function that runs a file's two functions in a second way (see `Way`).

    Args:
        encoder: the translation of the file.
        folder: an empty working folder.

    Raises:
        NoSecondWayError: a compiler is missing or refuses the file; also raised when the returned function is called.
        UndefinedError: only when the returned function is called: the file divides an integer by 0.
    """
    make = _naga_runner if name_of(file) == "WGSL" else _spirv_runner
    run = make(Source(file), encoder, folder)

    def way(n: np.ndarray, codes: np.ndarray, view: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        given = np.zeros((len(n), 3, 4), "<f4")
        given[:, 0, :3], given[:, 1, :3], given[:, 2, :3] = n, view, codes
        given.tofile(folder / GIVEN)
        run(len(n))
        output = np.fromfile(folder / MADE, "<f4").reshape(len(n), 2, 4)
        return output[:, 0, :3], output[:, 1, :3]

    return way


def _program_text(name: str, encoder: Translated) -> str:
    """Return the text of a program that calls an encoder's two functions, from the template with this name."""
    if encoder.packed and name == "second.hlsl":
        return _of_halves(encoder)
    size = encoder.components
    words = {"CODE": "xyz"[:size], "ZEROS_E": "0.0, 0.0" if size == 2 else "0.0"}
    for side, (function, takes_view) in zip(("ENCODE", "DECODE"), encoder.functions, strict=True):
        words |= {side: function, f"VIEW_{side[0]}": ", normalbench_view.xyz" if takes_view else ""}
    return template(name, **words)


def _of_halves(encoder: Translated) -> str:
    """Return the text of the program in second.hlsl for two functions whose code is a single 32-bit value."""
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


def _spirv_runner(source: Source, encoder: Translated, folder: Path) -> Callable[[int], None]:
    """Compile a file to SPIR-V with Slang, and return a function that runs it on OpenGL, in a process that the driver
    may crash. Raises NoSecondWayError."""
    of_language = list(slang.GLSL) if name_of(source.file) == GLSL_NAME else []
    used = macros(source.with_text(encoder.text), slang.TYPES)
    defined = [*of_language, *(word for macro in used for word in ("-D", macro))]
    defined.append("-enable-machine-readable-diagnostics")
    try:
        text = tools.slang_text(encoder.text + bare(_program_text("second.hlsl", encoder)), defined, folder)
        words, wall = [*defined, *SPIRV, "-o", "made.spv", TEXT], tools.wall_around(tools.SLANG, folder)
        done = tools.run(tools.SLANG, words, folder, {TEXT: text}, wall=wall)
    except (MissingError, ToolError) as error:
        raise NoSecondWayError(str(error)) from error
    except RefusedError as error:
        raise NoSecondWayError(slang.refusal(source, error), is_of_the_file=True) from error
    if done.status:
        raise NoSecondWayError(_refusal_text(source, done.err), is_of_the_file=True)
    words = children.python("normalbench.bench.shaders.languages.by_spirv", str(folder))
    return lambda _: _run(words, folder)


def _refusal_text(source: Source, printed: str) -> str:
    try:
        slang.check(source, printed, 1)
    except TranslationError as error:
        return f"{tools.SLANG} cannot read it: {error}"
    return f"{tools.SLANG} cannot read it"


def _naga_runner(source: Source, encoder: Translated, folder: Path) -> Callable[[int], None]:
    """Write a file's WGSL to a folder, and return a function that runs it on a Vulkan device, in a process that naga
    may crash. Raises NoSecondWayError."""
    try:
        text = judged(bare(encoder.text + _program_text("second.wgsl", encoder), is_wgsl=True), "wgsl")
    except RefusedError as error:
        raise NoSecondWayError(slang.refusal(source, error), is_of_the_file=True) from error
    tools.put(folder / "given.wgsl", text)
    words = children.python("normalbench.bench.shaders.languages.by_naga", str(folder))
    return lambda _: _run(words, folder)


def _run(command: list[str], folder: Path) -> None:
    """Run a command in a folder. Raises UndefinedError for a division by 0, NoSecondWayError for any
    other failure."""
    try:
        done = children.finished(command, SECONDS, folder)
    except subprocess.TimeoutExpired as error:
        raise NoSecondWayError(f"no result within {SECONDS:g} s") from error
    if done.returncode == by_spirv.UNDEFINED:
        raise UndefinedError("it divides an integer by 0 for some normals")
    if done.returncode:
        lines = [line.strip() for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        ended = signal_name(done.returncode) or f"status {done.returncode}"
        why = lines[-1][:200] if lines else f"it ended with {ended}"
        raise NoSecondWayError(why, done.returncode != by_spirv.NO_DEVICE and MISSING not in why)
