"""An OpenGL ES 3.1 context without a window, and one compute shader in it: a process of its own.

OpenGL and OpenGL ES of one process would share the libraries' current context. The folder that is named holds
`code.comp`, `given.npy` and `NAME.table.npy`; `made.npy` and `words.npy` are written there. Prints what the context is.
"""

from __future__ import annotations

import ctypes
import json
import sys
from ctypes import CFUNCTYPE, byref, c_char_p, c_int, c_uint, c_void_p
from pathlib import Path
from typing import Any

import numpy as np

from .essl import NO_CONTEXT, REFUSED
from .interface import GIVEN, MADE

# EGL 1.5 and its extension for contexts without a surface; OpenGL ES 3.1.
SURFACELESS, ES_API, NONE = 0x31DD, 0x30A0, 0x3038
MAJOR, MINOR = 0x3098, 0x30FB
RENDERER, VERSION = 0x1F01, 0x1F02
COMPUTE, COMPILED, LINKED = 0x91B9, 0x8B81, 0x8B82
BUFFER, COPY = 0x90D2, 0x88EA
TEXTURE, RGBA32F, RGBA, FLOAT = 0x0DE1, 0x8814, 0x1908, 0x1406
NEAREST, FILTERS, UNIT_0 = 0x2600, (0x2801, 0x2800), 0x84C0
READ, ALL_BARRIERS = 0x0001, 0xFFFFFFFF
GROUP = 64


class EndedError(Exception):
    """One line, and the status that the process ends with."""


def egl() -> Any:
    """The EGL library. Raises EndedError."""
    try:
        found = ctypes.CDLL("libEGL.so.1")
    except OSError as error:
        raise EndedError(str(error), NO_CONTEXT) from error
    found.eglGetProcAddress.restype, found.eglGetProcAddress.argtypes = c_void_p, [c_char_p]
    for name in ("eglCreateContext",):
        getattr(found, name).restype, getattr(found, name).argtypes = c_void_p, [c_void_p] * 4
    found.eglMakeCurrent.argtypes, found.eglInitialize.argtypes = [c_void_p] * 4, [c_void_p] * 3
    return found


def function(library: Any, name: str, result: Any, *given: Any) -> Any:
    """A function of EGL or of OpenGL ES. Raises EndedError."""
    place = library.eglGetProcAddress(name.encode())
    if not place:
        raise EndedError(f"there is no {name}", NO_CONTEXT)
    return CFUNCTYPE(result, *given)(place)


def make_current(library: Any) -> None:
    """A context of OpenGL ES 3.1, current in this process until it ends. Raises EndedError."""
    display = function(library, "eglGetPlatformDisplayEXT", c_void_p, c_uint, c_void_p, c_void_p)
    found = display(SURFACELESS, None, None)
    if not found or not library.eglInitialize(found, None, None) or not library.eglBindAPI(ES_API):
        raise EndedError("EGL has no display without a screen", NO_CONTEXT)
    wanted = (c_int * 5)(MAJOR, 3, MINOR, 1, NONE)
    context = library.eglCreateContext(found, None, None, wanted)
    if not context or not library.eglMakeCurrent(found, None, None, context):
        raise EndedError("the driver has none", NO_CONTEXT)


class Context:
    """The functions of OpenGL ES by name, as `gl.glCreateShader(...)`: whole numbers unless they are pointers."""

    def __init__(self, library: Any):
        self.library = library

    def call(self, name: str, *given: Any, result: Any = None) -> Any:
        """A function called; whole numbers go as 32-bit integers, anything else as a pointer."""
        types = [(c_int if value < 2**31 else c_uint) if isinstance(value, int) else c_void_p for value in given]
        return function(self.library, name, result, *types)(*given)


def compiled(gl: Context, text: str) -> int:
    """A compute program in use. Raises EndedError with the driver's first complaint."""
    shader, program = gl.call("glCreateShader", COMPUTE, result=c_uint), gl.call("glCreateProgram", result=c_uint)
    encoded = text.encode()
    gl.call("glShaderSource", shader, 1, byref(c_char_p(encoded)), None)
    gl.call("glCompileShader", shader)
    _check(gl, "Shader", shader, COMPILED)
    gl.call("glAttachShader", program, shader)
    gl.call("glLinkProgram", program)
    _check(gl, "Program", program, LINKED)
    gl.call("glUseProgram", program)
    return program


