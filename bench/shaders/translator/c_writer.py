"""A writer of C99, which has no vectors: each vector operation is written once per component.

The written file defines operations that GLSL leaves undefined. Conversion to an integer turns NaN into 0 and clamps
values that are out of range, as in Direct3D. x / 0 is x and x % 0 is 0, as in WGSL. Shift counts are modulo 32,
integer sums wrap, and an array index out of range becomes the nearest valid index. NaN has one bit pattern.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType

from .builtins import BITS, FETCH
from .c_defined import HELPERS, OPERATIONS, Range, counted, range_of
from .parser import BINDING, SHIFTS
from .texels import Texels
from .tree import (
    MATRICES,
    SIZES,
    Assign,
    Binary,
    Call,
    Choice,
    Construct,
    Declare,
    Elements,
    Expression,
    For,
    Function,
    Index,
    Literal,
    Member,
    Name,
    Program,
    Return,
    Statement,
    Struct,
    Swizzle,
    TranslationError,
    Unary,
    While,
    inside,
    scalar_of,
    size_of,
)
from .tree import SCALARS as LETTERS
from .writer import CHOICE, FIELDS, INDENT, PRIMARY, UNARY, Writer, words

ScalarText = tuple[str, int]
# Scalars in, a scalar out, component by component.
FUNCTIONS: Mapping[str, str] = MappingProxyType(
    {
        **{name: f"{name}f" for name in ("floor", "ceil", "trunc", "sqrt", "exp2", "log2", "exp", "log", "pow", "fma")},
        **{name: f"{name}f" for name in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2")},
        "abs": "fabsf",
        "roundEven": "rintf",
        "round": "rintf",
    }
)
# What C has no function for.
FORMULAS: Mapping[str, str] = MappingProxyType(
    {
        "fract": "{0} - floorf({0})",
        "mix": "{0} * (1.0f - {2}) + {1} * {2}",
        "step": "{1} < {0} ? 0.0f : 1.0f",
        "sign": "(float)(({0} > 0.0f) - ({0} < 0.0f))",
    }
)
SCALARS: Mapping[str, str] = MappingProxyType({"float": "float", "int": "int32_t", "uint": "uint32_t", "bool": "bool"})
# A part that may stand in several places without being computed twice.
PLAIN = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.")
WHOLE = ("int", "uint")


class CWriter(Writer):
    """A writer of C99. Structures and helpers have the program's prefix; tables are in a separate header."""

    float_suffix = "f"
    has_tables = False
    assigns_to_parts = False
    functions = FUNCTIONS
    reserved = words(
        "auto char double enum extern inline long register restrict short signed sizeof static struct switch typedef "
        "union unsigned void volatile half small near far y0 y1 yn j0 j1 jn break case const continue default do else "
        "float for goto if int return while bool true false asm typeof int8_t int16_t int32_t int64_t uint8_t uint16_t "
        "uint32_t uint64_t size_t memcpy NULL NAN INFINITY HUGE_VAL INT32_MAX INT32_MIN UINT32_MAX M_PI M_E M_PI_2 "
        "M_PI_4 M_1_PI M_2_PI M_SQRT2 DOMAIN SING OVERFLOW UNDERFLOW PLOSS TLOSS linux unix math_errhandling I complex"
    )

    def __init__(self, prefix: str, texels: Mapping[str, Texels], stem: str = ""):
        super().__init__(prefix, texels, stem)
        self._hoisted: list[str] = []
        self._indent, self._count = INDENT, 0
        self._helpers: dict[str, str] = {}
        # Constants that C computes when they are asked for.
        self._computed: set[str] = set()
        # Counters of loops that nothing else assigns to: what they are in the loop.
        self._ranges: dict[str, Range] = {}

    # The file.

    def _program(self, program: Program) -> str:
        constants = [self._constant(each) for each in program.constants]
        functions = [self._function(each) for each in program.functions]
        parts = [
            *self._head_parts(program),
            *(["\n".join(constants)] if constants else []),
            *functions,
        ]
        return "\n\n".join(parts) + "\n"

    def _head_parts(self, program: Program) -> list[str]:
        kinds = {getattr(node, "kind", "").partition("[")[0] for node in inside([program.constants, program.functions])}
        kinds |= {kind for struct in program.structs for kind in struct.kinds.values()}
        kinds |= {f"vec{kind[3]}" for kind in kinds & set(MATRICES)}
        includes = ["#include <math.h>", "#include <stdbool.h>", "#include <stdint.h>", "#include <string.h>"]
        includes += [f'#include "{self._stem}_tables.h"'] if program.tables else []
        contract = "#ifdef __clang__\n#pragma STDC FP_CONTRACT OFF\n#endif"
        helpers = [
            f"static inline {HELPERS[name].format(self._helpers[name])}" for name in HELPERS if name in self._helpers
        ]
        structs = [self._structure(kind) for kind in (*SIZES, *MATRICES) if kind in kinds]
        structs += map(self._struct, program.structs)
        return [part for part in ("\n".join(includes), contract, "\n".join(structs), "\n".join(helpers)) if part]

    def _struct(self, struct: Struct) -> str:
        fields = "".join(f"{INDENT}{self._kind(kind)} {name};\n" for name, kind in self._fields(struct).items())
        return f"typedef struct {{\n{fields}}} {struct.name};"

    def _structure(self, kind: str) -> str:
        if kind in MATRICES:
            size, scalar = int(kind[3]), self._kind(f"vec{kind[3]}")
        else:
            size, scalar = size_of(kind), SCALARS[scalar_of(kind)]
        return f"typedef struct {{ {scalar} {', '.join(FIELDS[:size])}; }} {self._kind(kind)};"

    def _helper(self, name: str, *given: str) -> ScalarText:
        """Return the text and the level of a call to a helper function, which will be written to the file."""
        if name not in self._helpers:
            self._helpers[name] = self._global_name(name)
        return f"{self._helpers[name]}({', '.join(given)})", PRIMARY

    def _kind(self, kind: str) -> str:
        return SCALARS.get(kind) or (kind if kind in self._structs else f"{self._prefix}_{kind}")

    def _global_text(self, constant: Declare) -> str:
        self._used, self._count = set(self._taken), 0
        text, hoisted = self._apart(lambda: self._declaration_text(constant), INDENT)
        if not hoisted and not any(isinstance(node, Call | Name) for node in inside(constant.value)):
            return f"static const {text};"
        if "[" in constant.kind:
            raise TranslationError(f"{constant.name}: an array of computed values cannot be written in C")
        self._computed.add(constant.name)
        head = f"static inline {self._kind(constant.kind)} {constant.name}(void)"
        result = text.partition(" = ")[2]
        result = f"({self._kind(constant.kind)}){result}" if result.startswith("{") else result
        return f"{head} {{\n{hoisted}{INDENT}return {result};\n}}"

    def _name(self, name: str) -> str:
        return f"{name}()" if name in self._computed else super()._name(name)

    def _declaration_text(self, declared: Declare) -> str:
        kind, _, count = declared.kind.partition("[")
        value, array = declared.value, f"[{count}" if count else ""
        # What is read before it is assigned to is the same wherever it is compiled.
        nothing = "{0}" if array or kind not in SCALARS else {"float": "0.0f", "bool": "false"}.get(kind, "0")
        if array and value is not None and not isinstance(value, Elements):
            raise TranslationError(f"{declared.name}: a copy of an array cannot be written in C")
        text = self._whole(value, is_initial=True) if value is not None else nothing
        return f"{self._kind(kind)} {self._name(declared.name)}{array} = {text}"

    def _signature(self, function: Function) -> str:
        parameters = ", ".join(f"{self._kind(p.kind)} {self._name(p.name)}" for p in function.parameters) or "void"
        return f"static inline {self._kind(function.kind)} {function.name}({parameters})"

    def _function(self, function: Function) -> str:
        self._count, self._ranges = 0, {}
        return super()._function(function)

    # Statements: what they need is said before them.

    def _statement(self, statement: Statement, indent: str) -> str:
        (text, hoisted) = self._apart(lambda: self._uncommented_text(statement, indent), indent)
        return self._comments(statement, indent) + hoisted + text

    def _apart(self, write: Callable[[], str], indent: str) -> tuple[str, str]:
        """Return the text that `write` returns, and the statements that must precede it."""
        outer = self._hoisted, self._indent
        self._hoisted, self._indent = [], indent
        text = write()
        hoisted = "".join(self._hoisted)
        self._hoisted, self._indent = outer
        return text, hoisted

    def _uncommented_text(self, statement: Statement, indent: str) -> str:
        match statement:
            case For():
                return self._loop(statement, indent)
            case While(condition, body):
                inner = indent + INDENT
                text, hoisted = self._apart(lambda: self._text(condition), inner)
                if not hoisted:
                    return self._block(f"while ({text})", body, indent)
                ends = f"{inner}if (!({text})) break;\n"
                return f"{indent}for (;;) {{\n{hoisted}{ends}{self._statements(body, inner)}{indent}}}\n"
        return super()._statement(_without_comments(statement), indent)

    def _loop(self, loop: For, indent: str) -> str:
        known = counted(loop)
        self._ranges |= known
        start = self._simple_text(loop.start) if loop.start else ""
        inner = indent + INDENT
        condition, before = self._apart(lambda: self._text(loop.condition), inner)
        step, before_step = self._apart(lambda: self._simple_text(loop.step) if loop.step else "", inner)
        if before or before_step:
            text = self._statement(self._loop_without_head(loop), indent)
        else:
            text = self._block(f"for ({start}; {condition}; {step})", loop.body, indent)
        for name in known:
            del self._ranges[name]
        return text

    def _simple_text(self, statement: Statement) -> str:
        match statement:
            case Assign(target, mark, value):
                if mark != "=" and self._is_plain(target, mark, value):
                    return super()._simple_text(statement)
                new_value = value if mark == "=" else Binary(target.kind, mark[:-1], target, value)
                return f"{self._place(target)} = {self._whole(new_value)}"
            case Return(value) if value is not None:
                return f"return {self._whole(value)}"
        return super()._simple_text(statement)

    def _is_plain(self, target: Expression, mark: str, value: Expression) -> bool:
        """Whether C's own operator, such as `+=`, can be used: the target is a scalar variable and, for whole
        numbers, C defines the result."""
        if target.kind not in SCALARS or not isinstance(target, Name):
            return False
        return scalar_of(target.kind) not in WHOLE or self._is_safe(Binary(target.kind, mark[:-1], target, value))

    def _whole(self, value: Expression | None, is_initial: bool = False) -> str:
        """Return the C text of a scalar or a whole structure; without the structure's type for an initial value."""
        assert value
        if isinstance(value, Elements):
            values = [self._whole(element, is_initial=True) for element in value.values]
            return f"{{{self._rows_text(values)}}}"
        if value.kind in SCALARS:
            return self._text(value)
        if isinstance(value, Name) or (isinstance(value, Call) and value.is_own):
            return self._text_and_level(value)[0]
        whole = self._assembled_text(self._parts(value), value.kind)
        return whole.removeprefix(f"({self._kind(value.kind)})") if is_initial else whole

    # Places: what can be assigned to, and read without being computed.

    def _place(self, value: Expression) -> str:
        """Return the C text of a variable or of a part of it. Raises TranslationError for any other expression."""
        match value:
            case Name(_, name):
                return self._name(name)
            case Swizzle(_, inner, names) if len(names) == 1:
                return self._component(inner, names)
            case Member(_, inner, name):
                return f"{self._place(inner)}.{self._field(name)}"
            case Index(_, inner, at) if inner.kind.endswith("]"):
                count = int(inner.kind.partition("[")[2].rstrip("]"))
                return f"{self._place(inner)}[{self._within(at, count)}]"
            case Index(_, inner, Literal(_, text)):
                return f"{self._place(inner)}.{FIELDS[int(text, 0)]}"
            case Index(_, inner, at):
                # The members of a structure of one type lie one after the other.
                size = int(inner.kind[3]) if inner.kind in MATRICES else size_of(inner.kind)
                return f"(&{self._place(inner)}.x)[{self._within(at, size)}]"
        raise TranslationError(f"a {type(value).__name__} of {value.kind} cannot be assigned to in C")

    def _component(self, inner: Expression, field: str) -> str:
        while isinstance(inner, Swizzle):
            field, inner = inner.fields[FIELDS.index(field)], inner.value
        return f"{self._place(inner)}.{field}"

    def _within(self, index: Expression, count: int) -> str:
        """Return the text of an index into `count` elements; a helper clamps it unless its range is known to fit."""
        known = self._range(index)
        if known and known[0] >= 0 and known[1] < count:
            return self._text(index)
        return self._helper("at", self._text(index), str(count))[0]

    # Values: a vector is the list of its components.

    def _text_and_level(self, value: Expression) -> ScalarText:
        """Return the text and level of a scalar, or of a whole value that is a name or a call of an own function."""
        if isinstance(value, Name):
            return self._name(value.name), PRIMARY
        if isinstance(value, Call) and value.is_own:
            given = ", ".join(self._whole(a) for a in value.arguments)
            return f"{value.name}({given})", PRIMARY
        (part,) = self._parts(value)
        return part

    def _parts(self, value: Expression) -> list[ScalarText]:
        match value:
            case Literal():
                return [(self._literal(value), PRIMARY)]
            case Name(kind, name) if name in self._computed and kind not in SCALARS:
                return self._made_parts(self._name(name), kind)
            case Name():
                return self._member_parts(self._name(value.name), value.kind)
            case Unary(kind, "-", inner) if scalar_of(kind) == "int" and not isinstance(inner, Literal):
                return [self._helper("subtract", "0", part[0]) for part in self._parts(inner)]
            case Unary(_, mark, inner):
                parts = self._parts(inner)
                return [(f"{mark}{_bracketed(part, UNARY + (mark == part[0][:1]))}", UNARY) for part in parts]
            case Binary():
                return self._combined_parts(value)
            case Choice():
                return self._choice_parts(value)
            case Call():
                return self._call_parts(value)
            case Construct():
                return self._constructed_parts(value)
            case Swizzle(_, inner, names):
                parts = self._parts(inner)
                return [parts[FIELDS.index(name)] for name in names]
            case Member(_, inner, name):
                fields = self._structs[inner.kind].kinds
                before = sum(self._count_of(fields[other]) for other in [*fields][: [*fields].index(name)])
                return self._parts(inner)[before:][: self._count_of(value.kind)]
            case Index():
                return self._indexed_parts(value)
        raise TranslationError(f"a {type(value).__name__} of {value.kind} cannot be written in C")

    def _indexed_parts(self, value: Index) -> list[ScalarText]:
        inner, index = value.value, value.at
        base = inner
        while isinstance(base, Index | Swizzle | Member):
            base = base.value
        is_there = isinstance(base, Name) and base.name not in self._computed
        if is_there and not isinstance(inner, Swizzle):
            return self._member_parts(self._place(value), value.kind)
        if inner.kind.endswith("]"):
            raise TranslationError("an element of an array without a name cannot be written in C")
        parts, size = self._parts(inner), size_of(value.kind)
        if isinstance(index, Literal):
            return parts[int(index.text, 0) * size :][:size]
        whole = self._temporary(self._kind(inner.kind), self._whole(inner))
        count = len(parts) // size
        return self._member_parts(f"(&{whole}.x)[{self._within(index, count)}]", value.kind)

    def _count_of(self, kind: str) -> int:
        """Return the number of scalars in a value of this type."""
        if kind in self._structs:
            return sum(map(self._count_of, self._structs[kind].kinds.values()))
        return int(kind[3]) ** 2 if kind in MATRICES else size_of(kind)

    def _member_parts(self, name: str, kind: str) -> list[ScalarText]:
        if kind in self._structs:
            fields = self._fields(self._structs[kind]).items()
            return [part for field, inner in fields for part in self._member_parts(f"{name}.{field}", inner)]
        if kind in MATRICES:
            fields = FIELDS[: int(kind[3])]
            return [(f"{name}.{column}.{row}", PRIMARY) for column in fields for row in fields]
        if size_of(kind) == 1 or kind.endswith("]"):
            return [(name, PRIMARY)]
        return [(f"{name}.{field}", PRIMARY) for field in FIELDS[: size_of(kind)]]

    def _once(self, part: ScalarText, kind: str) -> ScalarText:
        """Return a scalar for repeated use: unchanged if its text is plain, else as the name of a new variable."""
        if PLAIN.issuperset(part[0].removeprefix("-")):
            return part
        return self._temporary(self._kind(kind), part[0]), PRIMARY

    def _temporary(self, kind: str, text: str) -> str:
        """Declare a new variable with this value before the current statement, and return the variable's name."""
        name = self._fresh_name()
        self._hoisted.append(f"{self._indent}const {kind} {name} = {text};\n")
        return name

    def _fresh_name(self) -> str:
        self._count += 1
        while (name := f"t{self._count}") in self._used:
            self._count += 1
        return name

    def _broad_parts(self, value: Expression, size: int) -> list[ScalarText]:
        """Return the texts of a value's components; a scalar is computed once and repeated `size` times."""
        parts = self._parts(value)
        return [self._once(parts[0], scalar_of(value.kind))] * size if len(parts) == 1 < size else parts

    def _combined_parts(self, value: Binary) -> list[ScalarText]:
        left, right, mark = value.left, value.right, value.operator
        if mark == "*" and "mat" in left.kind and right.kind != "float":
            return self._product_parts(value)
        if mark == "*" and "mat" in right.kind and left.kind != "float":
            return self._product_parts(value)
        if mark in ("&&", "||"):
            return [self._logical(value)]
        level, size = BINDING[mark], self._size(value)
        scalar = scalar_of(left.kind)
        if scalar in WHOLE and mark in OPERATIONS and not self._is_safe(value):
            name = f"{'u' * (scalar == 'uint')}{OPERATIONS[mark]}"
            pairs = zip(self._broad_parts(left, size), self._broad_parts(right, size), strict=True)
            return [self._helper(name, a[0], b[0]) for a, b in pairs]
        if size == 1:
            texts = self._operand(value, left, level), self._operand(value, right, level + 1)
            return [(f"{texts[0]} {mark} {texts[1]}", level)]
        pairs = zip(self._broad_parts(left, size), self._broad_parts(right, size), strict=True)
        return [(f"{_bracketed(a, level)} {mark} {_bracketed(b, level + 1)}", level) for a, b in pairs]

    def _size(self, value: Binary) -> int:
        """Return the number of components of an operation: the largest number in its result and its operands."""
        kinds = (value.kind, value.left.kind, value.right.kind)
        return max(map(self._count_of, kinds))

    def _is_safe(self, value: Binary) -> bool:
        """Whether C defines the result of an operation on whole numbers."""
        right = self._range(value.right)
        if value.operator in SHIFTS:
            is_left_safe = (
                value.operator == ">>" or scalar_of(value.left.kind) == "uint" or self._range(value) is not None
            )
            return right is not None and right[0] >= 0 and right[1] < 32 and is_left_safe
        if value.operator in ("/", "%"):
            return right is not None and right[0] > 0
        return scalar_of(value.kind) == "uint" or self._range(value) is not None

    def _range(self, value: Expression) -> Range | None:
        """Return the smallest and the largest value that a whole number can have; None if they are unknown."""
        match value:
            case Literal("int" | "uint", text):
                return int(text, 0), int(text, 0)
            case Name(_, name):
                return self._ranges.get(name)
            case Construct("int" | "uint", [Literal("int" | "uint", text)]):
                return int(text, 0), int(text, 0)
            case Binary(_, mark, left, right):
                return range_of(mark, self._range(left), self._range(right))
        return None

    def _logical(self, value: Binary) -> ScalarText:
        """Return the text and the level of && or ||. If the right operand requires statements of its own, these go
        into an `if` before the current statement."""
        level = BINDING[value.operator]
        left = self._operand(value, value.left, level)
        text, hoisted = self._apart(lambda: self._operand(value, value.right, level + 1), self._indent + INDENT)
        if not hoisted:
            return f"{left} {value.operator} {text}", level
        name, no = self._fresh_name(), "" if value.operator == "&&" else "!"
        self._hoisted.append(f"{self._indent}bool {name} = {left};\n")
        inner = f"{hoisted}{self._indent}{INDENT}{name} = {text};\n"
        self._hoisted.append(f"{self._indent}if ({no}{name}) {{\n{inner}{self._indent}}}\n")
        return name, PRIMARY

    def _product_parts(self, value: Binary) -> list[ScalarText]:
        """Return the components of a matrix product: the dot products of a vector on the left with each column, or
        the sums of the columns, weighted by the components of a vector or of each column of another matrix."""
        left, right = value.left, value.right
        size = int((left if "mat" in left.kind else right).kind[3])
        if "mat" not in left.kind:
            n, columns = self._named_parts(left), self._parts(right)
            return [
                _sum_of_products(list(zip(n, columns[start : start + size], strict=True)))
                for start in range(0, size**2, size)
            ]
        columns, others = self._named_parts(left), self._named_parts(right)
        return [
            _sum_of_products([(columns[size * column + row], others[first + column]) for column in range(size)])
            for first in range(0, len(others), size)
            for row in range(size)
        ]

    def _named_parts(self, value: Expression) -> list[ScalarText]:
        """Return the texts of a value's components, each of which is computed only once."""
        return [self._once(part, scalar_of(value.kind)) for part in self._parts(value)]

    def _choice_parts(self, value: Choice) -> list[ScalarText]:
        count = self._count_of(value.kind)
        if size_of(value.condition.kind) > 1:
            parts = zip(
                *(self._parts(operand) for operand in (value.condition, value.chosen, value.other)), strict=True
            )
            return [_choice_part(*three) for three in parts]
        condition = self._text(value.condition, CHOICE + 1), UNARY
        inner = self._indent + INDENT
        chosen, before_chosen = self._parts_apart(value.chosen, inner)
        other, before_other = self._parts_apart(value.other, inner)
        if not before_chosen and not before_other:
            condition = self._once(condition, "bool") if count > 1 else condition
            return [_choice_part(condition, a, b) for a, b in zip(chosen, other, strict=True)]
        # What one of the two needs is computed where that one is chosen.
        name, kind = self._fresh_name(), self._kind(value.kind)
        texts = [self._assembled_text(parts, value.kind) for parts in (chosen, other)]
        nothing = "{0}" if value.kind not in SCALARS else "0"
        self._hoisted.append(
            f"{self._indent}{kind} {name} = {nothing};\n{self._indent}if ({condition[0]}) {{\n{before_chosen}"
            f"{inner}{name} = {texts[0]};\n{self._indent}}} else {{\n{before_other}{inner}{name} = {texts[1]};\n"
            f"{self._indent}}}\n"
        )
        return self._member_parts(name, value.kind)

    def _parts_apart(self, value: Expression, indent: str) -> tuple[list[ScalarText], str]:
        parts: list[ScalarText] = []

        def write() -> str:
            parts.extend(self._parts(value))
            return ""

        return parts, self._apart(write, indent)[1]

    def _assembled_text(self, parts: list[ScalarText], kind: str) -> str:
        texts = self._braced_text(kind, iter([text for text, _ in parts]))
        return texts if kind in SCALARS else f"({self._kind(kind)}){texts}"

    def _braced_text(self, kind: str, texts: Iterator[str]) -> str:
        """Return the braced initialiser of a value of this type, with scalars from `texts`; scalars have
        no braces."""
        if kind in SCALARS:
            return next(texts)
        inner = [scalar_of(kind)] * size_of(kind)
        if kind in MATRICES:
            inner = [f"vec{kind[3]}"] * int(kind[3])
        elif kind in self._structs:
            inner = list(self._structs[kind].kinds.values())
        return f"{{{', '.join(self._braced_text(inner_kind, texts) for inner_kind in inner)}}}"

    def _call_parts(self, value: Call) -> list[ScalarText]:
        if value.is_own:
            text = self._text_and_level(value)[0]
            return [(text, PRIMARY)] if value.kind in SCALARS else self._made_parts(text, value.kind)
        if value.name == FETCH:
            return self._fetched_parts(value)
        if value.name in OF_WHOLE:
            return getattr(self, f"_{value.name}")(*value.arguments)
        scalar, size = scalar_of(value.kind), size_of(value.kind)
        given = [self._broad_parts(a, size) for a in value.arguments]
        if scalar == "int" and value.name in ("abs", "sign"):
            return [self._helper(f"i{value.name}", x) for ((x, _),) in zip(*given, strict=True)]
        if value.name in FORMULAS:
            once = ([self._once(part, "float")[0] for part in parts] for parts in zip(*given, strict=True))
            return [(FORMULAS[value.name].format(*parts), CHOICE) for parts in once]
        if value.name == "smoothstep":
            return [self._smoothstep(*parts) for parts in zip(*given, strict=True)]
        if value.name == "inversesqrt":
            return [(f"1.0f / sqrtf({x})", BINDING["/"]) for ((x, _),) in zip(*given, strict=True)]
        return [self._scalar_call(value.name, scalar, parts) for parts in zip(*given, strict=True)]

    def _made_parts(self, text: str, kind: str) -> list[ScalarText]:
        """Store a value, given as text, in a new variable, and return the texts of its components."""
        return self._member_parts(self._temporary(self._kind(kind), text), kind)

    def _scalar_call(self, name: str, scalar: str, parts: tuple[ScalarText, ...]) -> ScalarText:
        texts, sign = [text for text, _ in parts], LETTERS[scalar]
        if name == "clamp":
            return self._helper(f"{sign}min", self._helper(f"{sign}max", *texts[:2])[0], texts[2])
        if name in ("min", "max"):
            return self._helper(f"{sign}{name}", *texts)
        if name in BITS:
            return self._helper(name, texts[0])
        if name not in FUNCTIONS:
            raise TranslationError(f"{name} cannot be written in C")
        return f"{FUNCTIONS[name]}({', '.join(texts)})", PRIMARY

    def _smoothstep(self, low: ScalarText, high: ScalarText, x: ScalarText) -> ScalarText:
        share = f"({_bracketed(x, 10)} - {_bracketed(low, 11)}) / ({_bracketed(high, 10)} - {_bracketed(low, 11)})"
        t = self._temporary("float", self._helper("min", self._helper("max", share, "0.0f")[0], "1.0f")[0])
        return f"{t} * {t} * (3.0f - 2.0f * {t})", BINDING["*"]

    def _dot(self, a: Expression, b: Expression) -> list[ScalarText]:
        return [_sum_of_products(list(zip(self._named_parts(a), self._named_parts(b), strict=True)))]

    def _length(self, value: Expression) -> list[ScalarText]:
        parts = self._named_parts(value)
        return [(f"sqrtf({_sum_of_products(list(zip(parts, parts, strict=True)))[0]})", PRIMARY)]

    def _distance(self, a: Expression, b: Expression) -> list[ScalarText]:
        return self._length(Binary(a.kind, "-", a, b))

    def _reflect(self, incident: Expression, normal: Expression) -> list[ScalarText]:
        i, n = self._named_parts(incident), self._named_parts(normal)
        twice = self._once((f"2.0f * ({_sum_of_products(list(zip(n, i, strict=True)))[0]})", BINDING["*"]), "float")
        return [
            (f"{_bracketed(a, 10)} - {twice[0]} * {_bracketed(b, 12)}", BINDING["-"]) for a, b in zip(i, n, strict=True)
        ]

    def _cross(self, a: Expression, b: Expression) -> list[ScalarText]:
        u, v = self._named_parts(a), self._named_parts(b)
        pairs = ((1, 2), (2, 0), (0, 1))
        minus = BINDING["-"]
        return [
            (
                f"{_bracketed(u[i], 11)} * {_bracketed(v[j], 12)} - {_bracketed(u[j], 11)} * {_bracketed(v[i], 12)}",
                minus,
            )
            for i, j in pairs
        ]

    def _normalize(self, value: Expression) -> list[ScalarText]:
        parts = self._named_parts(value)
        length2 = _sum_of_products(list(zip(parts, parts, strict=True)))
        scale = self._once((f"1.0f / sqrtf({length2[0]})", BINDING["/"]), "float")
        return [(f"{_bracketed(part, 11)} * {scale[0]}", 11) for part in parts]

    def _transpose(self, value: Expression) -> list[ScalarText]:
        size, parts = int(value.kind[3]), self._parts(value)
        return [parts[size * row + column] for column in range(size) for row in range(size)]

    def _all(self, value: Expression) -> list[ScalarText]:
        return [_joined_part("&&", self._parts(value))]

    def _any(self, value: Expression) -> list[ScalarText]:
        return [_joined_part("||", self._parts(value))]

    def _fetched_parts(self, value: Call) -> list[ScalarText]:
        table, place, _ = value.arguments
        name = getattr(table, "name", "")
        texels = self._texels[name]
        x, y = (
            self._helper("at", part[0], str(most))
            for part, most in zip(self._parts(place), (texels.width, texels.height), strict=True)
        )
        place = f"{y[0]} * {texels.width} + {x[0]}"
        first = self._temporary("int32_t", f"{texels.channels} * ({place})" if texels.channels > 1 else place)
        numbers = (f"{name}[{first}{f' + {channel}' if channel else ''}]" for channel in range(texels.channels))
        # Numbers in 8 bits are multiples of 1/255.
        parts = [(f"{number} / 255.0f", BINDING["/"]) if texels.is_bytes else (number, PRIMARY) for number in numbers]
        return parts + [("0.0f", PRIMARY)] * (4 - texels.channels)

    def _constructed_parts(self, value: Construct) -> list[ScalarText]:
        parts = [(part, scalar_of(a.kind)) for a in value.arguments for part in self._parts(a)]
        if value.kind in MATRICES:
            return [part for part, _ in parts]
        if value.kind in self._structs:
            return [part for part, _ in parts]
        scalar, size = scalar_of(value.kind), size_of(value.kind)
        if len(parts) == 1 < size:
            parts = [(self._once(parts[0][0], parts[0][1]), parts[0][1])] * size
        return [self._cast_part(part, kind, scalar) for part, kind in parts[:size]]

    def _cast_part(self, part: ScalarText, kind: str, scalar: str) -> ScalarText:
        if kind == scalar:
            return part
        if kind == "float" and scalar in WHOLE:
            return self._helper(f"to_{scalar}", part[0])
        return f"({SCALARS[scalar]}){_bracketed(part, UNARY)}", UNARY


# Functions of whole vectors, each a method of its name.
OF_WHOLE = frozenset(words("dot cross normalize length distance reflect transpose all any"))


def _without_comments(statement: Statement) -> Statement:
    return replace(statement, above=[])


def _bracketed(part: ScalarText, least: int) -> str:
    return f"({part[0]})" if part[1] < least else part[0]


def _choice_part(condition: ScalarText, chosen: ScalarText, other: ScalarText) -> ScalarText:
    return f"{_bracketed(condition, CHOICE + 1)} ? {_bracketed(chosen, CHOICE + 1)} : {other[0]}", CHOICE


def _joined_part(mark: str, parts: list[ScalarText]) -> ScalarText:
    level = BINDING[mark]
    return f" {mark} ".join(_bracketed(part, level + 1) for part in parts), level


def _sum_of_products(pairs: list[tuple[ScalarText, ScalarText]]) -> ScalarText:
    return " + ".join(f"{_bracketed(a, 11)} * {_bracketed(b, 12)}" for a, b in pairs), BINDING["+"]
