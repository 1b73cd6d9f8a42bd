"""What a frame encoding is: a pair of maps between tangent frames and up to four numbers, written twice."""

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
    """A pair of maps between tangent frames and codes, in JAX here and in GLSL in the file beside it.

    The GLSL file defines `vec4 <name>_encode(Frame frame, float least)` and `Frame <name>_decode(vec4 e, float least)`,
    and where it settles `vec4 <name>_settle(Frame frame, vec4 stored)`. What reaches an encoder has been through
    `rotation.frame_of`: nothing is NaN or infinite.

    Attributes:
        name: the catalogue's key, the file's name and the prefix of the GLSL functions.
        title: what a reader calls it.
        encode: (frame, least) -> numbers in [-1, 1], of four those that it makes and 0. `least` is the least number
            above 0 that the storage holds where the hand lies: what keeps a sign.
        decode: (numbers, least) -> frame.
        hand_in: which of the numbers has the frame's hand for its sign; None of rotations alone, whose frames all come
            back with hand 1.
        levels: for each number that it makes how many values it may have, from -1 to 1 evenly spread; 0 for a number
            like any other.
        storages: where it usually lies, names of FRAME_STORAGES.
        citation: where it comes from.
        glsl: the GLSL twin.
        ulps: how far the two languages may differ before storage, encode and decode, in 2^-23; encode as it is decoded
            where two codes stand for frames that near.
        ulps_reason: why it is that many.
        settle: (frame, the code as it comes back) -> the code to store, where some numbers depend on how others were
            rounded; those others stay as they came back.
        constants: numbers that both languages need, by their GLSL name.
        functions: what the names of its GLSL functions begin with, of a user's file; empty where that is the name.
        is_unit: its author's functions give and take numbers in [0, 1], u for c = 2 u - 1: every storage holds u.
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
        """What the names of its GLSL functions begin with."""
        return self.functions or self.name

    @property
    def components(self) -> int:
        """How many numbers it makes."""
        return len(self.levels)

    @property
    def signatures(self) -> tuple[str, ...]:
        """What its GLSL file defines."""
        settle = (f"vec4 {self.prefix}_settle(Frame frame, vec4 stored)",) if self.settle else ()
        return (
            f"vec4 {self.prefix}_encode(Frame frame, float least)",
            f"Frame {self.prefix}_decode(vec4 e, float least)",
            *settle,
        )
