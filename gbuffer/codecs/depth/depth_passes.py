"""Round trips of depths through a real render target or depth buffer: one fragment pass encodes, a second decodes."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from ....encodings import vec
from ....encodings.codecs.depth_codec import DepthCodec, DepthEncoding
from ....encodings.shared.position import Camera
from ....encodings.storages.depth_storage import DepthStorage, store_depth
from ....encodings.storages.storage import FORMATS, ROUNDINGS, rounds_to
from ....encodings.vec import jnp
from ...gl.device import Device, read_pixels
from ...gl.handles import Texture, VertexArray
from ...gl.raw import DepthBuffer
from ..codec_passes import storage_kind
from ..harness import Passes, Textures, check_functions, dithering, exact, set_uniforms

HOMES = ("packed", "channel", "attachment", "bytes")


def depth_defines(encoding: DepthEncoding) -> dict[str, object]:
    """Return the macros that adapt `depth_code.glsl` to an encoding.

    Raises:
        ShaderError: the encoding's GLSL file cannot be read or lacks one of the two functions.
    """
    check_functions(encoding.glsl, encoding.signatures)
    return {
        "DEPTH_ENCODE": f"{encoding.prefix}_encode_depth",
        "DEPTH_DECODE": f"{encoding.prefix}_decode_depth",
        "DEPTH_SIGNED": int(encoding.signed),
        "DEPTH_OWN_UNITS": int(encoding.own_units),
        **vec.CONSTANTS,
        **encoding.constants,
    }


def _storage_defines(storage: DepthStorage, rounding: str, shader_rounds: bool) -> dict[str, object]:
    return {
        "ROUNDING": ROUNDINGS.index(rounding),
        "HOME": HOMES.index(storage.home),
        "BITS": storage.bits,
        "FIRST": sum(storage.format.bits) - storage.bits,
        "SCALE": float(storage.scale),
        "KIND": storage_kind(storage.format),
        "ROUNDS": int(shader_rounds),
        "OPEN": int(storage.is_open),
        **({} if storage.code is None else _bytes_defines(storage.code)),
    }


def _bytes_defines(code: DepthEncoding) -> dict[str, object]:
    check_functions(code.glsl, code.signatures)
    return {"BYTES_ENCODE": f"{code.prefix}_encode_bytes", "BYTES_DECODE": f"{code.prefix}_decode_bytes"}


@dataclass(frozen=True)
class Rebuilt:
    """Results of a round trip: `positions` (height, width, 3), and the `numbers` and `depths` that they are
    computed from, (height, width), float32; `depths` have the stored sign."""

    positions: np.ndarray
    numbers: np.ndarray
    depths: np.ndarray


class DepthPasses(Passes):
    """A depth codec on an OpenGL device; a context manager that releases its resources there.

    Attributes:
        rounded_by: "device" if the storage's own conversion rounds as the codec requires, else "shader".

    Raises:
        ShaderError: the encoding's GLSL does not compile.
        FormatError: the device cannot render to the storage's format.
    """

    def __init__(self, device: Device, codec: DepthCodec):
        self._codec, rounding = codec, rounds_to(codec.rounding)
        is_native = rounds_by_itself(device, codec.storage, rounding)
        self.rounded_by = "device" if is_native else "shader"
        added, tables = dithering(codec.dither.added if codec.is_dithered else None)
        defines = depth_defines(codec.encoding) | _storage_defines(codec.storage, rounding, not is_native) | added
        code = codec.storage.code
        shaders = ("depth_encode.frag", "depth_decode.frag")
        names = {"DEPTH_ENCODING": (codec.encoding.glsl, *((code.glsl,) if code else ()))}
        super().__init__(device, shaders, defines, names, {"texels": codec.storage.format}, tables)

    def round_trip(self, points: np.ndarray, camera: Camera, way: int) -> Rebuilt:
        """Encode and store the depths of points on the screen, and return the positions rebuilt from them, with the
        numbers and depths that they are computed from.

        Args:
            points: screen position (-1 to 1, right and up) and view depth, float32 of shape (height, width, 3).
            way: the `way` of a `Rebuild`; methods that use the projection need a depth buffer's number.
        """
        given = _camera_uniforms(camera, self._codec.encoding) | {"way": way}
        for program in (self._encode.program, self._decode.program):
            set_uniforms(program, given)
        positions, stored = self._through([FORMATS["rgba32f"], FORMATS["rg32f"]], points=points)
        return Rebuilt(positions[..., :3], stored[..., 0], stored[..., 1])

    def _written_textures(self, stack: ExitStack, sources: Textures) -> Textures:
        given = {"points": sources["points"], **self._tables}
        return {"texels": _stored_texture(self._device, stack, self._codec.storage, self._encode, given)}


def _camera_uniforms(camera: Camera, encoding: DepthEncoding) -> dict[str, Any]:
    """Return the uniforms that describe a camera, by name."""
    projection = encoding.projection
    return {
        "rays": camera.rays,
        "range": (camera.near, camera.far),
        "clip": projection.clip if projection else (1.0, 0.0),
        "terms": camera.terms(projection),
        "clip_to_view": tuple(camera.clip_to_view(projection).T.ravel()),
    }


def _stored_texture(
    device: Device, stack: ExitStack, storage: DepthStorage, passed: VertexArray, given: Textures
) -> Texture:
    """Return the texture of a storage that a pass writes from textures, given by sampler name; it has their size and
    is released with the stack."""
    size = given["points"].size
    if storage.home != "attachment":
        target = device.owned(stack, device.target(size, storage.format))
        device.render(passed, [target], **given)
        return target
    buffer = DepthBuffer(device.context, size, 1, storage.format.internal_format)
    stack.callback(buffer.release)
    # A framebuffer of moderngl's has a colour target; nothing is written there.
    unused = device.owned(stack, device.target(size, FORMATS["r8"]))
    device.render(passed, [unused], buffer, **given)
    return buffer.texture


@cache
def rounds_by_itself(device: Device, storage: DepthStorage, rounding: str) -> bool:
    """Whether the device's own conversion into a storage rounds as the emulation does for `rounding`; always True for
    packed integers and bytes. A depth buffer is compared with rounding to nearest, whatever `rounding` is.

    Raises:
        FormatError: the device cannot render to the storage.
    """
    if storage.home in ("packed", "bytes"):
        return True  # bytes are whole numbers of the format's steps, or whatever the device makes of them
    if storage.home == "channel":
        return device.native_rounding(storage.format) == rounding
    # An odd number of steps: no value falls on a tie, where the formats leave devices a choice.
    numbers = np.linspace(0, 1, 4086, dtype=np.float32)
    expected = np.asarray(store_depth(jnp.asarray(numbers), storage))
    return np.array_equal(np.rint(expected * storage.scale), np.rint(through(device, storage, numbers) * storage.scale))


def through(device: Device, storage: DepthStorage, numbers: np.ndarray) -> np.ndarray:
    """Return float32 numbers, (count,), after they are written unchanged to a target's first channel or a depth
    buffer and read back.

    Raises:
        FormatError: the device cannot render to the storage.
    """
    points = np.zeros((1, len(numbers), 3), np.float32)
    points[0, :, 2] = numbers
    with ExitStack() as stack:
        source = device.owned(stack, device.upload(points))
        home = {"HOME": HOMES.index(storage.home)}
        write = device.owned(stack, device.fragment_pass("depth_as_it_is.frag", home))
        copy = device.owned(stack, device.fragment_pass("copy.frag"))
        result = device.owned(stack, device.target(source.size, FORMATS["rgba32f"]))
        device.render(copy, [result], source=_stored_texture(device, stack, storage, write, {"points": source}))
        return read_pixels(result)[0, :, 0].copy()


def exact_values(device: Device, encoding: DepthEncoding, camera: Camera, points: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the numbers for depths, the depths for numbers, and positions, from a compute shader, without storage.

    Args:
        points: place on the screen, depth, number; float32 of shape (count, 4).

    Returns:
        numbers and depths, (count, 2); positions from the numbers by the inverse projection and by its two terms, and
        from the depths by the eye ray, (count, 3).
    """
    defines, names = depth_defines(encoding), {"DEPTH_ENCODING": encoding.glsl}
    seen = _camera_uniforms(camera, encoding)
    values, *positions = exact(device, "depth_parity.comp", defines, names, [points], 4, **seen)
    return values[:, :2], *(position[:, :3] for position in positions)
