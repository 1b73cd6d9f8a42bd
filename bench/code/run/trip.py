"""A codec on a Vulkan device: its file of WGSL, from normals through packed texels and back."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module

import numpy as np

from ....encodings.codecs.codec import Codec
from ....gbuffer.gl.shader import ShaderError
from ...output.errors import MissingError
from ..numpy_source import words_of
from . import wgsl
from .interface import BLOCK, Interface, Ran
from .sources import folder

PREFIX = "codec"
EMIT = "normalbench.bench.code.emit"
# Normals and views of shape (count, 3) to what the file gives of them.
Trip = Callable[[np.ndarray, np.ndarray], Ran]


def interface_of(codec: Codec, prefix: str) -> Interface:
    """What the file of a codec has."""
    encoding = codec.encoding
    size, takes_view = encoding.components + encoding.sign_bits, encoding.domain == "view"
    return Interface(prefix, size, encoding.sign_bits, words_of(codec.storage), takes_view, encoding.tables())


@contextmanager
def by_wgsl(codec: Codec) -> Iterator[Trip]:
    """A codec's WGSL on the Vulkan device, compiled once.

    Raises:
        MissingError: wgpu or a Vulkan driver is missing; what to install.
        ShaderError: half arithmetic or a chain, or the device refuses the file; one line.
    """
    text, interface = _emitted(codec), interface_of(codec, PREFIX)
    with folder() as place:
        path = place / f"{PREFIX}.wgsl"
        path.write_text(text, encoding="utf-8")
        with wgsl.prepared(path, interface) as run:

            def trip(n: np.ndarray, view: np.ndarray) -> Ran:
                starts = range(0, max(len(n), 1), BLOCK)
                texels = np.zeros((min(len(n), BLOCK), 4), np.float32)
                parts = [(n[at : at + BLOCK], view[at : at + BLOCK]) for at in starts]
                found = [run(some, rays, texels[: len(some)]) for some, rays in parts]
                return Ran(*(np.concatenate(each) for each in zip(*found, strict=True)))

            yield trip


def _emitted(codec: Codec) -> str:
    if codec.encoding.before:
        raise ShaderError(f"{codec.name}: a chain of codecs is not written in WGSL; measure it by jax")
    if codec.encoding.is_half:
        raise ShaderError(f"{codec.name}: WGSL computes in 32 bits here; measure half arithmetic by jax or glsl")
    wgsl.device()
    try:
        emit = import_module(EMIT)
    except ImportError as error:
        raise MissingError(f"there is nothing that writes WGSL here ({error}); install a newer normalbench") from error
    return emit.emitted(codec, "wgsl", PREFIX)


def device_name() -> str:
    """What a row calls the device. Raises MissingError."""
    return wgsl.device_name()
