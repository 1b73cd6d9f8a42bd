"""The Metal Shading Language."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .hlsl_writer import KINDS
from .texels import Texels
from .tree import (
    Binary,
    Call,
    Choice,
    Construct,
    Declare,
    Elements,
    Expression,
    Function,
    Literal,
    Name,
    Program,
    inside,
    scalar_of,
    size_of,
)
from .writer import PRIMARY, Writer, words

TABLE = "texture2d<float>"


class MslWriter(Writer):
    """A writer of Metal 2 and later. Tables are arguments, because Metal has no textures outside functions."""

    kinds: Mapping[str, str] = MappingProxyType(KINDS)
    functions: Mapping[str, str] = MappingProxyType(
        {
            "inversesqrt": "rsqrt",
            "roundEven": "rint",
            "floatBitsToInt": "as_type<int>",
            "floatBitsToUint": "as_type<uint>",
            "intBitsToFloat": "as_type<float>",
            "uintBitsToFloat": "as_type<float>",
        }
    )
    reserved = words(
        "half sample vertex fragment kernel device constant thread texture sampler access bool2 bool3 bool4 "
        "int2 int3 int4 uint2 uint3 uint4 float2 float3 float4 half2 half3 half4 "
        "short2 ushort2 char uchar short ushort long ulong "
        "typename template operator namespace using unsigned signed asm auto catch class default delete enum explicit "
        "friend goto mutable new private protected public sizeof switch throw try typedef union virtual this matrix "
        "alignas alignof and and_eq bitand bitor bool break case char16_t char32_t compl const const_cast constexpr "
        "continue decltype do double dynamic_cast else export extern false final float for if inline int int8_t "
        "int16_t int32_t int64_t long metal noexcept not not_eq nullptr or or_eq override ptrdiff_t register "
        "reinterpret_cast return short signed size_t static static_assert static_cast struct thread_local threadgroup "
        "true typeid typename uint uint8_t uint16_t uint32_t uint64_t void volatile wchar_t while xor xor_eq as_type "
        "select texture2d bfloat packed_float2 packed_float3 packed_float4 atomic_int atomic_uint object mesh patch "
        "stage_in visible M_PI_F INFINITY NAN MAXFLOAT rint rsqrt fabs fmin fmax fmod"
    )
    float_suffix = "f"
    head = "#include <metal_stdlib>\nusing namespace metal;"
    has_tables = False
    splats = True

    binding_advice = "Functions that read it take it as their last parameter."

    def __init__(self, prefix: str, texels: Mapping[str, Texels], stem: str = ""):
        super().__init__(prefix, texels, stem)
        self._reads: dict[str, list[str]] = {}

    def program(self, program: Program) -> str:
        self._reads = tables_read(program)
        return super().program(program)

    def _head_parts(self, program: Program) -> list[str]:
        tables = sorted(table.name for table in program.tables)
        notes = (f"// {name}, {self._table_note(name).removeprefix('// ').rstrip()}" for name in tables)
        return [*super()._head_parts(program), *(note for note in notes if program.tables)]

    def _global_text(self, constant: Declare) -> str:
        return f"constant {self._declaration_text(constant)};"

    def _signature(self, function: Function) -> str:
        read = "".join(f", {TABLE} {name}" for name in self._reads[function.name])
        return f"inline {super()._signature(function).removesuffix(')')}{read})"

    def _elements(self, value: Elements) -> str:
        return f"{{{self._listed(value)}}}"

    def _call(self, value: Call) -> str:
        text = super()._call(value)
        return text.removesuffix(")") + "".join(f", {name}" for name in self._reads.get(value.name, [])) + ")"

    def _choice_and_level(self, value: Choice) -> tuple[str, int]:
        if size_of(value.condition.kind) == 1:
            return super()._choice_and_level(value)
        return f"select({self._arguments((value.other, value.chosen, value.condition))})", PRIMARY

    def _fetch(self, value: Call) -> str:
        table, place, _ = map(self._text, value.arguments)
        return f"{table}.read(uint2({place}))"

    def _construct(self, value: Construct) -> str:
        size = size_of(value.kind)
        if value.kind in self._structs:
            return f"{value.kind}{{{self._arguments(value.arguments)}}}"
        if len(value.arguments) == 1 and size == size_of(value.arguments[0].kind):
            return self._conversion(value, value.arguments[0], size)
        return super()._construct(value)

    def _conversion(self, value: Construct, given: Expression, size: int) -> str:
        """Return the text of a conversion. Vectors are converted to Booleans by a comparison, and from Booleans by a
        conditional, because compilers differ in the value of true."""
        from_kind, to_kind = scalar_of(given.kind), scalar_of(value.kind)
        if size > 1 and from_kind == "bool":
            ones, zero = (Construct(value.kind, [Literal(to_kind, text)]) for text in _ends(to_kind))
            return self._choice_and_level(Choice(value.kind, given, ones, zero))[0]
        if size > 1 and to_kind == "bool":
            zero = Construct(given.kind, [Literal(from_kind, _ends(from_kind)[1])])
            return f"({self._binary_and_level(Binary(value.kind, '!=', given, zero))[0]})"
        return f"{self._kind(value.kind)}({self._text(given)})"


def _ends(scalar: str) -> tuple[str, str]:
    return ("1.0", "0.0") if scalar == "float" else ("1", "0")


def tables_read(program: Program) -> dict[str, list[str]]:
    """Return the sorted names of the tables that each function reads, itself or in its calls, by function name."""
    names = {table.name for table in program.tables}
    tables: dict[str, list[str]] = {}
    for function in program.functions:
        nodes = list(inside(function.body))
        read = {node.name for node in nodes if isinstance(node, Name)} & names
        read |= {name for node in nodes if isinstance(node, Call) for name in tables.get(node.name, [])}
        tables[function.name] = sorted(read)
    return tables
