"""Functions that change their arguments, rewritten to return the changes, for languages without such arguments.

`void f(vec4 e, out vec3 n, inout float x)` becomes `f_made f(vec4 e, float x)`, which returns a structure of n and x,
and f(a, b, c) becomes `f_made made = f(a, c); b = made.n; c = made.x`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass, replace

from .tree import (
    Assign,
    Block,
    Call,
    Construct,
    Declare,
    Expression,
    For,
    Function,
    If,
    Member,
    Name,
    Parameter,
    Perform,
    Program,
    Return,
    Statement,
    Struct,
    TranslationError,
    While,
    inside,
)

RESULT = "result"


@dataclass(frozen=True)
class _Changing:
    """A function that changes its arguments.

    Attributes:
        made: the structure that it returns instead.
        parameters: its original parameters.
        has_result: whether it also returns a value of its own.
    """

    made: Struct
    parameters: list[Parameter]
    has_result: bool


def given_back(program: Program) -> Program:
    """Return a program in which no function changes its arguments; the functions are rewritten in place.

    Raises:
        TranslationError: a function that changes its arguments is called within an expression.
    """
    changing = {f.name: _changing(f) for f in program.functions if any(p.is_changed for p in f.parameters)}
    for function in program.functions:
        names = {node.name for node in inside(function) if isinstance(node, Name | Declare | Parameter)}
        function.body = list(_Calls(changing, names).statements(function.body))
        if function.name in changing:
            _give_back(function, changing[function.name])
    return replace(program, structs=[*program.structs, *(change.made for change in changing.values())])


def _changing(function: Function) -> _Changing:
    changed = {p.name: p.kind for p in function.parameters if p.is_changed}
    result = {} if function.kind == "void" else {_unused(RESULT, set(changed)): function.kind}
    return _Changing(Struct(f"{function.name}_made", result | changed), function.parameters, bool(result))


def _unused(name: str, taken: set[str]) -> str:
    """Return a name, with a number appended if it is taken, and add it to the taken names."""
    ways = (name, *(f"{name}_{number}" for number in range(2, len(taken) + 3)))
    free_name = next(way for way in ways if way not in taken)
    taken.add(free_name)
    return free_name


def _give_back(function: Function, changing: _Changing) -> None:
    """Rewrite a function that changes its arguments so that it returns the structure of `changing` instead."""
    changed = [p for p in function.parameters if p.is_changed]
    function.kind = changing.made.name
    begin = [Declare(p.kind, p.name, None) for p in function.parameters if not _is_taken(p)]
    function.parameters = [replace(p, is_changed=False) for p in function.parameters if _is_taken(p)]
    function.body = [*begin, *_with_returns(function.body, changing.made.name, changed)]
    if not isinstance(function.body[-1], Return):
        function.body.append(Return(_made(changing.made.name, None, changed)))


def _is_taken(parameter: Parameter) -> bool:
    """Whether a rewritten function still takes a parameter: not if the parameter only returns changes."""
    return parameter.is_given or not parameter.is_changed


def _made(kind: str, value: Expression | None, changed: list[Parameter]) -> Expression:
    return Construct(kind, [*([value] if value else []), *(Name(p.kind, p.name) for p in changed)])


def _with_returns(statements: list[Statement], kind: str, changed: list[Parameter]) -> list[Statement]:
    """Rewrite the return statements in a list, at any depth, to return a structure of the old value and the changed
    parameters. Return the same list."""
    for statement in statements:
        for body in _bodies(statement):
            body[:] = _with_returns(body, kind, changed)
        if isinstance(statement, Return):
            statement.value = _made(kind, statement.value, changed)
    return statements


def _bodies(statement: Statement) -> list[list[Statement]]:
    """Return the lists of statements inside a statement, such as both branches of an `if`; empty without any."""
    match statement:
        case If(_, chosen, other):
            return [chosen, other]
        case For() | While() | Block():
            return [statement.body]
    return []


@dataclass
class _Calls:
    """The calls in a function to functions that change their arguments.

    Attributes:
        changing: the called functions, by name.
        names: all names in the function.
    """

    changing: Mapping[str, _Changing]
    names: set[str]

    def statements(self, given: list[Statement]) -> Iterator[Statement]:
        """Yield statements in which each call that changes arguments is a separate statement, at any depth. Raises
        TranslationError for such a call within an expression."""
        for statement in given:
            for body in _bodies(statement):
                body[:] = self.statements(body)
            yield from self._apart(statement)

    def _apart(self, statement: Statement) -> Iterator[Statement]:
        """Yield a statement, or its replacement if its whole value is a call to a function that changes arguments.
        Raises TranslationError for such a call within an expression."""
        value = statement.call if isinstance(statement, Perform) else getattr(statement, "value", None)
        is_plain = not isinstance(statement, Assign) or statement.operator == "="
        if is_plain and isinstance(value, Call) and value.name in self.changing:
            yield from self._called(statement, value)
            return
        nested = [getattr(statement, name, None) for name in ("condition", "start", "step", "value", "target", "call")]
        for node in inside(nested):
            if isinstance(node, Call) and node.name in self.changing:
                raise TranslationError(f"{node.name} changes its argument; call it in a separate statement")
        yield statement

    def _called(self, statement: Statement, call: Call) -> Iterator[Statement]:
        changing = self.changing[call.name]
        output = Name(changing.made.name, _unused("made", self.names))
        pairs = list(zip(changing.parameters, call.arguments, strict=True))
        call.arguments, call.kind = [deepcopy(value) for p, value in pairs if _is_taken(p)], output.kind
        yield Declare(output.kind, output.name, call, above=statement.above)
        fields = list(changing.made.kinds.items())
        if isinstance(statement, Declare | Assign):
            kind = fields[0][1]
            yield replace(statement, value=Member(kind, output, fields[0][0]), above=[])
        for (name, kind), (_, place) in zip(
            fields[changing.has_result :], [pair for pair in pairs if pair[0].is_changed], strict=True
        ):
            yield Assign(place, "=", Member(kind, output, name))
        if isinstance(statement, Return):
            yield replace(statement, value=Member(fields[0][1], output, fields[0][0]), above=[])
