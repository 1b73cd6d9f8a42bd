"""Compilation of GLSL to SPIR-V by glslangValidator, and the number of SPIR-V instructions."""

from __future__ import annotations

import base64
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ....gbuffer.gl.shader import ShaderError, Source
from ...ground.compilers import tools
from ...ground.output import cache as kept
from ...ground.output.errors import MissingError
from ..judged import judged_text

COMPILER, OPTIMISER = tools.GLSLANG, tools.SPIRV_OPT
NO_COMPILER, NO_OPTIMISER = tools.MISSING[COMPILER], tools.MISSING[OPTIMISER]
MAGIC = struct.pack("<I", 0x07230203)
HEADER, FUNCTION, FUNCTION_END, LOOP_MERGE = 5, 54, 56, 246
UNROLL, DONT_UNROLL = 1, 2


@dataclass(frozen=True)
class Module:
    """A shader as SPIR-V, and the number of instructions in its optimised functions.

    The number is None without spirv-opt, or if a loop remains, whose instructions would count only once.
    """

    binary: bytes
    instructions: int | None


def version(tool: str) -> str | None:
    """Return all that a tool reports about its version; "(unknown version)" if that is empty, None without
    the tool."""
    try:
        return tools.version_text(tool) or "(unknown version)"
    except MissingError:
        return None


def compiler() -> str:
    """Return the GLSL compiler's version text. Raises MissingError, whose one-line message names the package."""
    compiler_version = version(COMPILER)
    if compiler_version is None:
        raise MissingError(NO_COMPILER)
    return compiler_version


class ToolError(ShaderError):
    """A tool that crashes or hangs, whatever its input."""


def title(output: str) -> str:
    """Return "glslang" and its version, from the compiler's version text."""
    return "glslang " + output.splitlines()[0].split(":")[-1].strip()


def titles() -> str:
    """Return the names and versions of the compiler and, if it is installed, of the optimiser, as one text. Raises
    MissingError as `compiler` does."""
    optimiser = version(OPTIMISER)
    return title(compiler()) + (f", {OPTIMISER} {_version_number(optimiser)}" if optimiser else "")


def _version_number(output: str) -> str:
    """Return the first number in a version text, such as v2023.1; the text's first line if it contains no number."""
    return next((word for word in output.split() if word.strip("v")[:1].isdigit()), output.splitlines()[0])


def compiled(source: Source, stage: str, counted: bool = True) -> Module:
    """Return a source compiled to SPIR-V, from the cache if neither its text nor the tools' versions have changed.

    The instructions are counted if `counted` is true and spirv-opt is installed.

    Args:
        stage: "vert", "frag" or "comp".

    Raises:
        MissingError: no compiler is installed.
        ShaderError: the source does not compile; the message names the file and the line.
    """
    optimiser = version(OPTIMISER) if counted else None
    ours = Path(__file__).read_text(encoding="utf-8")
    key = kept.key_of("spirv", source.text, stage, compiler(), optimiser or "", ours)
    cached = _as_module(kept.read(key))
    if cached:
        return cached
    binary = _glslang_binary(source, stage)
    optimised = _optimised(binary) if optimiser else None
    module = Module(binary, _count(optimised) if optimised else None)
    if optimised or not optimiser:
        kept.write(key, {"binary": base64.b64encode(binary).decode(), "instructions": module.instructions})
    return module


def _as_module(value: dict[str, Any] | None) -> Module | None:
    """Return the module in a cached dictionary of `binary` (base64) and `instructions`; None for other values."""
    try:
        binary, count = base64.b64decode((value or {})["binary"], validate=True), (value or {})["instructions"]
    except (KeyError, TypeError, ValueError):
        return None
    is_sound = _is_spirv(binary) and (count is None or isinstance(count, int))
    return Module(binary, count) if is_sound else None


def _is_spirv(binary: bytes) -> bool:
    return len(binary) > 4 * HEADER and len(binary) % 4 == 0 and binary.startswith(MAGIC)


def _glslang_binary(source: Source, stage: str) -> bytes:
    try:
        done, binary = tools.module_of(
            judged_text(source.text, "glsl", source), ["-S", stage, "-V", "--auto-map-bindings"]
        )
    except tools.ToolError as error:
        raise ToolError(str(error)) from error
    if done.status == 0 and _is_spirv(binary):
        return binary
    errors = [line.removeprefix("ERROR: ") for line in done.out.splitlines() if line.startswith("ERROR: ")]
    if not errors:
        raise ToolError(f"{COMPILER} ended with status {done.status} and no message")
    raise ShaderError(source.explain(errors[0]))


def _optimised(binary: bytes) -> bytes | None:
    """Return an optimised module whose loops of known length are unrolled, so that all instructions of a polynomial
    count; None if the optimiser fails, which is no error, because the GPU compilers do not need this module."""
    try:
        module = tools.optimised(_asking_to_unroll(binary))
    except tools.ToolError:
        return None
    return module if _is_spirv(module) else None


def _module_words(binary: bytes) -> list[int]:
    return list(struct.unpack(f"<{len(binary) // 4}I", binary))


def _instructions(words: list[int]) -> Iterator[tuple[int, int]]:
    """Yield (word index, opcode) for each instruction in a module's words."""
    place = HEADER
    while place < len(words):
        yield place, words[place] & 0xFFFF
        place += words[place] >> 16


def _asking_to_unroll(binary: bytes) -> bytes:
    """Return a module with the unroll hint on every loop; GLSL cannot express this hint without an extension."""
    words = _module_words(binary)
    for place, opcode in _instructions(words):
        if opcode == LOOP_MERGE:
            words[place + 3] = words[place + 3] & ~DONT_UNROLL | UNROLL
    return struct.pack(f"<{len(words)}I", *words)


def _count(binary: bytes) -> int | None:
    """Return the number of instructions in all functions, OpFunction to OpFunctionEnd; None if there is a loop."""
    inside, count = False, 0
    for _, opcode in _instructions(_module_words(binary)):
        if opcode == LOOP_MERGE:
            return None
        inside = inside or opcode == FUNCTION
        count += inside
        inside = inside and opcode != FUNCTION_END
    return count