def _check(gl: Context, kind: str, thing: int, asked: int) -> None:
    is_made, log = c_int(), ctypes.create_string_buffer(4096)
    gl.call(f"glGet{kind}iv", thing, asked, byref(is_made))
    if not is_made.value:
        gl.call(f"glGet{kind}InfoLog", thing, len(log), None, log)
        lines = [line for line in log.value.decode(errors="replace").splitlines() if line.strip()]
        raise EndedError(
            next((line for line in lines if "error" in line), (lines or ["it does not compile"])[0]), REFUSED
        )


def upload(gl: Context, program: int, tables: list[Path]) -> None:
    """Look-up tables as textures of four floats, bound to the samplers of their names."""
    for unit, path in enumerate(tables):
        texels, name = np.ascontiguousarray(np.load(path)), c_uint()
        gl.call("glGenTextures", 1, byref(name))
        gl.call("glActiveTexture", UNIT_0 + unit)
        gl.call("glBindTexture", TEXTURE, name.value)
        height, width, _ = texels.shape
        gl.call("glTexImage2D", TEXTURE, 0, RGBA32F, width, height, 0, RGBA, FLOAT, c_void_p(texels.ctypes.data))
        for which in FILTERS:
            gl.call("glTexParameteri", TEXTURE, which, NEAREST)
        sampler = gl.call("glGetUniformLocation", program, c_char_p(path.name.split(".")[0].encode()), result=c_int)
        if sampler >= 0:
            gl.call("glUniform1i", sampler, unit)


def buffer(gl: Context, binding: int, size: int, data: Any = None) -> int:
    """A storage buffer at a binding; its name."""
    name = c_uint()
    gl.call("glGenBuffers", 1, byref(name))
    gl.call("glBindBuffer", BUFFER, name.value)
    function(gl.library, "glBufferData", None, c_uint, ctypes.c_ssize_t, c_void_p, c_uint)(BUFFER, size, data, COPY)
    gl.call("glBindBufferBase", BUFFER, binding, name.value)
    return name.value


def read(gl: Context, name: int, size: int, dtype: Any) -> np.ndarray:
    """What a storage buffer holds, as rows of four."""
    gl.call("glBindBuffer", BUFFER, name)
    mapped = function(gl.library, "glMapBufferRange", c_void_p, c_uint, ctypes.c_ssize_t, ctypes.c_ssize_t, c_uint)
    place = mapped(BUFFER, 0, size, READ)
    return np.frombuffer(ctypes.string_at(place, size), dtype).reshape(-1, 4)


def run(gl: Context, folder: Path) -> None:
    """The shader of a folder on its rows. Raises EndedError."""
    program = compiled(gl, (folder / "code.comp").read_text(encoding="utf-8"))
    upload(gl, program, sorted(folder.glob("*.table.npy")))
    given = np.ascontiguousarray(np.load(folder / "given.npy"), np.float32)
    count = len(given) // GIVEN
    sizes = (count * MADE * 16, count * 16)
    buffer(gl, 0, max(given.nbytes, 16), c_void_p(given.ctypes.data))
    made, words = (buffer(gl, at, max(size, 16)) for at, size in enumerate(sizes, 1))
    gl.call("glDispatchCompute", -(-count // GROUP), 1, 1)
    gl.call("glMemoryBarrier", ALL_BARRIERS)
    gl.call("glFinish")
    np.save(folder / "made.npy", read(gl, made, sizes[0], np.float32))
    np.save(folder / "words.npy", read(gl, words, sizes[1], np.uint32))


def main(folder: Path) -> int:
    """The status that the process ends with."""
    try:
        library = egl()
        make_current(library)
        gl = Context(library)
        if (folder / "code.comp").exists():
            run(gl, folder)
        asked = {"renderer": RENDERER, "version": VERSION}
        said = {name: gl.call("glGetString", which, result=c_char_p).decode() for name, which in asked.items()}
        print(json.dumps(said))
    except EndedError as error:
        print(error.args[0], file=sys.stderr)
        return error.args[1]
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
