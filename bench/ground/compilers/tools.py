"""The compilers: where they are, what to install if they are missing, and how they are run."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from ..machine import children
from ..machine.systems import landlock, walls
from ..machine.systems.files import state_of
from ..machine.systems.people import how_to_install
from ..machine.systems.processes import file_of_child, signal_name
from ..machine.systems.walls import Wall
from ..output.errors import MissingError
from . import slang
from .text import RefusedError, Text, judged

GLSLANG, SPIRV_CROSS, SPIRV_OPT, SLANG = "glslangValidator", "spirv-cross", "spirv-opt", "slangc"
C = "cc"
# Slang's compiler as a library, which is no program.
SLANG_LIBRARY = "slang-compiler"
# What to install.
MISSING: Mapping[str, str] = MappingProxyType(
    {
        GLSLANG: f"no GLSL compiler: {GLSLANG} is not on the path; install it ({how_to_install('glslang-tools')})",
        SPIRV_CROSS: f"no HLSL: {SPIRV_CROSS} is not on the path; install it ({how_to_install('spirv-cross')})",
        SPIRV_OPT: f"no SPIR-V counts: {SPIRV_OPT} is not on the path; install it ({how_to_install('spirv-tools')})",
        SLANG: f"no Slang: {SLANG} is not installed; install it (pip install --no-deps slangtorch)",
        SLANG_LIBRARY: slang.MISSING,
        C: f"no C compiler: {C} is not on the path; install it ({how_to_install('gcc')})",
    }
)
# Python packages that have a tool in their folder bin.
_WHEELS: Mapping[str, str] = MappingProxyType({SLANG: "slangtorch"})
# What they say their version by; --version, if nothing else.
_ASKED: Mapping[str, str] = MappingProxyType({SPIRV_CROSS: "--revision", SLANG: "-v"})
SECONDS = 20.0


class ToolError(Exception):
    """A tool crashes or does not end."""


def path_of(tool: str) -> Path:
    """Return the path of a tool: on the path, or in an installed package that has it.

    Raises:
        MissingError: the tool is missing; the message is one line that says what to install.
    """
    if tool == SLANG_LIBRARY:
        return slang.path_of_library()
    path = shutil.which(tool) or _in_a_wheel(tool)
    if not path:
        raise MissingError(MISSING.get(tool, f"{tool} is not on the path"))
    return Path(path)


def states() -> list[str]:
    """Return a text for each compiler: its path and file state, or empty if the compiler is missing. Results of
    compilers are valid while these texts stay the same."""
    paths = (shutil.which(tool) for tool in MISSING)
    return [f"{path} {state_of(Path(path))}" if path else "" for path in paths]


def _in_a_wheel(tool: str) -> str | None:
    # The package itself is not imported: it needs what is not installed.
    spec = importlib.util.find_spec(_WHEELS[tool]) if tool in _WHEELS else None
    folders = (spec and spec.submodule_search_locations) or []
    return next((path for folder in folders if (path := shutil.which(tool, path=str(Path(folder) / "bin")))), None)


@cache
def version_text(tool: str) -> str:
    """Return all text that a tool prints about its version; empty if it cannot be run. Raises MissingError."""
    try:
        command = [path_of(tool), _ASKED.get(tool, "--version")]
        done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", timeout=SECONDS)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return f"{done.stdout}\n{done.stderr}".strip()


def first_line(tool: str) -> str:
    """Return the first line that a tool prints about its version; empty if it prints nothing. Raises MissingError."""
    return version_text(tool).partition("\n")[0].strip()


def version(tool: str) -> str:
    """Return a tool's name and the first line that it prints about its version, or what to install."""
    try:
        return f"{tool} {first_line(tool) or '(unknown version)'}"
    except MissingError as error:
        return str(error)


def stamp(tool: str) -> str:
    """Return text that identifies a build of a tool: its path, size and modification time. Raises MissingError."""
    path = path_of(tool).resolve()
    status = path.stat()
    return f"{path} {status.st_size} {status.st_mtime_ns}"


def stamp_or_empty(tool: str) -> str:
    """Return the `stamp` of a tool; empty if the tool is missing."""
    try:
        return stamp(tool)
    except MissingError:
        return ""


