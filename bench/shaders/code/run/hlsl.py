"""HLSL: glslang compiles it to SPIR-V, SPIRV-Cross makes GLSL of that, and the GL driver runs it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...isa import spirv
from ...languages import tools
from . import opengl
from .interface import Interface, Run, Runner
from .sources import EmittedSource, compile_with, folder, required

WRAPPER = Path(__file__).with_suffix(".hlsl")
# How a structure is made: by the function that HlslWriter writes behind it.
MADE = "{}_of({})"
# Bindings of what the file declares itself: behind the three buffers.
OPTIONS = ("-S", "comp", "-e", "main", "-V", "--target-env", "vulkan1.1", "--auto-map-bindings")


def _glslang_path() -> str:
    spirv.compiler()
    return required(spirv.COMPILER, spirv.NO_COMPILER)


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """The file on the GL device. Raises MissingError, ShaderError, NoDeviceError."""
    source = EmittedSource(WRAPPER, path, interface, MADE)
    with folder() as place:
        given = place / "code.hlsl"
        given.write_text(source.text, encoding="utf-8", newline="\n")
        compile_with([_glslang_path(), "-D", *OPTIONS, "-o", str(place / "code.spv"), str(given)], source, given)
        text = glsl_of(place / "code.spv")
    with opengl.prepared(opengl.compiled(text, str), interface) as run:
        yield run


def glsl_of(binary: Path) -> str:
    """GLSL of desktop OpenGL of a module of SPIR-V. Raises MissingError, ShaderError."""
    cross = str(tools.path_of(tools.SPIRV_CROSS))
    return compile_with([cross, "--version", "430", "--no-es", "--no-420pack-extension", str(binary)])


def translators() -> str:
    """The two translators. Raises MissingError."""
    glslang, cross = spirv.title(spirv.compiler()), tools.path_of(tools.SPIRV_CROSS).stem
    return f"{glslang.replace('glslang', spirv.COMPILER)}, {cross}"


def how() -> str:
    """The compilers and the device; SPIRV-Cross does not tell its version. Raises MissingError, NoDeviceError."""
    return f"{translators()}, {opengl.device_name()}"


RUNNER = Runner(prepared, how)
