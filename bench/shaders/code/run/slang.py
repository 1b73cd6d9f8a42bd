"""Slang: slangc makes GLSL for Vulkan of it, and from there it goes the way of HLSL."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...isa import spirv
from ...languages import tools
from . import opengl
from .hlsl import MADE, WRAPPER, glsl_of, translators
from .interface import Interface, Run, Runner
from .sources import EmittedSource, compile_with, first_line, folder


def _compiler() -> str:
    return str(tools.path_of(tools.SLANG))


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """The file on the GL device. Raises MissingError, ShaderError, NoDeviceError."""
    source = EmittedSource(WRAPPER, path, interface, MADE)
    with folder() as place:
        given, glsl, binary = (place / f"code.{ending}" for ending in ("slang", "comp", "spv"))
        given.write_text(source.text, encoding="utf-8", newline="\n")
        options = ("-target", "glsl", "-stage", "compute", "-entry", "main")
        compile_with([_compiler(), str(given), *options, "-o", str(glsl)], source, given)
        spirv.compiler()
        compile_with([spirv.COMPILER, "-V", "--target-env", "vulkan1.1", "-o", str(binary), str(glsl)])
        text = glsl_of(binary)
    with opengl.prepared(opengl.compiled(text, str), interface) as run:
        yield run


def how() -> str:
    """The compilers and the device. Raises MissingError, NoDeviceError."""
    return f"slangc {first_line(_compiler(), '-v')}, {translators()}, {opengl.device_name()}"


RUNNER = Runner(prepared, how)
