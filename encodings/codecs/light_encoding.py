"""The definition of a light encoding: maps between light and a texel, in JAX and in GLSL, and how light is added."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

from ..kinds import LIGHT, Kind
from ..vec import Vec4

# How light is added up: by the blending hardware, adding or multiplying texels; or by reading what is there, adding in
# the shader and writing, where no blending of texels adds light.
BLENDS = ("add", "multiply", "read")


@dataclass(frozen=True, eq=False)
class LightEncoding:
    """A pair of maps between light and the contents of a texel, in JAX and, in the file next to it, in GLSL.

    The GLSL file defines `vec4 <name>_encode(vec4 light)` and `vec4 <name>_decode(vec4 e)`. Light is linear: three
    colours and, if `has_alpha`, a fourth number that is accumulated separately.

    Attributes:
        name: the catalogue's key, the file's name and the prefix of the GLSL functions.
        title: human-readable name.
        encode: light (Vec4) -> texel, before the format stores it. An encoder that computes anything treats
            negative light and NaN as 0, and infinite light as the maximum that it can represent; `plain` and
            `linear` leave them to the format.
        decode: texel, as the format returns it -> light.
        storages: the formats for which it is made, names of LIGHT_STORAGES.
        blend: one of BLENDS.
        has_alpha: whether it stores a fourth number in formats with four channels.
        limit: the brightest white light that it can represent; infinite if only the format limits it.
        citation: source of the encoding.
        glsl: the GLSL twin.
        ulps: allowed differences between the two languages, of encode and decode, in 2^-23 of the brightest channel.
        ulps_reason: reason for these numbers.
        constants: numbers that both languages need, by GLSL name.
        ranged: function that returns the encoding over a different range, named `<name>:<range>`; None if it has no
            range.
        is_plain: whether a texel is the light itself; its light buffer has the format's name.
        in_curve: its name and title in an sRGB format, if it is made for such a format.
        functions: prefix of the GLSL functions in a user's file; empty if it is the file's name.
        any_bits: "unorm" or "float", if it can use all storages of that kind with three or four numbers; empty if
            it is made for the named storages only.
    """

    kind: ClassVar[Kind] = LIGHT
    name: str
    title: str
    encode: Callable[[Vec4], Vec4]
    decode: Callable[[Vec4], Vec4]
    storages: tuple[str, ...]
    blend: str
    has_alpha: bool
    limit: float
    citation: str
    glsl: Path
    ulps: tuple[int, int]
    ulps_reason: str
    constants: Mapping[str, float | tuple[float, ...]] = field(default_factory=dict)
    ranged: Callable[[float], LightEncoding] | None = None
    is_plain: bool = False
    in_curve: tuple[str, str] = ("", "")
    functions: str = ""
    any_bits: str = ""

    @property
    def no_light(self) -> float:
        """The value of every channel of a texel without light; blending such a texel leaves the target unchanged."""
        return 1.0 if self.blend == "multiply" else 0.0

    @property
    def prefix(self) -> str:
        """The prefix of the names of the GLSL functions, which is the same for every range."""
        return self.functions or self.glsl.stem

    @property
    def signatures(self) -> tuple[str, str]:
        """The GLSL signatures of the encoder and the decoder, without semicolons."""
        return f"vec4 {self.prefix}_encode(vec4 light)", f"vec4 {self.prefix}_decode(vec4 e)"
