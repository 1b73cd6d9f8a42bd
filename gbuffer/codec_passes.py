"""Normals through a real render target: encoded by one fragment pass, decoded from the texture by a second."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..encodings import vec
from ..encodings.codec import Codec
from ..encodings.encoding import Encoding
from ..encodings.storage import STORAGES, Storage
from .device import Device, read_pixels

KINDS = ("unorm", "snorm", "float")
DEPTH = Storage("r32f", "R32F", "float", (32,), 0x822E)


def encoding_defines(encoding: Encoding) -> dict[str, object]:
    """The macros that make `code.glsl` speak of an encoding."""
    size = encoding.components + encoding.sign_bits
    return {
        "CODE": f"vec{size}",
        "ENCODE": f"{encoding.name}_encode",
        "DECODE": f"{encoding.name}_decode",
        "COMPONENTS": encoding.components,
        "SIGN_BITS": encoding.sign_bits,
        **vec.CONSTANTS,
        **encoding.constants,
    }


def storage_defines(storage: Storage, rounding: str, shader_rounds: bool) -> dict[str, object]:
    """The macros that make `storage.glsl` speak of a storage."""
    kind = KINDS.index(storage.kind) + (storage.kind == "float" and storage.bits[0] == 32)
    return {
        "STORAGE_KIND": kind,
        "STORAGE_SCALE": float(storage.scale(0)) if storage.kind != "float" else 1.0,
        "STORAGE_TRUNCATE": int(rounding == "truncate"),
        "SHADER_ROUNDS": int(shader_rounds),
    }


@dataclass(frozen=True)
class Decoded:
    """What came back: `normals` as decoded and `codes` as stored, float32 arrays of shape (height, width, 3 and 4)."""

    normals: np.ndarray
    codes: np.ndarray


class CodecPasses:
    """A codec on a GL device.

    Attributes:
        rounded_by: "device" where the format's own conversion rounds as the codec asks, else "shader".

    Raises:
        ShaderError: the encoding's GLSL does not compile.
    """

    def __init__(self, device: Device, codec: Codec):
        self._device, self._codec = device, codec
        native = device.native_rounding(codec.storage)
        self.rounded_by = "device" if native == codec.rounding else "shader"
        defines = {
            **encoding_defines(codec.encoding),
            **storage_defines(codec.storage, codec.rounding, self.rounded_by == "shader"),
        }
        names = {"ENCODING": codec.encoding.glsl}
        self._encode = device.fragment_pass("encode.frag", defines, names)
        self._decode = device.fragment_pass("decode.frag", defines, names)
        self._tables = {name: device.upload(table) for name, table in codec.encoding.tables().items()}

    def release(self) -> None:
        for thing in (self._encode, self._decode, *self._tables.values()):
            thing.release()

    def round_trip(self, normals: np.ndarray, views: np.ndarray) -> Decoded:
        """Normals and view-space positions, float32 of shape (height, width, 4), encoded, stored and decoded."""
        size = (normals.shape[1], normals.shape[0])
        device, storage = self._device, self._codec.storage
        sources = {"normals": device.upload(normals), "views": device.upload(views), **self._tables}
        texels, depths = device.target(size, storage), device.target(size, DEPTH)
        results = [device.target(size, STORAGES["rgba32f"]) for _ in range(2)]
        kept = [texels, depths] if self._codec.encoding.sign_bits else [texels]
        device.render(self._encode, kept, **sources)
        device.render(self._decode, results, texels=texels, signed_depths=depths, **sources)
        decoded, codes = (read_pixels(result) for result in results)
        for texture in (sources["normals"], sources["views"], texels, depths, *results):
            texture.release()
        return Decoded(decoded[..., :3], codes)


def exact_values(device: Device, encoding: Encoding, normals, views, given) -> tuple[np.ndarray, np.ndarray]:
    """Codes of normals, and normals of given codes, by a compute shader and without storage.

    Args:
        normals, views, given: float32 arrays of shape (count, 4).

    Returns:
        codes and decoded normals, float32 arrays of shape (count, 4).
    """
    compute: Any = device.compute_pass("parity.comp", encoding_defines(encoding), {"ENCODING": encoding.glsl})
    context, count = device.context, len(normals)
    inputs = [context.buffer(np.ascontiguousarray(a, np.float32)) for a in (normals, views, given)]
    outputs = [context.buffer(reserve=count * 16) for _ in range(2)]
    tables = {name: device.upload(table) for name, table in encoding.tables().items()}
    for binding, buffer in enumerate([*inputs, *outputs]):
        buffer.bind_to_storage_buffer(binding)
    for unit, (name, texture) in enumerate(tables.items()):
        if name in compute:
            compute[name].value = unit
            texture.use(unit)
    compute.run(group_x=(count + 63) // 64)
    codes, decoded = (np.frombuffer(b.read(), np.float32).reshape(count, 4) for b in outputs)
    for thing in (*inputs, *outputs, *tables.values(), compute):
        thing.release()
    return codes, decoded
