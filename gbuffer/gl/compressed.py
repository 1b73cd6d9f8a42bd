"""Compressed textures as the device decodes them."""

from __future__ import annotations

from contextlib import ExitStack

import moderngl
import numpy as np

from ...encodings.storages.storage import STORAGES
from .device import Device, FormatError, read_pixels
from .raw import compressed_texture, delete_texture


def device_texels(device: Device, blocks: bytes, size: tuple[int, int], internal_format: int) -> np.ndarray:
    """Return the texels that a shader fetches from compressed blocks, float32 of shape (height, width, 4).

    Args:
        blocks: the compressed blocks, row by row.
        size: width and height in texels.
        internal_format: the OpenGL enum.

    Raises:
        FormatError: the device does not support the format, or a texture of this size.
    """
    if max(size) > device.max_size:
        raise FormatError(f"{device.renderer} supports at most {device.max_size} texels per side, not {max(size)}")
    with ExitStack() as stack:
        device.context.error  # noqa: B018 # reading it clears what an earlier call left
        number = compressed_texture(size, internal_format, blocks)
        stack.callback(delete_texture, number)
        if (error := device.context.error) != "GL_NO_ERROR":
            raise FormatError(f"{device.renderer} does not support this compressed format ({error})")
        texture = device.context.external_texture(number, size, 4, 0, "f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        result = device.owned(stack, device.target(size, STORAGES["rgba32f"]))
        device.render(device.owned(stack, device.fragment_pass("copy.frag")), [result], source=texture)
        return read_pixels(result)
