"""Tangent frames through a real render target: encoded by one fragment pass, decoded from the texture by a second."""

from __future__ import annotations

import re
from contextlib import ExitStack
from typing import Any

import numpy as np

from ...encodings import vec
from ...encodings.frame_codec import FrameCodec
from ...encodings.frame_encoding import FrameEncoding
from ...encodings.storage import STORAGES
from ..gl.device import Device, read_pixels
from ..gl.shader import ShaderError, read_shader
from .codec_passes import storage_defines

ROUNDING = "nearest"


def frame_defines(encoding: FrameEncoding, least: float) -> dict[str, object]:
    """The macros that make `frame_code.glsl` speak of an encoding.

    Raises:
        ShaderError: its GLSL file cannot be read or lacks one of its functions.
    """
    name, text = encoding.name, re.sub(r"\s+", " ", read_shader(encoding.glsl))
    wanted = [f"vec4 {name}_encode(Frame frame, float least)", f"Frame {name}_decode(vec4 e, float least)"]
    wanted += [f"vec4 {name}_settle(Frame frame, vec4 stored)"] if encoding.settle else []
    for signature in wanted:
        if not re.search(rf"\b{signature.split('(')[0]} ?\(", text):
            raise ShaderError(f"{encoding.glsl}: no function {signature}")
    return {
        "FRAME_ENCODE": f"{name}_encode",
        "FRAME_DECODE": f"{name}_decode",
        "FRAME_SETTLE": f"{name}_settle",
        "FRAME_SETTLES": int(encoding.settle is not None),
        "FRAME_LEAST": float(least),
        **vec.CONSTANTS,
        **encoding.constants,
    }


class FramePasses:
    """A frame codec on a GL device; a context manager that releases what it holds there.

    Attributes:
        rounded_by: "device" where the format's own conversion rounds to nearest, else "shader".

    Raises:
        ShaderError: the encoding's GLSL does not compile.
        FormatError: the device cannot render to the storage's format.
    """

    def __init__(self, device: Device, codec: FrameCodec):
        self._device, self._storage = device, codec.storage
        is_native = not codec.storage.is_packed and device.native_rounding(codec.storage) == ROUNDING
        self.rounded_by = "device" if is_native else "shader"
        defines = {
            **frame_defines(codec.encoding, codec.least),
            **storage_defines(codec.storage, [ROUNDING] * codec.storage.channels, not is_native),
        }
        names = {"FRAME_ENCODING": codec.encoding.glsl}
        with ExitStack() as stack:
            self._encode = device.owned(stack, device.fragment_pass("frame_encode.frag", defines, names))
            self._decode = device.owned(stack, device.fragment_pass("frame_decode.frag", defines, names))
            self._stack = stack.pop_all()

    def __enter__(self) -> FramePasses:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def round_trip(self, normals: np.ndarray, tangents: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Normals with hands, and tangents, float32 of shape (height, width, 4), encoded, stored and decoded.

        Raises:
            FormatError: the device cannot render to the storage's format.
        """
        device, size = self._device, (normals.shape[1], normals.shape[0])
        with ExitStack() as stack:
            given = {"normals": normals, "tangents": tangents}
            sources = {name: device.owned(stack, device.upload(pixels)) for name, pixels in given.items()}
            texels, *results = (
                device.owned(stack, device.target(size, kind))
                for kind in (self._storage.target, STORAGES["rgba32f"], STORAGES["rgba32f"])
            )
            device.render(self._encode, [texels], **sources)
            device.render(self._decode, results, texels=texels)
            decoded_normals, decoded_tangents = (read_pixels(result) for result in results)
        return decoded_normals, decoded_tangents


def exact_frames(device: Device, encoding: FrameEncoding, least: float, *given: np.ndarray) -> list[np.ndarray]:
    """Codes of frames, and frames of codes, by a compute shader and without storage.

    Args:
        given: normals with hands, tangents, and codes to decode; float32 arrays of shape (count, 4).

    Returns:
        codes, decoded normals with hands, and decoded tangents, likewise.
    """
    names = {"FRAME_ENCODING": encoding.glsl}
    with ExitStack() as stack:
        compute: Any = device.owned(
            stack, device.compute_pass("frame_parity.comp", frame_defines(encoding, least), names)
        )
        return device.computed(compute, given, 3)
