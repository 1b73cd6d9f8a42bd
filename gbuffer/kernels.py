"""Single operations wrapped into shaders that a compiler is asked about or a clock is held to: what they cost.

Each is measured less the empty operation that moves the same numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ..encodings.catalogue import ENCODINGS
from ..encodings.codec import Codec
from ..encodings.encoding import Encoding
from ..encodings.storage import STORAGES
from .codec_passes import encoding_defines
from .depth_passes import depth_defines
from .frame import layout_defines
from .layout import COMPONENTS, Layout, Target
from .materials import CONSTANTS
from .shader import SHADERS, Source

# The shaders by what they run as; fragment first, for that is where encoders live.
STAGES: Mapping[str, str] = MappingProxyType({"fragment": "kernel.frag", "compute": "kernel.comp"})
# Bindings below are left to the look-up tables.
PLANES, GROUP = 8, 64
# Of the depths that are packed; what they are changes no count.
NEAR, FAR = 0.1, 1000.0


@dataclass(frozen=True, eq=False)
class Operation:
    """What stands between loading numbers and storing them.

    Attributes:
        glsl: the file that defines `operation`.
        given, beside, made: how many numbers go in, go in beside them, and come out; each 2 to 4.
        own_defines, own_names: what that file needs, as `Source` takes it.
        tables: makes its look-up tables by sampler name, as `Encoding.tables`.
        is_portable: whether its SPIR-V says what it costs; what a driver has to unroll and fold first does not.
    """

    glsl: str
    given: int
    beside: int
    made: int
    own_defines: Mapping[str, object] = field(default_factory=dict)
    own_names: Mapping[str, Path] = field(default_factory=dict)
    tables: Callable[[], Mapping[str, Any]] = dict
    is_portable: bool = True

    @property
    def empty(self) -> Operation:
        """The operation that moves as many numbers and does nothing."""
        return Operation("kernel_empty.glsl", self.given, self.beside, self.made)

    @property
    def defines(self) -> dict[str, object]:
        """The macros of a kernel around it."""
        sizes = {"GIVEN": self.given, "BESIDE": self.beside, "MADE": self.made}
        taken = ("xyzw"[: self.given] * 2)[: self.made]
        vectors = {name: f"vec{size}" for name, size in sizes.items()}
        return {"PLANES": PLANES, "GROUP": GROUP, "TAKEN": taken, **vectors, **self.own_defines}

    @property
    def names(self) -> dict[str, Path]:
        """The files that a kernel includes by name."""
        return {**self.own_names, "OPERATION": SHADERS / self.glsl}

    def source(self, shader: str) -> Source:
        """The operation in one of the kernels. Raises ShaderError where a file cannot be read."""
        return Source(shader, self.defines, self.names)


def encode(encoding: Encoding) -> Operation:
    """A normal and the view-space position beside it to a code. Raises ShaderError as `encoding_defines`."""
    return Operation("kernel_encode.glsl", 3, 3, _size(encoding), *_read(encoding))


def decode(encoding: Encoding) -> Operation:
    """A code and the view-space position beside it to a normal. Raises ShaderError as `encoding_defines`."""
    return Operation("kernel_decode.glsl", _size(encoding), 3, 3, *_read(encoding))


def _size(encoding: Encoding) -> int:
    return encoding.components + encoding.sign_bits


def _read(encoding: Encoding) -> tuple[Any, ...]:
    return encoding_defines(encoding), {"ENCODING": encoding.glsl}, encoding.tables


@dataclass(frozen=True)
class Packing:
    """Numbers in the channels of a target: a code's, or a depth.

    Attributes:
        name: what a reader calls it.
        target: the format and the words that fill it.
        numbers: how many of a code's numbers; 0 for a depth.
        signed: whether the depth carries the sign of the normal's z.
    """

    name: str
    target: Target
    numbers: int
    signed: bool = False

    @property
    def channels(self) -> int:
        """The channels that hold something: at least 2, as GLSL has no vectors of one."""
        words, size = self._layout.words, self.target.storage.bits[0]
        last = (((w.first + w.bits - 1) // size if w.bits else w.first) for w in words if w.target == 0)
        return max(1, *last) + 1

    @property
    def _layout(self) -> Layout:
        suits = (e for e in ENCODINGS.values() if e.components == self.numbers or not self.numbers)
        encoding = next(e for e in suits if bool(e.sign_bits) == self.signed)
        # A depth needs a normal beside it to be a layout; that lies in a second target, which no kernel writes.
        beside = Target("rgba16f", " ".join(f"normal.{axis}" for axis in "xyz"[: encoding.components]))
        return Layout(self.name, self.name, (self.target, *(() if self.numbers else (beside,))), encoding.name, "")

    def pack(self) -> Operation:
        """The numbers to a texel; beside them a depth."""
        return Operation("kernel_pack.glsl", max(self.numbers, 2), 3, self.channels, *self._read(), is_portable=False)

    def unpack(self) -> Operation:
        """And back."""
        made = max(self.numbers, 2)
        return Operation("kernel_unpack.glsl", self.channels, 3, made, *self._read(), is_portable=False)

    def _read(self) -> tuple[Any, ...]:
        layout = self._layout
        first = 0 if self.numbers else COMPONENTS.index("depth")
        # Rounding is left to the device, as it is wherever the device rounds as asked.
        rounds = (0,) * len(layout.targets)
        needed = {"LOG2_POWER_MAX": CONSTANTS["LOG2_POWER_MAX"], "SIGN_BITS": 0, "FIRST_NUMBER": first}
        needed |= {"KERNEL_NEAR": NEAR, "KERNEL_FAR": FAR}
        depth = layout.depth_encoding
        defines = {**needed, **depth_defines(depth), **layout_defines(layout, rounds)}
        return defines, {"DEPTH_ENCODING": depth.glsl}


def _direct(storage: str, numbers: int) -> Packing:
    bits = ":".join(map(str, STORAGES[storage].bits[:numbers]))
    return Packing(f"{storage} {bits}", Target(storage, " ".join(f"normal.{a}" for a in "xyz"[:numbers])), numbers)


# What `--storage` may name: a format's own conversion, for two numbers and for three, and words laid across channels.
PACKINGS: Mapping[str, tuple[Packing, ...]] = MappingProxyType(
    {name: tuple(_direct(name, n) for n in (2, 3) if n <= s.channels) for name, s in STORAGES.items()}
    | {
        "11:11": (Packing("rgba8 11:11", Target("rgba8", "normal.x:11 normal.y:11"), 2),),
        "12:12": (Packing("rgba8 12:12", Target("rgba8", "normal.x:12 normal.y:12"), 2),),
        "16:16": (Packing("rgba8 16:16", Target("rgba8", "normal.x:16 normal.y:16"), 2),),
        "11:10:11": (Packing("rgba8 11:10:11", Target("rgba8", "normal.x:11 normal.y:10 normal.z:11"), 3),),
        "depth16": (Packing("rgba8 depth 8:8", Target("rgba8", "depth:16"), 0),),
        "depth24": (Packing("rgba8 depth 8:8:8", Target("rgba8", "depth:24"), 0),),
        "depth16_sign": (Packing("rgba8 signed depth 8:8", Target("rgba8", "depth:16"), 0, True),),
        "depth24_sign": (Packing("rgba8 signed depth 8:8:8", Target("rgba8", "depth:24"), 0, True),),
    }
)
# What a code's sign bit costs: a depth that carries it, less one that does not.
SIGN = (PACKINGS["depth24_sign"][0], PACKINGS["depth24"][0])


def packing_of(codec: Codec) -> Packing | None:
    """The packing that a codec's numbers, but for sign bits, go through."""
    numbers = max(codec.encoding.components, 2)
    return next((p for p in PACKINGS.get(codec.storage.name, ()) if p.numbers == numbers), None)
