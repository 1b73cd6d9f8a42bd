"""Writers of GLSL for OpenGL and Vulkan, and of GLSL ES, which requires precision qualifiers."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .parser import COMPARISONS
from .tree import Binary, Choice, Expression, TexelTable, Unary, size_of
from .writer import PRIMARY, Writer, words

NAMES: Mapping[str, str] = MappingProxyType({mark: name for name, mark in COMPARISONS.items()})


# Of GLSL 4.60 and of GLSL ES 3.20, but for types.
RESERVED = words(
    "active asm atomic_uint attribute buffer case cast centroid class coherent common const continue default demote "
    "discard do else enum extern external filter fixed flat for fvec2 fvec3 fvec4 goto half highp hvec2 hvec3 hvec4 if "
    "in inline inout input interface invariant layout long lowp main mediump namespace noinline noperspective out "
    "output partition patch precise precision public readonly resource restrict return sample shared short sizeof "
    "smooth static struct subroutine superp switch template this true false typedef uniform union unsigned using "
    "varying void volatile while writeonly double dvec2 dvec3 dvec4 float int uint bool vec2 vec3 vec4 ivec2 ivec3 "
    "ivec4 uvec2 uvec3 uvec4 bvec2 bvec3 bvec4 mat2 mat3 mat4 mat2x2 mat2x3 mat2x4 mat3x2 mat3x3 mat3x4 mat4x2 mat4x3 "
    "mat4x4 sampler sampler1D sampler2D sampler3D samplerCube sampler2DRect sampler3DRect sampler2DMS image1D image2D "
    "image3D imageCube texture texture2D textureCube texelFetch break"
)


class GlslWriter(Writer):
    """GLSL 4.3 and later."""

    functions: Mapping[str, str] = MappingProxyType({"atan2": "atan"})
    reserved = RESERVED
    has_precise = True

    def _text_and_level(self, value: Expression) -> tuple[str, int]:
        match value:
            case Unary(kind, "!", inner) if size_of(kind) > 1:
                return f"not({self._text(inner)})", PRIMARY
        return super()._text_and_level(value)

    def _binary_and_level(self, value: Binary) -> tuple[str, int]:
        if value.kind.startswith("bvec") and value.operator in NAMES:
            return f"{NAMES[value.operator]}({self._text(value.left)}, {self._text(value.right)})", PRIMARY
        return super()._binary_and_level(value)

    def _choice_and_level(self, value: Choice) -> tuple[str, int]:
        if size_of(value.condition.kind) == 1:
            return super()._choice_and_level(value)
        return f"mix({', '.join(map(self._text, (value.other, value.chosen, value.condition)))})", PRIMARY


class EsslWriter(GlslWriter):
    """GLSL ES 3.1 and later."""

    head = "precision highp float;\nprecision highp int;"
    # A word of GLSL ES 3.2.
    has_precise = False

    # WebGL 2 has no `layout(binding)`.
    binding_advice = "Bind it with glUniform1i."

    def _declared_table(self, table: TexelTable, binding: int) -> str:  # noqa: ARG002 (others have it in the text)
        return f"uniform highp sampler2D {table.name};"
