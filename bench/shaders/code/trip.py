"""A codec on a Vulkan device: a round trip of normals through packed texels, by the codec's WGSL file."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np

from ....encodings.codecs.codec import Codec
from ....gbuffer.gl.shader import ShaderError
from ...ground.output.errors import UsageError
from .files import Code, code_of
from .run import wgsl
from .run.interface import BLOCK, Ran
from .run.sources import folder

PREFIX = "codec"
# Normals and views of shape (count, 3) to what the file gives of them.
Trip = Callable[[np.ndarray, np.ndarray], Ran]


@contextmanager
def by_wgsl(codec: Codec) -> Iterator[Trip]:
    """Yield a function from normals and views, (count, 3) each, to the results of a codec's WGSL on the Vulkan
    device; the WGSL is compiled once.

    Raises:
        MissingError: wgpu or a Vulkan driver is missing; what to install.
        ShaderError: the codec uses half arithmetic or is a chain, or the device refuses the file; one line.
    """
    code = _wgsl_code(codec)
    with folder() as place:
        path = place / code.name
        path.write_text(code.body, encoding="utf-8", newline="\n")
        with wgsl.prepared(path, code.interface) as run:

            def trip(n: np.ndarray, view: np.ndarray) -> Ran:
                starts = range(0, max(len(n), 1), BLOCK)
                texels = np.zeros((min(len(n), BLOCK), 4), np.float32)
                parts = [(n[start : start + BLOCK], view[start : start + BLOCK]) for start in starts]
                outputs = [run(some, rays, texels[: len(some)]) for some, rays in parts]
                return Ran(*(np.concatenate(each) for each in zip(*outputs, strict=True)))

            yield trip


def _wgsl_code(codec: Codec) -> Code:
    if codec.encoding.before:
        raise ShaderError(f"{codec.name}: a chain of codecs cannot be written in WGSL; use --backend jax")
    if codec.encoding.is_half:
        raise ShaderError(f"{codec.name}: WGSL computes in 32 bits here; use --backend jax or glsl for half arithmetic")
    wgsl.device()
    try:
        return code_of(codec, "wgsl", PREFIX)
    except UsageError as error:
        raise ShaderError(str(error)) from error


def device_name() -> str:
    """Return the device's name as it appears in rows. Raises MissingError."""
    return wgsl.device_name()
