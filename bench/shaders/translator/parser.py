"""The common part of parsers of C-like languages: a sequence of tokens, scopes, and expressions with their types."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import count
from types import MappingProxyType

from .builtins import FETCH, OF_FLOATS, result_of
from .tokens import END, Token, with_a_point
from .tree import (
    Assign,
    Binary,
    Call,
    Choice,
    Construct,
    Expression,
    Function,
    Index,
    Literal,
    Name,
    Parameter,
    Perform,
    Place,
    Program,
    Return,
    Statement,
    Swizzle,
    TranslationError,
    Unary,
    one_error_type,
    scalar_of,
    size_of,
    vector,
)

# How tightly operators bind, from loosest to tightest.
BINDING: Mapping[str, int] = MappingProxyType(
    {
        mark: level
        for level, marks in enumerate(
            ("||", "^^", "&&", "|", "^", "&", "== !=", "< > <= >=", "<< >>", "+ -", "* / %"), 1
        )
        for mark in marks.split()
    }
)
COMPARES = frozenset(("==", "!=", "<", ">", "<=", ">="))
LOGICAL = frozenset(("&&", "||", "^^"))
SHIFTS = frozenset(("<<", ">>"))
ASSIGNS = frozenset(("=", "+=", "-=", "*=", "/=", "%=", "|=", "&=", "^=", "<<=", ">>="))
# Of whole numbers that are written out, such as an array's length less one.
FOLDED: Mapping[str, Callable[[int, int], int]] = MappingProxyType(
    {"+": operator.add, "-": operator.sub, "*": operator.mul}
)
# GLSL's functions for comparisons of vectors.
COMPARISONS: Mapping[str, str] = MappingProxyType(
    {
        "lessThan": "<",
        "lessThanEqual": "<=",
        "greaterThan": ">",
        "greaterThanEqual": ">=",
        "equal": "==",
        "notEqual": "!=",
    }
)
# What angles are multiplied by, which not every language has a function for.
ANGLES: Mapping[str, str] = MappingProxyType({"radians": "0.017453292519943295", "degrees": "57.29577951308232"})
# How deep expressions and statements may be nested: far from what Python recurses.
MOST_DEPTH = 60
# Of a sum, a product and so on.
MOST_TERMS = 1000
# The largest power of two that a float of 32 bits has, less one.
MOST_FOLDED = 126
FIELDS = ("xyzw", "rgba", "stpq")


class Parser:
    """The base class of parsers, with tokens, scopes and expressions.

    Args:
        given: the tokens.
    """

    def __init__(self, given: Sequence[Token]):
        self._tokens, self._at, self._depth = given, 0, 0
        self._scopes: list[dict[str, Expression]] = [{}]
        self._functions: dict[str, list[Function]] = {}
        self._made = Program([], [], [])
        # Those that the program does not have itself.
        self._made_functions: dict[str, Function] = {}
        # No name that is made is one of these.
        self._words = {token.text for token in given if token.kind == "word"}

    def program(self) -> Program:
        """Return the tree of the whole text. Raises TranslationError."""
        with one_error_type(self._error):
            program = self._program()
        program.functions[:0] = self._made_functions.values()
        return program

    def _program(self) -> Program:
        raise NotImplementedError

    # Tokens.

    @property
    def _next_token(self) -> Token:
        return self._tokens[self._at] if self._at < len(self._tokens) else END

    def _text_ahead(self, count: int) -> str:
        index = self._at + count
        return self._tokens[index].text if index < len(self._tokens) else ""

    def _take(self, *texts: str) -> Token:
        """Take and return the next token. Raises TranslationError at the end, or if texts are given and the token has
        none of them."""
        token = self._next_token
        if (texts and token.text not in texts) or token is END:
            raise self._error(f"expected {' or '.join(texts) or 'more'}, not {token.text}")
        self._at += 1
        return token

    def _skip(self, text: str) -> bool:
        """Take the next token if it has this text, and return whether it was taken."""
        if self._next_token.text != text or self._next_token is END:
            return False
        self._at += 1
        return True

    def _word_token(self) -> Token:
        if self._next_token.kind != "word":
            raise self._error(f"expected a name, not {self._next_token.text}")
        return self._take()

    def _error(self, what: str, place: Place | None = None) -> TranslationError:
        last = self._tokens[-1].place if self._tokens else END.place
        place = place or (last if self._next_token is END else self._next_token.place)
        return TranslationError(f"{place.line}:{place.column}: {what}")

    def _deeper(self, read: Callable):
        """Call `read` one level deeper, and return its result. Raises TranslationError if that is too deep."""
        self._depth += 1
        if self._depth > MOST_DEPTH:
            raise self._error(f"nested more than {MOST_DEPTH} levels deep")
        try:
            return read()
        finally:
            self._depth -= 1

    # Names.

    def _name_expression(self, token: Token) -> Expression:
        for scope in reversed(self._scopes):
            if token.text in scope:
                return replace(scope[token.text])
        self._at -= 1
        raise self._error(f"unknown name {token.text}")

    def _declared(self, name: str, kind: str, stands_for: Expression | None = None) -> str:
        """Declare a name in the innermost scope, and return its name in the tree.

        A name that would hide another name in the program gets a new name. Names in the tree therefore never hide
        each other, and code that writes the tree or renames parts of it needs no scopes.
        """
        called = self._unused(name) if stands_for is None and self._would_hide(name) else name
        self._scopes[-1][name] = stands_for or Name(kind, called)
        return called

    def _would_hide(self, name: str) -> bool:
        """Whether a name already belongs to a function, or to a scope around the innermost scope."""
        return name in self._functions or any(name in scope for scope in self._scopes[:-1])

    def _unused(self, name: str) -> str:
        """Return a name like this one that the program does not use, such as NAME_2, and mark it as used."""
        plain = name.rstrip("_")
        free_name = next(candidate for number in count(2) if (candidate := f"{plain}_{number}") not in self._words)
        self._words.add(free_name)
        return free_name

    def _add(self, function: Function) -> None:
        """Declare a function, under a name that is unique among its overloads."""
        same = self._functions.setdefault(function.name, [])
        kinds = ",".join(p.kind for p in function.parameters)
        function.name = f"{function.name}({kinds})"
        same.append(function)

    # Expressions.

    def _expression(self) -> Expression:
        return self._deeper(self._choice)

    def _choice(self) -> Expression:
        condition = self._binary(1)
        if not self._skip("?"):
            return condition
        chosen = self._expression()
        self._take(":")
        return self._choice_of(condition, chosen, self._expression())

    def _choice_of(self, condition: Expression, chosen: Expression, other: Expression) -> Expression:
        chosen, other = self._alike(chosen, other)
        return Choice(chosen.kind, condition, chosen, other)

    def _binary(self, least: int) -> Expression:
        left, terms = self._unary(), 1
        while (mark := self._next_token.text) in BINDING and BINDING[mark] >= least and self._next_token.kind == "mark":
            self._take()
            left, terms = self._operation(mark, left, self._binary(BINDING[mark] + 1)), terms + 1
            if terms > MOST_TERMS:
                raise self._error(f"an expression of more than {MOST_TERMS} terms")
        return left

    def _operation(self, mark: str, left: Expression, right: Expression) -> Expression:
        """Return the expression for an operator between two values in this language."""
        return self._combined(mark, left, right)

    def _combined(self, mark: str, left: Expression, right: Expression) -> Expression:
        """Return a component-wise operation on two values, which are converted to the same scalar type except in
        logic and shifts; integer literals are folded."""
        if mark in LOGICAL:
            # Of two truth values ^^ and != are one, and only GLSL has the former.
            return Binary("bool", "!=" if mark == "^^" else mark, left, right)
        if mark in SHIFTS:
            return Binary(left.kind, mark, left, right)
        left, right = self._alike(left, right, sizes_too=False)
        if isinstance(left, Literal) and isinstance(right, Literal) and left.kind == "int" and mark in FOLDED:
            whole = FOLDED[mark](int(left.text, 0), int(right.text, 0))
            if 0 <= whole < 2**31:
                return Literal("int", str(whole))
        if mark in COMPARES:
            return Binary(vector("bool", max(size_of(left.kind), size_of(right.kind))), mark, left, right)
        return Binary(self._product_kind(left.kind, right.kind), mark, left, right)

    def _product_kind(self, left: str, right: str) -> str:
        if left.startswith("mat"):
            return right if "vec" in right else left
        if right.startswith("mat"):
            return left if "vec" in left else right
        sizes = size_of(left), size_of(right)
        if 1 not in sizes and sizes[0] != sizes[1]:
            raise self._error(f"{left} and {right} cannot be combined")
        return left if sizes[0] >= sizes[1] else right

    def _alike(self, a: Expression, b: Expression, sizes_too: bool = True) -> tuple[Expression, Expression]:
        """Return two values converted to the same scalar type. With `sizes_too`, their sizes must be equal."""
        scalars = scalar_of(a.kind), scalar_of(b.kind)
        if scalars[0] != scalars[1]:
            widest = "float" if "float" in scalars else "uint"
            a, b = self._converted(a, widest), self._converted(b, widest)
        if sizes_too and size_of(a.kind) != size_of(b.kind):
            raise self._error(f"{a.kind} and {b.kind} cannot be combined")
        return a, b

    def _converted(self, value: Expression, scalar: str) -> Expression:
        """Return a value with components of another scalar type; a literal becomes a literal of that type. Raises
        TranslationError for a conversion from or to bool."""
        current = scalar_of(value.kind)
        if current == scalar:
            return value
        if "bool" in (current, scalar):
            raise self._error(f"expected {scalar}, not {current}")
        return self._cast(value, scalar)

    def _cast(self, value: Expression, scalar: str) -> Expression:
        """Return a value converted to components of another scalar type, as by a constructor; a literal becomes a
        literal of that type."""
        current = scalar_of(value.kind)
        if current == scalar:
            return value
        if isinstance(value, Literal) and "bool" not in (current, scalar) and current != "float":
            return Literal(scalar, f"{int(value.text, 0)}.0" if scalar == "float" else value.text)
        if isinstance(value, Unary) and value.operator == "-" and isinstance(value.value, Literal) and current == "int":
            if scalar == "float":
                return Unary(scalar, "-", self._cast(value.value, scalar))
            if scalar == "uint":
                return Literal(scalar, str(-int(value.value.text, 0) % 2**32))
        return Construct(vector(scalar, size_of(value.kind)), [value])

    def _unary(self) -> Expression:
        mark = self._next_token.text
        if self._next_token.kind == "mark" and mark in ("-", "!", "~", "+"):
            self._take()
            value = self._deeper(self._unary)
            return value if mark == "+" else Unary(value.kind, mark, value)
        return self._behind(self._primary())

    def _primary(self) -> Expression:
        raise NotImplementedError

    def _behind(self, value: Expression) -> Expression:
        """Read the member and index accesses that follow a value, and return the whole expression; the value itself
        if none follow."""
        while True:
            if self._skip("."):
                value = self._member(value, self._word_token())
            elif self._skip("["):
                index = self._expression()
                self._take("]")
                value = self._index_expression(value, index)
            else:
                return value

    def _index_expression(self, value: Expression, index: Expression) -> Expression:
        return Index(self._element_kind(value.kind), value, index)

    def _member(self, value: Expression, word: Token) -> Expression:
        size, names = size_of(value.kind), word.text
        for letters in FIELDS:
            if len(names) <= 4 and "vec" in value.kind and all(letter in letters[:size] for letter in names):
                plain = "".join("xyzw"[letters.index(letter)] for letter in names)
                return Swizzle(vector(scalar_of(value.kind), len(names)), value, plain)
        self._at -= 1
        raise self._error(f"{value.kind} has no member {names}")

    def _element_kind(self, kind: str) -> str:
        if kind.endswith("]"):
            return kind.partition("[")[0]
        if kind.startswith("mat"):
            return f"vec{kind[3]}"
        if size_of(kind) == 1:
            raise self._error(f"{kind} has no elements")
        return scalar_of(kind)

    def _array_kind(self, kind: str, length: Expression) -> str:
        count = self._whole_number(length)
        if count is None:
            raise self._error("the length of an array must be a constant integer")
        return f"{kind}[{count}]"

    def _whole_number(self, value: Expression | None) -> int | None:
        """Return the value of a constant integer expression; None for any other expression."""
        match value:
            case Literal("int" | "uint", text):
                return int(text, 0)
            case Name(_, name):
                return self._whole_number(next((c.value for c in self._made.constants if c.name == name), None))
            case Binary(_, mark, left, right) if mark in FOLDED:
                first, second = self._whole_number(left), self._whole_number(right)
                return None if first is None or second is None else FOLDED[mark](first, second)
        return None

    def _arguments(self) -> list[Expression]:
        """Read arguments up to the closing parenthesis; the opening parenthesis is already taken."""
        arguments: list[Expression] = []
        if self._skip(")"):
            return arguments
        arguments.append(self._expression())
        while self._skip(","):
            arguments.append(self._expression())
        self._take(")")
        return arguments

    def _called(self, name: str, arguments: list[Expression], place: Place | None = None) -> Expression:
        """Return the expression for a call of the function with this name: a call, or the operations that replace a
        function such as mod. Raises TranslationError for an unknown function.

        Args:
            place: the place of the name."""
        if name in self._functions:
            return self._own_call(name, arguments)
        if name == "mod" and len(arguments) == 2:
            return self._modulus("floor", *arguments)
        if name == "atan" and len(arguments) == 2:
            name = "atan2"
        if name in ANGLES and len(arguments) == 1:
            return self._combined("*", self._converted(arguments[0], "float"), Literal("float", ANGLES[name]))
        if name == "not" and len(arguments) == 1:
            return Unary(arguments[0].kind, "!", arguments[0])
        if name in COMPARISONS and len(arguments) == 2:
            return self._combined(COMPARISONS[name], *arguments)
        if name == "mix" and len(arguments) == 3 and scalar_of(arguments[2].kind) == "bool":
            return self._choice_of(arguments[2], arguments[1], arguments[0])
        arguments = self._given(name, arguments)
        if name == "exp2" and isinstance(arguments[0], Literal) and abs(float(arguments[0].text)) <= MOST_FOLDED:
            return Literal("float", with_a_point(repr(2.0 ** float(arguments[0].text))))
        kind = result_of(name, [a.kind for a in arguments]) if arguments else None
        if kind is None:
            raise self._error(f"unknown function {name}", place)
        return Call(kind, name, arguments)

    def _given(self, name: str, arguments: list[Expression]) -> list[Expression]:
        """Return a built-in function's arguments converted to one type, float if the function takes no other type."""
        if name in OF_FLOATS:
            return [self._converted(a, "float") for a in arguments]
        return self._all_alike(arguments) if len(arguments) > 1 and name != FETCH else arguments

    def _modulus(self, rounding: str, x: Expression, y: Expression) -> Expression:
        """Return x - y floor(x / y), or the same with trunc, because other languages' remainders differ for negative
        x.

        Operands other than names and numbers are passed to a function that is added to the program, because they
        would otherwise be written and computed twice.
        """
        x, y = self._alike(x, y, sizes_too=False)
        kind = self._product_kind(x.kind, y.kind)
        if all(map(_is_short, (x, y))) or len(self._scopes) == 1:
            return self._remainder(rounding, kind, x, y)
        name = f"{rounding}_modulus({x.kind},{y.kind})"
        if name not in self._made_functions:
            parameters = [Parameter(x.kind, "x"), Parameter(y.kind, "y")]
            body = self._remainder(rounding, kind, Name(x.kind, "x"), Name(y.kind, "y"))
            self._made_functions[name] = Function(kind, name, parameters, [Return(body)])
        return Call(kind, name, [x, y], is_own=True)

    def _remainder(self, rounding: str, kind: str, x: Expression, y: Expression) -> Expression:
        quotient = self._combined("/", x, y)
        return self._combined("-", x, self._combined("*", y, Call(kind, rounding, [quotient])))

    def _all_alike(self, arguments: list[Expression]) -> list[Expression]:
        scalars = {scalar_of(a.kind) for a in arguments}
        widest = next(s for s in ("float", "uint", "int", "bool") if s in scalars)
        return [self._converted(a, widest) for a in arguments]

    def _own_call(self, name: str, arguments: list[Expression]) -> Expression:
        kinds = [a.kind for a in arguments]
        same = self._functions[name]
        function = next((f for f in same if [p.kind for p in f.parameters] == kinds), None)
        if not function:
            sizes = [size_of(kind) for kind in kinds]
            function = next((f for f in same if [size_of(p.kind) for p in f.parameters] == sizes), None)
        if not function:
            raise self._error(f"{name} does not accept arguments of types ({', '.join(kinds)})")
        pairs = zip(arguments, function.parameters, strict=True)
        given = [self._converted(a, scalar_of(p.kind)) if a.kind != p.kind else a for a, p in pairs]
        return Call(function.kind, function.name, given, is_own=True)

    def _constructed(self, kind: str, arguments: list[Expression]) -> Expression:
        """Return the expression for a type's constructor: the arguments' components, converted to that type; surplus
        components of the last argument are dropped. Raises TranslationError for too many arguments."""
        if len(arguments) == 1 and arguments[0].kind == kind:
            return arguments[0]
        scalar, size = scalar_of(kind), size_of(kind)
        if kind.startswith("mat"):
            return self._matrix(kind, [self._cast(a, "float") for a in arguments])
        if len(arguments) == 1 and size_of(arguments[0].kind) in (1, size):
            cast = self._cast(arguments[0], scalar)
            return cast if size_of(cast.kind) == size else Construct(kind, [cast])
        components: list[Expression] = []
        for argument in arguments:
            left = size - sum(size_of(component.kind) for component in components)
            if left <= 0:
                raise self._error(f"too many components for {kind}")
            parts = min(size_of(argument.kind), left)
            if parts < size_of(argument.kind):
                argument = Swizzle(vector(scalar_of(argument.kind), parts), argument, FIELDS[0][:parts])
            components.append(self._cast(argument, scalar))
        return components[0] if size == 1 else Construct(kind, components)

    def _matrix(self, kind: str, arguments: list[Expression]) -> Expression:
        """Return a matrix constructed from its columns, from its numbers, from a single number for its diagonal, or
        from the corner of a larger matrix. Raises TranslationError for other arguments."""
        size = int(kind[3])
        if len(arguments) == 1 and arguments[0].kind == "float":
            (number,) = arguments
            zero = Literal("float", "0.0")
            columns = [[number if row == column else zero for row in range(size)] for column in range(size)]
            return Construct(kind, [Construct(f"vec{size}", column) for column in columns])
        if len(arguments) == 1 and arguments[0].kind.startswith("mat") and arguments[0].kind[3] > kind[3]:
            (matrix,) = arguments
            columns = [Index(f"vec{matrix.kind[3]}", matrix, Literal("int", str(column))) for column in range(size)]
            return Construct(kind, [Swizzle(f"vec{size}", column, FIELDS[0][:size]) for column in columns])
        if [a.kind for a in arguments] not in ([f"vec{size}"] * size, ["float"] * size**2):
            raise self._error(f"{kind} needs {size} columns, {size**2} numbers or one number")
        if len(arguments) > size:
            columns = [arguments[start : start + size] for start in range(0, size**2, size)]
            arguments = [Construct(f"vec{size}", column) for column in columns]
        return Construct(kind, arguments)

    # Statements.

    def _statement(self) -> list[Statement]:
        raise NotImplementedError

    def _block(self) -> list[Statement]:
        """Read statements between braces, in a scope of their own."""
        self._take("{")
        self._scopes.append({})
        statements: list[Statement] = []
        while not self._skip("}"):
            statements += self._deeper(self._statement)
        self._scopes.pop()
        return statements

    def _about(self, statement: Statement, first: Token) -> Statement:
        """Return a statement, whose last token was just taken, with the comments around its tokens added."""
        statement.above = [*first.above, *statement.above]
        statement.behind = statement.behind or self._tokens[self._at - 1].behind
        return statement

    def _assignment(self) -> Statement:
        """Read an assignment, an increment, a decrement or a call, without the character that ends it."""
        for mark in ("++", "--"):
            if self._skip(mark):
                target = self._behind(self._primary())
                return self._count_statement(target, mark)
        target = self._behind(self._primary())
        if self._next_token.text in ("++", "--"):
            return self._count_statement(target, self._take().text)
        if isinstance(target, Call) and target.is_own:
            return Perform(target)
        mark = self._take(*ASSIGNS).text
        value = self._expression()
        if mark not in ("<<=", ">>="):
            value = self._converted(value, scalar_of(target.kind))
        return Assign(target, mark, value)

    def _count_statement(self, target: Expression, mark: str) -> Statement:
        step = Literal("float", "1.0") if target.kind == "float" else Literal(target.kind, "1")
        return Assign(target, f"{mark[0]}=", step)


def _is_short(value: Expression) -> bool:
    """Whether a value is short enough to be written twice: a number or a name, with swizzles and unary operators."""
    while isinstance(value, Swizzle | Unary):
        value = value.value
    return isinstance(value, Literal | Name)
