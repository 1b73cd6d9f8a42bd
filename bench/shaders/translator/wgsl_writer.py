"""WGSL, WebGPU's language."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .parser import COMPARES, SHIFTS
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
    Struct,
    TexelTable,
    Unary,
    scalar_of,
    size_of,
    vector,
)
from .writer import BITWISE, INDENT, PRIMARY, UNARY, Writer, words

RESERVED = words(
    "active alignas as asm auto become bf16 catch class common const demote do enum explicit export extern external "
    "filter final finally fixed from get goto half impl implements import inline interface lowp highp macro match meta "
    "mod module move mut namespace new of out package partition pass patch pixelfragment precise precision premerge "
    "priv protected pub public readonly ref register resource restrict self set shared sizeof smooth snorm static std "
    "struct super target template this throw trait try type typedef typename union unless unorm unsafe unsized use "
    "using var varying virtual volatile where with writeonly yield loop fn let override switch sampler texture select "
    "bitcast textureLoad array atomic ptr f16 vec2 vec3 vec4 vec2h vec3h vec4h alias break case const_assert continue "
    "continuing default diagnostic discard else enable false for if requires return true while bool float int"
)


class WgslWriter(Writer):
    """A writer of WGSL; `group` is the bind group of the tables."""

    has_templates = True

    kinds: Mapping[str, str] = MappingProxyType(
        {
            "float": "f32",
            "int": "i32",
            "uint": "u32",
            **{
                f"{letter}vec{size}": f"vec{size}{short}"
                for letter, short in (("", "f"), ("i", "i"), ("u", "u"), ("b", "<bool>"))
                for size in (2, 3, 4)
            },
            **{f"mat{size}": f"mat{size}x{size}f" for size in (2, 3, 4)},
        }
    )
    functions: Mapping[str, str] = MappingProxyType(
        {
            "inversesqrt": "inverseSqrt",
            "roundEven": "round",
            "floatBitsToInt": "bitcast<i32>",
            "floatBitsToUint": "bitcast<u32>",
            "intBitsToFloat": "bitcast<f32>",
            "uintBitsToFloat": "bitcast<f32>",
        }
    )
    reserved = RESERVED
    splats = True
    assigns_to_parts = False
    group = 0

    def __init__(self, prefix: str, texels: Mapping[str, Texels], stem: str = ""):
        super().__init__(prefix, texels, stem)
        # Parameters that a function assigns to: variables, which begin as what it is given.
        self._copied: dict[str, str] = {}

    def _declared_table(self, table: TexelTable, binding: int) -> str:
        return f"@group({self.group}) @binding({binding}) var {table.name}: texture_2d<f32>;"

    def _global_text(self, constant: Declare) -> str:
        value = self._text(constant.value) if constant.value else ""
        return f"const {constant.name}: {self._kind(constant.kind)} = {value};"

    def _struct(self, struct: Struct) -> str:
        fields = "".join(f"{INDENT}{name}: {self._kind(kind)},\n" for name, kind in self._fields(struct).items())
        return f"struct {struct.name} {{\n{fields}}}"

    def _kind(self, kind: str) -> str:
        element, _, count = kind.partition("[")
        if count:
            return f"array<{self._kind(element)}, {count.rstrip(']')}>"
        return super()._kind(kind)

    def _signature(self, function: Function) -> str:
        called = {p.name: self._copied.get(p.name, self._name(p.name)) for p in function.parameters}
        parameters = ", ".join(f"{called[p.name]}: {self._kind(p.kind)}" for p in function.parameters)
        return f"fn {function.name}({parameters}) -> {self._kind(function.kind)}"

    def _body(self, function: Function) -> str:
        changed = [p.name for p in function.parameters if p.name in self._assigned]
        self._copied = {name: self._unused(f"given_{name}") for name in changed}
        copies = (f"{INDENT}var {self._name(name)} = {given};\n" for name, given in self._copied.items())
        return "".join(copies) + super()._body(function)

    def _declaration_text(self, declared: Declare) -> str:
        value = f" = {self._text(declared.value)}" if declared.value is not None else ""
        annotation = "" if value else f": {self._kind(declared.kind)}"
        # What is not a variable is indexed by constants alone.
        is_variable = declared.name in self._assigned or not value or declared.kind.endswith("]")
        word = "var" if is_variable else "let"
        return f"{word} {self._name(declared.name)}{annotation}{value}"

    def _local_text(self, declared: Declare) -> str:
        return self._declaration_text(declared)

    def _count_text(self, target: Expression, mark: str) -> str:
        return f"{self._text(target)}{mark[0] * 2}"

    def _text_and_level(self, value: Expression) -> tuple[str, int]:
        match value:
            case Unary(kind, "-", inner) if scalar_of(kind) == "uint":
                return self._binary_and_level(Binary(kind, "-", _broad(Literal("uint", "0"), size_of(kind)), inner))
        return super()._text_and_level(value)

    def _binary_and_level(self, value: Binary) -> tuple[str, int]:
        left, right = value.left, value.right
        size = max(size_of(left.kind), size_of(right.kind))
        if value.operator in SHIFTS:
            by = f"{right.text}u" if isinstance(right, Literal) else self._as_uint(right)
            if size_of(right.kind) < size:
                by = f"vec{size}u({by})"
            return f"{self._text(left, UNARY)} {value.operator} {by}", UNARY - 1
        if value.operator in BITWISE | COMPARES:
            left, right = _broad(left, size), _broad(right, size)
            value = Binary(value.kind, value.operator, left, right)
        if value.operator in ("==", "!=") and left.kind == "bool":
            return f"{self._text(left, PRIMARY)} {value.operator} {self._text(right, PRIMARY)}", 7
        return super()._binary_and_level(value)

    def _as_uint(self, value: Expression) -> str:
        return self._text(value, UNARY) if value.kind == "uint" else f"u32({self._text(value)})"

    def _choice_and_level(self, value: Choice) -> tuple[str, int]:
        parts = (value.other, value.chosen, value.condition)
        return f"select({self._arguments(parts)})", PRIMARY

    def _fetch(self, value: Call) -> str:
        return f"textureLoad({', '.join(map(self._text, value.arguments))})"

    def _elements(self, value: Elements) -> str:
        return f"{self._kind(value.kind)}({self._listed(value)})"


def _broad(value: Expression, size: int) -> Expression:
    """Return a value with `size` components; a scalar is repeated."""
    if size_of(value.kind) == size:
        return value
    return Construct(vector(value.kind, size), [value])
