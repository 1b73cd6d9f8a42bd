"""The definition of a frame encoding: maps between tangent frames and up to four numbers, in JAX and in GLSL."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

from ..kinds import FRAME, Kind
from ..rotation import Frame
from ..vec import Vec4


@dataclass(frozen=True, eq=False)
class FrameEncoding:
    """A pair of maps between tangent frames and codes, in JAX and, in the file next to it, in GLSL.

    The GLSL file defines `vec4 <name>_encode(Frame frame, float least)` and
    `Frame <name>_decode(vec4 e, float least)`, and also `vec4 <name>_settle(Frame frame, vec4 stored)` if it has a
    `settle`. The inputs of an encoder have passed through `rotation.frame_of`: none is NaN or infinite.

    Attributes:
        name: the catalogue's key, the file's name and the prefix of the GLSL functions.
        title: human-readable name.
        encode: (frame, least) -> four numbers in [-1, 1]; numbers that it does not use are 0. `least` is the
            smallest positive number that the storage can hold in the number whose sign is the hand, so that the sign
            is kept.
        decode: (numbers, least) -> frame.
        hand_in: index of the number whose sign is the frame's hand; None for encodings of rotations, whose frames
            all decode with hand 1.
        levels: how many values each of its numbers may have, evenly spaced from -1 to 1; 0 for an ordinary number.
        storages: usual storages, names of FRAME_STORAGES.
        citation: source of the encoding.
        glsl: the GLSL twin.
        ulps: allowed differences between the two languages before storage, of encode and decode, in 2^-23; encode is
            compared after decoding if two codes represent frames this close to each other.
        ulps_reason: reason for these numbers.
        settle: (frame, code as read back) -> code to store, if some numbers depend on how the others were rounded;
            those others remain as read back.
        constants: numbers that both languages need, by GLSL name.
        functions: prefix of the GLSL functions in a user's file; empty if it is the name.
        is_unit: whether its author's functions take and return numbers u in [0, 1], with c = 2 u - 1; every storage
            then holds u.
    """

    kind: ClassVar[Kind] = FRAME
    name: str
    title: str
    encode: Callable[[Frame, Any], Vec4]
    decode: Callable[[Vec4, Any], Frame]
    hand_in: int | None
    levels: tuple[int, ...]
    storages: tuple[str, ...]
    citation: str
    glsl: Path
    ulps: tuple[int, int]
    ulps_reason: str
    settle: Callable[[Frame, Vec4], Vec4] | None = None
    constants: Mapping[str, float | tuple[float, ...]] = field(default_factory=dict)
    functions: str = ""
    is_unit: bool = False

    @property
    def prefix(self) -> str:
        """The prefix of the names of the GLSL functions."""
        return self.functions or self.name

    @property
    def components(self) -> int:
        """The number of components that the encoder produces."""
        return len(self.levels)

    @property
    def signatures(self) -> tuple[str, ...]:
        """The GLSL signatures of the encoder, the decoder and, if it exists, `settle`, without semicolons."""
        settle = (f"vec4 {self.prefix}_settle(Frame frame, vec4 stored)",) if self.settle else ()
        return (
            f"vec4 {self.prefix}_encode(Frame frame, float least)",
            f"Frame {self.prefix}_decode(vec4 e, float least)",
            *settle,
        )
