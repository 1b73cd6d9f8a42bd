"""WGSL read as a tree: functions without side effects, and constants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from .parser import Parser
from .tokens import END, Token, tokens, with_a_point
from .tree import (
    Binary,
    Call,
    Construct,
    Declare,
    Elements,
    Expression,
    For,
    Function,
    If,
    Leave,
    Literal,
    Name,
    Parameter,
    Program,
    Return,
    Statement,
    Unary,
    While,
    inside,
    scalar_of,
    size_of,
    vector,
)

SCALARS: Mapping[str, str] = MappingProxyType(
    {"f32": "float", "f16": "float", "i32": "int", "u32": "uint", "bool": "bool"}
)
SHORT: Mapping[str, str] = MappingProxyType({"f": "float", "h": "float", "i": "int", "u": "uint"})
KINDS: Mapping[str, str] = MappingProxyType(
    {
        **SCALARS,
        **{f"vec{size}{letter}": vector(scalar, size) for size in (2, 3, 4) for letter, scalar in SHORT.items()},
        **{f"mat{size}x{size}{letter}": f"mat{size}" for size in (2, 3, 4) for letter in "fh"},
    }
)
GENERIC = frozenset((*(f"vec{size}" for size in (2, 3, 4)), *(f"mat{size}x{size}" for size in (2, 3, 4)), "array"))
NAMES: Mapping[str, str] = MappingProxyType({"inverseSqrt": "inversesqrt", "round": "roundEven"})
# From what a word's bits were to what they become.
BITS: Mapping[tuple[str, str], str] = MappingProxyType(
    {
        ("float", "int"): "floatBitsToInt",
        ("float", "uint"): "floatBitsToUint",
        ("int", "float"): "intBitsToFloat",
        ("uint", "float"): "uintBitsToFloat",
    }
)
SCALAR_NAMES = {"float": "f32", "int": "i32", "uint": "u32", "bool": "bool"}
ONE, ZERO = Literal("float", "1.0"), Literal("float", "0.0")
SKIPPED = frozenset(("alias", "enable", "requires", "diagnostic", "const_assert"))


def read_wgsl(text: str) -> Program:
    """A program of WGSL's text. Raises TranslationError."""
    return WgslParser(tokens(text)).program()


