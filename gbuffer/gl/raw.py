"""OpenGL calls that moderngl lacks: depth with stencil, two-sided stencil, write masks and SPIR-V programs."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

import moderngl

TEXTURE_2D, TEXTURE_2D_MULTISAMPLE, TEXTURE_SAMPLES = 0x0DE1, 0x9100, 0x9106
DEPTH32F_STENCIL8 = 0x8CAD
DEPTH_ATTACHMENT, DEPTH_STENCIL_ATTACHMENT, FRAMEBUFFER, COMPLETE = 0x8D00, 0x821A, 0x8D40, 0x8CD5
FRAMEBUFFER_DEPTH_STENCIL, STENCIL = 0x84F9, 0x1802
STENCIL_TEST, DEPTH_CLAMP = 0x0B90, 0x864F
COLOR, COLOR_ATTACHMENT = 0x1800, 0x8CE0
FRONT, BACK, FRONT_AND_BACK = 0x0404, 0x0405, 0x0408
ALWAYS, NOTEQUAL = 0x0207, 0x0205
COMPUTE, SPIRV, LINKED, ALL_BARRIERS = 0x91B9, 0x9551, 0x8B82, 0xFFFFFFFF
KEEP, ZERO, REPLACE, INCR_WRAP, DECR_WRAP = 0x1E00, 0, 0x1E01, 0x8507, 0x8508

_SIGNATURES = {
    "glGenTextures": "ip",
    "glDeleteTextures": "ip",
    "glBindTexture": "ui",
    "glTexStorage2D": "uiuii",
    "glGetTexLevelParameteriv": "uiup",
    "glCompressedTexImage2D": "uiuiiiip",
    "glTexStorage2DMultisample": "uiuiib",
    "glFramebufferTexture2D": "uuuui",
    "glFramebufferTexture": "uuui",
    "glFramebufferTextureLayer": "uuuii",
    "glCheckFramebufferStatus": "u",
    "glBlendColor": "ffff",
    "glClearBufferfi": "uifi",
    "glClearBufferiv": "uip",
    "glClearBufferuiv": "uip",
    "glColorMask": "bbbb",
    "glStencilFunc": "uiu",
    "glStencilOpSeparate": "uuuu",
    "glCreateShader": "u",
    "glShaderBinary": "ipupi",
    "glSpecializeShader": "upupp",
    "glCreateProgram": "",
    "glAttachShader": "uu",
    "glLinkProgram": "u",
    "glGetProgramiv": "uup",
    "glGetProgramInfoLog": "uipp",
    "glUseProgram": "u",
    "glDispatchCompute": "uuu",
    "glMemoryBarrier": "u",
}
_TYPES = {"i": ctypes.c_int, "u": ctypes.c_uint, "f": ctypes.c_float, "b": ctypes.c_ubyte, "p": ctypes.c_void_p}


# GL's libraries, and what finds its functions in them.
_FINDERS = {
    "libEGL.so.1": "eglGetProcAddress",
    "libGL.so.1": "glXGetProcAddress",
    "opengl32.dll": "wglGetProcAddress",
}


@cache
def _lookup() -> Callable[[bytes], int | None]:
    """Return a function that maps the name of an OpenGL function, in bytes, to its address in the current context, or
    to None. Raises OSError if no OpenGL library can be loaded."""
    for name, function in _FINDERS.items():
        try:
            library = ctypes.CDLL(name)
            find = getattr(library, function)
        except (OSError, AttributeError):
            continue
        find.restype, find.argtypes = ctypes.c_void_p, [ctypes.c_char_p]
        return lambda wanted: _address(find(wanted)) or _address_within(library, wanted.decode())
    raise OSError(f"none of {', '.join(_FINDERS)} can be loaded")


def _address(address: int | None) -> int | None:
    """Return the address that a finder returned; None for the values that mean "not found" in WGL."""
    return None if address in (None, 1, 2, 3, ctypes.c_void_p(-1).value) else address


def _address_within(library: ctypes.CDLL, name: str) -> int | None:
    """Return the address of a library's own function, such as OpenGL 1.1's in opengl32.dll; None if not found."""
    symbol = getattr(library, name, None)
    return ctypes.cast(symbol, ctypes.c_void_p).value if symbol else None


@cache
def function(name: str) -> Callable[..., Any]:
    """Return an OpenGL function, with its C types, by a name in _SIGNATURES."""
    address = _lookup()(name.encode())
    arguments = [_TYPES[letter] for letter in _SIGNATURES[name]]
    return ctypes.CFUNCTYPE(ctypes.c_uint, *arguments)(address or 0)


def samples_of(texture: moderngl.Texture) -> int:
    """Return the samples per pixel of a multisample texture, which may be more than were requested."""
    samples = ctypes.c_int()
    function("glBindTexture")(TEXTURE_2D_MULTISAMPLE, texture.glo)
    function("glGetTexLevelParameteriv")(TEXTURE_2D_MULTISAMPLE, 0, TEXTURE_SAMPLES, ctypes.byref(samples))
    function("glBindTexture")(TEXTURE_2D_MULTISAMPLE, 0)
    return samples.value


class DepthBuffer:
    """A depth texture that render passes can test against and write to, and that shaders can read.

    Args:
        context: the current OpenGL context.
        size: width and height in pixels.
        samples: samples per pixel: 1, or a number that the device supports.
        internal_format: the OpenGL enum of the format.
        attachment: its attachment point in a framebuffer, DEPTH_ATTACHMENT or DEPTH_STENCIL_ATTACHMENT.
    """

    def __init__(
        self,
        context: moderngl.Context,
        size: tuple[int, int],
        samples: int,
        internal_format: int,
        attachment: int = DEPTH_ATTACHMENT,
    ):
        self._target = TEXTURE_2D_MULTISAMPLE if samples > 1 else TEXTURE_2D
        self._attachment = attachment
        number = ctypes.c_uint()
        function("glGenTextures")(1, ctypes.byref(number))
        self._number = number.value
        function("glBindTexture")(self._target, self._number)
        if samples > 1:
            function("glTexStorage2DMultisample")(self._target, samples, internal_format, *size, 1)
        else:
            function("glTexStorage2D")(self._target, 1, internal_format, *size)
        function("glBindTexture")(self._target, 0)
        self.texture = context.external_texture(self._number, size, 1, samples if samples > 1 else 0, "f4")
        if samples == 1:
            self.texture.filter = (moderngl.NEAREST, moderngl.NEAREST)

    def attach(self, framebuffer: moderngl.Framebuffer) -> None:
        """Attach the buffer to a framebuffer as depth, and as stencil if it has one; the framebuffer becomes current.
        Raises moderngl.Error if the framebuffer is then incomplete."""
        framebuffer.use()
        function("glFramebufferTexture2D")(FRAMEBUFFER, self._attachment, self._target, self._number, 0)
        status = function("glCheckFramebufferStatus")(FRAMEBUFFER)
        if status != COMPLETE:
            raise moderngl.Error(f"the framebuffer is not complete ({status:#x})")

    def release(self) -> None:
        """Free it on the device."""
        function("glDeleteTextures")(1, ctypes.byref(ctypes.c_uint(self._number)))


def compressed_texture(size: tuple[int, int], internal_format: int, blocks: bytes) -> int:
    """Create a texture from compressed blocks, row by row, and return its OpenGL name. An unknown format leaves an
    OpenGL error and a texture without texels."""
    number = ctypes.c_uint()
    function("glGenTextures")(1, ctypes.byref(number))
    function("glBindTexture")(TEXTURE_2D, number.value)
    function("glCompressedTexImage2D")(TEXTURE_2D, 0, internal_format, *size, 0, len(blocks), blocks)
    function("glBindTexture")(TEXTURE_2D, 0)
    return number.value


def delete_texture(number: int) -> None:
    """Free a texture by its OpenGL name, a number."""
    function("glDeleteTextures")(1, ctypes.byref(ctypes.c_uint(number)))


def attach_slice(index: int, volume: int, layer: int | None) -> None:
    """Attach a volume's slice `layer`, or all if None, as colour attachment `index` of the current framebuffer."""
    if layer is None:
        function("glFramebufferTexture")(FRAMEBUFFER, COLOR_ATTACHMENT + index, volume, 0)
    else:
        function("glFramebufferTextureLayer")(FRAMEBUFFER, COLOR_ATTACHMENT + index, volume, 0, layer)


