"""The two functions of a layout as operations whose cost compilers report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .....gbuffer.defines.kernels import Operation
from .....gbuffer.defines.packings import FAR, NEAR
from .....gbuffer.gl.shader import ShaderError
from .....gbuffer.layouts.layout import Layout
from ....ground.output.errors import UsageError
from ...translator.tree import size_of
from .bits import parts_of
from .emit import functions_text, read_of
from .fields import Leaf, surface_leaves, target_leaves
from .surface import Contents
from .text import Texts

FILE = Path(__file__).with_name("kernel_layout.glsl")
# Nothing goes in beside a surface, but GLSL has no arrays of no numbers.
BESIDE = 1


def pack_operation(layout: Layout) -> Operation:
    """Return the operation that packs a surface into the channels that hold part of it. Raises ShaderError if code
    cannot be written for the layout, or its cost depends on the pixel's position."""
    texts = _texts(layout)
    return _operation(texts, ("Surface", surface_leaves(texts)), ("Targets", _held(texts)), "pack_gbuffer")


def unpack_operation(layout: Layout) -> Operation:
    """Return the operation that unpacks a surface from the channels that hold part of it. Raises ShaderError like
    `pack_operation`."""
    texts = _texts(layout)
    return _operation(texts, ("Targets", _held(texts)), ("Surface", surface_leaves(texts)), "unpack_gbuffer")


def _texts(layout: Layout) -> Texts:
    if layout.encoding.domain == "view":
        raise ShaderError(f"{layout.name}: the cost of {layout.encoding.name} depends on the pixel's position")
    try:
        return Texts(Contents(layout))
    except UsageError as error:
        raise ShaderError(str(error)) from error


def _operation(
    texts: Texts, given: tuple[str, Sequence[Leaf]], returned: tuple[str, Sequence[Leaf]], function: str
) -> Operation:
    """Return the operation for one of a layout's functions.

    Args:
        given, returned: the types of its argument and of its result, each with the numbers that are loaded or stored.
        function: the function's name."""
    defines, files = read_of(texts.contents.layout)
    own = {
        # Macros are of one line.
        "FUNCTIONS": " ".join(line for line in functions_text(texts).splitlines() if not line.startswith("//")),
        "KERNEL_FUNCTION": function,
        "KERNEL_NEAR": NEAR,
        "KERNEL_FAR": FAR,
        "KERNEL_FROM": given[0],
        "KERNEL_TO": returned[0],
        "KERNEL_LOADS": " ".join(_load(i, leaf) for i, leaf in enumerate(given[1])),
        "KERNEL_STORES": " ".join(_store(i, leaf) for i, leaf in enumerate(returned[1])),
    }
    tables = texts.contents.layout.encoding.tables
    return Operation(FILE, len(given[1]), BESIDE, len(returned[1]), defines | own, files, tables, is_portable=False)


def _load(index: int, leaf: Leaf) -> str:
    number = f"given[{index}]"
    return f"from.{leaf.path} = {f'floatBitsToUint({number})' if leaf.is_whole else number};"


def _store(index: int, leaf: Leaf) -> str:
    number = f"to.{leaf.path}"
    return f"made[{index}] = {f'uintBitsToFloat({number})' if leaf.is_whole else number};"


def _held(texts: Texts) -> list[Leaf]:
    """Return the channels that hold part of a surface; constants are written to the others."""
    places = [(i, channel) for i, target in enumerate(texts.targets) for channel in range(size_of(target.kind))]
    return [leaf for leaf, place in zip(target_leaves(texts), places, strict=True) if _holds(texts.contents, *place)]


def _holds(contents: Contents, index: int, channel: int) -> bool:
    storage = contents.layout.targets[index].storage
    words = [word for word in contents.words if word.target == index]
    has_own = any(not word.bits and word.first == channel for word in words)
    return channel < storage.channels and (has_own or any(parts_of(words, channel, storage)))
