"""GLSL to SPIR-V by glslangValidator, and how many instructions that is."""

from __future__ import annotations

import base64
import shutil
import struct
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ..gbuffer.shader import ShaderError, Source
from . import cache as kept
from .errors import MissingError

COMPILER, OPTIMISER = "glslangValidator", "spirv-opt"
NO_COMPILER = f"no GLSL compiler: {COMPILER} is not on the path; install it (Debian: apt-get install glslang-tools)"
NO_OPTIMISER = f"no SPIR-V counts: {OPTIMISER} is not on the path; install it (Debian: apt-get install spirv-tools)"
SECONDS = 20
HEADER, FUNCTION, FUNCTION_END, LOOP_MERGE = 5, 54, 56, 246
UNROLL, DONT_UNROLL = 1, 2


@dataclass(frozen=True)
class Module:
    """A shader as SPIR-V, and how many instructions its functions have once optimised; None without spirv-opt."""

    binary: bytes
    instructions: int | None


@cache
def version(tool: str) -> str | None:
    """All that a tool says of its version; None where it is not there."""
    if not shutil.which(tool):
        return None
    try:
        done = subprocess.run([tool, "--version"], capture_output=True, text=True, timeout=SECONDS)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return f"{done.stdout}{done.stderr}".strip() or "of no version"


def compiler() -> str:
    """The GLSL compiler's version. Raises MissingError, one line that names the package."""
    said = version(COMPILER)
    if said is None:
        raise MissingError(NO_COMPILER)
    return said


def title(said: str) -> str:
    """The name of a compiler's version, in a few words."""
    return "glslang " + said.splitlines()[0].split(":")[-1].strip()


def compiled(source: Source, stage: str, counted: bool = True) -> Module:
    """A source as SPIR-V; `stage` is "vert", "frag" or "comp". Kept by its text and the tools' versions.

    Its instructions are counted if that is asked for and there is spirv-opt.

    Raises:
        MissingError: there is no compiler.
        ShaderError: it does not compile; the message names the file and the line.
    """
    optimiser = version(OPTIMISER) if counted else None
    key = kept.key_of("spirv", source.text, stage, compiler(), optimiser or "")
    found = kept.read(key, {"binary", "instructions"})
    if found:
        return Module(base64.b64decode(found["binary"]), found["instructions"])
    with tempfile.TemporaryDirectory(prefix="normalbench-") as folder:
        binary = _by_glslang(source, stage, Path(folder))
        optimised = _optimised(binary, Path(folder)) if optimiser else None
    module = Module(binary, _count(optimised) if optimised else None)
    if optimised or not optimiser:
        kept.write(key, {"binary": base64.b64encode(binary).decode(), "instructions": module.instructions})
    return module


def _by_glslang(source: Source, stage: str, folder: Path) -> bytes:
    out = folder / "shader.spv"
    command = [COMPILER, "--stdin", "-S", stage, "-V", "--auto-map-bindings", "-o", str(out)]
    done = _run(command, source.text)
    if done.returncode == 0 and out.exists():
        return out.read_bytes()
    errors = [line.removeprefix("ERROR: ") for line in done.stdout.splitlines() if line.startswith("ERROR: ")]
    if not errors:
        raise ShaderError(f"{source.place}: {COMPILER} ended with status {done.returncode} and said nothing")
    raise ShaderError(source.explain(errors[0]))


def _optimised(binary: bytes, folder: Path) -> bytes | None:
    """The module with loops of a known length unrolled, so that a polynomial counts as long as it is; None where the
    optimiser fails, for the compilers do without it."""
    given, out = folder / "given.spv", folder / "optimised.spv"
    given.write_bytes(_asking_to_unroll(binary))
    try:
        _run([OPTIMISER, "-O", str(given), "-o", str(out)], "")
        return out.read_bytes()
    except (ShaderError, OSError):
        return None


def _run(command: list[str], text: str) -> subprocess.CompletedProcess[str]:
    try:
        return subprocess.run(command, input=text, capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired as error:
        raise ShaderError(f"{command[0]} took longer than {SECONDS} s") from error


def _words(binary: bytes) -> list[int]:
    return list(struct.unpack(f"<{len(binary) // 4}I", binary))


def _instructions(words: list[int]) -> Iterator[tuple[int, int]]:
    """(place, opcode) of each instruction of a module."""
    place = HEADER
    while place < len(words):
        yield place, words[place] & 0xFFFF
        place += words[place] >> 16


def _asking_to_unroll(binary: bytes) -> bytes:
    """The module with the hint to unroll on every loop, which GLSL has no word for without an extension."""
    words = _words(binary)
    for place, opcode in _instructions(words):
        if opcode == LOOP_MERGE:
            words[place + 3] = words[place + 3] & ~DONT_UNROLL | UNROLL
    return struct.pack(f"<{len(words)}I", *words)


def _count(binary: bytes) -> int:
    """Instructions from each OpFunction to its OpFunctionEnd."""
    inside, count = False, 0
    for _, opcode in _instructions(_words(binary)):
        inside = inside or opcode == FUNCTION
        count += inside
        inside = inside and opcode != FUNCTION_END
    return count
