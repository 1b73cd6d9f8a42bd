"""The kinds of encodings: for normals, depth, tangent frames, light, motion and material values (curves).

Pure data, so that code that reads users' files need not import JAX.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar, Protocol

if TYPE_CHECKING:
    from pathlib import Path

# A word of a name.
WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z0-9]+")


def words_in(name: str) -> set[str]:
    """Return the set of words in a name that is written in camel case or with separators, in lower case."""
    return {word.lower() for word in WORD.findall(name)}


@dataclass(frozen=True)
class Kind:
    """A kind of encoding, defined by the quantity that it encodes.

    Attributes:
        name: human-readable name of the quantity.
        folder: folder that contains the pairs of files.
        plural: the quantity in the plural.
        command: command that measures a user's file of this kind, with {} in place of the file.
        spoken: parts of function names that indicate this kind, in lower case.
        begins: beginnings of words that indicate this kind only there, because they also occur inside other words:
            Through contains rough.
    """

    name: str
    folder: str
    plural: str
    command: str
    spoken: tuple[str, ...] = ()
    begins: tuple[str, ...] = ()

    @property
    def word(self) -> str:
        """The last word of the kind's name: "frame" for a tangent frame."""
        return self.name.rpartition(" ")[2]

    def is_in(self, name: str) -> bool:
        """Whether a function's name indicates this kind."""
        lower = name.lower()
        return any(part in lower for part in self.spoken) or any(
            word.startswith(self.begins) for word in words_in(name)
        )


NORMAL = Kind("normal", "normals", "normals", "normalbench quality --encoding {}")
FRAME = Kind(
    "tangent frame",
    "frame",
    "tangent frames",
    "normalbench frames --encoding {}",
    ("frame", "tangent", "tbn", "quaternion"),
    ("quat",),
)
MOTION = Kind("motion", "motion", "motion vectors", "normalbench vectors --encoding {}", ("motion", "velocity"))
DEPTH = Kind("depth", "depth", "depth", "normalbench depth --depth {}", ("depth",))
CURVE = Kind(
    "curve",
    "curve",
    "roughness and the like",
    "normalbench curves --encoding {}",
    ("roughness", "metalness", "metallic", "smoothness"),
    ("rough", "metal", "gloss"),
)
LIGHT = Kind(
    "light",
    "light",
    "light",
    "normalbench lights --light-buffer {}",
    ("radiance", "luminance", "rgbm", "rgbe"),
    ("light", "hdr"),
)
# Names are looked through in this order: light and curves have words that others' names have too.
KINDS = (
    NORMAL,
    FRAME,
    MOTION,
    DEPTH,
    CURVE,
    LIGHT,
)
BY_NAME: Mapping[str, Kind] = MappingProxyType({kind.name: kind for kind in KINDS})


def kind_spoken_of(name: str) -> Kind | None:
    """Return the first of KINDS that a function's name indicates; None if it indicates none. Never NORMAL."""
    return next((kind for kind in KINDS if kind.is_in(name)), None)


class AnyEncoding(Protocol):
    """The attributes that encodings of every kind have; the class of each kind documents them."""

    kind: ClassVar[Kind]

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
