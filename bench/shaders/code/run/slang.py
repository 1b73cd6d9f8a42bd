"""Slang: slangc makes GLSL for Vulkan of it, and from there it goes the way of HLSL."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from ...isa import spirv
from . import opengl
from .hlsl import WRAPPER, glsl_of, translators
from .interface import Interface, Run, Runner
from .sources import EmittedSource, compile_with, first_line, folder, required

INSTALL = "no Slang compiler: slangc is not on the path; install it (pip install --no-deps slangtorch)"


def compiler() -> str:
    """slangc of the search path, or that of the package slangtorch, which is not imported. Raises MissingError."""
    found = find_spec("slangtorch")
    wheel = Path(found.origin).parent / "bin" if found and found.origin else Path()
    return required(shutil.which("slangc") or shutil.which("slangc", path=str(wheel)), INSTALL)


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """The file on the GL device. Raises MissingError, ShaderError, NoDeviceError."""
    source = EmittedSource(WRAPPER, path, interface)
    with folder() as place:
        given, glsl, binary = (place / f"code.{ending}" for ending in ("slang", "comp", "spv"))
        given.write_text(source.text, encoding="utf-8")
        options = ("-target", "glsl", "-stage", "compute", "-entry", "main")
        compile_with([compiler(), str(given), *options, "-o", str(glsl)], source, given)
        spirv.compiler()
        compile_with([spirv.COMPILER, "-V", "--target-env", "vulkan1.1", "-o", str(binary), str(glsl)])
        text = glsl_of(binary)
    with opengl.prepared(opengl.compiled(text, str), interface) as run:
        yield run


def how() -> str:
    """The compilers and the device. Raises MissingError, NoDeviceError."""
    return f"slangc {first_line(compiler(), '-v')}, {translators()}, {opengl.device_name()}"


RUNNER = Runner(prepared, how)
