"""C99, which has no vectors: what a shader says of a vector is said of each of its components."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .builtins import BITS, FETCH
from .parser import BINDING
from .tree import SCALARS as LETTERS
from .tree import (
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
    If,
    Index,
    Literal,
    Name,
    Program,
    Return,
    Statement,
    Swizzle,
    TranslationError,
    Unary,
    While,
    inside,
    scalar_of,
    size_of,
)
from .writer import CHOICE, INDENT, PRIMARY, UNARY, Writer, words

Part = tuple[str, int]
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
STRUCTS = tuple(f"{letter}vec{size}" for letter in LETTERS.values() for size in (2, 3, 4))
SCALARS: Mapping[str, str] = MappingProxyType({"float": "float", "int": "int32_t", "uint": "uint32_t", "bool": "bool"})
FIELDS = "xyzw"
# A part that may stand in several places without being computed twice.
PLAIN = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.")


class CWriter(Writer):
    """C99. Structures and helpers have the program's prefix; tables are in a header of their own."""

    float_suffix = "f"
    has_tables = False
    reserved = words(
        "auto char double enum extern inline long register restrict short signed sizeof static struct switch typedef "
        "union unsigned void volatile half small near far y0 y1 yn j0 j1 jn"
    )

    def __init__(self, prefix: str, sizes: Mapping[str, tuple[int, int]]):
        super().__init__(prefix, sizes)
        self._hoisted: list[str] = []
        self._indent, self._count = INDENT, 0

    # The file.

    def _head(self, program: Program) -> list[str]:
        functions = program.functions
        nodes = [node for f in functions for node in inside(f)]
        kinds = {getattr(node, "kind", "") for node in nodes}
        used = [kind for kind in STRUCTS if kind in kinds]
        includes = ["#include <math.h>", "#include <stdbool.h>", "#include <stdint.h>", "#include <string.h>"]
        includes += [f'#include "{self._prefix}_tables.h"'] if program.tables else []
        contract = "#ifdef __clang__\n#pragma STDC FP_CONTRACT OFF\n#endif"
        calls = {(node.name, scalar_of(node.kind)) for node in nodes if isinstance(node, Call) and not node.is_own}
        return ["\n".join(includes), contract, self._structs(used, "mat3" in kinds), *self._helpers(calls)]

    def _structs(self, kinds: list[str], has_matrix: bool) -> str:
        kinds = ["vec3", *kinds] if has_matrix and "vec3" not in kinds else kinds
        lines = [
            f"typedef struct {{ {SCALARS[scalar_of(kind)]} {', '.join(FIELDS[: size_of(kind)])}; }} {self._kind(kind)};"
            for kind in kinds
        ]
        if has_matrix:
            lines.append(f"typedef struct {{ {self._kind('vec3')} x, y, z; }} {self._kind('mat3')};")
        return "\n".join(lines)

    def _helpers(self, calls: set[tuple[str, str]]) -> list[str]:
        p, found = self._prefix, []
        ordered = (("min", "a < b ? a : b"), ("max", "a > b ? a : b"))
        for scalar, kind in SCALARS.items():
            for name, text in ordered:
                if {(name, scalar), ("clamp", scalar)} & calls:
                    helper = f"{p}_{LETTERS[scalar]}{name}({kind} a, {kind} b)"
                    found.append(f"static inline {kind} {helper} {{ return {text}; }}")
        for name in sorted({name for name, _ in calls} & set(BITS)):
            given = "float" if BITS[name] != "float" else SCALARS["int" if name.startswith("int") else "uint"]
            made = SCALARS[BITS[name]]
            body = f"{made} y; memcpy(&y, &x, sizeof y); return y;"
            found.append(f"static inline {made} {p}_{name}({given} x) {{ {body} }}")
        return ["\n".join(found)] if found else []

    def _kind(self, kind: str) -> str:
        return SCALARS.get(kind) or f"{self._prefix}_{kind}"

    def _global(self, constant: Declare) -> str:
        return f"static const {self._declared(constant)};"

    def _declared(self, declared: Declare) -> str:
        kind, _, count = declared.kind.partition("[")
        value = declared.value
        text = f" = {self._whole(value, is_initial=True)}" if value is not None else ""
        return f"{self._kind(kind)} {self._name(declared.name)}{'[' + count if count else ''}{text}"

    def _signature(self, function: Function) -> str:
        return "static inline " + super()._signature(function)

    # Statements: what they need is said before them.

    def _statement(self, statement: Statement, indent: str) -> str:
        outer, self._hoisted, self._indent = self._hoisted, [], indent
        text = self._one(statement, indent)
        hoisted, self._hoisted = self._hoisted, outer
        above = self._comments(statement, indent)
        return above + "".join(hoisted) + text

    def _one(self, statement: Statement, indent: str) -> str:
        behind = f"  // {statement.behind}" if statement.behind else ""
        match statement:
            case If():
                return self._if(statement, indent)
            case For(start, condition, step, body):
                head = f"for ({self._plain(start)}; {self._text(condition)}; {self._plain(step)})"
                return self._block(head, body, indent)
            case While(condition, body):
                return self._block(f"while ({self._text(condition)})", body, indent)
        return f"{indent}{self._plain(statement)};{behind}\n"

    def _plain(self, statement: Statement) -> str:
        match statement:
            case Assign(target, mark, value) if size_of(target.kind) > 1:
                made = value if mark == "=" else Binary(target.kind, mark[:-1], target, value)
                return f"{self._text(target)} = {self._whole(made)}"
            case Return(value) if value is not None:
                return f"return {self._whole(value)}"
        return super()._plain(statement)

    def _whole(self, value: Expression, is_initial: bool = False) -> str:
        """A value as C has it: a scalar, or a structure."""
        if isinstance(value, Elements):
            return f"{{{self._listed(value)}}}"
        if size_of(value.kind) == 1 and not value.kind.startswith("mat"):
            return self._text(value)
        if isinstance(value, Name) or (isinstance(value, Call) and value.is_own):
            return self._text(value)
        texts = [text for text, _ in self._parts(value)]
        if value.kind == "mat3":
            texts = [f"{{{', '.join(texts[at : at + 3])}}}" for at in (0, 3, 6)]
        parts = ", ".join(texts)
        return f"{{{parts}}}" if is_initial else f"({self._kind(value.kind)}){{{parts}}}"

    # Values: a vector is the list of its components.

    def _written(self, value: Expression) -> Part:
        """A scalar; or a whole vector that has a name."""
        if isinstance(value, Name):
            return self._name(value.name), PRIMARY
        if isinstance(value, Call) and value.is_own:
            given = ", ".join(self._whole(a) for a in value.arguments)
            return f"{value.name}({given})", PRIMARY
        (part,) = self._parts(value)
        return part

    def _parts(self, value: Expression) -> list[Part]:
        match value:
            case Literal():
                return [(self._literal(value), PRIMARY)]
            case Name():
                return self._members(self._name(value.name), value.kind)
            case Unary(_, mark, inner):
                parts = self._parts(inner)
                return [(f"{mark}{_in(part, UNARY + (mark == part[0][:1]))}", UNARY) for part in parts]
            case Binary():
                return self._combination(value)
            case Choice():
                return self._choices(value)
            case Call():
                return self._calls(value)
            case Construct():
                return self._constructs(value)
            case Swizzle(_, inner, names):
                parts = self._parts(inner)
                return [parts[FIELDS.index(name)] for name in names]
            case Index(_, inner, at) if inner.kind.endswith("]"):
                return [(f"{self._text(inner)}[{self._text(at)}]", PRIMARY)]
            case Index(_, Name(_, name), at):
                # The members of a structure of one type lie one after the other.
                return [(f"(&{self._name(name)}.x)[{self._text(at)}]", PRIMARY)]
        raise TranslationError(f"a {type(value).__name__} of {value.kind} cannot be written in C")

    def _members(self, name: str, kind: str) -> list[Part]:
        if kind == "mat3":
            return [(f"{name}.{column}.{row}", PRIMARY) for column in "xyz" for row in "xyz"]
        if size_of(kind) == 1 or kind.endswith("]"):
            return [(name, PRIMARY)]
        return [(f"{name}.{field}", PRIMARY) for field in FIELDS[: size_of(kind)]]

    def _once(self, part: Part, kind: str) -> Part:
        """A scalar that is used several times, computed once."""
        if all(letter in PLAIN for letter in part[0]):
            return part
        self._count += 1
        name = f"t{self._count}"
        self._hoisted.append(f"{self._indent}const {self._kind(kind)} {name} = {part[0]};\n")
        return name, PRIMARY

    def _function(self, function: Function) -> str:
        self._count = 0
        return super()._function(function)

    def _broad(self, value: Expression, size: int) -> list[Part]:
        """A value's components, a scalar as many times."""
        parts = self._parts(value)
        return [self._once(parts[0], scalar_of(value.kind))] * size if len(parts) == 1 < size else parts

    def _combination(self, value: Binary) -> list[Part]:
        if "mat" in value.left.kind or "mat" in value.right.kind:
            return self._product(value)
        size, level = size_of(value.kind), BINDING[value.operator]
        if size == 1:
            left, right = self._operand(value, value.left, level), self._operand(value, value.right, level + 1)
            return [(f"{left} {value.operator} {right}", level)]
        pairs = zip(self._broad(value.left, size), self._broad(value.right, size), strict=True)
        return [(f"{_in(a, level)} {value.operator} {_in(b, level + 1)}", level) for a, b in pairs]

    def _product(self, value: Binary) -> list[Part]:
        """A matrix's columns by a vector from the left, or summed by a vector's components."""
        if value.left.kind == "vec3":
            n, columns = self._named(value.left), self._parts(value.right)
            return [_sum(list(zip(n, columns[at : at + 3], strict=True))) for at in (0, 3, 6)]
        columns, n = self._parts(value.left), self._named(value.right)
        return [_sum([(n[at], columns[3 * at + row]) for at in range(3)]) for row in range(3)]

    def _named(self, value: Expression) -> list[Part]:
        """A vector's components, each computed once."""
        return [self._once(part, scalar_of(value.kind)) for part in self._parts(value)]

    def _choices(self, value: Choice) -> list[Part]:
        size, conditions = size_of(value.kind), self._broad(value.condition, size_of(value.kind))
        conditions = conditions if size > 1 else [(self._text(value.condition, CHOICE + 1), UNARY)]
        parts = zip(conditions, self._parts(value.chosen), self._parts(value.other), strict=True)
        return [(f"{_in(c, CHOICE + 1)} ? {_in(a, CHOICE + 1)} : {b[0]}", CHOICE) for c, a, b in parts]

    def _calls(self, value: Call) -> list[Part]:
        if value.is_own:
            text = self._written(value)[0]
            return [(text, PRIMARY)] if value.kind in SCALARS else self._made(text, value.kind)
        if value.name == FETCH:
            return self._fetched(value)
        of_vectors = (
            getattr(self, f"_{value.name}", None) if value.name in ("dot", "cross", "normalize", "length") else None
        )
        if of_vectors:
            return of_vectors(*value.arguments)
        size = size_of(value.kind)
        given = [self._broad(a, size) for a in value.arguments]
        if value.name in FORMULAS:
            once = ([self._once(part, "float")[0] for part in parts] for parts in zip(*given, strict=True))
            return [(FORMULAS[value.name].format(*parts), CHOICE) for parts in once]
        if value.name == "inversesqrt":
            return [(f"1.0f / sqrtf({x})", BINDING["/"]) for ((x, _),) in zip(*given, strict=True)]
        return [
            (self._scalar_call(value.name, scalar_of(value.kind), parts), PRIMARY) for parts in zip(*given, strict=True)
        ]

    def _made(self, text: str, kind: str) -> list[Part]:
        """A structure under a name, as its components."""
        self._count += 1
        name = f"t{self._count}"
        self._hoisted.append(f"{self._indent}const {self._kind(kind)} {name} = {text};\n")
        return self._members(name, kind)

    def _scalar_call(self, name: str, scalar: str, parts: tuple[Part, ...]) -> str:
        texts, p = [text for text, _ in parts], self._prefix
        sign = LETTERS[scalar]
        if name == "clamp":
            return f"{p}_{sign}min({p}_{sign}max({texts[0]}, {texts[1]}), {texts[2]})"
        if name in ("min", "max"):
            return f"{p}_{sign}{name}({', '.join(texts)})"
        if name in BITS:
            return f"{p}_{name}({texts[0]})"
        if name not in FUNCTIONS:
            raise TranslationError(f"{name} cannot be written in C")
        return f"{FUNCTIONS[name]}({', '.join(texts)})"

    def _dot(self, a: Expression, b: Expression) -> list[Part]:
        return [_sum(list(zip(self._named(a), self._named(b), strict=True)))]

    def _length(self, value: Expression) -> list[Part]:
        return [(f"sqrtf({self._dot(value, value)[0][0]})", PRIMARY)]

    def _cross(self, a: Expression, b: Expression) -> list[Part]:
        u, v = self._named(a), self._named(b)
        pairs = ((1, 2), (2, 0), (0, 1))
        minus = BINDING["-"]
        return [(f"{_in(u[i], 11)} * {_in(v[j], 12)} - {_in(u[j], 11)} * {_in(v[i], 12)}", minus) for i, j in pairs]

    def _normalize(self, value: Expression) -> list[Part]:
        parts = self._named(value)
        length2 = _sum(list(zip(parts, parts, strict=True)))
        scale = self._once((f"1.0f / sqrtf({length2[0]})", BINDING["/"]), "float")
        return [(f"{_in(part, 11)} * {scale[0]}", 11) for part in parts]

    def _fetched(self, value: Call) -> list[Part]:
        table, place, _ = value.arguments
        x, y = self._named(place)
        name = getattr(table, "name", "")
        width, channels = self._sizes[name]
        first = f"{channels} * ({_in(y, 11)} * {width} + {_in(x, 11)})"
        parts = [(f"{name}[{first}{f' + {channel}' if channel else ''}]", PRIMARY) for channel in range(channels)]
        return parts + [("0.0f", PRIMARY)] * (4 - channels)

    def _constructs(self, value: Construct) -> list[Part]:
        parts = [(part, scalar_of(a.kind)) for a in value.arguments for part in self._parts(a)]
        if value.kind == "mat3":
            return [part for part, _ in parts]
        scalar, size = scalar_of(value.kind), size_of(value.kind)
        if len(parts) == 1 < size:
            parts = [(self._once(parts[0][0], parts[0][1]), parts[0][1])] * size
        return [_cast(part, SCALARS[scalar]) if kind != scalar else part for part, kind in parts[:size]]


def _in(part: Part, least: int) -> str:
    return f"({part[0]})" if part[1] < least else part[0]


def _cast(part: Part, kind: str) -> Part:
    return f"({kind}){_in(part, UNARY)}", UNARY


def _sum(pairs: list[tuple[Part, Part]]) -> Part:
    return " + ".join(f"{_in(a, 11)} * {_in(b, 12)}" for a, b in pairs), BINDING["+"]