def depth_stencil(context: moderngl.Context, size: tuple[int, int], samples: int) -> DepthBuffer:
    """Return a new depth buffer with stencil, D32F S8."""
    return DepthBuffer(context, size, samples, DEPTH32F_STENCIL8, DEPTH_STENCIL_ATTACHMENT)


def clear_depth_stencil() -> None:
    """Clear depth to 1 and stencil to 0 in the current framebuffer."""
    function("glClearBufferfi")(FRAMEBUFFER_DEPTH_STENCIL, 0, 1.0, 0)


def clear_words(attachments: Iterable[int]) -> None:
    """Clear integer colour attachments of the current framebuffer, by their numbers, to 0."""
    for attachment in attachments:
        function("glClearBufferuiv")(COLOR, attachment, (ctypes.c_uint * 4)())


def mark_volume() -> None:
    """Make draws change only the stencil: a back face behind the drawn surface increments it, a front face
    decrements it. Surfaces inside a closed volume end up at 1, wherever the eye is (depth fail)."""
    function("glColorMask")(0, 0, 0, 0)
    function("glStencilFunc")(ALWAYS, 0, 0xFF)
    function("glStencilOpSeparate")(BACK, KEEP, INCR_WRAP, KEEP)
    function("glStencilOpSeparate")(FRONT, KEEP, DECR_WRAP, KEEP)


