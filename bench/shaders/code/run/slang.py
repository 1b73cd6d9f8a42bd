"""Slang: slangc translates it to GLSL for Vulkan; the other steps, through SPIR-V, are the same as for HLSL."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ....ground.compilers import tools
from ...judged import judged_text
from . import opengl
from .hlsl import MADE, MODULE, WRAPPER, glsl_of_module, translators
from .interface import Interface, Run, Runner
from .sources import EmittedSource, compile_with, folder


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """Compile a Slang file for the OpenGL device, and yield a function that runs it on rows. Raises MissingError,
    ShaderError, NoDeviceError."""
    source = EmittedSource(WRAPPER, path, interface, MADE)
    with folder() as place:
        files = {"code.slang": judged_text(source.text, "slang", source)}
        options = ("-target", "glsl", "-stage", "compute", "-entry", "main")
        glsl_text = compile_with(tools.SLANG, ["code.slang", *options], place, files, source.explain)
        glsl = {"code.comp": judged_text(glsl_text, "glsl")}
        compile_with(tools.GLSLANG, ["-V", "--target-env", "vulkan1.1", "-o", MODULE, "code.comp"], place, glsl)
        text = glsl_of_module(place)
    with opengl.prepared(opengl.compiled(text, str), interface) as run:
        yield run


def how() -> str:
    """Return the names of the compilers and the OpenGL device, as text. Raises MissingError, NoDeviceError."""
    return f"slangc {tools.first_line(tools.SLANG)}, {translators()}, {opengl.device_name()}"


RUNNER = Runner(prepared, how)
