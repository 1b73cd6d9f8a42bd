"""The compilers that translate: where they are, what to install where they are not, and how they are run."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ...ground.machine.children import text_of
from ...ground.machine.systems.people import how_to_install
from ...ground.machine.systems.processes import signal_name
from ...ground.output.errors import MissingError
from . import slang_library

GLSLANG, SPIRV_CROSS, SLANG = "glslangValidator", "spirv-cross", "slangc"
# Slang's compiler as a library, which is no program.
SLANG_LIBRARY = "slang-compiler"
# What to install.
MISSING: Mapping[str, str] = MappingProxyType(
    {
        GLSLANG: f"no HLSL: {GLSLANG} is not on the path; install it ({how_to_install('glslang-tools')})",
        SPIRV_CROSS: f"no HLSL: {SPIRV_CROSS} is not on the path; install it ({how_to_install('spirv-cross')})",
        SLANG: f"no Slang: {SLANG} is not there; install it (pip install --no-deps slangtorch)",
        SLANG_LIBRARY: slang_library.MISSING,
    }
)
# Python packages that have a tool in their folder bin.
_WHEELS: Mapping[str, str] = MappingProxyType({SLANG: "slangtorch"})
# What they say their version by.
_ASKED: Mapping[str, str] = MappingProxyType({GLSLANG: "--version", SPIRV_CROSS: "--revision", SLANG: "-v"})
SECONDS = 20


class ToolError(Exception):
    """A tool that crashes or does not end, whatever it is given."""


def path_of(tool: str) -> Path:
    """Where a tool is: on the path, or in a package that has it.

    Raises:
        MissingError: one line that says what to install.
    """
    if tool == SLANG_LIBRARY:
        return slang_library.path_of_library()
    found = shutil.which(tool) or _in_a_wheel(tool)
    if not found:
        raise MissingError(MISSING[tool])
    return Path(found)


def _in_a_wheel(tool: str) -> str | None:
    # The package itself is not imported: it needs what is not installed.
    spec = importlib.util.find_spec(_WHEELS[tool]) if tool in _WHEELS else None
    folders = (spec and spec.submodule_search_locations) or []
    return next((found for folder in folders if (found := shutil.which(tool, path=str(Path(folder) / "bin")))), None)


@cache
def version(tool: str) -> str:
    """A tool's own word for its version, or what to install."""
    try:
        path = path_of(tool)
        done = subprocess.run(
            [path, _ASKED[tool]], capture_output=True, encoding="utf-8", errors="replace", timeout=SECONDS
        )
    except MissingError as error:
        return str(error)
    except (OSError, subprocess.TimeoutExpired):
        return f"{tool} does not say its version"
    said = f"{done.stdout}{done.stderr}".strip().splitlines()
    return f"{tool} {said[0] if said else 'of no version'}"


def stamp(tool: str) -> str:
    """What tells one build of a tool from another: its place, size and time. Raises MissingError."""
    found = path_of(tool).resolve()
    status = found.stat()
    return f"{found} {status.st_size} {status.st_mtime_ns}"


def stamp_or_empty(tool: str) -> str:
    """The same; empty where there is no such tool."""
    try:
        return stamp(tool)
    except MissingError:
        return ""


def run(tool: str, words: Sequence[str], folder: Path) -> tuple[int, str]:
    """A tool's status, and all that it printed: as `run_apart`."""
    status, out, err = run_apart(tool, words, folder)
    return status, out + err


def run_apart(tool: str, words: Sequence[str], folder: Path) -> tuple[int, str, str]:
    """A tool's status, and what it printed to standard output and to standard error.

    It runs in a folder, and may use as much memory and time as this process.

    Raises:
        MissingError: there is no such tool.
        ToolError: it crashes or does not end.
    """
    command = [str(path_of(tool)), *words]
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        try:
            files: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stdout": out, "stderr": err}
            status = subprocess.run(command, **files, timeout=SECONDS, cwd=folder).returncode
        except subprocess.TimeoutExpired as error:
            raise ToolError(f"{tool} did not end within {SECONDS} s") from error
        if name := signal_name(status):
            raise ToolError(f"{tool} was ended by {name}: this is too much for it")
        return status, text_of(out), text_of(err)
