"""A writer of a program's text in C-like languages. For GLSL, no names are replaced."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from .builtins import BITS, FETCH, LIKE_GIVEN, OF_VECTORS
from .parser import BINDING, COMPARISONS, SHIFTS
from .texels import Texels
from .tokens import with_a_point
from .tree import (
    Assign,
    Binary,
    Block,
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
    Leave,
    Literal,
    Member,
    Name,
    Perform,
    Program,
    Return,
    Statement,
    Struct,
    Swizzle,
    TexelTable,
    TranslationError,
    Unary,
    While,
    inside,
    one_error_type,
    scalar_of,
    size_of,
)

# What others call of a codec's program, each behind the program's prefix.
PUBLIC = ("encode", "decode", "pack", "unpack", "to_target", "from_target")
INDENT = "    "
# Whole numbers below this are written with all their digits.
MOST_DIGITS = 2**24
FIELDS = "xyzw"
# Of an array, in a line.
ELEMENTS = 6
# How tightly what is not a binary operation binds.
CHOICE, UNARY, PRIMARY = 0, 12, 13
BITWISE = SHIFTS | {"&", "|", "^"}
# Functions that GLSL lets mix vectors and scalars.
MIXING = frozenset(("min", "max", "clamp", "mix", "step", "smoothstep"))
MIXED = BITWISE | {"&&", "||", "^^"}
# What a program calls, or may call once it is written: a variable of such a name would hide it.
BUILTINS = frozenset((*LIKE_GIVEN, *OF_VECTORS, *BITS, *COMPARISONS, FETCH, "cross", "any", "all", "not", "transpose"))


class Writer:
    """A writer of a program's text. Subclasses define how their languages differ.

    Args:
        prefix: the prefix of the program's names.
        texels: the contents of each table, by its name.
        stem: the prefix of the names of files next to the program's; `prefix` if it is empty.

    Attributes:
        head: the text before everything else.
        binding_advice: a sentence on how to bind a table.
        has_tables: whether tables are variables of the program.
        splats: whether vector functions need vectors in place of scalar arguments.
        has_rich_parameters: whether functions can take and return arrays, and change their arguments.
        assigns_to_parts: whether several components of a vector can be assigned to at once.
        has_precise: whether a variable can be declared to be computed as it is written.
        has_templates: whether `a < b, c > (d)` may be read as a template and a call.
        kinds: the type names that differ from GLSL's.
        functions: the names of built-in functions that differ from GLSL's.
        reserved: words that cannot be names of variables.
    """

    kinds: Mapping[str, str] = {}
    functions: Mapping[str, str] = {}
    reserved: frozenset[str] = frozenset()
    float_suffix = ""
    has_precise = False
    has_templates = False
    head = ""
    binding_advice = "Change the binding to yours."
    has_tables = True
    splats = False
    has_rich_parameters = False
    assigns_to_parts = True

    def __init__(self, prefix: str, texels: Mapping[str, Texels], stem: str = ""):
        self._prefix, self._texels, self._stem = prefix, texels, stem or prefix
        # Tables that are declared already.
        self._bindings = 0
        self._renamed: dict[str, str] = {}
        self._assigned: set[str] = set()
        # Names that no variable of a function may have, and all that it has.
        self._taken: set[str] = set()
        self._used: set[str] = set()
        self._structs: dict[str, Struct] = {}

    def program(self, program: Program) -> str:
        """Return the text of the whole program. Raises TranslationError."""
        everything = [*program.constants, *program.tables, *program.functions]
        self._taken = {definition.name for definition in everything} | self.reserved | BUILTINS
        self._taken |= {*self.kinds.values(), *self.functions.values(), *(struct.name for struct in program.structs)}
        self._structs = {struct.name: struct for struct in program.structs}
        with one_error_type():
            return self._program(program)

    def _program(self, program: Program) -> str:
        parts = [*self._head_parts(program), *map(self._struct, program.structs)]
        if self.has_tables:
            parts += map(self._table, sorted(program.tables, key=lambda table: table.name))
        if program.constants:
            parts.append("\n".join(self._constant(each) for each in program.constants))
        parts += [self._function(each) for each in program.functions]
        return "\n\n".join(parts) + "\n"

    def _head_parts(self, program: Program) -> list[str]:  # noqa: ARG002 (C's depends on it)
        return [self.head] if self.head else []

    def _struct(self, struct: Struct) -> str:
        fields = "".join(f"{INDENT}{self._kind(kind)} {name};\n" for name, kind in self._fields(struct).items())
        return f"struct {struct.name} {{\n{fields}}};"

    def _fields(self, struct: Struct) -> dict[str, str]:
        """Return the types of a structure's fields, by the fields' names in the language."""
        return {self._field(name): kind for name, kind in struct.kinds.items()}

    def _field(self, name: str) -> str:
        """Return a field's name, with an underscore appended if it is a reserved word of the language."""
        return f"{name}_" if name in self.reserved else name

    def _table(self, table: TexelTable) -> str:
        """Return a table's declaration, after a note on its texture. Tables are bound in the order of their names."""
        declared = self._declared_table(table, self._bindings)
        self._bindings += 1
        return self._table_note(table.name) + declared

    def _declared_table(self, table: TexelTable, binding: int) -> str:
        return f"layout(binding = {binding}) uniform sampler2D {table.name};"

    def _table_note(self, name: str) -> str:
        """Return comments on a texture's contents; empty for an unknown table."""
        if name not in self._texels:
            return ""
        texels, file = self._texels[name], f"{self._stem}_{name.removeprefix(f'{self._prefix}_')}.dds"
        size = f"{texels.width} x {texels.height} texels, {texels.format}, one mip level, from {file}"
        return f"// {size}.\n// Read texel by texel, without a sampler or a filter. {self.binding_advice}\n"

    def _constant(self, constant: Declare) -> str:
        return self._comments(constant, "") + self._global_text(constant)

    def _global_text(self, constant: Declare) -> str:
        return f"const {self._declaration_text(constant)};"

    # Functions and statements.

    def _function(self, function: Function) -> str:
        self._assigned = {base_of(node) for node in inside(function.body) if isinstance(node, Assign)}
        if not self.has_rich_parameters:
            self._check_parameters(function)
        local = [node.name for node in inside(function.body) if isinstance(node, Declare)]
        own = [*local, *(p.name for p in function.parameters)]
        self._used = {*own, *self._taken}
        self._renamed = {}
        for name in (name for name in dict.fromkeys(own) if name in self._taken):
            self._renamed[name] = self._unused(f"{name}_")
        body = self._body(function)
        return self._comments(function, "") + self._definition_text(self._signature(function), body)

    def _definition_text(self, signature: str, body: str) -> str:
        return f"{signature} {{\n{body}}}"

    def _body(self, function: Function) -> str:
        return self._statements(function.body, INDENT)

    def _global_name(self, name: str) -> str:
        """Return a new name with the program's prefix, for a definition of the writer's, and mark it as taken."""
        own_name = f"{self._prefix}_{name}"
        while own_name in self._taken:
            own_name += "_"
        self._taken.add(own_name)
        return own_name

    def _unused(self, name: str) -> str:
        """Return this name, with a number appended if the function already uses it, and mark it as used."""
        ways = (name, *(f"{name.rstrip('_')}_{number}" for number in range(2, len(self._used) + 3)))
        unused_name = next(way for way in ways if way not in self._used)
        self._used.add(unused_name)
        return unused_name

    def _check_parameters(self, function: Function) -> None:
        """Raise TranslationError for arrays as parameters or results, and for arguments that a function changes."""
        if any(kind.endswith("]") for kind in (function.kind, *(p.kind for p in function.parameters))):
            raise TranslationError(f"{function.name} has an array as a parameter or a result; use separate numbers")
        if any(p.is_changed for p in function.parameters):
            raise TranslationError(f"{function.name} changes its argument; return the result instead")

    def _signature(self, function: Function) -> str:
        parameters = ", ".join(f"{self._kind(p.kind)} {self._name(p.name)}" for p in function.parameters)
        return f"{self._kind(function.kind)} {function.name}({parameters})"

    def _comments(self, statement: Statement, indent: str) -> str:
        return "".join(f"{indent}// {line}\n" for line in statement.above)

    def _statements(self, statements: list[Statement], indent: str) -> str:
        return "".join(self._statement(self._plainer(each), indent) for each in statements)

    def _plainer(self, statement: Statement) -> Statement:
        """Return a statement, rewritten if the language cannot assign to several components at once."""
        if self.assigns_to_parts:
            return statement
        match statement:
            case Assign(Swizzle(kind, _, names) as target, mark, value) if len(names) > 1:
                return self._part_by_part(statement, target, value if mark == "=" else _applied(kind, statement))
            case For(_, _, Assign(Swizzle(_, _, names)), _) if len(names) > 1:
                return self._loop_without_head(statement)
        return statement

    def _part_by_part(self, statement: Assign, target: Swizzle, value: Expression) -> Statement:
        """Return `n.xy = VALUE` as a block with a variable, because VALUE may read the components that it changes."""
        name, scalar = self._unused("parts"), scalar_of(target.kind)
        parts: list[Statement] = [Declare(target.kind, name, value)]
        for to, field in zip(target.fields, FIELDS, strict=False):
            component = Swizzle(scalar, Name(target.kind, name), field)
            parts.append(Assign(Swizzle(scalar, target.value, to), "=", component))
        return Block(parts, above=statement.above, behind=statement.behind)

    def _loop_without_head(self, loop: For) -> Statement:
        """Return a `for` loop as an endless loop in a block, for a condition or a step that is more than an
        expression; `continue` proceeds to the step."""
        name = self._unused("is_first")
        first = Name("bool", name)
        self._assigned.add(name)
        step = [If(first, [Assign(first, "=", Literal("bool", "false"))], [loop.step])] if loop.step else []
        ends = If(Unary("bool", "!", loop.condition), [Leave("break")], [])
        body = While(Literal("bool", "true"), [*step, ends, *loop.body])
        begin = [loop.start] if loop.start else []
        flag = [Declare("bool", name, Literal("bool", "true"))] if step else []
        return Block([*begin, *flag, body], above=loop.above)

    def _statement(self, statement: Statement, indent: str) -> str:
        behind = f"  // {statement.behind}" if statement.behind else ""
        above = self._comments(statement, indent)
        match statement:
            case If():
                return above + self._if(statement, indent)
            case For(start, condition, step, body):
                ends = [self._simple_text(end) if end else "" for end in (start, step)]
                return above + self._block(f"for ({ends[0]}; {self._text(condition)}; {ends[1]})", body, indent)
            case Block(body):
                return above + self._block("", body, indent)
            case While():
                return above + self._block(f"while ({self._text(statement.condition)})", statement.body, indent)
        return f"{above}{indent}{self._simple_text(statement)};{behind}\n"

    def _block(self, head: str, body: list[Statement], indent: str) -> str:
        return f"{indent}{head}{' ' * bool(head)}{{\n{self._statements(body, indent + INDENT)}{indent}}}\n"

    def _if(self, statement: If, indent: str) -> str:
        text = self._block(f"if ({self._text(statement.condition)})", statement.chosen, indent)
        if not statement.other:
            return text
        return text.rstrip("\n") + self._block(" else", statement.other, indent).removeprefix(indent)

    def _simple_text(self, statement: Statement) -> str:
        """Return the text of a simple statement, without the semicolon."""
        match statement:
            case Declare():
                return self._local_text(statement)
            case Assign(target, mark, Literal(text="1")) if mark in ("+=", "-="):
                return self._count_text(target, mark)
            case Assign(target, mark, value):
                return f"{self._text(target)} {mark} {self._text(value)}"
            case Perform(call):
                return self._text(call)
            case Leave(word):
                return word
            case Return(None):
                return "return"
            case Return(value):
                return f"return {self._text(value)}" if value else "return"
        raise TranslationError(f"a {type(statement).__name__} cannot be written")

    def _count_text(self, target: Expression, mark: str) -> str:
        return f"{mark[0] * 2}{self._text(target)}"

    def _local_text(self, declared: Declare) -> str:
        precise = "precise " if declared.is_precise and self.has_precise else ""
        return precise + ("const " if declared.is_constant else "") + self._declaration_text(declared)

    def _declaration_text(self, declared: Declare) -> str:
        kind, _, count = declared.kind.partition("[")
        array = f"[{count}" if count else ""
        value = f" = {self._text(declared.value)}" if declared.value is not None else ""
        return f"{self._kind(kind)} {self._name(declared.name)}{array}{value}"

    # Expressions.

    def _kind(self, kind: str) -> str:
        return self.kinds.get(kind, kind)

    def _name(self, name: str) -> str:
        return self._renamed.get(name, name)

    def _text(self, value: Expression, least: int = 0) -> str:
        """Return the text of a value, in parentheses if the expression around it binds more tightly."""
        text, level = self._text_and_level(value)
        return f"({text})" if level < least else text

    def _text_and_level(self, value: Expression) -> tuple[str, int]:
        match value:
            case Literal():
                return self._literal(value), PRIMARY
            case Name(_, name):
                return self._name(name), PRIMARY
            case Unary(_, mark, inner):
                return mark + self._text(inner, UNARY + (isinstance(inner, Unary))), UNARY
            case Binary():
                return self._binary_and_level(value)
            case Choice():
                return self._choice_and_level(value)
            case Call():
                return self._call(value), PRIMARY
            case Construct():
                return self._construct(value), PRIMARY
            case Swizzle(_, inner, names):
                return f"{self._text(inner, PRIMARY)}.{names}", PRIMARY
            case Index(_, inner, at):
                return f"{self._text(inner, PRIMARY)}[{self._text(at)}]", PRIMARY
            case Member(_, inner, name):
                return f"{self._text(inner, PRIMARY)}.{self._field(name)}", PRIMARY
            case Elements():
                return self._elements(value), PRIMARY
        raise TranslationError(f"a {type(value).__name__} cannot be written")

    def _literal(self, value: Literal) -> str:
        if value.kind == "float":
            return shortest(value.text) + self.float_suffix
        return value.text + ("u" if value.kind == "uint" else "")

    def _binary_and_level(self, value: Binary) -> tuple[str, int]:
        level = BINDING[value.operator]
        left, right = self._operand(value, value.left, level), self._operand(value, value.right, level + 1)
        return f"{left} {value.operator} {right}", level

    def _operand(self, parent: Binary, child: Expression, least: int) -> str:
        return self._text(child, least_of(parent, child, least))

    def _choice_and_level(self, value: Choice) -> tuple[str, int]:
        condition, chosen = self._text(value.condition, CHOICE + 1), self._text(value.chosen, CHOICE + 1)
        return f"{condition} ? {chosen} : {self._text(value.other)}", CHOICE

    def _call(self, value: Call) -> str:
        if value.name == FETCH and not value.is_own:
            return self._fetch(value)
        if self.splats and value.name in MIXING and not value.is_own:
            value = Call(value.kind, value.name, [_splat(a, value.kind) for a in value.arguments])
        name = value.name if value.is_own else self.functions.get(value.name, value.name)
        return f"{name}({self._arguments(value.arguments)})"

    def _arguments(self, values: Sequence[Expression]) -> str:
        """Return the text of a call's arguments. A comparison `a < b` before other arguments is put in parentheses if
        `f(a < b, c > (d))` may be read as a template and a call."""
        return ", ".join([*map(self._argument_text, values[:-1]), *map(self._text, values[-1:])])

    def _argument_text(self, value: Expression) -> str:
        return self._text(value, UNARY if self.has_templates and is_less(value) else 0)

    def _fetch(self, value: Call) -> str:
        return f"texelFetch({', '.join(map(self._text, value.arguments))})"

    def _construct(self, value: Construct) -> str:
        return f"{self._kind(value.kind)}({self._arguments(value.arguments)})"

    def _elements(self, value: Elements) -> str:
        kind, _, count = value.kind.partition("[")
        return f"{self._kind(kind)}[{count}({self._listed(value)})"

    def _listed(self, value: Elements) -> str:
        """Return the text of an array's elements, separated by commas; on several lines if there are many."""
        return self._rows_text(list(map(self._text, value.values)))

    def _rows_text(self, texts: list[str]) -> str:
        if len(texts) <= ELEMENTS:
            return ", ".join(texts)
        rows = (", ".join(texts[start : start + ELEMENTS]) for start in range(0, len(texts), ELEMENTS))
        return "\n" + ",\n".join(INDENT + row for row in rows)


