"""What a light encoding is: a pair of maps between light and a texel, written twice, and how light is added in it."""

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
    """A pair of maps between light and what a texel holds, in JAX here and in GLSL in the file beside it.

    The GLSL file defines `vec4 <name>_encode(vec4 light)` and `vec4 <name>_decode(vec4 e)`. Light is linear: three
    colours and, where `has_alpha`, a fourth number that is added up on its own.

    Attributes:
        name: the catalogue's key, the file's name and the prefix of the GLSL functions.
        title: what a reader calls it.
        encode: light (Vec4) to a texel, as the format is given it. An encoder that computes anything takes
            negative light and NaN for none, and infinite light for the most that it holds; `plain` and `linear` leave
            that to the format.
        decode: a texel, as the format gives it back, to light.
        storages: the formats that it is made for, names of LIGHT_STORAGES.
        blend: one of BLENDS.
        has_alpha: whether it holds a fourth number, in a format that has four.
        limit: the most white light that it holds; infinite where only the format limits it.
        citation: where it comes from.
        glsl: the GLSL twin.
        ulps: how far the two languages may differ, encode and decode, in 2^-23 of the brightest channel.
        ulps_reason: why it is that many.
        constants: numbers that both languages need, by their GLSL name.
        ranged: makes the encoding over another range, named `<name>:<range>`; None where it has none.
        is_plain: whether a texel is the light itself; a light buffer of it goes by the format's name.
        in_curve: its name and title in a format that keeps colours by the sRGB curve, where it is made for one.
        functions: what the names of its GLSL functions begin with, of a user's file; empty where that is the file's.
        any_bits: "unorm" or "float", where it may lie in all storages of that kind that have three or four numbers;
            empty where it is made for the named ones alone.
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
        """What every channel of a texel without light holds: what blending leaves another as it is by."""
        return 1.0 if self.blend == "multiply" else 0.0

    @property
    def prefix(self) -> str:
        """What the names of its GLSL functions begin with. Over another range they are the same functions."""
        return self.functions or self.glsl.stem

    @property
    def signatures(self) -> tuple[str, str]:
        """What its GLSL file defines."""
        return f"vec4 {self.prefix}_encode(vec4 light)", f"vec4 {self.prefix}_decode(vec4 e)"
