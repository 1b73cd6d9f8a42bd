"""Normals through a real render target: encoded by one fragment pass, decoded from the texture by a second."""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...encodings import vec
from ...encodings.codec import Codec
from ...encodings.encoding import Encoding
from ...encodings.storage import R32F, ROUNDINGS, STORAGES, Storage
from ..gl.device import Device, bind, read_pixels
from ..gl.shader import ShaderError, read_shader

KINDS = ("unorm", "snorm", "float")


def encoding_defines(encoding: Encoding) -> dict[str, object]:
    """The macros that make `code.glsl` speak of an encoding.

    Raises:
        ShaderError: its GLSL file cannot be read or lacks one of the two functions.
    """
    size = encoding.components + encoding.sign_bits
    code, text = f"vec{size}", re.sub(r"\s+", " ", read_shader(encoding.glsl))
    for result, verb, given in ((code, "encode", "vec3 n"), ("vec3", "decode", f"{code} e")):
        signature = f"{result} {encoding.prefix}_{verb}({given}, vec3 view)"
        if not re.search(rf"\b{result} {encoding.prefix}_{verb} ?\( ?{given.split()[0]}\b", text):
            raise ShaderError(f"{encoding.glsl}: no function {signature}")
    return {
        "CODE": code,
        "ENCODE": f"{encoding.prefix}_encode",
        "DECODE": f"{encoding.prefix}_decode",
        "COMPONENTS": encoding.components,
        "SIGN_BITS": encoding.sign_bits,
        "LEVELS": levels_of(encoding),
        "PRECISE": int(encoding.is_precise),
        **vec.CONSTANTS,
        **encoding.constants,
    }


def levels_of(encoding: Encoding) -> tuple[int, ...]:
    """How many values each of three numbers of a code has."""
    return tuple(encoding.levels_of(component) for component in range(3))


def storage_kind(storage: Storage) -> int:
    """A format's kind as `storage.glsl` counts them: UNORM 0, SNORM 1, half 2, small floats 3, 32-bit floats 4."""
    if storage.kind == "float":
        return {16: 2, 32: 4}.get(storage.bits[0], 3)
    return KINDS.index(storage.kind)


def storage_defines(storage: Storage, roundings: Sequence[str], shader_rounds: bool) -> dict[str, object]:
    """The macros that make `storage.glsl` speak of a storage; `roundings` is of each of its channels."""
    channels = [i % storage.channels for i in range(4)]
    scales = [storage.scale(i) for i in channels]
    return {
        "STORAGE_KIND": storage_kind(storage),
        "STORAGE_BIASED": int(storage.is_biased),
        "STORAGE_PACKED": int(storage.is_packed),
        "STORAGE_CHANNELS": storage.channels,
        "STORAGE_SCALE": tuple(float(scale) for scale in scales),
        "STORAGE_STEP": tuple(float(np.float32(1 / scale)) for scale in scales),
        "STORAGE_BITS": tuple(storage.bits[i] for i in channels),
        "STORAGE_ROUNDING": tuple(ROUNDINGS.index(roundings[i]) for i in channels),
        "SHADER_ROUNDS": int(shader_rounds),
    }


@dataclass(frozen=True)
class Decoded:
    """What came back: `normals` as decoded and `codes` as stored, float32 arrays of shape (height, width, 3 and 4)."""

    normals: np.ndarray
    codes: np.ndarray


class CodecPasses:
    """A codec on a GL device; a context manager that releases what it holds there.

    Attributes:
        rounded_by: "device" where the format's own conversion rounds as the codec asks, else "shader".

    Raises:
        ShaderError: the encoding's GLSL does not compile.
    """

    def __init__(self, device: Device, codec: Codec):
        self._device, self._codec = device, codec
        is_native = not codec.storage.is_packed and device.native_rounding(codec.storage) == codec.rounding
        self.rounded_by = "device" if is_native else "shader"
        roundings = [codec.rounding_of(channel) for channel in range(codec.storage.channels)]
        defines = {
            **encoding_defines(codec.encoding),
            **storage_defines(codec.storage, roundings, self.rounded_by == "shader"),
        }
        names = {"ENCODING": codec.encoding.glsl}
        with ExitStack() as stack:
            self._encode = device.owned(stack, device.fragment_pass("encode.frag", defines, names))
            self._decode = device.owned(stack, device.fragment_pass("decode.frag", defines, names))
            tables = codec.encoding.tables().items()
            self._tables = {name: device.owned(stack, device.upload(table)) for name, table in tables}
            self._stack = stack.pop_all()

    def __enter__(self) -> CodecPasses:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def round_trip(self, normals: np.ndarray, views: np.ndarray) -> Decoded:
        """Normals and view-space positions, float32 of shape (height, width, 4), encoded, stored and decoded.

        Raises:
            FormatError: the device cannot render to the storage's format.
        """
        size = (normals.shape[1], normals.shape[0])
        device, storage = self._device, self._codec.storage.target
        with ExitStack() as stack:
            given = {"normals": normals, "views": views}
            sources = {name: device.owned(stack, device.upload(pixels)) for name, pixels in given.items()}
            texels, depths, *results = (
                device.owned(stack, device.target(size, kind))
                for kind in (storage, R32F, STORAGES["rgba32f"], STORAGES["rgba32f"])
            )
            kept = [texels, depths] if self._codec.encoding.sign_bits else [texels]
            device.render(self._encode, kept, **sources, **self._tables)
            device.render(self._decode, results, texels=texels, signed_depths=depths, **sources, **self._tables)
            decoded, codes = (read_pixels(result) for result in results)
        return Decoded(decoded[..., :3], codes)


def exact_values(device: Device, encoding: Encoding, normals, views, given) -> tuple[np.ndarray, np.ndarray]:
    """Codes of normals, and normals of given codes, by a compute shader and without storage.

    Args:
        normals, views, given: float32 arrays of shape (count, 4).

    Returns:
        codes and decoded normals, float32 arrays of shape (count, 4).
    """
    with ExitStack() as stack:
        compute: Any = device.owned(
            stack, device.compute_pass("parity.comp", encoding_defines(encoding), {"ENCODING": encoding.glsl})
        )
        tables = encoding.tables().items()
        bind(compute, {name: device.owned(stack, device.upload(table)) for name, table in tables})
        codes, decoded = device.computed(compute, [normals, views, given], 2)
    return codes, decoded
