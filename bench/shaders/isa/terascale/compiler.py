"""Mesa's r600, asked what it makes of a fragment shader: a GL context on the null device, and what the driver prints.

R600_DEBUG=ps has it print each fragment shader's code to standard error. It compiles for the state that is drawn with,
so each shader is drawn once; the null device does nothing about it. Runs in a child process (`child`).
"""

from __future__ import annotations

import ctypes
import os
import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ....ground.machine.systems.people import how_to_install
from ..compiler import DriverError, MissingDriverError, fingerprint
from . import disassembly

# Where `driver.variables` tells the child that the driver is.
FOLDER, DRIVER = "LIBGL_DRIVERS_PATH", "r600_dri.so"
EGL = "libEGL.so.1"
# Lanes that an instruction is for, on all of these chips but the smallest.
WAVEFRONT = 64
# What a shader in 16-bit types asks for.
HALVES = b"explicit_arithmetic_types_float16"
_PRINTED = re.compile(r"^bytecode (\d+) dw -- (\d+) gprs -- .*\nshader .*\n((?:.*\n)*?)-{30,}$", re.M)


def loaded() -> dict[str, str]:
    """The driver's file and its fingerprint. Raises MissingDriverError where there is no EGL to load it."""
    try:
        ctypes.CDLL(EGL)
    except OSError as error:
        raise MissingDriverError(f"no EGL: {EGL} cannot be loaded; install it ({how_to_install('libegl1')})") from error
    path = Path(os.environ.get(FOLDER, "")) / DRIVER
    return {str(path): fingerprint(path)}


class Compiler:
    """A context that compiles and draws.

    Attributes:
        device: what the driver calls it.
        version: Mesa's.

    Raises:
        DriverError: there is none, or it is another driver's.
    """

    def __init__(self):
        from .....gbuffer.gl import once

        self._once = once
        try:
            self._context = once.context()
        except once.NoContextError as error:
            raise DriverError(f"r600 makes no context: {error}") from error
        # "AMD CYPRESS (DRM 2.50.0 / ...)", "4.3 (Core Profile) Mesa 22.3.6"
        self.device = once.renderer(self._context).split(" (")[0]
        self.version = once.version(self._context).split("Mesa ")[-1].split()[0]
        if not self.device.startswith("AMD "):
            raise DriverError(f"the driver offers {self.device}, which is not the null Radeon")

    def compile(self, stage: str, code: bytes, vertex: bytes, _: int) -> list[dict[str, Any]]:
        """What the compiler makes of a fragment shader: a list of one kernel, as `..compiler.Compiler.compile`.

        Args:
            stage: "fragment".
            code: the shader, and `vertex` the one before it, as GLSL.

        Raises:
            DriverError: it is of another stage, does not compile, or nothing was printed of it.
        """
        if stage != "fragment":
            raise DriverError(f"{stage} shaders: these counts are of fragment shaders alone")
        if HALVES in code:
            raise DriverError(f"{self.device} computes no shaders in 16 bits")
        with _standard_error() as printed:
            try:
                self._once.draw(self._context, vertex.decode(), code.decode())
            except self._once.NoContextError as error:
                raise DriverError(f"{self.device} does not compile it: {error}") from error
        found = _PRINTED.findall(printed[0])
        if not found:
            raise DriverError(f"{self.device} prints no code of it")
        # Once for no state in particular, and at last for the one that was drawn with.
        words, registers, assembly = found[-1]
        statistics = {"Instructions": disassembly.count(assembly), "VGPRs": int(registers), "Code size": 4 * int(words)}
        return [{"simd_width": WAVEFRONT, "statistics": statistics, "assembly": assembly}]


@contextmanager
def _standard_error() -> Iterator[list[str]]:
    """What the process prints to standard error within the block, which is there after it."""
    printed: list[str] = []
    with tempfile.TemporaryFile() as file:
        kept = os.dup(2)
        os.dup2(file.fileno(), 2)
        try:
            yield printed
        finally:
            os.dup2(kept, 2)
            os.close(kept)
            file.seek(0)
            printed.append(file.read().decode(errors="replace"))
