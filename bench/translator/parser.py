"""What readers of C-like languages share: tokens one after the other, scopes, and expressions with their types."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

from .builtins import result_of
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
    Perform,
    Place,
    Statement,
    Swizzle,
    TranslationError,
    Unary,
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
# How deep expressions and statements may be nested: far from what Python recurses.
MOST_DEPTH = 60
FIELDS = ("xyzw", "rgba", "stpq")


class Parser:
    """Tokens, scopes and expressions.

    Args:
        given: the tokens.
    """

    def __init__(self, given: Sequence[Token]):
        self._tokens, self._at, self._depth = given, 0, 0
        self._scopes: list[dict[str, Expression]] = [{}]
        self._functions: dict[str, list[Function]] = {}

    # Tokens.

    @property
    def _next(self) -> Token:
        return self._tokens[self._at] if self._at < len(self._tokens) else END

    def _ahead(self, count: int) -> str:
        at = self._at + count
        return self._tokens[at].text if at < len(self._tokens) else ""

    def _take(self, *texts: str) -> Token:
        """The next token, which must be one of these if any are named."""
        token = self._next
        if (texts and token.text not in texts) or token is END:
            raise self._error(f"{' or '.join(texts) or 'more'} expected, not {token.text}")
        self._at += 1
        return token

    def _skip(self, text: str) -> bool:
        if self._next.text != text or self._next is END:
            return False
        self._at += 1
        return True

    def _word(self) -> Token:
        if self._next.kind != "word":
            raise self._error(f"a name expected, not {self._next.text}")
        return self._take()

    def _error(self, what: str, place: Place | None = None) -> TranslationError:
        last = self._tokens[-1].place if self._tokens else END.place
        place = place or (last if self._next is END else self._next.place)
        return TranslationError(f"{place.line}:{place.column}: {what}")

    def _deeper(self, read: Callable):
        """What a reader reads, one level deeper. Raises TranslationError where that is too deep."""
        self._depth += 1
        if self._depth > MOST_DEPTH:
            raise self._error(f"nested more than {MOST_DEPTH} deep")
        try:
            return read()
        finally:
            self._depth -= 1

    # Names.

    def _named(self, token: Token) -> Expression:
        for scope in reversed(self._scopes):
            if token.text in scope:
                return scope[token.text]
        self._at -= 1
        raise self._error(f"{token.text} is not known here")

    def _declared(self, name: str, kind: str, stands_for: Expression | None = None) -> None:
        self._scopes[-1][name] = stands_for or Name(kind, name)

    def _add(self, function: Function) -> None:
        """Make a function known; its name becomes its own among those of that name."""
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
        return self._chosen(condition, chosen, self._expression())

    def _chosen(self, condition: Expression, chosen: Expression, other: Expression) -> Expression:
        chosen, other = self._alike(chosen, other)
        return Choice(chosen.kind, condition, chosen, other)

    def _binary(self, least: int) -> Expression:
        left = self._unary()
        while (mark := self._next.text) in BINDING and BINDING[mark] >= least and self._next.kind == "mark":
            self._take()
            left = self._combined(mark, left, self._binary(BINDING[mark] + 1))
        return left

    def _combined(self, mark: str, left: Expression, right: Expression) -> Expression:
        if mark in LOGICAL:
            return Binary("bool", mark, left, right)
        if mark in SHIFTS:
            return Binary(left.kind, mark, left, right)
        left, right = self._alike(left, right, sizes_too=False)
        if isinstance(left, Literal) and isinstance(right, Literal) and left.kind == "int" and mark in FOLDED:
            return Literal("int", str(FOLDED[mark](int(left.text, 0), int(right.text, 0))))
        if mark in COMPARES:
            return Binary(vector("bool", max(size_of(left.kind), size_of(right.kind))), mark, left, right)
        return Binary(self._product(left.kind, right.kind), mark, left, right)

    def _product(self, left: str, right: str) -> str:
        if left.startswith("mat"):
            return right if "vec" in right else left
        if right.startswith("mat"):
            return left if "vec" in left else right
        sizes = size_of(left), size_of(right)
        if 1 not in sizes and sizes[0] != sizes[1]:
            raise self._error(f"{left} and {right} do not mix")
        return left if sizes[0] >= sizes[1] else right

    def _alike(self, a: Expression, b: Expression, sizes_too: bool = True) -> tuple[Expression, Expression]:
        """Two values of one scalar type, whole numbers made into what the other is."""
        scalars = scalar_of(a.kind), scalar_of(b.kind)
        if scalars[0] != scalars[1]:
            widest = "float" if "float" in scalars else "uint"
            a, b = self._converted(a, widest), self._converted(b, widest)
        if sizes_too and size_of(a.kind) != size_of(b.kind):
            raise self._error(f"{a.kind} and {b.kind} do not mix")
        return a, b

    def _converted(self, value: Expression, scalar: str) -> Expression:
        """A value with components of another type; a literal becomes a literal of it."""
        found = scalar_of(value.kind)
        if found == scalar:
            return value
        if "bool" in (found, scalar):
            raise self._error(f"a {found} where a {scalar} is expected")
        if isinstance(value, Literal):
            return Literal(scalar, f"{int(value.text, 0)}.0" if scalar == "float" else value.text)
        if isinstance(value, Unary) and isinstance(value.value, Literal):
            return Unary(scalar, value.operator, self._converted(value.value, scalar))
        return Construct(vector(scalar, size_of(value.kind)), [value])

    def _unary(self) -> Expression:
        mark = self._next.text
        if self._next.kind == "mark" and mark in ("-", "!", "~", "+"):
            self._take()
            value = self._deeper(self._unary)
            return value if mark == "+" else Unary(value.kind, mark, value)
        return self._behind(self._primary())

    def _primary(self) -> Expression:
        raise NotImplementedError

    def _behind(self, value: Expression) -> Expression:
        """Members and elements behind a value."""
        while True:
            if self._skip("."):
                value = self._member(value, self._word())
            elif self._skip("["):
                at = self._expression()
                self._take("]")
                value = Index(self._element(value.kind), value, at)
            else:
                return value

    def _member(self, value: Expression, word: Token) -> Expression:
        size, names = size_of(value.kind), word.text
        for letters in FIELDS:
            if len(names) <= 4 and "vec" in value.kind and all(letter in letters[:size] for letter in names):
                plain = "".join("xyzw"[letters.index(letter)] for letter in names)
                return Swizzle(vector(scalar_of(value.kind), len(names)), value, plain)
        self._at -= 1
        raise self._error(f"a {value.kind} has no .{names}")

    def _element(self, kind: str) -> str:
        if kind.endswith("]"):
            return kind.partition("[")[0]
        if kind.startswith("mat"):
            return f"vec{kind[3]}"
        if size_of(kind) == 1:
            raise self._error(f"a {kind} has no elements")
        return scalar_of(kind)

    def _arguments(self) -> list[Expression]:
        """What stands between parentheses, the first of which is taken."""
        found: list[Expression] = []
        if self._skip(")"):
            return found
        found.append(self._expression())
        while self._skip(","):
            found.append(self._expression())
        self._take(")")
        return found

    def _called(self, name: str, arguments: list[Expression], place: Place | None = None) -> Expression:
        """A call; `place` is where the name stands."""
        if name in self._functions:
            return self._own(name, arguments)
        if name == "mod" and len(arguments) == 2:
            return self._modulus(*arguments)
        if name == "atan" and len(arguments) == 2:
            name = "atan2"
        if name in COMPARISONS and len(arguments) == 2:
            return self._combined(COMPARISONS[name], *arguments)
        if name == "mix" and len(arguments) == 3 and scalar_of(arguments[2].kind) == "bool":
            return self._chosen(arguments[2], arguments[1], arguments[0])
        if len(arguments) > 1 and name not in ("texelFetch",):
            arguments = self._all_alike(arguments)
        if name == "exp2" and isinstance(arguments[0], Literal):
            return Literal("float", with_a_point(repr(2.0 ** float(arguments[0].text))))
        kind = result_of(name, [a.kind for a in arguments]) if arguments else None
        if kind is None:
            raise self._error(f"{name} is not a function that is known here", place)
        return Call(kind, name, arguments)

    def _modulus(self, x: Expression, y: Expression) -> Expression:
        """x - y floor(x / y), which other languages' remainders are not where x is negative."""
        quotient = self._combined("/", x, y)
        return self._combined("-", x, self._combined("*", y, Call(quotient.kind, "floor", [quotient])))

    def _all_alike(self, arguments: list[Expression]) -> list[Expression]:
        scalars = {scalar_of(a.kind) for a in arguments}
        widest = next(s for s in ("float", "uint", "int", "bool") if s in scalars)
        return [self._converted(a, widest) for a in arguments]

    def _own(self, name: str, arguments: list[Expression]) -> Expression:
        kinds = [a.kind for a in arguments]
        same = self._functions[name]
        found = next((f for f in same if [p.kind for p in f.parameters] == kinds), None)
        if not found:
            sizes = [size_of(kind) for kind in kinds]
            found = next((f for f in same if [size_of(p.kind) for p in f.parameters] == sizes), None)
        if not found:
            raise self._error(f"{name} does not take ({', '.join(kinds)})")
        pairs = zip(arguments, found.parameters, strict=True)
        given = [self._converted(a, scalar_of(p.kind)) if a.kind != p.kind else a for a, p in pairs]
        return Call(found.kind, found.name, given, is_own=True)

    def _constructed(self, kind: str, arguments: list[Expression]) -> Expression:
        if len(arguments) == 1 and arguments[0].kind == kind:
            return arguments[0]
        if len(arguments) == 1 and isinstance(arguments[0], Literal) and kind in ("float", "uint", "int"):
            literal = arguments[0]
            if literal.kind == "int":
                return self._converted(literal, kind)
        scalar = scalar_of(kind)
        if size_of(kind) > 1 or kind.startswith("mat"):
            mixes = len(arguments) > 1 or size_of(arguments[0].kind) == 1
            arguments = [self._converted(a, scalar) for a in arguments] if mixes else arguments
        return Construct(kind, arguments)

    # Statements.

    def _statement(self) -> list[Statement]:
        raise NotImplementedError

    def _block(self) -> list[Statement]:
        """Statements between braces, in a scope of their own."""
        self._take("{")
        self._scopes.append({})
        found: list[Statement] = []
        while not self._skip("}"):
            found += self._deeper(self._statement)
        self._scopes.pop()
        return found

    def _about(self, statement: Statement, first: Token) -> Statement:
        """A statement with the comments around its tokens, the last of which was just taken."""
        statement.above = [*first.above, *statement.above]
        statement.behind = statement.behind or self._tokens[self._at - 1].behind
        return statement

    def _assignment(self) -> Statement:
        """An assignment, a count up or down, or a call, without what ends it."""
        for mark in ("++", "--"):
            if self._skip(mark):
                target = self._behind(self._primary())
                return self._counted(target, mark)
        target = self._behind(self._primary())
        if self._next.text in ("++", "--"):
            return self._counted(target, self._take().text)
        if isinstance(target, Call) and target.is_own:
            return Perform(target)
        mark = self._take(*ASSIGNS).text
        value = self._expression()
        if mark not in ("<<=", ">>="):
            value = self._converted(value, scalar_of(target.kind))
        return Assign(target, mark, value)

    def _counted(self, target: Expression, mark: str) -> Statement:
        one = Literal("float", "1.0") if target.kind == "float" else Literal(target.kind, "1")
        return Assign(target, f"{mark[0]}=", one)
