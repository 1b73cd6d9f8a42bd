"""Single operations wrapped in shaders, so that a compiler or a timer can find their cost.

The cost of an empty operation that moves the same numbers is subtracted.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ...encodings.codecs.encoding import Encoding
from ...encodings.storages.storage import STORAGES
from ..codecs.codec_passes import encoding_defines
from ..gl.shader import Source, shaders

# The shaders by what they run as; fragment first, for that is where encoders live.
STAGES: Mapping[str, str] = MappingProxyType({"fragment": "kernel.frag", "compute": "kernel.comp"})
# Bindings below are left to the look-up tables.
PLANES, GROUP = 8, 64


@dataclass(frozen=True, eq=False)
class Operation:
    """The step between loading numbers and storing them.

    Attributes:
        glsl: the file that defines `operation`: a shader's name or a path.
        given, beside, made: numbers of inputs, additional inputs and outputs; at least 1 each.
        own_defines, own_names: the macros and files that the file needs, as for `Source`.
        tables: function that returns the lookup tables by sampler name, like `Encoding.tables`.
        is_portable: whether its SPIR-V shows its cost; false if a driver has to unroll and fold the code first.
    """

    glsl: str | Path
    given: int
    beside: int
    made: int
    own_defines: Mapping[str, object] = field(default_factory=dict)
    own_names: Mapping[str, Path] = field(default_factory=dict)
    tables: Callable[[], Mapping[str, Any]] = dict
    is_portable: bool = True

    @property
    def empty(self) -> Operation:
        """The operation that moves as many numbers but does nothing with them."""
        return Operation("kernel_empty.glsl", self.given, self.beside, self.made)

    @property
    def defines(self) -> dict[str, object]:
        """The macros of a kernel that runs the operation."""
        sizes = {"GIVEN": self.given, "BESIDE": self.beside, "MADE": self.made}
        kinds = {name: f"vec{size}" if 2 <= size <= 4 else f"float[{size}]" for name, size in sizes.items()}
        beside = {"BESIDE_PLANE": max(4, self.given)}
        return {"PLANES": PLANES, "GROUP": GROUP, **beside, **kinds, **self.own_defines}

    @property
    def names(self) -> dict[str, Path]:
        """The paths of the files that a kernel includes, by macro name; OPERATION is the kernel's own file."""
        return {**self.own_names, "OPERATION": Path(shaders().get(str(self.glsl), self.glsl))}

    def source(self, shader: str) -> Source:
        """Return the source of a kernel that runs the operation; `shader` names the kernel. Raises ShaderError if a
        file cannot be read."""
        return Source(shader, self.defines, self.names)


def encode(encoding: Encoding) -> Operation:
    """Return the operation that encodes a normal, given its view position; if encoded precisely, for 8-bit UNORM.

    Raises:
        ShaderError: as in `encoding_defines`.
    """
    defines, *others = _read(encoding)
    scale = {"KERNEL_SCALE": float(STORAGES["rgba8"].scale(0))}
    portable = not encoding.is_precise
    return Operation(
        "kernel_encode.glsl", 3, 3, _number_count(encoding), defines | scale, *others, is_portable=portable
    )


def decode(encoding: Encoding) -> Operation:
    """Return the operation that decodes a code, given its view position. Raises ShaderError as `encoding_defines`."""
    return Operation("kernel_decode.glsl", _number_count(encoding), 3, 3, *_read(encoding))


def _number_count(encoding: Encoding) -> int:
    return encoding.components + encoding.sign_bits


def _read(encoding: Encoding) -> tuple[Any, ...]:
    """Return the macros of an encoding, the files named in the macros, and the function that returns the tables."""
    as_it_stands = {"AS_IT_STANDS": 1} if encoding.is_packed else {}
    return encoding_defines(encoding) | as_it_stands, {"ENCODING": encoding.glsl}, encoding.tables