class WgslParser(Parser):
    """WGSL's declarations and statements."""

    def __init__(self, given: Sequence[Token]):
        super().__init__(given)
        self._made = Program([], [], [])
        self._aliases: dict[str, str] = {}
        self._abstract: set[str] = set()

    def program(self) -> Program:
        """All of it; functions that call later ones come after these."""
        self._know_all()
        while self._next is not END:
            if not self._skip(";"):
                self._global()
        self._made.functions = _callees_first(self._made.functions)
        return self._made

    def _know_all(self) -> None:
        """Makes every function known by its signature: WGSL calls them before they stand."""
        self._know_aliases()
        for at, token in enumerate(self._tokens):
            if token.text == "fn" and token.kind == "word":
                self._at = at
                self._add(self._signature())
        self._at = 0

    def _know_aliases(self) -> None:
        for at, token in enumerate(self._tokens):
            if token.text == "alias":
                self._at = at + 1
                name = self._word().text
                self._take("=")
                self._aliases[name] = self._kind()

    def _global(self) -> None:
        first = self._next
        if self._skip("const"):
            self._made.constants.append(self._declared_constant(first))
        elif first.text == "@" and self._ahead(1) == "must_use":
            self._at += 2
        elif first.text in SKIPPED:
            while self._take().text != ";":
                pass
        elif first.text == "fn":
            self._function(first)
        else:
            raise self._error(f"{first.text}: only functions, constants and aliases are read")

    def _declared_constant(self, first: Token) -> Declare:
        declared = self._declarator(is_constant=True)
        self._take(";")
        self._about(declared, first)
        return declared

    def _signature(self) -> Function:
        self._take("fn")
        name = self._word().text
        self._take("(")
        parameters: list[Parameter] = []
        while not self._skip(")"):
            called = self._word().text
            self._take(":")
            parameters.append(Parameter(self._kind(), called))
            if self._next.text != ")":
                self._take(",")
        return Function(self._kind() if self._skip("->") else "void", name, parameters, [])

    def _function(self, first: Token) -> None:
        read = self._signature()
        (function,) = self._functions[read.name]
        self._scopes.append({})
        for parameter in function.parameters:
            self._declared(parameter.name, parameter.kind)
        function.body = self._block()
        self._scopes.pop()
        function.above = list(first.above)
        self._made.functions.append(function)

    def _kind(self) -> str:
        token = self._word()
        known = {**KINDS, **self._aliases}
        if token.text in known:
            return known[token.text]
        if token.text not in GENERIC:
            self._at -= 1
            raise self._error(f"{token.text} is not a type that is known here")
        self._take("<")
        element = self._kind()
        if token.text == "array":
            self._take(",")
            count = self._unary()
            self._take(">")
            return f"{element}[{getattr(count, 'text', '?')}]"
        self._take(">")
        return f"mat{token.text[3]}" if token.text.startswith("mat") else vector(element, int(token.text[3]))

    # Statements.

    def _statement(self) -> list[Statement]:
        first = self._next
        if self._skip(";"):
            return []
        if first.text == "{":
            return self._block()
        made = self._one(first)
        made.above = [*first.above, *made.above]
        if not isinstance(made, If | For | While):
            made.behind = self._tokens[self._at - 1].behind
        return [made]

    def _one(self, first: Token) -> Statement:
        if self._skip("if"):
            return self._if()
        if self._skip("for"):
            return self._for()
        if self._skip("while"):
            return While(self._expression(), self._block())
        if self._skip("loop"):
            return While(Literal("bool", "true"), self._block())
        made = self._simple(first)
        self._take(";")
        return made

    def _simple(self, first: Token) -> Statement:
        """A statement of one line, without what ends it."""
        if first.text in ("break", "continue"):
            return Leave(self._take().text)
        if self._skip("return"):
            return Return(None if self._next.text == ";" else self._expression())
        if first.text in ("let", "var", "const"):
            return self._declarator(is_constant=self._take().text == "const")
        return self._assignment()

    def _if(self) -> Statement:
        condition, chosen = self._expression(), self._block()
        if not self._skip("else"):
            return If(condition, chosen, [])
        return If(condition, chosen, [self._if()] if self._skip("if") else self._block())

    def _for(self) -> Statement:
        self._take("(")
        self._scopes.append({})
        start = self._simple(self._next)
        self._take(";")
        condition = self._expression()
        self._take(";")
        step = self._assignment()
        self._take(")")
        body = self._block()
        self._scopes.pop()
        return For(start, condition, step, body)

    def _declarator(self, is_constant: bool) -> Declare:
        name = self._word().text
        kind = self._kind() if self._skip(":") else None
        value = self._expression() if self._skip("=") else None
        if value is None and kind is None:
            raise self._error(f"{name} has neither a type nor a value")
        if value is not None and kind and size_of(kind) == 1 and kind in SCALARS.values():
            value = self._converted(value, kind)
        if value is not None and kind and scalar_of(kind) != scalar_of(value.kind):
            value = self._converted(value, scalar_of(kind))
        if is_constant and kind is None:
            self._abstract.add(name)
        kind = kind or (value.kind if value else "")
        self._declared(name, kind)
        return Declare(kind, name, value, is_constant)

    # What expressions are made of.

    def _primary(self) -> Expression:
        token = self._take()
        if token.kind == "number":
            return _number(token.text)
        if token.text == "(":
            value = self._expression()
            self._take(")")
            return value
        if token.text in ("true", "false"):
            return Literal("bool", token.text)
        if token.kind != "word":
            self._at -= 1
            raise self._error(f"{token.text} is not expected here")
        if token.text == "bitcast":
            return self._bits()
        if token.text in KINDS or token.text in GENERIC or token.text in self._aliases:
            return self._made_of(token)
        if self._skip("("):
            return self._named_call(token, self._arguments())
        return self._named(token)

    def _bits(self) -> Expression:
        self._take("<")
        kind = self._kind()
        self._take(">")
        self._take("(")
        (value,) = self._arguments()
        pair = (scalar_of(value.kind), scalar_of(kind))
        return Call(kind, BITS[pair], [value]) if pair in BITS else Construct(kind, [value])

    def _made_of(self, token: Token) -> Expression:
        """A type's constructor; without its element's type that is what it is given."""
        self._at -= 1
        if token.text in GENERIC and self._ahead(1) == "(":
            self._at += 2
            values = self._all_alike(self._arguments())
            element = scalar_of(values[0].kind)
            if token.text == "array":
                return Elements(f"{element}[{len(values)}]", values)
            size = int(token.text[3])
            kind = f"mat{size}" if token.text.startswith("mat") else vector(element, size)
            return self._constructed(kind, values)
        kind = self._kind()
        self._take("(")
        values = self._arguments()
        if "[" in kind:
            return Elements(kind, [self._converted(value, kind.partition("[")[0]) for value in values])
        return self._constructed(kind, values or [Literal("int", "0")])

    def _named_call(self, token: Token, arguments: list[Expression]) -> Expression:
        name = token.text
        if name in self._functions:
            return self._called(name, arguments, token.place)
        if name == "select" and len(arguments) == 3:
            other, chosen, condition = arguments
            return self._chosen(condition, chosen, other)
        if name == "saturate" and len(arguments) == 1:
            return self._called("clamp", [*arguments, ZERO, ONE])
        return self._called(NAMES.get(name, name), arguments, token.place)

    def _converted(self, value: Expression, scalar: str) -> Expression:
        """WGSL converts nothing but numbers that are written out, and constants without a type."""
        if scalar_of(value.kind) != scalar and not self._is_abstract(value):
            raise self._error(f"{value.kind} where {scalar} is expected; WGSL converts by {SCALAR_NAMES[scalar]}()")
        return super()._converted(value, scalar)

    def _is_abstract(self, value: Expression) -> bool:
        leaves = [node for node in inside(value) if not isinstance(node, Binary | Unary)]
        return all(isinstance(n, Literal) or (isinstance(n, Name) and n.name in self._abstract) for n in leaves)

    def _combined(self, mark: str, left: Expression, right: Expression) -> Expression:
        if mark == "%" and "float" in (scalar_of(left.kind), scalar_of(right.kind)):
            # x - y trunc(x / y)
            quotient = self._combined("/", left, right)
            whole = Call(quotient.kind, "trunc", [quotient])
            return self._combined("-", left, self._combined("*", right, whole))
        return super()._combined(mark, left, right)


def _number(text: str) -> Literal:
    lower = text.lower()
    if lower.startswith("0x"):
        return Literal("uint" if lower.endswith("u") else "int", text.rstrip("uUi"))
    if lower[-1] in "ui":
        return Literal("uint" if lower[-1] == "u" else "int", lower[:-1])
    if lower[-1] in "fh" or any(mark in lower for mark in ".e"):
        return Literal("float", with_a_point(lower.rstrip("fh")))
    return Literal("int", lower)


def _callees_first(functions: list[Function]) -> list[Function]:
    """Functions in an order in which each calls only those before it."""
    by_name, found, begun = {f.name: f for f in functions}, [], set()

    def add(function: Function) -> None:
        if function.name in begun:
            return
        begun.add(function.name)
        for node in inside(function.body):
            if isinstance(node, Call) and node.is_own:
                add(by_name[node.name])
        found.append(function)

    for function in functions:
        add(function)
    return found