def _applied(kind: str, assigned: Assign) -> Expression:
    """Return the value that `x OPERATOR= VALUE` assigns, as an operation of this type."""
    return Binary(kind, assigned.operator[:-1], assigned.target, assigned.value)


def _splat(value: Expression, kind: str) -> Expression:
    """Return a scalar expression as the constructor of a vector type, and a vector expression unchanged."""
    return value if size_of(value.kind) == size_of(kind) else Construct(kind, [value])


def least_of(parent: Binary, child: Expression, least: int) -> int:
    """Return how tightly an operand must bind to need no parentheses: `least`, or UNARY if bitwise or logical
    operators are mixed, because readers and some languages expect parentheses there."""
    is_mixed = isinstance(child, Binary) and child.operator != parent.operator and _is_unclear(parent, child)
    return UNARY if is_mixed else least


def _is_unclear(parent: Binary, child: Binary) -> bool:
    """Whether languages or readers differ in which of two operations binds more tightly."""
    compares = parent.operator in ("&&", "||") and child.operator not in MIXED
    return (parent.operator in MIXED or child.operator in MIXED) and not compares


def is_less(value: Expression) -> bool:
    """Whether a value is a `<` comparison, whose text can look like the start of a template."""
    return isinstance(value, Binary) and value.operator == "<"


