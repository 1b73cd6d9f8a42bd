"""Lights in a real light buffer: added one by one, as in the light passes of a renderer."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass

import numpy as np

from ....encodings import vec
from ....encodings.codecs.light_codec import LightCodec
from ....encodings.shared import chromaticity
from ....encodings.storages.storage import STORAGES, Storage
from ...gl.device import ADD, MULTIPLY, Device, bind
from ..codec_passes import storage_defines
from ..harness import Passes, Textures, check_functions, exact

# How the light buffer's code blends; one that is read is overwritten.
BLEND_OF = {"add": ADD, "multiply": MULTIPLY, "read": None}


def light_defines(codec: LightCodec) -> dict[str, object]:
    """Return the macros that adapt `light_code.glsl` to a codec.

    Raises:
        ShaderError: the encoding's GLSL file cannot be read or lacks one of the two functions.
    """
    encoding = codec.encoding
    check_functions(encoding.glsl, encoding.signatures)
    return {
        "LIGHT_ENCODE": f"{encoding.prefix}_encode",
        "LIGHT_DECODE": f"{encoding.prefix}_decode",
        "LIGHT_READS": int(codec.blend == "read"),
        **_packing_defines(codec.storage),
        "LIGHT_CHANNELS": codec.storage.channels,
        **vec.CONSTANTS,
        **chromaticity.CONSTANTS,
        **encoding.constants,
    }


def _packing_defines(storage: Storage) -> dict[str, object]:
    """Return the macros for numbers packed across channels, which are stored without a bias, as encoded."""
    if not storage.is_packed:
        return {"LIGHT_PACKED": 0}
    laid = storage_defines(storage, ["nearest"] * storage.channels, True)
    return {**laid, "STORAGE_BIASED": 0, "LIGHT_PACKED": 1}


@dataclass(frozen=True)
class Sum:
    """The contents of a light buffer: `light`, and the `texels` that encode it, as returned by the encoding; float32
    arrays of shape (width, 4)."""

    light: np.ndarray
    texels: np.ndarray


class LightPasses(Passes):
    """A light codec on an OpenGL device; a context manager that releases its resources there.

    Raises:
        ShaderError: the encoding's GLSL does not compile.
    """

    def __init__(self, device: Device, codec: LightCodec):
        self._codec = codec
        shaders, names = ("add_light.frag", "decode_light.frag"), {"LIGHT_ENCODING": codec.glsl}
        super().__init__(device, shaders, light_defines(codec), names, {"texels": codec.storage.target})

    def accumulate(self, lights: np.ndarray) -> Sum:
        """Add lights, float32 of shape (count, width, 4), one by one in their order; each column is a pixel. Return
        the sum of each pixel, decoded, and its texel.

        Raises:
            FormatError: the device cannot render to the encoding's format.
        """
        light, kept = self._through([STORAGES["rgba32f"]] * 2, lights=lights)
        return Sum(light[0], kept[0])

    def _written_textures(self, stack: ExitStack, sources: Textures) -> Textures:
        width, count = sources["lights"].size
        device, none = self._device, self._codec.no_light
        copies = 2 if self._codec.blend == "read" else 1
        textures = [device.owned(stack, device.target((width, 1), self._codec.storage.target)) for _ in range(copies)]
        targets = [device.owned(stack, device.framebuffer([texture])) for texture in textures]
        for target in targets:
            target.clear(none, none, none, none)
        device.blend(BLEND_OF[self._codec.blend])
        for i in range(count):
            targets[(i + 1) % copies].use()
            bind(self._encode.program, {**sources, "light_before": textures[i % copies]})
            self._encode.program["light"] = i
            self._encode.render(vertices=3)
        device.idle.use()
        return {"texels": textures[count % copies]}


def exact_light(device: Device, codec: LightCodec, lights, given) -> tuple[np.ndarray, np.ndarray]:
    """Return the texels for lights, and the light of given texels, from a compute shader, without storage.

    Args:
        lights, given: float32 arrays of shape (count, 4).

    Returns:
        texels and decoded light, float32 arrays of shape (count, 4).
    """
    defines, names = light_defines(codec) | {"LIGHT_PACKED": 0}, {"LIGHT_ENCODING": codec.glsl}
    texels, decoded = exact(device, "light_parity.comp", defines, names, [lights, given], 2)
    return texels, decoded
