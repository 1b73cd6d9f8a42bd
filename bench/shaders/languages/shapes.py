"""What the two functions of a user's code take and give, by what the code is of: a value for each kind but normals.

A program calls the functions of every kind in one way, by adapters `float4 NAME(float4 n, float3 view)`: a `Part` says
where in these seven numbers it lies. GLSL around the adapters then has the functions that the catalogue's codes have.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

# A word of a name.
WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z0-9]+")


def words_in(name: str) -> set[str]:
    """The words of a name, in lower case."""
    return {word.lower() for word in WORD.findall(name)}


@dataclass(frozen=True, eq=False)
class Part:
    """A number or a vector that a function is given or gives.

    Attributes:
        name: of it.
        sizes: by how many numbers it may have, it in the seven numbers of an adapter; vec4 stands for that type.
        words: what parameters of it are called, in lower case; one of a letter is the whole name.
        is_needed: whether a function has it in any case.
    """

    name: str
    sizes: Mapping[int, str]
    words: tuple[str, ...]
    is_needed: bool = True

    def likeness(self, called: str) -> int:
        """How many letters of a name, in lower case, are those of this part."""
        return max(
            (len(word) for word in self.words if word == called or (len(word) > 1 and word in called)), default=0
        )


@dataclass(frozen=True)
class Shape:
    """What two functions take and give.

    Attributes:
        kind: what the code is of, as `normalbench list` calls it: see `encodings.codecs.kind`.
        parts: what is encoded.
        code: its code.
        settings: what both functions may be given besides.
        results: the names of the parts that each adapter of a decoder gives, with 0 for what is not there.
        template: the file of GLSL around the adapters.
        wanted: how the two functions look, for messages.
        has_sign: whether its numbers may lie in [-1, 1]: then [0, 1] is another way to write them.
    """

    kind: str
    parts: tuple[Part, ...]
    code: Part
    settings: tuple[Part, ...]
    template: str
    wanted: str
    results: tuple[tuple[str, ...], ...]
    has_sign: bool = False


@dataclass(frozen=True)
class Words:
    """How people speak of a kind.

    Attributes:
        plural: what the code is of.
        names: what functions' names that are of it have in them, in lower case.
        begins: what a word of such a name begins with, which others may have in them: Through has rough.
        command: what measures files of it, with {} for the file.
    """

    plural: str
    names: tuple[str, ...]
    begins: tuple[str, ...]
    command: str

    def are_in(self, name: str) -> bool:
        """Whether a name is of this."""
        lower, words = name.lower(), words_in(name)
        return any(one in lower for one in self.names) or any(word.startswith(self.begins) for word in words)


OF_CODE = ("code", "encoded", "packed", "e", "enc")
RANGE = Part("range", {1: "view.x"}, ("range", "scale", "max"), is_needed=False)
PLANES = (
    Part("near", {1: "view.x"}, ("near",), is_needed=False),
    Part("far", {1: "view.y"}, ("far",), is_needed=False),
)
NORMAL = Part("normal", {3: "n.xyz"}, ("normal", "nrm", "n"))
TANGENT = Part("tangent", {3: "view", 4: "vec4(view, n.w)"}, ("tangent", "t"))
BITANGENT = Part("bitangent", {3: "cross(n.xyz, view) * n.w"}, ("bitangent", "binormal", "b"), is_needed=False)
HAND = Part("hand", {1: "n.w"}, ("hand", "sign"), is_needed=False)
HAND_BESIDE = Part("hand", {1: "view.x"}, ("hand", "sign"), is_needed=False)

MOTION, DEPTH, CURVE, LIGHT, FRAME = "motion", "depth", "curve", "light", "tangent frame"
SHAPES: Mapping[str, tuple[Shape, ...]] = MappingProxyType(
    {
        MOTION: (
            Shape(
                MOTION,
                (Part("motion", {2: "n.xy"}, ("motion", "velocity", "v")),),
                Part("code", {2: "n.xy"}, OF_CODE),
                (RANGE,),
                "adapters/motion.glsl",
                "float2 Encode(float2 motion) and float2 Decode(float2 code); either may have a range behind it",
                (("motion",),),
                has_sign=True,
            ),
        ),
        DEPTH: (
            Shape(
                DEPTH,
                (Part("depth", {1: "n.x"}, ("depth", "z", "d")),),
                Part("code", {1: "n.x"}, OF_CODE),
                PLANES,
                "adapters/depth.glsl",
                "float Encode(float depth) and float Decode(float code); either may have near and far behind it",
                (("depth",),),
            ),
        ),
        CURVE: (
            Shape(
                CURVE,
                (Part("quantity", {1: "n.x"}, ("rough", "metal", "value", "x")),),
                Part("code", {1: "n.x"}, OF_CODE),
                (RANGE,),
                "adapters/curve.glsl",
                "float Encode(float roughness) and float Decode(float code); either may have a range behind it",
                (("quantity",),),
            ),
        ),
        LIGHT: (
            Shape(
                LIGHT,
                (Part("light", {3: "n.xyz", 4: "n"}, ("light", "colour", "color", "rgb", "hdr")),),
                Part("code", {4: "n", 3: "n.xyz"}, OF_CODE),
                (),
                "adapters/light.glsl",
                "float4 Encode(float3 light) and float3 Decode(float4 texel)",
                (("light",),),
            ),
        ),
        FRAME: (
            Shape(
                FRAME,
                (NORMAL, TANGENT, BITANGENT, HAND),
                Part("code", {4: "n", 3: "n.xyz"}, OF_CODE),
                (),
                "adapters/frame.glsl",
                "float4 Pack(float3 normal, float4 tangent) and void Unpack(float4 code, out float3 normal, "
                "out float4 tangent)",
                (("normal", "hand"), ("tangent",), ("bitangent",)),
                has_sign=True,
            ),
            Shape(
                FRAME,
                (Part("rotation", {4: "n"}, ("q", "quat", "rotation")), HAND_BESIDE),
                Part("code", {4: "n", 3: "n.xyz"}, OF_CODE),
                (),
                "adapters/quaternion.glsl",
                "float4 Encode(float4 quaternion) and float4 Decode(float4 code)",
                (("rotation",), ("hand",)),
                has_sign=True,
            ),
        ),
    }
)
# Light and curves have words that others' names have too: they come last.
WORDS: Mapping[str, Words] = MappingProxyType(
    {
        FRAME: Words(
            "tangent frames", ("frame", "tangent", "tbn", "quaternion"), ("quat",), "normalbench frames --encoding {}"
        ),
        MOTION: Words("motion vectors", ("motion", "velocity"), (), "normalbench vectors --encoding {}"),
        DEPTH: Words("depth", ("depth",), (), "normalbench depth --depth {}"),
        CURVE: Words(
            "roughness and the like",
            ("roughness", "metalness", "metallic", "smoothness"),
            ("rough", "metal", "gloss"),
            "normalbench curves --encoding {}",
        ),
        LIGHT: Words(
            "light",
            ("radiance", "luminance", "rgbm", "rgbe"),
            ("light", "hdr"),
            "normalbench lights --light-buffer {}",
        ),
    }
)

OF_NORMALS = Words("normals", (), (), "normalbench quality --encoding {}")


def kind_spoken_of(name: str) -> str:
    """The kind that a function's name is of; empty where it names none of these."""
    return next((kind for kind, words in WORDS.items() if words.are_in(name)), "")
