"""The nodes of a syntax tree, whatever language it was read from. Types have their GLSL names."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, fields, is_dataclass
from threading import Lock
from typing import Any

SCALARS = {"float": "", "int": "i", "uint": "u", "bool": "b"}
SIZES = {f"{letter}vec{size}": size for letter in SCALARS.values() for size in (2, 3, 4)}
MATRICES = ("mat2", "mat3", "mat4")
# Frames of Python for the deepest tree: sums of many terms lean to one side.
MOST_FRAMES = 12_000
UNEXPECTED = (ArithmeticError, AssertionError, AttributeError, LookupError, RecursionError, TypeError, ValueError)


class TranslationError(Exception):
    """Code that cannot be read, or written in another language; one-line message, with line and column if known."""


@contextmanager
def one_error_type(placed: Callable[[str], Exception] = TranslationError) -> Iterator[None]:
    """Allow deep trees, and turn any unexpected error of a reader or a writer into a TranslationError.

    Args:
        placed: a function that makes the error from a message, with the place if it is known.
    """
    with _room:
        try:
            yield
        except UNEXPECTED as error:
            why = "the code is nested too deeply" if isinstance(error, RecursionError) else "the code cannot be parsed"
            raise placed(why) from error


class _Room:
    """A higher recursion limit for deep trees, while any thread needs it: all threads share one limit."""

    def __init__(self) -> None:
        self._lock, self._users, self._before = Lock(), 0, 0

    def __enter__(self) -> None:
        with self._lock:
            if not self._users:
                self._before = sys.getrecursionlimit()
                sys.setrecursionlimit(max(self._before, MOST_FRAMES))
            self._users += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._users -= 1
            if not self._users:
                sys.setrecursionlimit(self._before)


_room = _Room()


@dataclass(frozen=True)
class Place:
    """The line and column of a token, counted from 1."""

    line: int
    column: int


def scalar_of(kind: str) -> str:
    """Return the type of the components of a vector or a matrix; any other type, such as a scalar, unchanged."""
    if kind in SIZES:
        return next(scalar for scalar, letter in SCALARS.items() if kind.startswith(f"{letter}vec"))
    return "float" if kind.partition("[")[0] in MATRICES else kind


def size_of(kind: str) -> int:
    """Return the number of components of a vector type; 1 for any other type."""
    return SIZES.get(kind, 1)


def vector(scalar: str, size: int) -> str:
    """Return the type of a vector of `size` components; for one component, the scalar type."""
    return scalar if size == 1 else f"{SCALARS[scalar]}vec{size}"


@dataclass
class Expression:
    """A value; `kind` is its type, for an array the type of its elements followed by [count]."""

    kind: str


@dataclass
class Literal(Expression):
    """A number or a Boolean; `text` has no suffix."""

    text: str


@dataclass
class Name(Expression):
    name: str


@dataclass
class Unary(Expression):
    operator: str
    value: Expression


@dataclass
class Binary(Expression):
    operator: str
    left: Expression
    right: Expression


@dataclass
class Choice(Expression):
    """condition ? chosen : other, with a single Boolean as the condition or a Boolean per component."""

    condition: Expression
    chosen: Expression
    other: Expression


@dataclass
class Call(Expression):
    """A call of a built-in function or, if `is_own`, of one of the program's functions."""

    name: str
    arguments: list[Expression]
    is_own: bool = False


@dataclass
class Construct(Expression):
    """A type's constructor: a conversion, a vector of parts, a matrix of columns, or a structure of its fields."""

    arguments: list[Expression]


@dataclass
class Swizzle(Expression):
    value: Expression
    fields: str


@dataclass
class Index(Expression):
    value: Expression
    at: Expression


@dataclass
class Member(Expression):
    """A field of a structure."""

    value: Expression
    field: str


@dataclass
class Elements(Expression):
    """An array of numbers."""

    values: list[Expression]


@dataclass
class Statement:
    """A statement; `above` holds the comments before it, `behind` the comment at its end, without comment marks."""

    above: list[str] = field(default_factory=list, kw_only=True)
    behind: str = field(default="", kw_only=True)


@dataclass
class Declare(Statement):
    """A declaration; `is_precise` if compilers must compute the value exactly as it is written."""

    kind: str
    name: str
    value: Expression | None
    is_constant: bool = False
    is_precise: bool = False


@dataclass
class Assign(Statement):
    """An assignment; `operator` is =, += and so on."""

    target: Expression
    operator: str
    value: Expression


@dataclass
class Perform(Statement):
    """A call as a statement, for the changes that it makes."""

    call: Call


@dataclass
class Block(Statement):
    """Statements with their own scope."""

    body: list[Statement]


@dataclass
class If(Statement):
    condition: Expression
    chosen: list[Statement]
    other: list[Statement]


@dataclass
class For(Statement):
    """A `for` loop; `start` and `step` are None if they are empty."""

    start: Statement | None
    condition: Expression
    step: Statement | None
    body: list[Statement]


@dataclass
class While(Statement):
    condition: Expression
    body: list[Statement]


@dataclass
class Leave(Statement):
    """break or continue."""

    word: str


@dataclass
class Return(Statement):
    value: Expression | None


@dataclass
class Parameter:
    """A parameter; `is_changed` if the caller sees assignments to it (GLSL's inout), and not `is_given` if it also
    starts without the caller's value (GLSL's out)."""

    kind: str
    name: str
    is_changed: bool = False
    is_given: bool = True


@dataclass
class Function(Statement):
    """A function; `unread` is the reason why its body could not be read, raised only if the function is needed."""

    kind: str
    name: str
    parameters: list[Parameter]
    body: list[Statement]
    unread: TranslationError | None = field(default=None, kw_only=True)


@dataclass
class TexelTable:
    """A texture that is read texel by texel."""

    name: str


@dataclass
class Struct:
    """A structure: the types of its fields, by name."""

    name: str
    kinds: dict[str, str]


@dataclass
class Program:
    """Structures, constants, tables and functions, each ordered so that it uses only what comes before it."""

    constants: list[Declare]
    tables: list[TexelTable]
    functions: list[Function]
    structs: list[Struct] = field(default_factory=list)

    def function(self, name: str) -> Function:
        """Return the function with this name. Raises ValueError unless exactly one function has it."""
        (function,) = (f for f in self.functions if f.name == name)
        return function


def plain_name(function: Function) -> str:
    """Return a function's name as it was written, without the types of its parameters."""
    return function.name.partition("(")[0]


def inside(node: Any) -> Iterator[Any]:
    """Yield a node and all nodes below it, including nodes in lists, in the order of the text."""
    left = [node]
    while left:
        node = left.pop()
        if isinstance(node, list):
            left += reversed(node)
        elif is_dataclass(node):
            yield node
            left += [getattr(node, each.name) for each in reversed(fields(node))]
