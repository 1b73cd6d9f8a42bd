"""The OpenGL device: a headless context, its limits and its rounding."""

from __future__ import annotations

import sys
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import cache
from pathlib import Path
from typing import Any, Protocol, TypeVar

import moderngl
import numpy as np

from ...encodings.storages.rounding import store_texel
from ...encodings.storages.storage import STORAGES, Storage
from ...encodings.vec import jnp
from .lasting import Lasting
from .opened import OPENED
from .raw import DepthBuffer, attach_slice, samples_of
from .shader import ShaderError, Source

SOFTWARE = ("llvmpipe", "softpipe", "swrast", "swiftshader", "software")
DITHER, FRAMEBUFFER_SRGB = 0x0BD0, 0x8DB9
# How a device's own conversion may round.
NATIVE_ROUNDINGS = ("nearest", "truncate")
# Beyond these, what no frame uses is released.
KEPT_PROGRAMS = 64
# Sets of textures, each of up to a hundred megabytes.
KEPT_TEXTURES = 4
SRGB8_ALPHA8 = 0x8C43
# What pictures may be of, and as what a device is given it.
PICTURES = {"uint8": "f1", "uint16": "nu2", "float32": "f4"}
# Factors of what is drawn and of what is there: their sum, their product, and the one over the other by its alpha.
ADD, MULTIPLY = (moderngl.ONE, moderngl.ONE), (moderngl.DST_COLOR, moderngl.ZERO)
OVER = (moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA)
# The one over the other by `raw.blend_by`: GL's CONSTANT_ALPHA and ONE_MINUS_CONSTANT_ALPHA, unknown to moderngl.
BY_ALPHA = (0x8003, 0x8004)
# What is drawn of vertices that are no triangles' corners.
POINTS = moderngl.POINTS
# What to do about it, by system.
INSTALL = {
    "linux": "install an OpenGL driver (Debian: apt-get install libegl1 libgl1 libgl1-mesa-dri)",
    "win32": "install the driver of the GPU's vendor",
    "darwin": "Apple supports OpenGL only up to 4.1; use quality --backend wgsl, which runs on Metal",
}


class _Releasable(Protocol):
    def release(self) -> None: ...


Owned = TypeVar("Owned", bound=_Releasable)


class NoDeviceError(Exception):
    """This machine has no usable OpenGL driver."""


def _release_all(resources: Sequence[_Releasable]) -> None:
    for resource in resources:
        resource.release()


def _create_context() -> moderngl.Context:
    # EGL needs no display; only Linux has it. A missing library is reported as a plain Exception by glcontext.
    options: dict[str, Any] = {"backend": "egl"} if sys.platform == "linux" else {}
    try:
        return moderngl.create_context(standalone=True, require=430, **options)
    except Exception as error:
        reason = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
        raise NoDeviceError(f"no OpenGL 4.3 device: {reason}; {INSTALL.get(sys.platform, INSTALL['linux'])}") from error


class FormatError(Exception):
    """The device cannot render to a format."""


def _dtype(storage: Storage) -> str:
    if storage.is_integer:
        return f"u{storage.bits[0] // 8}"
    by_bits = {"float": {11: "f2", 16: "f2", 32: "f4"}, "unorm": {16: "f2"}, "snorm": {16: "f2"}}[storage.kind]
    return by_bits.get(storage.bits[0], "f1")


