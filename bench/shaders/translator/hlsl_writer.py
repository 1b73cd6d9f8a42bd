"""HLSL, which Slang reads as well."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .parser import COMPARES
from .tree import (
    Binary,
    Call,
    Choice,
    Construct,
    Declare,
    Elements,
    Expression,
    For,
    Index,
    Literal,
    Name,
    Program,
    Statement,
    Struct,
    TexelTable,
    inside,
    size_of,
)
from .writer import FIELDS, INDENT, PRIMARY, UNARY, Writer, is_less, words

KINDS: Mapping[str, str] = MappingProxyType(
    {
        f"{letter}vec{size}": f"{scalar}{size}"
        for letter, scalar in (("", "float"), ("i", "int"), ("u", "uint"), ("b", "bool"))
        for size in (2, 3, 4)
    }
    | {f"mat{size}": f"float{size}x{size}" for size in (2, 3, 4)}
)


TRUTHS = frozenset(("&&", "||"))


class HlslWriter(Writer):
    """A writer of HLSL for shader model 5 and later. A matrix is written transposed: its rows are GLSL's columns."""

    kinds = KINDS
    functions: Mapping[str, str] = MappingProxyType(
        {
            "inversesqrt": "rsqrt",
            "mix": "lerp",
            "fract": "frac",
            "roundEven": "round",
            "floatBitsToInt": "asint",
            "floatBitsToUint": "asuint",
            "intBitsToFloat": "asfloat",
            "uintBitsToFloat": "asfloat",
            "fma": "mad",
        }
    )
    reserved = words(
        "asm auto bool2 bool3 bool4 buffer catch centroid char class column_major const_cast default delete "
        "double double2 double3 double4 dword enum explicit export fixed float2 float2x2 float3 float3x3 float4 "
        "float4x4 friend goto half half2 half3 half4 in inout int2 int3 int4 interface line linear long matrix "
        "min16float mutable namespace new operator out packoffset pass point precise private protected public "
        "register row_major sample sampler shared short signed sizeof snorm string switch technique template "
        "texture this throw triangle try typedef typename uint2 uint3 uint4 union unorm unsigned using vector "
        "virtual mul lerp frac saturate clip rsqrt mad asint asuint asfloat float1 int1 uint1 bool1 uint64_t int64_t "
        "float16_t func let var extension import module struct static const volatile uniform globallycallable "
        "groupshared if else for while do switch case break continue return void float int uint bool true false "
        "associatedtype property where each expand internal This get set init is as none"
    )
    has_templates = True
    has_precise = True
    binding_advice = "Change the register to yours."
    # A choice by components that is longer than this is a function of its own: it would be written for each of them.
    most_letters = 120

    def _program(self, program: Program) -> str:
        self._choices: dict[str, tuple[str, str]] = {}
        self._makers: dict[str, str] = {}
        declared = (node for function in program.functions for node in inside(function.body))
        constants = [*program.constants, *(node for node in declared if isinstance(node, Declare) and node.is_constant)]
        self._constants = {constant.name for constant in constants}
        text = super()._program(program)
        return "".join(f"{function}\n\n" for _, function in self._choices.values()) + text

    def _statement(self, statement: Statement, indent: str) -> str:
        """Return the text of a statement. A loop with constant ends that reads a constant array is marked [unroll],
        so that the array's elements become literals in the instructions."""
        text = super()._statement(statement, indent)
        if not isinstance(statement, For) or not _has_ends(statement) or not self._reads_array(statement):
            return text
        above = self._comments(statement, indent)
        return f"{above}{indent}[unroll]\n{text.removeprefix(above)}"

    def _reads_array(self, loop: For) -> bool:
        arrays = (node.value for node in inside(loop.body) if isinstance(node, Index) and node.value.kind.endswith("]"))
        return any(isinstance(array, Name) and array.name in self._constants for array in arrays)

    def _struct(self, struct: Struct) -> str:
        """Return the text of a structure and of a function that makes it from its fields; HLSL has no such
        constructor."""
        fields = self._fields(struct)
        name = self._makers[struct.name] = self._global_name(f"{struct.name.removeprefix(f'{self._prefix}_')}_of")
        given = ", ".join(f"{self._kind(kind)} {field}" for field, kind in fields.items())
        local = "made_" if "made" in fields else "made"
        sets = "".join(f"{INDENT}{local}.{field} = {field};\n" for field in fields)
        body = f"{INDENT}{struct.name} {local};\n{sets}{INDENT}return {local};\n"
        return f"{super()._struct(struct)}\n\n{struct.name} {name}({given}) {{\n{body}}}"

    def _declared_table(self, table: TexelTable, binding: int) -> str:
        return f"Texture2D<float4> {table.name} : register(t{binding});"

    def _global_text(self, constant: Declare) -> str:
        return f"static const {self._declaration_text(constant)};"

    def _elements(self, value: Elements) -> str:
        return f"{{{self._listed(value)}}}"

    def _fetch(self, value: Call) -> str:
        table, place, level = map(self._text, value.arguments)
        return f"{table}.Load(int3({place}, {level}))"

    def _binary_and_level(self, value: Binary) -> tuple[str, int]:
        if value.operator == "*" and "mat" in value.left.kind + value.right.kind:
            return f"mul({self._text(value.right)}, {self._text(value.left)})", PRIMARY
        # glslang makes one truth value of two constant vectors.
        if value.operator in COMPARES and size_of(value.kind) > 1 and self._is_constant(value):
            parts = ", ".join(self._component(value, field) for field in FIELDS[: size_of(value.kind)])
            return f"{self._kind(value.kind)}({parts})", PRIMARY
        return super()._binary_and_level(value)

    def _is_constant(self, value: Expression) -> bool:
        nodes = list(inside(value))
        names = {node.name for node in nodes if isinstance(node, Name)}
        return names <= self._constants and not any(isinstance(node, Call) and node.is_own for node in nodes)

    def _operand(self, parent: Binary, child: Expression, least: int) -> str:
        """Return the text of an operand. A `<` in a logical operation is put in parentheses, because Slang reads `a <
        b && c > (d)` as a call of a generic function."""
        return super()._operand(parent, child, UNARY if parent.operator in TRUTHS and is_less(child) else least)

    def _choice_and_level(self, value: Choice) -> tuple[str, int]:
        """Return the text and the level of a conditional; vectors are chosen by component, because HLSL 2021 has no
        `?:` for vectors, and earlier versions have no select."""
        size = size_of(value.condition.kind)
        if size == 1:
            text, level = super()._choice_and_level(value)
            condition = self._text(value.condition)
            is_unclear = is_less(value.condition) and ">" in text
            return f"({condition}){text.removeprefix(condition)}" if is_unclear else text, level
        whole = value.condition, value.chosen, value.other
        texts = [*map(self._text, whole)]
        # What is long is so by components too; to write them all the same would triple the work at each inner choice.
        if sum(map(len, texts)) <= 2 * self.most_letters:
            parts = ([self._component(part, field) for part in whole] for field in FIELDS[:size])
            text = ", ".join(map("{0[0]} ? {0[1]} : {0[2]}".format, parts))
            if len(text) <= self.most_letters:
                return f"{self._kind(value.kind)}({text})", PRIMARY
        return f"{self._choice_of(value.kind, value.condition.kind, size)}({', '.join(texts)})", PRIMARY

    def _component(self, value: Expression, field: str) -> str:
        """Return the text of a vector's component; for a comparison or a constructor, without the
        other components."""
        index = FIELDS.index(field)
        match value:
            case Binary(_, mark, left, right) if mark in COMPARES and size_of(left.kind) == size_of(right.kind):
                return f"({self._component(left, field)} {mark} {self._component(right, field)})"
            case Construct(_, [one]) if size_of(one.kind) == 1:
                return self._text(one, PRIMARY)
            case Construct(_, given) if all(size_of(part.kind) == 1 for part in given):
                return self._text(given[index], PRIMARY)
        return f"{self._text(value, PRIMARY)}.{field}"

    def _choice_of(self, kind: str, condition: str, size: int) -> str:
        """Return the name of the function that chooses between two values of a type; write the function on first use.

        Args:
            condition: the type of the condition.
            size: the number of components."""
        if kind not in self._choices:
            name, kind_name = self._global_name(f"chosen_{self._kind(kind)}"), self._kind(kind)
            head = f"{kind_name} {name}({self._kind(condition)} condition, {kind_name} chosen, {kind_name} other)"
            parts = (f"condition.{field} ? chosen.{field} : other.{field}" for field in FIELDS[:size])
            body = f"return {kind_name}({', '.join(parts)});"
            self._choices[kind] = name, f"{head} {{\n{INDENT}{body}\n}}"
        return self._choices[kind][0]

    def _construct(self, value: Construct) -> str:
        size, given = size_of(value.kind), value.arguments
        if value.kind in self._makers:
            return f"{self._makers[value.kind]}({self._arguments(given)})"
        if size > 1 and len(given) == 1 and size_of(given[0].kind) == 1:
            if isinstance(given[0], Literal | Name):
                return f"{self._kind(value.kind)}({', '.join([self._text(given[0])] * size)})"
            return f"({self._text(given[0])}).{'x' * size}"
        return super()._construct(value)


def _has_ends(loop: For) -> bool:
    """Whether a loop's counter begins and ends at literal numbers."""
    match loop.start, loop.condition:
        case Declare(_, _, Literal()), Binary(_, _, Name(), Literal()):
            return True
    return False
