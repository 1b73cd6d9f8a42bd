"""Translation of HLSL to GLSL without Slang: glslang compiles it to SPIR-V, which SPIRV-Cross converts to GLSL."""

from __future__ import annotations

import re
from pathlib import Path

from ...ground.compilers import tools
from ...ground.compilers.text import RefusedError, judged
from .pairs import Function
from .programs import ENTRY, TranslationError, macros, program
from .slang import refusal
from .source import Source

TOOLS = (tools.GLSLANG, tools.SPIRV_CROSS)
# The version of the shaders that this becomes part of.
VERSION = "430"
GIVEN, MADE = "given.hlsl", "made.spv"
# ERROR: given.hlsl:3: 'q' : unknown variable
_ERROR = re.compile(rf"^ERROR: {re.escape(GIVEN)}:(\d+): '([^']*)' : (.*)$", re.M)


def shader(source: Source, function: Function, folder: Path) -> str:
    """Return the text of a GLSL fragment shader that calls a function of an HLSL source (see `plain.py`).

    Raises:
        TranslationError: the source does not compile.
        ToolError: a tool crashes or hangs.
        MissingError: a tool is not installed.
    """
    try:
        text = judged(program(source, function), "hlsl")
    except RefusedError as error:
        raise TranslationError(refusal(source, error)) from None
    # Without names (-g0) no identifier of the user's can be one of GLSL's or of this program's. Not optimised (-Od), a
    # function with an early return stays one, and does not become a loop of one turn.
    options = ["-D", "-e", ENTRY, "-S", "frag", "-V", "--target-env", "vulkan1.1", "-g0", "-Od", "-o", MADE]
    words = [*options, *_define_options(source), GIVEN]
    status, out, err = tools.run(tools.GLSLANG, words, folder, {GIVEN: text})
    _check(source, status, out + err)
    words = ["--version", VERSION, "--no-es", "--remove-unused-variables", MADE]
    status, out, err = tools.run(tools.SPIRV_CROSS, words, folder, {})
    if status:
        raise TranslationError(f"{source.path}: {tools.SPIRV_CROSS}: {' '.join((out + err).split())[:300]}")
    return out


def _define_options(source: Source) -> list[str]:
    return [f"-D{macro}" for macro in macros(source)]


def _check(source: Source, status: int, message: str) -> None:
    """Raise TranslationError if glslang ended with an error status for a source; `message` is its output."""
    if not status:
        return
    match = _ERROR.search(message)
    if not match:
        why = next((line for line in message.splitlines() if "error" in line.lower()), f"status {status}, no message")
        raise TranslationError(f"{source.path}: {tools.GLSLANG}: {why}")
    token, what = match[2], match[3].strip()
    message = f"{what.lower()} {token}" if what == "Expected" else f"{token}: {what}" if token else what
    raise TranslationError(source.explained(int(match[1]), message, token))