def words(text: str) -> frozenset[str]:
    """Return the set of words in a text, which are separated by white space."""
    return frozenset(text.split())


def base_of(assigned: Assign) -> str:
    """Return the name of the variable that an assignment changes, wholly or in part; empty if it changes none."""
    target = assigned.target
    while isinstance(target, Swizzle | Index | Member):
        target = target.value
    return target.name if isinstance(target, Name) else ""


def shortest(text: str) -> str:
    """Return the shortest text of the same 32-bit float as a number's text; the given text if that is not finite."""
    # Here, because reading a user's file needs no arrays.
    import numpy as np

    number = np.float32(text)
    if number.is_integer() and abs(number) < MOST_DIGITS:
        return with_a_point(f"{number:.0f}")
    return with_a_point(str(number)) if np.isfinite(number) else text


def commented(lines: Iterable[str], mark: str = "//") -> str:
    """Return lines as a text of comments, each line with the mark before it and a newline after it."""
    return "".join(f"{mark} {line}".rstrip() + "\n" for line in lines)


def identifier(name: str) -> str:
    """Return a name as a lower-case identifier for every language: ASCII letters, digits and single underscores, with
    an n before a leading digit."""
    plain = re.sub(r"_+", "_", re.sub(r"\W", "_", name, flags=re.ASCII)).strip("_").lower()
    return f"n{plain}" if plain[:1].isdigit() else plain
