"""Round trips of tangent frames through a real render target: one fragment pass encodes, a second decodes."""

from __future__ import annotations

import numpy as np

from ....encodings import vec
from ....encodings.codecs.frame_codec import FrameCodec
from ....encodings.codecs.frame_encoding import FrameEncoding
from ....encodings.storages.storage import STORAGES, rounds_to
from ...gl.device import Device
from ..codec_passes import rounding_defines
from ..harness import Passes, check_functions, dithering, exact


def frame_defines(encoding: FrameEncoding, least: float) -> dict[str, object]:
    """Return the macros that adapt `frame_code.glsl` to an encoding; `least` is the codec's `least`.

    Raises:
        ShaderError: the encoding's GLSL file cannot be read or lacks one of its functions.
    """
    check_functions(encoding.glsl, encoding.signatures)
    name = encoding.prefix
    return {
        "FRAME_ENCODE": f"{name}_encode",
        "FRAME_DECODE": f"{name}_decode",
        "FRAME_SETTLE": f"{name}_settle",
        "FRAME_SETTLES": int(encoding.settle is not None),
        "FRAME_LEAST": float(least),
        **vec.CONSTANTS,
        **encoding.constants,
    }


class FramePasses(Passes):
    """A frame codec on an OpenGL device; a context manager that releases its resources there.

    Attributes:
        rounded_by: "device" if the format's own conversion rounds as the codec requires, else "shader".

    Raises:
        ShaderError: the encoding's GLSL does not compile.
        FormatError: the device cannot render to the storage's format.
    """

    def __init__(self, device: Device, codec: FrameCodec):
        encoding, storage = codec.encoding, codec.storage
        channels = [codec.rounding_of(channel) for channel in range(storage.channels)]
        self.rounded_by, rounds = rounding_defines(device, storage, rounds_to(codec.rounding), channels)
        added, tables = dithering(codec.dither.added if codec.is_dithered else None)
        defines = frame_defines(encoding, codec.least) | rounds | added
        shaders, names = ("frame_encode.frag", "frame_decode.frag"), {"FRAME_ENCODING": encoding.glsl}
        super().__init__(device, shaders, defines, names, {"texels": storage.target}, tables)

    def round_trip(self, normals: np.ndarray, tangents: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return normals with hands, and tangents, float32 of shape (height, width, 4), after encoding, storage and
        decoding; two arrays of the same shape.

        Raises:
            FormatError: the device cannot render to the storage's format.
        """
        decoded_normals, decoded_tangents = self._through([STORAGES["rgba32f"]] * 2, normals=normals, tangents=tangents)
        return decoded_normals, decoded_tangents


def exact_frames(device: Device, encoding: FrameEncoding, least: float, *given: np.ndarray) -> list[np.ndarray]:
    """Return the codes of frames, and the frames of given codes, from a compute shader, without storage.

    Args:
        given: normals with hands, tangents, and codes to decode; float32 arrays of shape (count, 4).

    Returns:
        codes, decoded normals with hands, and decoded tangents; float32 arrays of shape (count, 4).
    """
    defines, names = frame_defines(encoding, least), {"FRAME_ENCODING": encoding.glsl}
    return exact(device, "frame_parity.comp", defines, names, given, 3)
