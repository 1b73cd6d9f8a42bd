"""Python with NumPy, for all normals of an array at once.

A vector is the last axis of an array. What a shader does for one normal under a condition is done for all, and kept for
those that it holds for: `np.where(chosen, new, old)`. A loop goes on while it does for any.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from .c_defined import counted
from .numpy_helpers import HELPERS, needed
from .numpy_values import BINDING, TYPES, NumpyValues, broad, inner_shape, shape_text
from .texels import Texels
from .tree import (
    Assign,
    Binary,
    Block,
    Call,
    Choice,
    Declare,
    Expression,
    For,
    Function,
    If,
    Index,
    Leave,
    Literal,
    Member,
    Name,
    Program,
    Return,
    Statement,
    Struct,
    Swizzle,
    Table,
    TranslationError,
    While,
    inside,
    scalar_of,
)
from .writer import FIELDS, INDENT, PRIMARY, words

TRUE = Literal("bool", "true")
# The parameter of functions with loops of their own length: for which normals they are called.
LANES = "lanes"


@dataclass
class _Loop:
    """A loop that is being written.

    Attributes:
        looping: the variable that says for which normals it goes on.
        going: the one that says for which of them this turn does; the same where nothing continues.
    """

    looping: str
    going: str

    @property
    def both(self) -> tuple[str, ...]:
        """The variables, each once: what leaves the loop leaves its turn."""
        return tuple(dict.fromkeys((self.looping, self.going)))


@dataclass
class _State:
    """Where in a function the writer is.

    Attributes:
        masks: of the conditions around, one in the other, the variable that says for which normals all of them hold;
            the first is that of the function itself, empty where it is called for all.
        depth: of each variable, how many conditions it was declared within.
        loops: those around.
        live: the variable that says for which normals the function has not returned; empty where it has for none.
        result: the variable of what it returns for the others.
    """

    masks: list[str] = field(default_factory=lambda: [""])
    depth: dict[str, int] = field(default_factory=dict)
    loops: list[_Loop] = field(default_factory=list)
    live: str = ""
    result: str = ""


class NumpyWriter(NumpyValues):
    """Python with NumPy 2."""

    reserved = words(
        "as and assert async await break class continue def del elif else except finally for from global if import in "
        "is lambda nonlocal not or pass raise return try while with yield True False None match case type np Path "
        "range print zip len enumerate NamedTuple"
    )

    def __init__(self, prefix: str, texels: Mapping[str, Texels], stem: str = ""):
        super().__init__(prefix, texels, stem)
        self._state = _State()

    # The file.

    def _program(self, program: Program) -> str:
        everything = (*program.constants, *program.tables, *program.functions)
        self._taken |= {*HELPERS, LANES, *(self._own(one.name) for one in everything)}
        for function in program.functions:
            if _has_a_loop_of_its_own(function, self._laned):
                self._laned.add(function.name)
        constants = [self._constant(each) for each in program.constants]
        functions = [self._function(each) for each in program.functions]
        tables = [self._table(each) for each in sorted(program.tables, key=lambda table: table.name)]
        head = ["from pathlib import Path"] * bool(tables) + ["from typing import NamedTuple"] * bool(program.structs)
        head += [""] * bool(head) + ["import numpy as np"]
        structs = [*map(self._struct, program.structs), *self._choosing_texts()]
        helpers = [HELPERS[name] for name in needed(self._helpers)]
        values = ["\n".join([*tables, *constants])] if tables or constants else []
        return "\n\n\n".join(["\n".join(head), *helpers, *structs, *values, *functions]) + "\n"

    def _table(self, table: Table) -> str:
        name, texels = self._own(table.name), self._texels[table.name]
        file = f"{self._stem}_{table.name.removeprefix(f'{self._prefix}_')}.npy"
        size = f"shape ({texels.height}, {texels.width}, {texels.channels})"
        scale = " / np.float32(255.0)" if texels.is_bytes else ""
        said = f"# {size}, {'multiples of 1/255 as uint8' if texels.is_bytes else 'float32'}."
        return f'{said}\n{name} = np.load(Path(__file__).with_name("{file}")){scale}'

    def _struct(self, struct: Struct) -> str:
        fields = self._fields(struct)
        shapes = "; ".join(f"{name}: {self._shape_text(kind)}" for name, kind in fields.items())
        names = "".join(f"\n{INDENT}{name}: np.ndarray" for name in fields)
        return f'class {struct.name}(NamedTuple):\n{INDENT}"""{shapes}."""\n{names}'

    def _field(self, name: str) -> str:
        # A field of a NamedTuple begins with no underscore.
        return super()._field(f"field{name}" if name.startswith("_") else name)

    def _choosing_texts(self) -> list[str]:
        """The functions that choose between structures, and those between structures in them."""
        found: dict[str, str] = {}
        while left := sorted(self._chosen - found.keys()):
            found |= {kind: self._choosing_text(kind) for kind in left}
        return list(found.values())

    def _choosing_text(self, kind: str) -> str:
        """The function that takes one structure where something holds, and another one elsewhere."""
        fields = self._fields(self._structs[kind]).items()
        parts = [
            self._where_text(broad("holds", inner), inner, f"chosen.{name}", f"other.{name}") for name, inner in fields
        ]
        said = '"""One where something holds, and the other elsewhere."""'
        return f"def _chosen_{kind}(holds, chosen, other):\n{INDENT}{said}\n{INDENT}return {kind}({', '.join(parts)})"

    def _shape_text(self, kind: str) -> str:
        return kind if kind in self._structs else shape_text(kind)

    def _as_text(self, name: str, kind: str) -> str:
        """What others give, as arrays of its type."""
        if kind not in self._structs:
            return f"np.asarray({name}, {TYPES[scalar_of(kind)]})"
        kinds = self._structs[kind].kinds.values()
        return f"{kind}({', '.join(self._as_text(f'{name}[{at}]', inner) for at, inner in enumerate(kinds))})"

    def _global_text(self, constant: Declare) -> str:
        return f"{self._own(constant.name)} = {self._value_text(constant)}"

    # Functions.

    def _function(self, function: Function) -> str:
        masks = [LANES if function.name in self._laned else ""]
        self._state = _State(masks, {p.name: 0 for p in function.parameters})
        return super()._function(function).rstrip("\n")

    def _definition_text(self, signature: str, body: str) -> str:
        return f"{signature}\n{body}"

    def _signature(self, function: Function) -> str:
        names = [self._name(p.name) for p in function.parameters]
        names += [f"{LANES}=np.bool_(True)"] * (function.name in self._laned)
        return f"def {self._own(function.name)}({', '.join(names)}):"

    def _body(self, function: Function) -> str:
        body = _with_choices(function.body)
        public = [f"{INDENT}{line}\n" for line in self._opening(function)]
        returns = list(_returns(body, is_in_loop=False))
        if any(is_in_loop for _, is_in_loop in returns):
            self._state.live, self._state.result = self._unused("live"), self._unused("result")
            public += [f"{INDENT}{self._state.live} = np.bool_(True)\n"]
            public += [f"{INDENT}{self._state.result} = {self._zero_text(function.kind)}\n"]
        text = "".join(public) + self._statements(body, INDENT)
        if not isinstance(body[-1] if body else None, Return):
            text += f"{INDENT}return {self._state.result or None}\n"
        return text

    def _opening(self, function: Function) -> Iterator[str]:
        """What a function that others call begins with."""
        if function.name not in self._public:
            return
        shapes = [f"{p.name}: {self._shape_text(p.kind)}" for p in function.parameters]
        yield f'"""{self._shape_text(function.kind)}, of {"; ".join(shapes)}."""'
        for p in function.parameters:
            yield f"{self._name(p.name)} = {self._as_text(self._name(p.name), p.kind)}"

    def _comments(self, statement: Statement, indent: str) -> str:
        above = "".join(f"{indent}# {line}".rstrip() + "\n" for line in statement.above)
        is_public = isinstance(statement, Function) and statement.name in self._public
        return above + '@np.errstate(all="ignore")\n' * is_public

    # Statements.

    def _statements(self, statements: list[Statement], indent: str) -> str:
        # Nothing is done behind what leaves.
        last = next((at for at, one in enumerate(statements) if _ends(one)), len(statements))
        return super()._statements(statements[: last + 1], indent)

    def _statement(self, statement: Statement, indent: str) -> str:
        behind = f"  # {statement.behind}" if statement.behind else ""
        above = self._comments(statement, indent)
        match statement:
            case Block(body):
                return above + self._statements(body, indent)
            case For() | While():
                return above + self._loop(statement, indent)
            case If():
                return above + self._if(statement, indent)
            case Return(value) if value is not None:
                lines = self._return_lines(value)
            case Leave(word):
                lines = self._leave_lines(word)
            case _:
                lines = [self._simple_text(statement)]
        lines[-1] += behind
        return above + "".join(f"{indent}{line}\n" for line in lines)

    def _simple_text(self, statement: Statement) -> str:
        match statement:
            case Declare():
                self._state.depth[statement.name] = len(self._state.masks) - 1
                return f"{self._name(statement.name)} = {self._value_text(statement)}"
            case Assign(target, mark, value):
                made = value if mark == "=" else Binary(target.kind, mark[:-1], target, value)
                return self._anew(target, self._typed(made))
        raise TranslationError(f"a {type(statement).__name__} is not written in Python")

    def _value_text(self, declared: Declare) -> str:
        return self._zero_text(declared.kind) if declared.value is None else self._typed(declared.value)

    def _anew(self, target: Expression, text: str) -> str:
        """A variable, or a part of one, made anew: arrays are never changed in place."""
        match target:
            case Name(kind, name):
                return f"{self._name(name)} = {self._kept_text(kind, name, text)}"
            case Swizzle(_, inner, names):
                places = "".join(f"{FIELDS.index(name)}, " for name in names)
                places = places.strip() if len(names) == 1 else places.removesuffix(", ")
                return self._anew(inner, f"{self._helper_name('_replaced')}({self._text(inner)}, ({places}), {text})")
            case Member(_, inner, name):
                return self._anew(inner, f"{self._text(inner, PRIMARY)}._replace({self._field(name)}={text})")
            case Index(kind, inner, at):
                axes = f", {len(inner_shape(kind))}" if inner_shape(kind) else ""
                put = f"{self._helper_name('_put')}({self._text(inner)}, {self._text(at)}, {text}{axes})"
                return self._anew(inner, put)
        raise TranslationError(f"a {type(target).__name__} of {target.kind} cannot be assigned to in Python")

    def _kept_text(self, kind: str, name: str, text: str) -> str:
        """A new value, for those normals alone that the conditions since the variable's declaration hold for."""
        mask = self._state.masks[-1]
        if self._state.depth.get(name) == len(self._state.masks) - 1 or not mask:
            return text
        return self._where_text(broad(mask, kind), kind, text, self._name(name))

    def _if(self, statement: If, indent: str) -> str:
        outer = self._state.masks[-1]
        least = BINDING["&"] if outer else 0
        condition = self._typed(statement.condition, least)
        chosen = self._unused("chosen")
        lines = [f"{chosen} = {outer} & {condition}" if outer else f"{chosen} = {condition}"]
        other = self._unused("other") if statement.other else ""
        lines += [f"{other} = {outer} & ~{chosen}" if outer else f"{other} = ~{chosen}"] if other else []
        text = "".join(f"{indent}{line}\n" for line in lines)
        text += self._within(chosen, statement.chosen, indent)
        text += self._within(other, statement.other, indent) if other else ""
        return text + (self._without_those_that_left(indent) if _leaves(statement) else "")

    def _within(self, mask: str, body: list[Statement], indent: str) -> str:
        """Statements under one more condition."""
        self._state.masks.append(mask)
        text = self._statements(body, indent)
        self._state.masks.pop()
        return text

    def _without_those_that_left(self, indent: str) -> str:
        """After what may leave a loop: the conditions around hold no longer for those that did."""
        mask = self._state.masks[-1]
        if not self._state.loops or mask == (going := self._state.loops[-1].going):
            return ""
        return f"{indent}{mask} = {mask} & {going}\n"

    def _leave_lines(self, word: str) -> list[str]:
        loop, mask = self._state.loops[-1], self._state.masks[-1]
        return [f"{name} = {name} & ~{mask}" for name in (loop.both if word == "break" else (loop.going,))]

    def _return_lines(self, value: Expression) -> list[str]:
        state, mask = self._state, self._state.masks[-1]
        text = self._typed(value)
        if len(state.masks) == 1:
            chosen = self._where_text(broad(state.live, value.kind), value.kind, text, state.result)
            return [f"return {chosen if state.live else text}"]
        if not state.live:
            state.live, state.result = self._unused("live"), self._unused("result")
            return [f"{state.result} = {text}", f"{state.live} = ~{mask}"]
        taken = self._unused("taken")
        lines = [f"{taken} = {mask} & {state.live}"]
        chosen = self._where_text(broad(taken, value.kind), value.kind, text, state.result)
        lines += [f"{state.result} = {chosen}"]
        ended = [state.live, *(name for loop in state.loops[-1:] for name in loop.both)]
        return lines + [f"{name} = {name} & ~{taken}" for name in ended]

    def _loop(self, loop: For | While, indent: str) -> str:
        if isinstance(loop, For) and counted(loop) and not _leaves(loop.body):
            return self._counting(loop, indent)
        start, step = (loop.start, loop.step) if isinstance(loop, For) else (None, None)
        text = self._statement(start, indent) if start else ""
        looping = self._unused("looping")
        going = self._unused("going") if _leaves(loop.body, ("continue",)) else looping
        conditions = [*self._around(), *self._unless_true(loop.condition)]
        text += f"{indent}{looping} = {self._and_text(conditions)}\n"
        text += f"{indent}while np.any({looping}):\n"
        inner = indent + INDENT
        text += f"{inner}{going} = {looping}\n" if going != looping else ""
        self._state.loops.append(_Loop(looping, going))
        text += self._within(going, loop.body, inner)
        text += self._within(looping, [step], inner) if step else ""
        self._state.loops.pop()
        if _is_condition(loop.condition):
            with self._where(looping):
                again = self._and_text([looping, *self._unless_true(loop.condition)])
            text += f"{inner}{looping} = {again}\n"
        return text + self._after_a_loop_that_returns(loop, indent)

    def _after_a_loop_that_returns(self, loop: For | While, indent: str) -> str:
        if not self._state.loops or not any(isinstance(node, Return) for node in inside(loop.body)):
            return ""
        text = "".join(f"{indent}{name} = {name} & {self._state.live}\n" for name in self._state.loops[-1].both)
        return text + self._without_those_that_left(indent)

    def _counting(self, loop: For, indent: str) -> str:
        """A loop that counts the same for all normals."""
        start, condition, step = loop.start, loop.condition, loop.step
        assert isinstance(start, Declare) and isinstance(condition, Binary) and isinstance(step, Assign)
        self._state.depth[start.name] = len(self._state.masks) - 1
        by = self._text(step.value)
        end = self._text(condition.right) + (" + 1" if condition.operator == "<=" else "")
        counts = (
            f"np.arange({self._value_text(start)}, {end}{'' if by == '1' else f', {by}'}, dtype={TYPES[start.kind]})"
        )
        body = self._statements(loop.body, indent + INDENT) or f"{indent}{INDENT}pass\n"
        return f"{indent}for {self._name(start.name)} in {counts}:\n{body}"

    def _and_text(self, conditions: list[str]) -> str:
        return " & ".join(conditions) or "np.bool_(True)"

    def _around(self) -> list[str]:
        """The variables that say for which normals a statement is done."""
        return [name for name in (self._state.masks[-1], self._state.live) if name]

    def _unless_true(self, condition: Expression) -> list[str]:
        """A condition's text in a list; an empty list where the condition is `true` itself."""
        return [self._typed(condition, BINDING["&"])] if _is_condition(condition) else []

    def _name(self, name: str) -> str:
        if name in self._state.depth or name in self._renamed:
            return super()._name(name)
        return self._own(name) if name in self._taken else name