class Device:
    """An OpenGL context and the few operations of which passes consist.

    Raises:
        NoDeviceError: no OpenGL 4.3 driver was found; the message says what to install.
    """

    def __init__(self):
        self.context = _create_context()
        self.renderer = str(self.context.info["GL_RENDERER"])
        self.version = str(self.context.info["GL_VERSION"])
        self.is_software = any(word in self.renderer.lower() for word in SOFTWARE)
        self.max_size = int(self.context.info["GL_MAX_TEXTURE_SIZE"])
        self.max_volume = int(self.context.info["GL_MAX_3D_TEXTURE_SIZE"])
        info = self.context.info
        self.max_targets = int(min(info["GL_MAX_DRAW_BUFFERS"], info["GL_MAX_COLOR_ATTACHMENTS"]))
        samples = ("GL_MAX_SAMPLES", "GL_MAX_COLOR_TEXTURE_SAMPLES", "GL_MAX_DEPTH_TEXTURE_SAMPLES")
        self.max_samples = int(min(info[name] for name in samples))
        self._programs: Lasting[moderngl.Program] = Lasting(KEPT_PROGRAMS, lambda program: program.release())
        self._native: dict[str, str] = {}
        self._textures: Lasting[list[Any]] = Lasting(KEPT_TEXTURES, _release_all)
        # In use while no pass is: a framebuffer that is released while in use leaves an error for the next one.
        self.idle = self.context.simple_framebuffer((1, 1))
        # GL dithers by default, where it dithers at all: what is stored would not be what was written.
        self.context.disable_direct(DITHER)
        # sRGB targets are written and blended in linear light; others take no notice.
        self.context.enable_direct(FRAMEBUFFER_SRGB)

    def fragment_pass(self, path: str | Path, defines: Mapping[str, object] | None = None, names=None):
        """Return a vertex array that runs a fragment shader over a whole target when it is rendered; see `render`.

        Args:
            path, defines, names: as in `Source`.

        Raises:
            ShaderError: the shader does not compile; the message names the file and the line.
        """
        return self.context.vertex_array(self.program("fullscreen.vert", path, defines, names), [])

    def program(
        self, vertex: str | Path, fragment: str | Path, defines: Mapping[str, object] | None = None, names=None
    ):
        """Return a program of a vertex and a fragment shader, compiled with the same macros. Raises ShaderError as
        `fragment_pass` does."""
        return self._compiled_program(Source(vertex, defines, names), Source(fragment, defines, names))

    def shared_program(
        self,
        stack: ExitStack,
        vertex: str | Path,
        fragment: str | Path,
        defines: Mapping[str, object],
        names=None,
    ) -> moderngl.Program:
        """Return a program that is in use until the stack closes; the device keeps it for later requests for the same
        shaders. Raises ShaderError as `fragment_pass` does."""
        sources = Source(vertex, defines, names), Source(fragment, defines, names)
        key = (sources[0].text, sources[1].text)
        return self._programs.used(stack, key, lambda: self._compiled_program(*sources))

    def _compiled_program(self, first: Source, second: Source) -> moderngl.Program:
        try:
            return self.context.program(vertex_shader=first.text, fragment_shader=second.text)
        except moderngl.Error as error:
            # A complaint about a pair does not always say which of the two it is about: the vertex shader alone tells.
            with explained(first):
                self.context.program(vertex_shader=first.text).release()
            raise ShaderError(second.explain(str(error))) from error

    def compute_pass(self, path: str | Path, defines: Mapping[str, object] | None = None, names=None):
        """Return a compiled compute shader. Raises ShaderError as `fragment_pass` does."""
        source = Source(path, defines, names)
        with explained(source):
            return self.context.compute_shader(source.text)

    def computed(self, compute: moderngl.ComputeShader, inputs: Sequence[np.ndarray], outputs: int) -> list[np.ndarray]:
        """Run a compute shader in groups of 64 on float32 arrays of shape (count, 4), and return `outputs` arrays of
        that shape. Storage buffers are bound from 0 on: the inputs, then the outputs."""
        count = len(inputs[0])
        with ExitStack() as stack:
            given = [self.context.buffer(np.ascontiguousarray(a, np.float32)) for a in inputs]
            output_buffers = [self.context.buffer(reserve=count * 16) for _ in range(outputs)]
            for binding, buffer in enumerate([*given, *output_buffers]):
                self.owned(stack, buffer).bind_to_storage_buffer(binding)
            compute.run(group_x=(count + 63) // 64)
            return [np.frombuffer(buffer.read(), np.float32).reshape(count, 4) for buffer in output_buffers]

    def target(self, size: tuple[int, int], storage: Storage, samples: int = 1) -> moderngl.Texture:
        """Return a texture of a storage format to render to and to fetch from."""
        texture = self.context.texture(
            size,
            storage.channels,
            samples=samples if samples > 1 else 0,
            dtype=_dtype(storage),
            internal_format=storage.internal_format,
        )
        if samples == 1:
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def volume(self, size: tuple[int, int, int], storage: Storage) -> moderngl.Texture3D:
        """Return a volume (3D texture) to render to slice by slice. moderngl chooses its format by type and channels.

        Raises:
            FormatError: the volume is larger than the device supports.
        """
        if max(size) > self.max_volume:
            asked = " x ".join(map(str, size))
            raise FormatError(
                f"{self.renderer} supports at most {self.max_volume} texels per side of a volume, not {asked}"
            )
        volume = self.context.texture3d(size, storage.channels, dtype=_dtype(storage))
        volume.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return volume

    def depth_map(self, size: tuple[int, int]) -> moderngl.Texture:
        """Return a depth texture whose depths shaders can read as numbers, without comparison."""
        texture = self.context.depth_texture(size)
        texture.compare_func = ""
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    @staticmethod
    def smooth(texture: moderngl.Texture | moderngl.Texture3D) -> None:
        """Set a texture to linear filtering, clamped to its edge."""
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        texture.repeat_x = texture.repeat_y = False

    def mipmapped(self, texels: np.ndarray) -> moderngl.Texture:
        """Return a texture with mipmaps and trilinear filtering from a float16 array, (height, width, channels)."""
        height, width, channels = texels.shape
        texture = self.context.texture((width, height), channels, texels.tobytes(), dtype="f2")
        texture.build_mipmaps()
        texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        return texture

    def picture(self, texels: np.ndarray, is_srgb: bool, repeats: tuple[bool, bool]) -> moderngl.Texture:
        """Return a texture of texels of shape (height, width, 4): uint8 or uint16, read in [0, 1] and with mipmaps,
        or float32 without filtering.

        Args:
            is_srgb: whether the first three channels are on the sRGB curve; 8 bits only.
            repeats: whether the texture repeats along x and along y; otherwise its edge is extended.
        """
        height, width, _ = texels.shape
        data, dtype = np.ascontiguousarray(texels).tobytes(), PICTURES[texels.dtype.name]
        internal = {"internal_format": SRGB8_ALPHA8} if is_srgb else {}
        texture = self.context.texture((width, height), 4, data, dtype=dtype, **internal)
        if texels.dtype == np.float32:
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        else:
            texture.build_mipmaps()
            texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        texture.repeat_x, texture.repeat_y = repeats
        return texture

    def layers(self, pixels: np.ndarray) -> moderngl.TextureArray:
        """Return a float32 texture array, unfiltered, from an array, (layers, height, width, channels)."""
        count, height, width, channels = pixels.shape
        data = np.ascontiguousarray(pixels, np.float32).tobytes()
        texture = self.context.texture_array((width, height, count), channels, data, dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def lasting(
        self,
        stack: ExitStack,
        key: Hashable,
        make: Callable[[], Sequence[moderngl.Texture | moderngl.TextureArray]],
    ) -> list[Any]:
        """Return the textures for a key, from `make` unless the device still has them. The textures are in use until
        the stack closes, and are kept for later requests."""
        return self._textures.used(stack, key, lambda: list(make()))

    @staticmethod
    def build_mips(texture: moderngl.Texture) -> None:
        """Generate a target's mipmaps from its texels. Set linear filtering within the nearest level, clamped to the
        edge."""
        texture.build_mipmaps()
        texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
        texture.repeat_x = texture.repeat_y = False

    def given_samples(self, asked: int) -> int:
        """Return the samples per pixel that a target gets for a requested number, 1 or more: rounded down to a power
        of two and to the device's maximum, then up if the device does not support that number."""
        samples = 1 << (min(asked, self.max_samples).bit_length() - 1)
        if samples == 1:
            return 1
        with ExitStack() as stack:
            return samples_of(self.owned(stack, self.target((1, 1), STORAGES["rgba32f"], samples)))

    def upload(self, pixels: np.ndarray) -> moderngl.Texture:
        """Return a float32 texture, unfiltered, from an array of shape (height, width, channels)."""
        height, width, channels = pixels.shape
        data = np.ascontiguousarray(pixels, np.float32)
        texture = self.context.texture((width, height), channels, data, dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def render(
        self,
        passed: moderngl.VertexArray,
        targets: list[moderngl.Texture],
        depth: DepthBuffer | None = None,
        /,
        **textures: moderngl.Texture,
    ):
        """Run a fragment pass into targets; bind samplers by name, except those that the compiler dropped.

        Args:
            depth: the depth buffer to which `gl_FragDepth` is written, without a depth test.

        Raises:
            FormatError: the device cannot render to one of the targets.
        """
        framebuffer = self.framebuffer(targets)
        try:
            self.blend(None)
            if depth:
                self._write_depth(framebuffer, depth)
            framebuffer.use()
            bind(passed.program, textures)
            passed.render(moderngl.TRIANGLES, vertices=3)
        finally:
            self.idle.use()
            framebuffer.release()

    def _write_depth(self, framebuffer: moderngl.Framebuffer, depth: DepthBuffer) -> None:
        try:
            depth.attach(framebuffer)
        except moderngl.Error as error:
            raise FormatError(f"{self.renderer} cannot render to this depth format: {error}") from error
        framebuffer.depth_mask = True
        # Without the test nothing would be written; it lets everything pass.
        self.context.enable_only(moderngl.DEPTH_TEST)
        self.context.depth_func = "1"

    def framebuffer(
        self, targets: Sequence[moderngl.Texture], depth: DepthBuffer | moderngl.Texture | None = None
    ) -> moderngl.Framebuffer:
        """Return a framebuffer with colour textures and a depth texture, or with a depth texture only. Raises
        FormatError if the device cannot render to it."""
        try:
            if not isinstance(depth, DepthBuffer):
                return self.context.framebuffer(list(targets), depth)
            size, samples, none = depth.texture.size, depth.texture.samples, self.context.empty_framebuffer
            framebuffer = self.context.framebuffer(list(targets)) if targets else none(size, samples=samples)
            depth.attach(framebuffer)
        except moderngl.Error as error:
            raise FormatError(f"{self.renderer} cannot render to this format: {error}") from error
        return framebuffer

    def slice_framebuffer(self, volumes: Sequence[moderngl.Texture3D], layer: int | None) -> moderngl.Framebuffer:
        """Return a framebuffer for slice `layer` of each volume, or for all slices, by `gl_Layer`, if None. moderngl
        creates the framebuffer with flat targets, which the slices then replace."""
        width, height, _ = volumes[0].size
        with ExitStack() as stack:
            flat = [self.owned(stack, self.target((width, height), STORAGES["rgba8"])) for _ in volumes]
            framebuffer = self.framebuffer(flat)
            framebuffer.use()
            for index, volume in enumerate(volumes):
                attach_slice(index, volume.glo, layer)
        return framebuffer

    def blend(self, function: tuple[int, int] | None) -> None:
        """Set the source and destination blend factors for the following draws, None for no blending; turn off the
        depth test and culling."""
        self.state(None, function)

    def state(self, depth: str | None, blend: tuple[int, int] | None = None, cull: str | None = None) -> None:
        """Set the depth test, blending and culling for the following draws.

        Args:
            depth: the comparison, such as "<"; None for no depth test.
            blend: the source and destination factors; None for no blending.
            cull: the faces to cull, "front" or "back"; None to draw both."""
        flags = moderngl.NOTHING
        if depth:
            self.context.depth_func = depth
            flags |= moderngl.DEPTH_TEST
        if blend:
            self.context.blend_func = blend
            flags |= moderngl.BLEND
        if cull:
            self.context.cull_face = cull
            flags |= moderngl.CULL_FACE
        self.context.enable_only(flags)

    def cull(self, is_on: bool) -> None:
        """Turn culling on or off for the faces set by `state` or `cull_face`."""
        (self.context.enable if is_on else self.context.disable)(moderngl.CULL_FACE)

    def resolve(self, samples: moderngl.Texture, pixels: moderngl.Texture) -> None:
        """Average the samples of each pixel of the texture `samples` into the texture `pixels`, as the hardware does.
        Raises FormatError."""
        with ExitStack() as stack:
            source, target = (self.owned(stack, self.framebuffer([texture])) for texture in (samples, pixels))
            self.context.copy_framebuffer(target, source)
            self.idle.use()

    def through(self, values: np.ndarray, storage: Storage) -> np.ndarray:
        """Write values, float32, (height, width, 4), to a target of the format; return the values read back."""
        height, width, _ = values.shape
        with ExitStack() as stack:
            source = self.owned(stack, self.upload(values))
            kept = self.owned(stack, self.target((width, height), storage))
            result = self.owned(stack, self.target((width, height), STORAGES["rgba32f"]))
            copy = self.owned(stack, self.fragment_pass("copy.frag"))
            self.render(copy, [kept], source=source)
            self.render(copy, [result], source=kept)
            return read_pixels(result)

    @staticmethod
    def owned(stack: ExitStack, thing: Owned) -> Owned:
        """Return `thing` unchanged. When the stack closes, release it and, for a vertex array, its program."""
        stack.callback(thing.release)
        program = getattr(thing, "program", None)
        if program:
            stack.callback(program.release)
        return thing

    @property
    def answers(self) -> bool:
        """Whether the device still draws: a texel of a random colour must read back unchanged. A driver that has
        lost its GPU reports no error and returns arbitrary data."""
        texel = np.random.default_rng().integers(0, 256, 4, np.uint8)
        self.idle.clear(*(texel / np.float32(255)).tolist())
        return self.idle.read(components=4) == texel.tobytes()

    def native_rounding(self, storage: Storage) -> str:
        """Return how the device's own conversion to the format rounds: "nearest", "truncate" or "other"."""
        if storage.name not in self._native:
            self._native[storage.name] = self._probe_rounding(storage)
        return self._native[storage.name]

    def _probe_rounding(self, storage: Storage) -> str:
        if storage.kind == "float" and storage.bits[0] == 32:
            return "nearest"
        # An odd number of steps: no value falls on a tie, where the formats leave devices a choice.
        steps = 4085
        values = np.linspace(0.0 if storage.is_biased else -1.0, 1.0, steps + 1, dtype=np.float32)
        pixels = np.repeat(values[None, :, None], 4, axis=2)
        got = self.through(pixels, storage)[0, :, 0]
        for rounding in NATIVE_ROUNDINGS:
            expected = np.asarray(store_texel(jnp.asarray(values), storage, 0, rounding))
            if np.array_equal(in_steps(got, storage), in_steps(expected, storage)):
                return rounding
        return "other"


def bind(program: Any, textures: Mapping[str, moderngl.Texture | Sequence[moderngl.Texture]]) -> None:
    """Bind textures to a program's samplers by name, and lists of textures to arrays of samplers; skip samplers that
    the compiler dropped."""
    unit = 0
    for name, given in textures.items():
        if name not in program:
            continue
        several = list(given) if isinstance(given, Sequence) else [given]
        # The compiler shortens an array whose last elements nobody reads.
        several = several[: program[name].array_length]
        units = list(range(unit, unit + len(several)))
        program[name].value = units[0] if len(units) == 1 else units
        for slot, texture in zip(units, several, strict=True):
            texture.use(slot)
        unit += len(units)


@contextmanager
def explained(source: Source) -> Iterator[None]:
    """Run a block; reraise a compiler error in it as a ShaderError that names the source's files and lines."""
    try:
        yield
    except moderngl.Error as error:
        raise ShaderError(source.explain(str(error))) from error


def in_steps(texels: np.ndarray, storage: Storage, channel: int = 0) -> np.ndarray:
    """Return texels read back from a device as the integers that the format stores; float and sRGB texels unchanged.

    To decode an integer, some devices divide by the scale (an H100) and others multiply by its reciprocal (llvmpipe).
    The results may differ by a unit in the last place although the stored integers are the same.
    """
    # What comes back of the sRGB curve is light, whose steps are uneven.
    if storage.kind == "float" or storage.curved:
        return texels
    return np.rint(texels * storage.scale(channel))


def read_pixels(texture: moderngl.Texture) -> np.ndarray:
    """Return the texels of a float32 texture, read back from the device, (height, width, channels)."""
    width, height = texture.size
    return np.frombuffer(texture.read(), np.float32).reshape(height, width, texture.components)


@cache
def device() -> Device:
    """Return the process's only OpenGL device, opened by the first call. Raises NoDeviceError."""
    gl_device = Device()
    OPENED.append(gl_device)
    return gl_device