def shade_marked(again: bool = False) -> None:
    """Make draws change colour only where the stencil is not 0, and then set the stencil to 0; keep the stencil if
    `again`, for another draw."""
    function("glColorMask")(1, 1, 1, 1)
    function("glStencilFunc")(NOTEQUAL, 0, 0xFF)
    after = KEEP if again else ZERO
    function("glStencilOpSeparate")(FRONT_AND_BACK, KEEP, after, after)


def once_a_pixel(number: int) -> None:
    """Make draws change a sample only if its stencil is not `number` (1 to 255), and then set it to `number`."""
    function("glStencilFunc")(NOTEQUAL, number, 0xFF)
    function("glStencilOpSeparate")(FRONT_AND_BACK, KEEP, KEEP, REPLACE)


def clear_stencil() -> None:
    """Clear the stencil of the current framebuffer to 0; leave the depth unchanged."""
    function("glClearBufferiv")(STENCIL, 0, ctypes.byref(ctypes.c_int(0)))


def blend_by(alpha: float) -> None:
    """Set the alpha that `device.BY_ALPHA` uses in the draws that follow."""
    function("glBlendColor")(alpha, alpha, alpha, alpha)


def compute_program(code: bytes, entry: str) -> int:
    """Return the OpenGL name of a compute program made from a SPIR-V module whose main function is `entry`. The
    device must support GL_ARB_gl_spirv. Raises moderngl.Error if the driver rejects the module.
    """
    shader, program = ctypes.c_uint(function("glCreateShader")(COMPUTE)), function("glCreateProgram")()
    function("glShaderBinary")(1, ctypes.byref(shader), SPIRV, code, len(code))
    function("glSpecializeShader")(shader, entry.encode(), 0, None, None)
    function("glAttachShader")(program, shader)
    function("glLinkProgram")(program)
    is_linked, log = ctypes.c_int(), ctypes.create_string_buffer(1024)
    function("glGetProgramiv")(program, LINKED, ctypes.byref(is_linked))
    if not is_linked.value:
        function("glGetProgramInfoLog")(program, len(log), None, log)
        raise moderngl.Error(log.value.decode(errors="replace") or "the driver cannot link the SPIR-V")
    return program


def dispatch(program: int, groups: int) -> None:
    """Run groups of a compute program; a barrier makes the program's writes visible to all later commands."""
    function("glUseProgram")(program)
    function("glDispatchCompute")(groups, 1, 1)
    function("glMemoryBarrier")(ALL_BARRIERS)
