"""GLSL for OpenGL ES: compiled and run by the OpenGL driver, if the driver supports it besides its own GLSL."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .....gbuffer.gl.device import device
from ....ground.output.errors import MissingError
from . import opengl
from .interface import Interface, Run, Runner
from .sources import EmittedSource

WRAPPER = Path(__file__).with_suffix(".comp")
COMPATIBLE = "ARB_ES3_1_compatibility"


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """Compile a GLSL ES file for the OpenGL device, and yield a function that runs it on rows. Raises MissingError,
    ShaderError, NoDeviceError."""
    how()
    source = EmittedSource(WRAPPER, path, interface)
    with opengl.prepared(opengl.compiled(source.text, source.explain), interface) as run:
        yield run


def how() -> str:
    """Return the OpenGL device's name and version. Raises NoDeviceError, or MissingError if it lacks GLSL ES 3.1."""
    if f"GL_{COMPATIBLE}" not in device().context.extensions:
        raise MissingError(f"{opengl.device_name()} does not support GLSL ES 3.1: it lacks {COMPATIBLE}")
    return opengl.device_name()


RUNNER = Runner(prepared, how)
