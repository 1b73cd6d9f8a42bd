"""The kinds of encodings: of normals, depth, tangent frames, light and motion, and curves of what materials are."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from .curve_codec import CurveEncoding
from .depth_codec import DepthEncoding
from .encoding import Encoding
from .frame_encoding import FrameEncoding
from .light_encoding import LightEncoding
from .motion_codec import MotionEncoding


class AnyEncoding(Protocol):
    """What encodings of every kind say of themselves; see each kind for what they mean there."""

    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def citation(self) -> str: ...
    @property
    def glsl(self) -> Path: ...
    @property
    def ulps(self) -> tuple[int, int]: ...
    @property
    def ulps_reason(self) -> str: ...
    @property
    def signatures(self) -> tuple[str, ...]: ...


@dataclass(frozen=True)
class Kind:
    """What encodings are of.

    Attributes:
        name: what a reader calls what is encoded.
        folder: where the pairs of files lie.
        encoding: the type of each pair's ENCODING.
    """

    name: str
    folder: str
    encoding: type

    @property
    def word(self) -> str:
        """Its name as one word: frame of tangent frames."""
        return self.name.rpartition(" ")[2]


NORMAL = Kind("normal", "normals", Encoding)
DEPTH = Kind("depth", "depth", DepthEncoding)
FRAME = Kind("tangent frame", "frame", FrameEncoding)
LIGHT = Kind("light", "light", LightEncoding)
MOTION = Kind("motion", "motion", MotionEncoding)
CURVE = Kind("curve", "curve", CurveEncoding)
KINDS = (NORMAL, DEPTH, FRAME, LIGHT, MOTION, CURVE)
