"""The Metal Shading Language."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .hlsl_writer import KINDS
from .tree import Call, Choice, Construct, Declare, Elements, Function, Name, Program, inside, size_of
from .writer import PRIMARY, Writer, words

TABLE = "texture2d<float>"


class MslWriter(Writer):
    """Metal 2 and later. Tables are arguments: Metal has no textures outside of functions."""

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
        "friend goto mutable new private protected public sizeof switch throw try typedef union virtual this matrix"
    )
    float_suffix = "f"
    head = "#include <metal_stdlib>\nusing namespace metal;"
    has_tables = False
    splats = True

    def __init__(self, prefix: str, sizes: Mapping[str, tuple[int, int]]):
        super().__init__(prefix, sizes)
        self._reads: dict[str, list[str]] = {}

    def program(self, program: Program) -> str:
        self._reads = tables_read(program)
        return super().program(program)

    def _global(self, constant: Declare) -> str:
        return f"constant {self._declared(constant)};"

    def _signature(self, function: Function) -> str:
        read = "".join(f", {TABLE} {name}" for name in self._reads[function.name])
        return f"inline {super()._signature(function).removesuffix(')')}{read})"

    def _elements(self, value: Elements) -> str:
        return f"{{{self._listed(value)}}}"

    def _call(self, value: Call) -> str:
        text = super()._call(value)
        return text.removesuffix(")") + "".join(f", {name}" for name in self._reads.get(value.name, [])) + ")"

    def _choice(self, value: Choice) -> tuple[str, int]:
        if size_of(value.condition.kind) == 1:
            return super()._choice(value)
        return f"select({', '.join(map(self._text, (value.other, value.chosen, value.condition)))})", PRIMARY

    def _fetch(self, value: Call) -> str:
        table, place, _ = map(self._text, value.arguments)
        return f"{table}.read(uint2({place}))"

    def _construct(self, value: Construct) -> str:
        kind = self._kind(value.kind)
        if size_of(value.kind) == 1 and len(value.arguments) == 1:
            return f"{kind}({self._text(value.arguments[0])})"
        return super()._construct(value)


def tables_read(program: Program) -> dict[str, list[str]]:
    """The tables that each function reads, itself or by those it calls; by name, in order."""
    names = {table.name for table in program.tables}
    found: dict[str, list[str]] = {}
    for function in program.functions:
        nodes = list(inside(function.body))
        read = {node.name for node in nodes if isinstance(node, Name)} & names
        read |= {name for node in nodes if isinstance(node, Call) for name in found.get(node.name, [])}
        found[function.name] = sorted(read)
    return found
