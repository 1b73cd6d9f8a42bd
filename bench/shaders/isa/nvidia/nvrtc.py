"""NVRTC, which compiles CUDA C++ without needing the GPU. It runs in a child process (`child`)."""

from __future__ import annotations

import ctypes
from pathlib import Path

from ..compiler import DriverError

# The graphics driver's own arithmetic: denormals are zero, quotients and roots are approximations, products are fused.
OPTIONS = ("--use_fast_math", "--device-as-default-execution-space", "--std=c++17")


class Nvrtc:
    """The NVRTC library.

    Attributes:
        version: its version, such as "12.9".

    Raises:
        DriverError: the library cannot be loaded.
    """

    def __init__(self, path: Path):
        try:
            self._library = ctypes.CDLL(str(path))
            major, minor = ctypes.c_int(), ctypes.c_int()
            self._asked("nvrtcVersion", ctypes.byref(major), ctypes.byref(minor))
        except (OSError, AttributeError) as error:
            raise DriverError(f"{path.name} cannot be loaded: {error}") from error
        self.version = f"{major.value}.{minor.value}"

    def check(self, architecture: str) -> None:
        """Raise DriverError for an architecture that NVRTC does not compile for."""
        count = ctypes.c_int()
        self._asked("nvrtcGetNumSupportedArchs", ctypes.byref(count))
        numbers = (ctypes.c_int * count.value)()
        self._asked("nvrtcGetSupportedArchs", numbers)
        known = [f"sm_{number}" for number in numbers]
        if architecture not in known:
            raise DriverError(f"NVRTC {self.version} does not compile for {architecture}; known: {', '.join(known)}")

    def cubin(self, text: str, architecture: str) -> bytes:
        """Compile a program's text for an architecture, and return the ELF file. Raises DriverError."""
        program = ctypes.c_void_p()
        self._asked("nvrtcCreateProgram", ctypes.byref(program), text.encode(), b"kernel.cu", 0, None, None)
        try:
            options = [option.encode() for option in (f"--gpu-architecture={architecture}", *OPTIONS)]
            given = (ctypes.c_char_p * len(options))(*options)
            if self._library.nvrtcCompileProgram(program, len(options), given):
                raise DriverError(f"NVRTC cannot compile the kernel: {self._log(program)}")
            return self._output_bytes("CUBIN", program)
        finally:
            self._library.nvrtcDestroyProgram(ctypes.byref(program))

    def _log(self, program: ctypes.c_void_p) -> str:
        """Return the first error line in a program's log, or else the log's first line; at most 200 characters."""
        lines = self._output_bytes("ProgramLog", program).decode(errors="replace").strip("\0\n").splitlines()
        return next((line for line in lines if "error" in line), lines[0] if lines else "no message")[:200]

    def _output_bytes(self, what: str, program: ctypes.c_void_p) -> bytes:
        size = ctypes.c_size_t()
        self._asked(f"nvrtcGet{what}Size", program, ctypes.byref(size))
        held = ctypes.create_string_buffer(size.value)
        self._asked(f"nvrtcGet{what}", program, held)
        return held.raw

    def _asked(self, name: str, *given: object) -> None:
        if status := getattr(self._library, name)(*given):
            raise DriverError(f"NVRTC: {name} failed with status {status}")
