"""The inputs and outputs of the two functions of a user's encoding, for each kind of value except normals.

A program calls the functions of every kind in the same way, through adapters `float4 NAME(float4 n, float3 view)`; a
`CodeArgument` gives the place of a value among these seven numbers. GLSL around the adapters then provides the same
functions as the catalogue's encodings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ....encodings import kinds


@dataclass(frozen=True, eq=False)
class CodeArgument:
    """A number or a vector that a function takes or returns.

    Attributes:
        name: its name.
        sizes: its place among the seven numbers of an adapter, by its number of components; vec4 stands for that
            type.
        words: words in the names of matching parameters, in lower case; a single letter must be the whole name.
        is_needed: whether every function must have it.
    """

    name: str
    sizes: Mapping[int, str]
    words: tuple[str, ...]
    is_needed: bool = True

    def likeness(self, called: str) -> int:
        """Return the length of the longest of this argument's words that occurs in a lower-case name; 0 if none
        occurs. A single letter must be the whole name."""
        return max(
            (len(word) for word in self.words if word == called or (len(word) > 1 and word in called)), default=0
        )


@dataclass(frozen=True)
class Shape:
    """The inputs and outputs of two functions.

    Attributes:
        parts: the encoded values.
        code: their code.
        settings: other inputs that both functions may have.
        results: the names of the parts that each of the decoder's adapters returns; a missing part is 0.
        template: the GLSL file around the adapters.
        wanted: the required form of the two functions, for messages.
        has_sign: whether the code's numbers may be in [-1, 1]; then the code may also be in [0, 1].
    """

    parts: tuple[CodeArgument, ...]
    code: CodeArgument
    settings: tuple[CodeArgument, ...]
    template: str
    wanted: str
    results: tuple[tuple[str, ...], ...]
    has_sign: bool = False


OF_CODE = ("code", "encoded", "packed", "e", "enc")
RANGE = CodeArgument("range", {1: "view.x"}, ("range", "scale", "max"), is_needed=False)
PLANES = (
    CodeArgument("near", {1: "view.x"}, ("near",), is_needed=False),
    CodeArgument("far", {1: "view.y"}, ("far",), is_needed=False),
)
NORMAL = CodeArgument("normal", {3: "n.xyz"}, ("normal", "nrm", "n"))
TANGENT = CodeArgument("tangent", {3: "view", 4: "vec4(view, n.w)"}, ("tangent", "t"))
BITANGENT = CodeArgument("bitangent", {3: "cross(n.xyz, view) * n.w"}, ("bitangent", "binormal", "b"), is_needed=False)
HAND = CodeArgument("hand", {1: "n.w"}, ("hand", "sign"), is_needed=False)
HAND_BESIDE = CodeArgument("hand", {1: "view.x"}, ("hand", "sign"), is_needed=False)

SHAPES: Mapping[kinds.Kind, tuple[Shape, ...]] = MappingProxyType(
    {
        kinds.MOTION: (
            Shape(
                (CodeArgument("motion", {2: "n.xy"}, ("motion", "velocity", "v")),),
                CodeArgument("code", {2: "n.xy"}, OF_CODE),
                (RANGE,),
                "adapters/motion.glsl",
                "float2 Encode(float2 motion) and float2 Decode(float2 code); a range may follow as a parameter",
                (("motion",),),
                has_sign=True,
            ),
        ),
        kinds.DEPTH: (
            Shape(
                (CodeArgument("depth", {1: "n.x"}, ("depth", "z", "d")),),
                CodeArgument("code", {1: "n.x"}, OF_CODE),
                PLANES,
                "adapters/depth.glsl",
                "float Encode(float depth) and float Decode(float code); near and far may follow as parameters",
                (("depth",),),
            ),
            Shape(
                (CodeArgument("depth", {1: "n.x"}, ("depth", "z", "d")),),
                CodeArgument("code", {4: "n", 3: "n.xyz", 2: "n.xy"}, OF_CODE),
                (),
                "adapters/depth_bytes.glsl",
                "float4 Pack(float depth) and float Unpack(float4 texel), with a byte per component",
                (("depth",),),
            ),
        ),
        kinds.CURVE: (
            Shape(
                (CodeArgument("quantity", {1: "n.x"}, ("rough", "metal", "value", "x")),),
                CodeArgument("code", {1: "n.x"}, OF_CODE),
                (RANGE,),
                "adapters/curve.glsl",
                "float Encode(float roughness) and float Decode(float code); a range may follow as a parameter",
                (("quantity",),),
            ),
        ),
        kinds.LIGHT: (
            Shape(
                (CodeArgument("light", {3: "n.xyz", 4: "n"}, ("light", "colour", "color", "rgb", "hdr")),),
                CodeArgument("code", {4: "n", 3: "n.xyz"}, OF_CODE),
                (),
                "adapters/light.glsl",
                "float4 Encode(float3 light) and float3 Decode(float4 texel)",
                (("light",),),
            ),
        ),
        kinds.FRAME: (
            Shape(
                (NORMAL, TANGENT, BITANGENT, HAND),
                CodeArgument("code", {4: "n", 3: "n.xyz"}, OF_CODE),
                (),
                "adapters/frame.glsl",
                "float4 Pack(float3 normal, float4 tangent) and void Unpack(float4 code, out float3 normal, "
                "out float4 tangent)",
                (("normal", "hand"), ("tangent",), ("bitangent",)),
                has_sign=True,
            ),
            Shape(
                (CodeArgument("rotation", {4: "n"}, ("q", "quat", "rotation")), HAND_BESIDE),
                CodeArgument("code", {4: "n", 3: "n.xyz"}, OF_CODE),
                (),
                "adapters/quaternion.glsl",
                "float4 Encode(float4 quaternion) and float4 Decode(float4 code)",
                (("rotation",), ("hand",)),
                has_sign=True,
            ),
        ),
    }
)
