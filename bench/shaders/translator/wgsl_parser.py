"""A parser of WGSL into a tree: functions without side effects, and constants.

A module may also contain entry points, bindings and functions of pointers. These are left out, and a function that
needs any of them has the reason in place of its body.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from copy import deepcopy
from functools import cache
from itertools import takewhile
from pathlib import Path
from types import MappingProxyType

from .glsl_parser import read_glsl
from .parser import BINDING, SHIFTS, Parser
from .tokens import END, Token, tokens, with_a_point
from .tree import (
    Binary,
    Block,
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
    Member,
    Name,
    Parameter,
    Program,
    Return,
    Statement,
    Struct,
    TranslationError,
    Unary,
    While,
    inside,
    one_error_type,
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
# What declares that which a pipeline sets, and what no encoder has.
SET_FROM_OUTSIDE = frozenset(("var", "override"))
# Where a comment may begin, and what stands in one.
OPENS, CLOSES = frozenset("({["), frozenset(")}]")
# What stands behind the name that a declaration gives.
NAME_ENDS = frozenset(("(", ":", "=", "{", ";"))
DECLARATION_ENDS = frozenset(("}", ";"))
OUTSIDE, INSIDE = re.compile(r"//[^\n]*|/\*"), re.compile(r"/\*|\*/")
OF_A_PIPELINE = re.compile(r"@|ptr|atomic|sampler\w*|texture_\w+")
# What WGSL defines and GLSL does not; no name of WGSL begins with two underscores.
DEFINED = Path(__file__).with_name("wgsl_defined.glsl")
OPERATIONS: Mapping[str, str] = MappingProxyType({"/": "__quotient", "%": "__remainder"})
CONVERSIONS: Mapping[str, str] = MappingProxyType({"int": "__to_int", "uint": "__to_uint"})
# GLSL's operation of whole numbers for one of truth values, neither of which decides whether the other is computed.
TRUTHS = frozenset(("&", "|"))


def read_wgsl(text: str) -> Program:
    """Return the program in a WGSL text. Raises TranslationError."""
    with one_error_type():
        parser = WgslParser(tokens(_with_flat_comments(text)))
    return parser.program()


def _with_flat_comments(text: str) -> str:
    """Return a text without nested comments, which WGSL allows: the marks of inner comments become blanks."""
    depth = position = 0
    flat_text = ""
    while match := (INSIDE if depth else OUTSIDE).search(text, position):
        is_mark = match[0] in ("/*", "*/")
        depth += is_mark * (1 if match[0] == "/*" else -1)
        is_inner = is_mark and depth + (match[0] == "*/") > 1
        flat_text += text[position : match.start()] + ("  " if is_inner else match[0])
        position = match.end()
    return flat_text + text[position:]


@cache
def _defined() -> list[Function]:
    return read_glsl(DEFINED.read_text(encoding="utf-8")).functions


class WgslParser(Parser):
    """WGSL's declarations and statements."""

    def __init__(self, given: Sequence[Token]):
        super().__init__(given)
        self._aliases: dict[str, str] = {}
        self._abstract: set[str] = set()
        # Constants that stand outside of functions: where their declarations begin, and those that are read.
        self._constants: dict[str, int] = {}
        self._types: dict[str, int] = {}
        self._structs: dict[str, Struct] = {}
        self._read: set[str] = set()
        # Why what is declared outside of functions cannot be read, by name.
        self._unread: dict[str, TranslationError] = {}

    def _program(self) -> Program:
        """Read the whole program, with each function after the functions that it calls."""
        declarations = list(self._declarations())
        self._know_all(declarations)
        for declared in declarations:
            self._at = declared.start
            try:
                while self._at < declared.stop:
                    self._global()
            except TranslationError as error:
                self._leave_out(declared, error)
        self._made.functions = [*deepcopy(_defined()), *_callees_first(self._made.functions)]
        self._made.structs = list(self._structs.values())
        return self._made

    def _declarations(self) -> Iterator[range]:
        """Yield the range of token indices of each declaration of the module."""
        depth = begin = 0
        for index, token in enumerate(self._tokens):
            depth += (token.text in OPENS) - (token.text in CLOSES)
            if depth or token.text not in DECLARATION_ENDS:
                continue
            if index > begin or token.text != ";":
                yield range(begin, index + 1)
            begin = index + 1
        if begin < len(self._tokens):
            yield range(begin, len(self._tokens))

    def _known_by(self, declared: range) -> tuple[Token, str]:
        """Return the token that begins a declaration, such as fn, and the declared name; move to that token."""
        self._at = declared.start
        while self._next_token.text == "@":
            self._at += 2
            self._skip_group()
        word = self._next_token
        behind = (i for i in range(self._at, declared.stop) if self._tokens[i].text in NAME_ENDS)
        return word, self._tokens[max(next(behind, declared.stop) - 1, self._at)].text

    def _skip_group(self) -> None:
        """Skip a group in parentheses, if the next token opens one."""
        depth = 0
        while self._next_token is not END:
            depth += (self._next_token.text == "(") - (self._next_token.text == ")")
            if not depth and self._next_token.text != ")":
                return
            self._at += 1

    def _know_all(self, declarations: Sequence[range]) -> None:
        """Declare everything outside functions, because WGSL may use a name before its declaration."""
        known = {declared: self._known_by(declared) for declared in declarations}
        for word, name in known.values():
            if word.text in SET_FROM_OUTSIDE:
                what = f"{name} is set from outside; only the normal and the view-space position are available"
                self._unread[name] = self._error(what, word.place)
        for declared, (word, name) in known.items():
            if word.text == "const":
                self._known_by(declared)
                self._constants[name] = self._at
        self._know_types({name: span for span, (word, name) in known.items() if word.text in ("alias", "struct")})
        for declared, (word, _) in known.items():
            if word.text == "fn" and not self._has_attributes(declared):
                self._know_function(declared)

    def _has_attributes(self, declared: range) -> bool:
        """Whether a declaration begins with an attribute other than @must_use, as an entry point does."""
        self._at = declared.start
        return self._next_token.text == "@" and self._text_ahead(1) != "must_use"

    def _know_function(self, declared: range) -> None:
        _, name = self._known_by(declared)
        begin = self._at
        try:
            self._add(self._signature())
        except TranslationError as error:
            signature = (self._tokens[i].text for i in range(begin, declared.stop))
            if not any(self._is_of_a_pipeline(text) for text in takewhile("{".__ne__, signature)):
                raise
            self._unread[name] = error

    def _is_of_a_pipeline(self, text: str) -> bool:
        return text in self._unread or bool(OF_A_PIPELINE.fullmatch(text))

    def _know_types(self, declared: Mapping[str, range]) -> None:
        """Declare aliases and structures, each after the types that it uses."""
        for name, span in declared.items():
            self._known_by(span)
            self._types[name] = self._at
        for name in declared:
            with suppress(TranslationError):
                self._know_type(name)

    def _know_type(self, name: str) -> None:
        if name not in self._types:
            return
        before, self._at = self._at, self._types.pop(name)
        try:
            self._read_type(name)
        except TranslationError as error:
            self._unread[name] = error
            raise
        self._at = before

    def _read_type(self, name: str) -> None:
        word = self._take().text
        self._take()
        if word == "alias":
            self._take("=")
            self._aliases[name] = self._kind()
        else:
            self._structs[name] = Struct(name, self._fields())
            self._aliases[name] = name

    def _leave_out(self, declared: range, error: TranslationError) -> None:
        """Leave out a declaration that cannot be read; its error is kept and raised where its name is needed. Raises
        the error immediately if the declaration has no end."""
        if self._tokens[declared.stop - 1].text not in DECLARATION_ENDS:
            raise error
        word, name = self._known_by(declared)
        self._scopes[1:], self._depth = [], 0
        if word.text == "fn" and name in self._functions:
            (function,) = self._functions[name]
            function.body, function.unread = [], error
            self._made.functions.append(function)
        else:
            self._unread.setdefault(name, error)

    def _fields(self) -> dict[str, str]:
        self._take("{")
        fields: dict[str, str] = {}
        while not self._skip("}"):
            name = self._word_token().text
            self._take(":")
            fields[name] = self._kind()
            if self._next_token.text != "}":
                self._take(",")
        return fields

    def _global(self) -> None:
        first = self._next_token
        if self._skip("const"):
            self._constant(first)
        elif self._skip(";"):
            pass
        elif first.text == "@" and self._text_ahead(1) == "must_use":
            self._at += 2
        elif self._skip("struct"):
            self._word_token()
            self._fields()
        elif first.text in SKIPPED:
            while self._take().text != ";":
                pass
        elif first.text == "fn":
            self._function(first)
        else:
            raise self._error(f"{first.text}: only functions, constants, structures and aliases are supported")

    def _constant(self, first: Token) -> None:
        if (name := self._next_token.text) not in self._read:
            self._read.add(name)
            self._made.constants.append(self._declared_constant(first))
            return
        while self._take().text != ";":
            pass

    def _name_expression(self, token: Token) -> Expression:
        """Return the expression for a name; a constant outside functions is read when it is first used."""
        if not any(token.text in scope for scope in self._scopes):
            self._read_constant(token)
        return super()._name_expression(token)

    def _read_constant(self, token: Token) -> None:
        """Read the global constant that a name refers to, unless it has been read. Raises TranslationError."""
        if token.text in self._constants and token.text not in self._read:
            before, inner = self._at, self._scopes
            self._at, self._scopes = self._constants[token.text] + 1, self._scopes[:1]
            try:
                self._constant(token)
            except TranslationError as error:
                self._unread[token.text] = error
            self._at, self._scopes = before, inner
        if token.text in self._unread:
            raise self._unread[token.text]

    def _would_hide(self, name: str) -> bool:
        return len(self._scopes) > 1 and (name in self._constants or super()._would_hide(name))

    def _declared_constant(self, first: Token) -> Declare:
        declared = self._declarator(is_constant=True)
        self._take(";")
        self._about(declared, first)
        return declared

    def _signature(self) -> Function:
        self._take("fn")
        name = self._word_token().text
        self._take("(")
        parameters: list[Parameter] = []
        while not self._skip(")"):
            called = self._word_token().text
            self._take(":")
            parameters.append(Parameter(self._kind(), called))
            if self._next_token.text != ")":
                self._take(",")
        return Function(self._kind() if self._skip("->") else "void", name, parameters, [])

    def _function(self, first: Token) -> None:
        read = self._signature()
        (function,) = self._functions[read.name]
        self._scopes.append({})
        for parameter in function.parameters:
            parameter.name = self._declared(parameter.name, parameter.kind)
        function.body = self._block()
        self._scopes.pop()
        function.above = list(first.above)
        self._made.functions.append(function)

    def _kind(self) -> str:
        token = self._word_token()
        if token.text in self._types:
            self._know_type(token.text)
        known = {**KINDS, **self._aliases}
        if token.text in known:
            return known[token.text]
        if token.text in self._unread:
            raise self._unread[token.text]
        if token.text not in GENERIC:
            self._at -= 1
            raise self._error(f"{token.text} is not a type that is known here")
        self._take("<")
        element = self._kind()
        if token.text == "array":
            self._take(",")
            # The mark behind a length is no comparison.
            count = self._binary(BINDING["+"])
            self._skip(",")
            self._take(">")
            return self._array_kind(element, count)
        self._take(">")
        return f"mat{token.text[3]}" if token.text.startswith("mat") else vector(element, int(token.text[3]))

    # Statements.

    def _statement(self) -> list[Statement]:
        first = self._next_token
        if self._skip(";"):
            return []
        if first.text == "{":
            return [Block(self._block())]
        if first.text == "_" and self._text_ahead(1) == "=":
            self._at += 2
            self._expression()
            self._take(";")
            return []
        statement = self._one_statement(first)
        statement.above = [*first.above, *statement.above]
        if not isinstance(statement, If | For | While | Block):
            statement.behind = self._tokens[self._at - 1].behind
        return [statement]

    def _one_statement(self, first: Token) -> Statement:
        if self._skip("if"):
            return self._if()
        if self._skip("for"):
            return self._for()
        if self._skip("while"):
            return While(self._expression(), self._block())
        if self._skip("loop"):
            return self._loop()
        if self._skip("switch"):
            return self._switch()
        statement = self._simple(first)
        self._take(";")
        return statement

    def _simple(self, first: Token) -> Statement:
        """Read a simple statement, without the character that ends it."""
        if first.text in ("break", "continue"):
            return Leave(self._take().text)
        if self._skip("return"):
            return Return(None if self._next_token.text == ";" else self._expression())
        if first.text in ("let", "var", "const"):
            return self._declarator(is_constant=self._take().text == "const")
        return self._assignment()

    def _if(self) -> Statement:
        condition, chosen = self._expression(), self._block()
        if not self._skip("else"):
            return If(condition, chosen, [])
        return If(condition, chosen, [self._if()] if self._skip("if") else self._block())

    def _loop(self) -> Statement:
        """Read loop { BODY continuing { ... break if CONDITION; } }; the continuing part is added to the body."""
        self._take("{")
        self._scopes.append({})
        body: list[Statement] = []
        while not self._skip("}"):
            if self._next_token.text != "continuing":
                body += self._deeper(self._statement)
                continue
            if _leaves(body, "continue"):
                raise self._error("a loop with both continue and continuing is not supported")
            self._take()
            body.append(Block(self._continuing_statements()))
        self._scopes.pop()
        return While(Literal("bool", "true"), body)

    def _continuing_statements(self) -> list[Statement]:
        self._take("{")
        self._scopes.append({})
        statements: list[Statement] = []
        while not self._skip("}"):
            if self._next_token.text == "break" and self._text_ahead(1) == "if":
                self._at += 2
                statements.append(If(self._expression(), [Leave("break")], []))
                self._take(";")
            else:
                statements += self._deeper(self._statement)
        self._scopes.pop()
        return statements

    def _switch(self) -> Statement:
        """Read a switch after its first word, and return it as a block of nested conditionals on a variable."""
        value = self._expression()
        name = self._unused("chosen_by")
        chosen_by = Name(value.kind, name)
        self._take("{")
        cases: list[tuple[Expression | None, list[Statement]]] = []
        while not self._skip("}"):
            cases.append(self._case(chosen_by))
        other: list[Statement] = next((body for condition, body in cases if condition is None), [])
        for condition, body in reversed([branch for branch in cases if branch[0] is not None]):
            assert condition
            other = [If(condition, body, other)]
        return Block([Declare(value.kind, name, value), *other])

    def _case(self, chosen_by: Name) -> tuple[Expression | None, list[Statement]]:
        """Read a case of a switch. Return its condition, which is None for the default, and its body without a final
        break. Raises TranslationError for any other break."""
        condition: Expression | None = None
        is_default = self._skip("default")
        if not is_default:
            self._take("case")
            while self._next_token.text not in ("{", ":"):
                if self._skip("default"):
                    is_default = True
                else:
                    same = self._combined("==", chosen_by, self._expression())
                    condition = Binary("bool", "||", condition, same) if condition else same
                self._skip(",")
        self._skip(":")
        body = self._block()
        if body and body[-1] == Leave("break"):
            body.pop()
        if _leaves(body, "break"):
            raise self._error("break inside a case of a switch is not supported")
        return (None if is_default else condition), body

    def _for(self) -> Statement:
        self._take("(")
        self._scopes.append({})
        start = None if self._next_token.text == ";" else self._simple(self._next_token)
        self._take(";")
        condition = Literal("bool", "true") if self._next_token.text == ";" else self._expression()
        self._take(";")
        step = None if self._next_token.text == ")" else self._assignment()
        self._take(")")
        body = self._block()
        self._scopes.pop()
        return For(start, condition, step, body)

    def _declarator(self, is_constant: bool) -> Declare:
        name = self._word_token().text
        kind = self._kind() if self._skip(":") else None
        value = self._expression() if self._skip("=") else None
        if value is None and kind:
            # WGSL's variables are 0 until they are something else.
            value = self._zero_value(kind)
        if value is None and kind is None:
            raise self._error(f"variable {name} has neither a type nor a value")
        if value is not None and kind and size_of(kind) == 1 and kind in SCALARS.values():
            value = self._converted(value, kind)
        if value is not None and kind and scalar_of(kind) != scalar_of(value.kind):
            value = self._converted(value, scalar_of(kind))
        is_abstract = is_constant and kind is None
        kind = kind or (value.kind if value else "")
        called = self._declared(name, kind)
        if is_abstract:
            self._abstract.add(called)
        return Declare(kind, called, value, is_constant)

    # What expressions are made of.

    def _arguments(self) -> list[Expression]:
        """Read arguments as in GLSL; a comma may follow the last argument."""
        arguments: list[Expression] = []
        while not self._skip(")"):
            arguments.append(self._expression())
            if self._next_token.text != ")":
                self._take(",")
        return arguments

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
            raise self._error(f"unexpected {token.text}")
        if token.text == "bitcast":
            return self._bits()
        is_variable = any(token.text in scope for scope in self._scopes)
        if not is_variable and (token.text in KINDS or token.text in GENERIC or token.text in self._aliases):
            return self._made_of(token)
        if self._skip("("):
            return self._named_call(token, self._arguments())
        return self._name_expression(token)

    def _bits(self) -> Expression:
        self._take("<")
        kind = self._kind()
        self._take(">")
        self._take("(")
        (value,) = self._arguments()
        pair = (scalar_of(value.kind), scalar_of(kind))
        return Call(kind, BITS[pair], [value]) if pair in BITS else Construct(kind, [value])

    def _made_of(self, token: Token) -> Expression:
        """Read a type's constructor. A missing element type is inferred from the arguments."""
        self._at -= 1
        if token.text in GENERIC and self._text_ahead(1) == "(":
            self._at += 2
            values = self._arguments()
            if token.text == "array":
                return self._array_of(values, token)
            values = self._all_alike(values)
            element = scalar_of(values[0].kind)
            size = int(token.text[3])
            kind = f"mat{size}" if token.text.startswith("mat") else vector(element, size)
            return self._constructed(kind, values)
        kind = self._kind()
        self._take("(")
        values = self._arguments()
        if "[" in kind:
            return self._typed_array(kind, values, token)
        if kind in self._structs:
            return Construct(kind, self._field_values(kind, values))
        return self._constructed(kind, values or [Literal("int", "0")])

    def _typed_array(self, kind: str, values: list[Expression], token: Token) -> Expression:
        element, _, length = kind.partition("[")
        if values and len(values) != int(length.rstrip("]")):
            raise self._error(f"an array of {length.rstrip(']')} elements has {len(values)} values", token.place)
        values = [self._converted(value, scalar_of(element)) for value in values]
        return Elements(kind, values or self._zero_elements(kind))

    def _array_of(self, values: list[Expression], token: Token) -> Expression:
        """Return an array of these values, converted to one type. Raises TranslationError if this is impossible."""
        if len({value.kind for value in values}) > 1:
            values = self._all_alike(values)
        kinds = sorted({value.kind for value in values})
        if len(kinds) != 1:
            message = f"array elements must have the same type, not {', '.join(kinds) or 'none'}"
            raise self._error(message, token.place)
        return Elements(self._array_kind(kinds[0], Literal("int", str(len(values)))), values)

    def _array_kind(self, kind: str, length: Expression) -> str:
        """Return the type of an array, as in GLSL. Raises TranslationError for an array of arrays."""
        if "[" in kind:
            raise self._error("arrays of arrays are not supported; use one array and compute the index")
        return super()._array_kind(kind, length)

    def _field_values(self, kind: str, values: list[Expression]) -> list[Expression]:
        kinds = self._structs[kind].kinds.values()
        if not values:
            return [self._zero_value(field_kind) for field_kind in kinds]
        return [v if v.kind == k else self._converted(v, scalar_of(k)) for v, k in zip(values, kinds, strict=True)]

    def _zero_elements(self, kind: str) -> list[Expression]:
        element, _, length = kind.partition("[")
        return [self._zero_value(element) for _ in range(int(length.rstrip("]")))]

    def _zero_value(self, kind: str) -> Expression:
        if kind in self._structs:
            return Construct(kind, self._field_values(kind, []))
        if "[" in kind:
            return Elements(kind, self._zero_elements(kind))
        return self._constructed(kind, [Literal("int", "0")])

    def _constructed(self, kind: str, arguments: list[Expression]) -> Expression:
        """Return a constructor as in GLSL, except that floats beyond an integer's range become its nearest end."""
        scalar, names = scalar_of(kind), CONVERSIONS
        if scalar in names and any(scalar_of(argument.kind) == "float" for argument in arguments):
            arguments = [
                argument if scalar_of(argument.kind) != "float" else self._defined(names[scalar], scalar, [argument])
                for argument in arguments
            ]
        return super()._constructed(kind, arguments)

    def _defined(self, name: str, scalar: str, given: list[Expression]) -> Expression:
        """Return a call of a function in `wgsl_defined.glsl`, with scalar arguments repeated to vectors.

        Args:
            scalar: the type of the result's components."""
        size = max(size_of(argument.kind) for argument in given)
        given = [
            argument if size_of(argument.kind) == size else Construct(vector(argument.kind, size), [argument])
            for argument in given
        ]
        called = f"{name}({','.join(argument.kind for argument in given)})"
        return Call(vector(scalar, size), called, given, is_own=True)

    def _member(self, value: Expression, word: Token) -> Expression:
        if value.kind in self._structs:
            kind = self._structs[value.kind].kinds.get(word.text)
            if kind is None:
                raise self._error(f"{value.kind} has no member {word.text}", word.place)
            return Member(kind, value, word.text)
        return super()._member(value, word)

    def _index_expression(self, value: Expression, index: Expression) -> Expression:
        """Return an element of a value; an index that is not a literal is clamped to the last element."""
        return super()._index_expression(
            value, index if isinstance(index, Literal) else self._clamped_index(value.kind, index)
        )

    def _clamped_index(self, kind: str, index: Expression) -> Expression:
        count = int(kind.partition("[")[2].rstrip("]")) if "[" in kind else int(kind[-1])
        whole = index if index.kind == "uint" else Construct("uint", [index])
        return Call("uint", "min", [whole, Literal("uint", str(count - 1))])

    def _named_call(self, token: Token, arguments: list[Expression]) -> Expression:
        name = token.text
        if name in self._functions:
            return self._called(name, arguments, token.place)
        if name == "select" and len(arguments) == 3:
            other, chosen, condition = arguments
            return self._choice_of(condition, chosen, other)
        if name == "saturate" and len(arguments) == 1:
            return self._called("clamp", [*arguments, ZERO, ONE])
        return self._called(NAMES.get(name, name), arguments, token.place)

    def _converted(self, value: Expression, scalar: str) -> Expression:
        """Return a value with components of another scalar type. Raises TranslationError unless the value already has
        this type, or is a literal or a constant without a type, because WGSL converts nothing else."""
        if scalar_of(value.kind) != scalar and not self._is_abstract(value):
            raise self._error(f"expected {scalar}, not {value.kind}; convert it with {SCALAR_NAMES[scalar]}()")
        return super()._converted(value, scalar)

    def _is_abstract(self, value: Expression) -> bool:
        leaves = [node for node in inside(value) if not isinstance(node, Binary | Unary | Construct)]
        return all(isinstance(n, Literal) or (isinstance(n, Name) and n.name in self._abstract) for n in leaves)

    def _operation(self, mark: str, left: Expression, right: Expression) -> Expression:
        """Return an operation as in GLSL, but with WGSL's defined results for integer division and for shifts."""
        scalar = scalar_of(left.kind)
        if mark in SHIFTS:
            by = right if isinstance(right, Literal) else self._masked_shift(right)
            return self._combined(mark, left, by)
        if mark in TRUTHS and scalar == "bool":
            if size_of(left.kind) == 1:
                return self._combined(mark * 2, left, right)
            whole = vector("uint", size_of(left.kind))
            both = Binary(whole, mark, Construct(whole, [left]), Construct(whole, [right]))
            return Construct(left.kind, [both])
        left, right = self._alike(left, right, sizes_too=False)
        scalar = scalar_of(left.kind)
        if mark == "%" and scalar == "float":
            return self._modulus("trunc", left, right)
        if mark in OPERATIONS and scalar in CONVERSIONS:
            # By a number above 0 both languages divide alike, but for remainders of negative numbers.
            is_plain = _divides(right) and (mark, scalar) != ("%", "int")
            return (
                self._combined(mark, left, right)
                if is_plain
                else self._defined(OPERATIONS[mark], scalar, [left, right])
            )
        return self._combined(mark, left, right)

    def _masked_shift(self, by: Expression) -> Expression:
        whole = by if scalar_of(by.kind) == "uint" else Construct(vector("uint", size_of(by.kind)), [by])
        return self._combined("&", whole, Literal("uint", "31"))


def _divides(value: Expression) -> bool:
    """Whether a divisor is a positive literal."""
    return isinstance(value, Literal) and int(value.text, 0) > 0


def _leaves(body: list[Statement], word: str) -> bool:
    """Whether statements contain this word, "break" or "continue", for the loop around them."""
    for statement in body:
        match statement:
            case Leave(said) if said == word:
                return True
            case If(_, chosen, other) if _leaves(chosen, word) or _leaves(other, word):
                return True
            case Block(inner) if _leaves(inner, word):
                return True
    return False


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
    """Return functions in an order in which each calls only functions before it."""
    by_name, ordered, begun = {f.name: f for f in functions}, [], set()

    def add(function: Function) -> None:
        if function.name in begun:
            return
        begun.add(function.name)
        for node in inside(function.body):
            if isinstance(node, Call) and node.is_own and node.name in by_name:
                add(by_name[node.name])
        ordered.append(function)

    for function in functions:
        add(function)
    return ordered
