"""GLSL for desktop OpenGL: compiled and run by the OpenGL driver."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from . import opengl
from .interface import Interface, Run, Runner
from .sources import EmittedSource

WRAPPER = Path(__file__).with_suffix(".comp")


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """Compile a file for the OpenGL device, and yield a function that runs it. Raises ShaderError, NoDeviceError."""
    source = EmittedSource(WRAPPER, path, interface)
    with opengl.prepared(opengl.compiled(source.text, source.explain), interface) as run:
        yield run


RUNNER = Runner(prepared, opengl.device_name)
