"""A parser of GLSL into a tree: functions without side effects, constants, and tables that are read texel
by texel."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy

from .parser import Parser
from .tokens import END, Preprocessor, Token, suffixed
from .tree import (
    Assign,
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
    TexelTable,
    Unary,
    While,
    one_error_type,
    scalar_of,
    size_of,
)

TYPES = frozenset(
    (
        *("float", "int", "uint", "bool", "mat2", "mat3", "mat4"),
        *(f"{letter}vec{size}" for letter in ("", "i", "u", "b") for size in (2, 3, 4)),
    )
)
PRECISIONS = frozenset(("highp", "mediump", "lowp", "precise"))


def read_glsl(text: str) -> Program:
    """Return the tree of a GLSL text whose includes are already resolved. Raises TranslationError."""
    before = Preprocessor()
    with one_error_type():
        parser = GlslParser(before.tokens(text), before.constants)
    return parser.program()


class GlslParser(Parser):
    """A parser of GLSL's declarations and statements.

    Args:
        given: the tokens.
        constants: the tokens of named numbers, by name.
    """

    def __init__(self, given: Sequence[Token], constants: dict[str, list[Token]]):
        super().__init__(given)
        self._structs: dict[str, Struct] = {}
        for name, words in constants.items():
            value = GlslParser(words, {})._initial()
            self._constant(name, value)

    def _initial(self) -> Expression:
        return self._expression()

    def _constant(self, name: str, value: Expression) -> None:
        self._made.constants.append(Declare(value.kind, name, value, is_constant=True))
        self._declared(name, value.kind)

    def _program(self) -> Program:
        while self._next_token is not END:
            if not self._skip(";"):
                self._global()
        return self._made

    def _global(self) -> None:
        first = self._next_token
        if self._skip("uniform"):
            self._table()
        elif self._skip("precision"):
            self._at += 3
        elif self._skip("struct"):
            self._struct()
        elif self._next_token.text == "const":
            self._constants_of(self._declaration())
        else:
            self._function(first)

    def _constants_of(self, declared: list[Statement]) -> None:
        self._made.constants += [each for each in declared if isinstance(each, Declare)]

    def _table(self) -> None:
        while self._next_token.text in PRECISIONS:
            self._take()
        self._take("sampler2D")
        name = self._word_token().text
        self._take(";")
        self._made.tables.append(TexelTable(name))
        self._declared(name, "sampler2D")

    def _struct(self) -> None:
        name = self._word_token().text
        self._take("{")
        kinds: dict[str, str] = {}
        while not self._skip("}"):
            kind = self._kind()
            kinds[self._word_token().text] = kind
            while self._skip(","):
                kinds[self._word_token().text] = kind
            if self._next_token.text == "[":
                raise self._error("arrays in structures are not supported")
            self._take(";")
        self._take(";")
        self._structs[name] = Struct(name, kinds)
        self._made.structs.append(self._structs[name])

    def _is_type(self, text: str) -> bool:
        return text in TYPES or text in self._structs

    def _kind(self) -> str:
        while self._next_token.text in PRECISIONS:
            self._take()
        token = self._word_token()
        if not self._is_type(token.text) and token.text != "void":
            self._at -= 1
            raise self._error(f"{token.text} is not a type that is known here")
        return token.text

    def _function(self, first: Token) -> None:
        kind, name = self._sized(self._kind()), self._word_token().text
        self._take("(")
        parameters = self._parameters()
        if self._skip(";"):
            return
        function = Function(kind, name, parameters, [])
        self._scopes.append({})
        for parameter in parameters:
            parameter.name = self._declared(parameter.name, parameter.kind)
        function.body = self._block()
        self._scopes.pop()
        self._add(function)
        self._about(function, first)
        function.behind = ""
        self._made.functions.append(function)

    def _parameters(self) -> list[Parameter]:
        parameters: list[Parameter] = []
        while not self._skip(")"):
            words = []
            while self._next_token.text in ("const", "in", "inout", "out"):
                words.append(self._take().text)
            kind = self._sized(self._kind())
            name = "" if self._next_token.text in (",", ")") else self._word_token().text
            is_changed = bool({"inout", "out"} & set(words))
            kind = kind if "[" in kind else self._sized(kind)
            parameters.append(Parameter(kind, name or f"unused{len(parameters)}", is_changed, "out" not in words))
            if self._next_token.text != ")":
                self._take(",")
        return parameters

    def _sized(self, kind: str) -> str:
        """Read a length in brackets, if one follows, and return the type of an array; otherwise return the type
        unchanged."""
        length = self._length()
        return kind if length is None else self._array_kind(kind, length)

    def _array_kind(self, kind: str, length: Expression) -> str:
        if kind in self._structs:
            raise self._error("arrays of structures are not supported")
        return super()._array_kind(kind, length)

    def _length(self) -> Expression | None:
        if not self._skip("["):
            return None
        length = self._expression()
        self._take("]")
        return length

    # Statements.

    def _body(self) -> list[Statement]:
        if self._next_token.text == "{":
            return self._block()
        self._scopes.append({})
        statements = self._deeper(self._statement)
        self._scopes.pop()
        return statements

    def _statement(self) -> list[Statement]:
        first = self._next_token
        if self._skip(";"):
            return []
        if first.text == "{":
            return [Block(self._block())]
        if (self._is_type(first.text) and self._text_ahead(1) != "(") or first.text in ("const", *PRECISIONS):
            statements = self._declaration()
        else:
            statements = [self._simple_statement(first)]
        if statements:
            statements[0].above = [*first.above, *statements[0].above]
            if not isinstance(statements[-1], If | For | While | Block):
                statements[-1].behind = self._tokens[self._at - 1].behind
        return statements

    def _simple_statement(self, first: Token) -> Statement:
        if self._skip("if"):
            return self._if()
        if self._skip("for"):
            return self._for()
        if self._skip("while"):
            self._take("(")
            condition = self._expression()
            self._take(")")
            return While(condition, self._body())
        if self._skip("do"):
            return self._do()
        if first.text in ("break", "continue"):
            return Leave(self._before_semicolon(self._take().text))
        if self._skip("return"):
            return Return(self._before_semicolon(None if self._next_token.text == ";" else self._expression()))
        return self._before_semicolon(self._assignment())

    def _before_semicolon(self, what):
        self._take(";")
        return what

    def _if(self) -> Statement:
        self._take("(")
        condition = self._expression()
        self._take(")")
        chosen = self._body()
        return If(condition, chosen, self._body() if self._skip("else") else [])

    def _for(self) -> Statement:
        self._take("(")
        self._scopes.append({})
        starts = self._starts()
        condition = Literal("bool", "true") if self._next_token.text == ";" else self._expression()
        self._take(";")
        step = None if self._next_token.text == ")" else self._assignment()
        self._take(")")
        body = self._body()
        self._scopes.pop()
        if len(starts) > 1:
            return Block([*starts, For(None, condition, step, body)])
        return For(starts[0] if starts else None, condition, step, body)

    def _starts(self) -> list[Statement]:
        """Read the initialisation in the head of a `for` loop, and return its statements; empty if there are none."""
        if self._skip(";"):
            return []
        if self._is_type(self._next_token.text) or self._next_token.text in ("const", *PRECISIONS):
            return self._declaration()
        return [self._before_semicolon(self._assignment())]

    def _do(self) -> Statement:
        """Read a loop after `do`: BODY while (CONDITION). Return a `while` loop that first skips the condition."""
        is_first = self._unused("is_first")
        body = self._body()
        self._take("while")
        self._take("(")
        condition = self._expression()
        self._take(")")
        self._take(";")
        first = Name("bool", is_first)
        begun = Assign(first, "=", Literal("bool", "false"))
        loop = While(Binary("bool", "||", first, condition), [begun, *body])
        return Block([Declare("bool", is_first, Literal("bool", "true")), loop])

    def _declaration(self) -> list[Statement]:
        """Read a declaration as one statement per name; a constant that equals another constant is an alias of it."""
        is_constant, is_precise = self._skip("const"), self._next_token.text == "precise"
        kind, is_open = self._kind(), self._next_token.text == "[" and self._text_ahead(1) == "]"
        self._at += 2 * is_open
        kind = self._sized(kind)
        declarations = [d for d in [self._declarator(kind, is_constant, is_open)] if d]
        while self._skip(","):
            declarations += [d for d in [self._declarator(kind, is_constant, is_open)] if d]
        self._take(";")
        for declared in declarations:
            if isinstance(declared, Declare):
                declared.is_precise = is_precise
        return declarations

    def _declarator(self, kind: str, is_constant: bool, is_open: bool) -> Statement | None:
        """Read a name and its value in a declaration, and return the declaration; None for an alias of another
        constant.

        Args:
            is_open: whether the name is an array that is as long as its value."""
        name = self._word_token().text
        if self._next_token.text == "[" and self._text_ahead(1) == "]":
            self._at += 2
            is_open = True
        kind = self._sized(kind)
        value = self._expression() if self._skip("=") else None
        if value is None and is_open:
            raise self._error(f"array {name} has neither a length nor a value")
        if is_constant and getattr(value, "name", None) in {each.name for each in self._made.constants}:
            assert value
            self._declared(name, value.kind, value)
            return None
        if value is not None and not is_open and "[" not in kind:
            value = self._converted(value, scalar_of(kind))
        kind = value.kind if value is not None and is_open else kind
        return Declare(kind, self._declared(name, kind), value, is_constant)

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
        if token.text in TYPES and self._skip("["):
            return self._array(token.text)
        if token.text in TYPES:
            self._take("(")
            return self._constructed(token.text, self._arguments())
        if token.text in self._structs and self._skip("("):
            return self._structure(self._structs[token.text], self._arguments())
        if token.kind != "word":
            self._at -= 1
            raise self._error(f"unexpected {token.text}")
        if self._skip("("):
            return self._called(token.text, self._arguments(), token.place)
        return self._name_expression(token)

    def _structure(self, struct: Struct, given: list[Expression]) -> Expression:
        kinds = list(struct.kinds.values())
        if len(given) != len(kinds):
            raise self._error(f"{struct.name} has {len(kinds)} fields, not {len(given)}")
        values = [self._converted(argument, scalar_of(kind)) for argument, kind in zip(given, kinds, strict=True)]
        return Construct(struct.name, values)

    def _choice_of(self, condition: Expression, chosen: Expression, other: Expression) -> Expression:
        """Return a conditional; for structures, a conditional for each field, because not every language can choose
        between structures."""
        if chosen.kind not in self._structs or chosen.kind != other.kind:
            return super()._choice_of(condition, chosen, other)
        pairs = zip(self._field_values(chosen), self._field_values(other), strict=True)
        # Whoever renames what is called meets each call once.
        choices = (self._choice_of(*deepcopy((condition, *pair))) for pair in pairs)
        return Construct(chosen.kind, list(choices))

    def _field_values(self, value: Expression) -> list[Expression]:
        """Return the values of a structure's fields. Raises TranslationError unless the structure is a name or a
        constructor, because any other expression would be computed once per field."""
        whole = value
        while isinstance(whole, Member):
            whole = whole.value
        if isinstance(value, Construct):
            return value.arguments
        if not isinstance(whole, Name):
            raise self._error(f"?: between computed values of {value.kind} is not supported; use if")
        return [Member(kind, value, name) for name, kind in self._structs[value.kind].kinds.items()]

    def _array(self, kind: str) -> Expression:
        if self._next_token.text != "]":
            self._expression()
        self._take("]")
        self._take("(")
        values = [self._converted(value, scalar_of(kind)) for value in self._arguments()]
        return Elements(f"{kind}[{len(values)}]", values)

    def _index_expression(self, value: Expression, index: Expression) -> Expression:
        """Return an element of an array, a vector or a matrix; for an array without a name, one of its values."""
        return (
            self._element_of(value, index) if isinstance(value, Elements) else super()._index_expression(value, index)
        )

    def _element_of(self, array: Elements, index: Expression) -> Expression:
        choice = array.values[-1]
        for number, value in reversed([*enumerate(array.values[:-1])]):
            choice = self._choice_of(Binary("bool", "==", index, Literal(index.kind, str(number))), value, choice)
        return choice

    def _operation(self, mark: str, left: Expression, right: Expression) -> Expression:
        """Return an operation on two values; == and != of vectors return a single Boolean. Raises TranslationError
        for structures."""
        if left.kind in self._structs or right.kind in self._structs:
            raise self._error(f"{left.kind} {mark} {right.kind}: compare structures field by field")
        combined = self._combined(mark, left, right)
        if mark in ("==", "!=") and size_of(combined.kind) > 1:
            return Call("bool", "all" if mark == "==" else "any", [combined])
        return combined

    def _member(self, value: Expression, word: Token) -> Expression:
        if value.kind in self._structs and (kind := self._structs[value.kind].kinds.get(word.text)):
            return Member(kind, value, word.text)
        is_vector = size_of(value.kind) > 1
        if word.text == "length" and (is_vector or value.kind.endswith("]")):
            self._take("(")
            self._take(")")
            return Literal("int", str(size_of(value.kind)) if is_vector else value.kind.partition("[")[2].rstrip("]"))
        return super()._member(value, word)


def _number(text: str) -> Expression:
    """Return the expression for a number's text; a 32-bit whole number whose highest bit is set is negative."""
    kind, plain = suffixed(text)
    if kind == "int" and int(plain, 0) >= 2**31:
        return Unary(kind, "-", Literal(kind, str(2**32 - int(plain, 0))))
    return Literal(kind, plain)
