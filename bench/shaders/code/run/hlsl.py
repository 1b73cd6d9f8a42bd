"""HLSL: glslang compiles it to SPIR-V, SPIRV-Cross translates the SPIR-V to GLSL, and the OpenGL driver runs that."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ....ground.compilers import tools
from ....ground.compilers.text import Text
from ...isa import spirv
from ...judged import judged_text
from . import opengl
from .interface import Interface, Run, Runner
from .sources import EmittedSource, compile_with, folder

WRAPPER = Path(__file__).with_suffix(".hlsl")
# How a structure is made: by the function that HlslWriter writes behind it.
MADE = "{}_of({})"
# Bindings of what the file declares itself: behind the three buffers.
MODULE = "code.spv"
OPTIONS = ("-S", "comp", "-e", "main", "-V", "--target-env", "vulkan1.1", "--auto-map-bindings")


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """Compile an HLSL file for the OpenGL device, and yield a function that runs it on rows. Raises MissingError,
    ShaderError, NoDeviceError."""
    source = EmittedSource(WRAPPER, path, interface, MADE)
    with folder() as place:
        text = glsl_of(place, judged_text(source.text, "hlsl", source), source.explain)
    with opengl.prepared(opengl.compiled(text, str), interface) as run:
        yield run


def glsl_of(place: Path, text: Text, explain: Callable[[str], str] = str) -> str:
    """Return an HLSL text as GLSL for desktop OpenGL, compiled in a folder. Raises MissingError, ShaderError."""
    compile_with(tools.GLSLANG, ["-D", *OPTIONS, "-o", MODULE, "code.hlsl"], place, {"code.hlsl": text}, explain)
    return glsl_of_module(place)


def glsl_of_module(place: Path) -> str:
    """Return GLSL for desktop OpenGL from the SPIR-V file MODULE in a folder. Raises MissingError, ShaderError."""
    return compile_with(tools.SPIRV_CROSS, ["--version", "430", "--no-es", "--no-420pack-extension", MODULE], place, {})


def translators() -> str:
    """Return the names of the two translators, with the version of glslang, as text. Raises MissingError."""
    glslang, cross = spirv.title(spirv.compiler()), tools.path_of(tools.SPIRV_CROSS).stem
    return f"{glslang.replace('glslang', tools.GLSLANG)}, {cross}"


def how() -> str:
    """Return the names of the translators and the OpenGL device, as text. Raises MissingError, NoDeviceError."""
    return f"{translators()}, {opengl.device_name()}"


RUNNER = Runner(prepared, how)
