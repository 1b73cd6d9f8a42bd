"""A writer of CUDA C++ that uses glsl.cuh, which defines GLSL's vectors and functions under their own names."""

from __future__ import annotations

from ...translator.builtins import BITS, LIKE_GIVEN, OF_VECTORS
from ...translator.tree import (
    Assign,
    Binary,
    Choice,
    Construct,
    Declare,
    Elements,
    Expression,
    Function,
    Statement,
    Swizzle,
    TexelTable,
)
from ...translator.writer import PRIMARY, Writer, words

FIELDS = "xyzw"


class CudaWriter(Writer):
    """A writer of inline device functions; lookup tables are sampler handles in constant memory."""

    float_suffix = "f"
    splats = True
    has_rich_parameters = True
    # In C++ a variable hides the function of its name, in GLSL not before its own value is known.
    reserved = (LIKE_GIVEN | OF_VECTORS | set(BITS)) | words(
        "alignas alignof all and any Array asm assign auto bool catch char chosen class compl concept constexpr cross "
        "const_cast decltype default delete double dynamic_cast enum explicit export extern final friend goto inline "
        "kernel lane long mutable namespace new noexcept not Of operator or override part_of planes private protected "
        "public put register reinterpret_cast requires Same short signed Size sizeof static static_assert static_cast "
        "swizzled template this thread_local throw try typedef typeid typename union unsigned using Vec virtual "
        "volatile wchar_t xor"
    )

    def _table(self, table: TexelTable) -> str:
        return f"__constant__ sampler2D {table.name};"

    def _global_text(self, constant: Declare) -> str:
        return f"static constexpr {self._declaration_text(constant)};"

    def _signature(self, function: Function) -> str:
        parameters = (f"{self._kind(p.kind)} {'&' * p.is_changed}{self._name(p.name)}" for p in function.parameters)
        return f"__forceinline__ {self._kind(function.kind)} {function.name}({', '.join(parameters)})"

    def _kind(self, kind: str) -> str:
        return kind_text(kind)

    def _declaration_text(self, declared: Declare) -> str:
        value = f" = {self._text(declared.value)}" if declared.value is not None else ""
        return f"{self._kind(declared.kind)} {self._name(declared.name)}{value}"

    def _elements(self, value: Elements) -> str:
        return f"{self._kind(value.kind)}{{{self._listed(value)}}}"

    def _construct(self, value: Construct) -> str:
        if value.kind in self._structs:
            return f"{value.kind}{{{self._arguments(value.arguments)}}}"
        return super()._construct(value)

    def _simple_text(self, statement: Statement) -> str:
        match statement:
            case Assign(Swizzle(kind, inner, names) as target, mark, value) if len(names) > 1:
                new_value = value if mark == "=" else Binary(kind, mark[:-1], target, value)
                return f"assign<{_field_indices(names)}>({self._text(inner)}, {self._text(new_value)})"
        return super()._simple_text(statement)

    def _text_and_level(self, value: Expression) -> tuple[str, int]:
        match value:
            case Swizzle(_, inner, names):
                return self._swizzle_text(inner, names), PRIMARY
        return super()._text_and_level(value)

    def _swizzle_text(self, inner: Expression, names: str) -> str:
        if len(names) == 1:
            return f"{self._text(inner, PRIMARY)}[{_field_indices(names)}]"
        return f"swizzled<{_field_indices(names)}>({self._text(inner)})"

    def _block(self, head: str, body: list[Statement], indent: str) -> str:
        # Compilers of shaders unroll every loop that they know the length of; CUDA's stops sooner unless asked.
        unrolls = f"{indent}#pragma unroll\n" if head.startswith("for") else ""
        return unrolls + super()._block(head, body, indent)

    def _choice_and_level(self, value: Choice) -> tuple[str, int]:
        """Return the text and level of a conditional: both values are computed and one is selected, as in shaders."""
        return f"chosen({', '.join(map(self._text, (value.condition, value.chosen, value.other)))})", PRIMARY


def kind_text(kind: str) -> str:
    """Return a GLSL type in the notation of glsl.cuh: `Array<float, 4>` for `float[4]`; other types are unchanged."""
    scalar, bracket, count = kind.partition("[")
    return f"Array<{scalar}, {count.rstrip(']')}>" if bracket else kind


def _field_indices(names: str) -> str:
    return ", ".join(str(FIELDS.index(name)) for name in names)