def put(path: Path, text: Text) -> None:
    """Write a checked text to the file that a compiler reads."""
    path.write_text(text.content, encoding="utf-8", newline="\n")


class Ran(NamedTuple):
    """The exit status of a tool, and its output."""

    status: int
    out: str
    err: str


def run(
    tool: str,
    words: Sequence[str],
    folder: Path,
    files: Mapping[str, Text],
    seconds: float = SECONDS,
    wall: Wall | None = None,
) -> Ran:
    """Write texts into a folder, run a tool there, and return its exit status and output.

    Args:
        words: options, and names of files in the folder.
        files: the texts that the tool is given, by file name.
        seconds: the time limit.
        wall: what the tool may access, for text that anybody may have written; None for no restriction.

    Raises:
        MissingError: the tool is missing.
        ToolError: the tool crashes or does not end; any other exit status is not an error.
    """
    for name, text in files.items():
        put(folder / name, text)
    command = [str(path_of(tool)), *words]
    try:
        done = children.finished(wall.around(command) if wall else command, seconds, folder)
    except subprocess.TimeoutExpired as error:
        raise ToolError(f"{tool} did not end within {seconds:g} s") from error
    except OSError as error:
        raise ToolError(f"{tool}: {error.strerror or error}") from error
    if name := signal_name(done.returncode):
        raise ToolError(f"{tool} was ended by {name}: it cannot handle this input")
    return Ran(done.returncode, done.stdout, done.stderr)


def wall_around(tool: str, folder: Path) -> Wall | None:
    """Return the wall for a tool that works on anybody's text in a folder; None if this system does not support
    walls.

    Raises:
        MissingError: the tool is missing.
    """
    is_walled = landlock.is_available()
    return walls.of_tool(path_of(tool)) | Wall(writes=(str(folder),)) if is_walled else None


def slang_text(text: str, words: Sequence[str], folder: Path) -> Text:
    """Return a checked text for `slangc` with some options. If the text itself does not show which words macros
    spell, the preprocessor of `slangc` does.

    Raises:
        RefusedError: `slangc` may not be given the text.
        MissingError: the tool is missing.
        ToolError: the tool crashes, does not end, or its preprocessor rejects the text.
    """

    def expanded(plain: Text) -> str:
        wall = wall_around(SLANG, folder)
        done = run(SLANG, [*words, "-E", slang.GIVEN], folder, {slang.GIVEN: plain}, wall=wall)
        if done.status:
            raise ToolError(f"{SLANG}: {' '.join(done.err.split())[:200]}")
        return done.out

    try:
        return judged(text, "slang")
    except RefusedError:
        return judged(text, "slang", expanded, slang.knows)


def module_of(text: Text, words: Sequence[str]) -> tuple[Ran, bytes]:
    """Run glslang on a text passed by standard input. Return the exit status and output, and the SPIR-V module."""
    with file_of_child() as module_file:
        command = [str(path_of(GLSLANG)), "--stdin", *words, "-o", module_file.path]
        done = _piped(command, text.content.encode(), *module_file.descriptors)
        return Ran(done.returncode, done.stdout.decode(errors="replace"), ""), module_file.content()


def optimised(binary: bytes) -> bytes:
    """Return a SPIR-V module after `spirv-opt` has optimised it; empty if `spirv-opt` rejects it."""
    done = _piped([str(path_of(SPIRV_OPT)), "-O", "-", "-o", "-"], binary)
    return done.stdout if done.returncode == 0 else b""


def _piped(command: list[str], given: bytes, *descriptors: int) -> subprocess.CompletedProcess[bytes]:
    try:
        return subprocess.run(command, input=given, capture_output=True, timeout=SECONDS, pass_fds=descriptors)
    except subprocess.TimeoutExpired as error:
        raise ToolError(f"{Path(command[0]).name} took longer than {SECONDS:g} s") from error


def webgpu_module(device: Any, text: Text) -> Any:
    """Return the shader module that naga makes from WGSL on a wgpu device."""
    return device.create_shader_module(code=text.content)