def _has_a_loop_of_its_own(function: Function, such: set[str]) -> bool:
    """Whether the length of a loop depends on the normal, here or in a function that is called; `such` have one."""
    for node in inside(function.body):
        if isinstance(node, While) or (isinstance(node, For) and (not counted(node) or _leaves(node.body))):
            return True
        if isinstance(node, Call) and node.is_own and node.name in such:
            return True
    return False


def _is_condition(condition: Expression) -> bool:
    """Whether it is anything but the literal `true`."""
    return condition != TRUE


def _leaves(node: object, leaving: tuple[str, ...] = ("break", "continue")) -> bool:
    """Whether statements may leave the loop around them: a loop within has words of its own, but returns leave all."""
    if isinstance(node, list):
        return any(_leaves(one, leaving) for one in node)
    match node:
        case Leave(word):
            return word in leaving
        case Return():
            return "break" in leaving
        case For() | While():
            return "break" in leaving and any(isinstance(one, Return) for one in inside(node.body))
        case If(_, chosen, other):
            return _leaves(chosen, leaving) or _leaves(other, leaving)
        case Block(body):
            return _leaves(body, leaving)
    return False


def _ends(statement: Statement) -> bool:
    """Whether nothing that stands behind a statement is done."""
    if isinstance(statement, Block):
        return any(map(_ends, statement.body))
    return isinstance(statement, Leave | Return)


def _returns(statements: list[Statement], is_in_loop: bool) -> Iterator[tuple[Return, bool]]:
    """Each return, and whether it stands in a loop."""
    for statement in statements:
        match statement:
            case Return():
                yield statement, is_in_loop
            case If(_, chosen, other):
                yield from _returns([*chosen, *other], is_in_loop)
            case Block(body):
                yield from _returns(body, is_in_loop)
            case For() | While():
                yield from _returns(statement.body, True)


def _with_choices(statements: list[Statement]) -> list[Statement]:
    """if (c) return a; return b; as return c ? a : b."""
    match statements:
        case [
            *first,
            If(condition, [Return(Expression() as chosen)], []) as test,
            Return(Expression() as other) as last,
        ]:
            made = Return(Choice(chosen.kind, condition, chosen, other), above=[*test.above, *last.above])
            return _with_choices([*first, made])
        case [*first, If(condition, [Return(Expression() as chosen)], [Return(Expression() as other)]) as test]:
            made = Return(Choice(chosen.kind, condition, chosen, other), above=test.above)
            return _with_choices([*first, made])
    return statements
