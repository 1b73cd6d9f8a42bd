"""What an encoding is: a pair of maps between unit normals and a few numbers, written twice."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .vec import Vec2, Vec3

Code = Vec2 | Vec3


@dataclass(frozen=True, eq=False)
class Encoding:
    """A pair of maps between normals and codes, in JAX here and in GLSL in the file beside it.

    The GLSL file defines `<name>_encode(vec3 n, vec3 view)` and `<name>_decode(code, vec3 view)`; the code is a vec2 or
    vec3 of `components + sign_bits` numbers.

    Attributes:
        name: the catalogue's key, the file's name and the prefix of the GLSL functions.
        title: what a reader calls it.
        encode: (n, view) -> code, unit normal to numbers in [-1, 1] on its domain. `view` is the view-space position.
        decode: (code, view) -> normal, not renormalised unless the method does so.
        components: how many numbers are stored with the storage's precision.
        domain: the normals it can hold: "sphere", "hemisphere" (z >= 0) or "view" (facing the viewer).
        citation: where it comes from.
        glsl: the GLSL twin.
        ulps: how far the two languages may differ before storage, encode and decode, in 2^-23 (a unit in the last
            place of 1), times how far the map moves its result for a unit of its input where that is more than one.
        ulps_reason: why it is that many.
        sign_bits: further components that are 1 or -1 and take one bit, kept in the sign of the depth.
        constants: numbers that both languages need, by their GLSL name.
        levels: for each component how many values it may have, from -1 to 1 evenly spread; 0, as where none are given,
            for a number like any other.
        is_precise: of the codes around, every component rounded down or up, the one that decodes nearest is stored.
        searches: the encoder takes the best of several codes; where two are as good the languages may differ.
        tables: makes the look-up tables by GLSL sampler name, float32 arrays of shape (height, width, channels).
        functions: what the names of its GLSL functions begin with, of a variant that shares another's file.
    """

    name: str
    title: str
    encode: Callable[[Vec3, Vec3], Any]
    decode: Callable[[Any, Vec3], Vec3]
    components: int
    domain: str
    citation: str
    glsl: Path
    ulps: tuple[int, int]
    ulps_reason: str
    sign_bits: int = 0
    levels: tuple[int, ...] = ()
    is_precise: bool = False
    searches: bool = False
    constants: Mapping[str, float | tuple[float, ...]] = field(default_factory=dict)
    tables: Callable[[], Mapping[str, Any]] = dict
    functions: str = ""

    @property
    def prefix(self) -> str:
        """What the names of its GLSL functions begin with."""
        return self.functions or self.name

    def levels_of(self, component: int) -> int:
        """How many values a number of its code has; 0 for one like any other, 2 for a sign bit."""
        if component >= self.components:
            return 2
        return self.levels[component] if self.levels else 0
