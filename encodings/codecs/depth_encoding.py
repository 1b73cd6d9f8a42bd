"""What a depth encoding is: a pair of maps between view depth and one number, written twice."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..position import Projection

# A unit in the last place of 1 in float32.
ULP = 2.0**-23


@dataclass(frozen=True, eq=False)
class DepthEncoding:
    """A pair of maps between depths and numbers, in JAX here and in GLSL in the file beside it.

    The depth is planar: -z of the view-space position, not the distance from the eye. The GLSL file defines
    `float <name>_encode_depth(float depth, float near, float far)`, and `<name>_decode_depth` of a number likewise,
    named so because light codes are compiled beside them. What reaches an encoder has been through `vec.depth_or_far`:
    nothing is NaN, infinite or beyond `far`. The encoder itself clamps what is nearer than its range.

    Attributes:
        name: the catalogue's key, the file's name and the prefix of the GLSL functions.
        title: what a reader calls it.
        encode: (depth, near, far) -> number in [0, 1]; in [-1, 1] with the depth's sign if `signed`. On float64 arrays
            the exact map.
        decode: (number, near, far) -> depth, likewise.
        storages: where it usually lies, names of DEPTH_STORAGES.
        citation: where it comes from.
        glsl: the GLSL twin.
        ulps: how far either language may be from the exact maps, encode and decode. A unit is 2^-23 of the number, and
            what 2^-23 of the depth moves the number by; for decode the same of the depth.
        ulps_reason: why it is that many.
        projection: where the number is what a depth buffer holds, how clip space counts it; the inverse projection then
            gives the position.
        signed: whether the depth carries the sign of the normal's z. Zero has a sign too.
        own_units: whether float formats hold the depth in the scene's own units, which is a far plane at 1: they need
            no range.
        constants: numbers that both languages need, by their GLSL name.
    """

    name: str
    title: str
    encode: Callable[[Any, Any, Any], Any]
    decode: Callable[[Any, Any, Any], Any]
    storages: tuple[str, ...]
    citation: str
    glsl: Path
    ulps: tuple[int, int]
    ulps_reason: str
    projection: Projection | None = None
    signed: bool = False
    own_units: bool = False
    constants: Mapping[str, Any] = field(default_factory=dict)

    @property
    def signatures(self) -> tuple[str, str]:
        """What its GLSL file defines."""
        return (
            f"float {self.name}_encode_depth(float depth, float near, float far)",
            f"float {self.name}_decode_depth(float number, float near, float far)",
        )
