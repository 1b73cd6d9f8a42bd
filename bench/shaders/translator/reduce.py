"""The reduction of a program to the parts that some of its functions need, under names that do not collide."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from dataclasses import fields, is_dataclass
from itertools import count
from types import MappingProxyType
from typing import Any

from .tokens import with_a_point
from .tree import (
    Assign,
    Binary,
    Call,
    Declare,
    Function,
    Literal,
    Member,
    Name,
    Program,
    Struct,
    TexelTable,
    TranslationError,
    inside,
    plain_name,
    size_of,
)

# Parameters that functions have for others' sake.
SETTINGS = ("view", "range", "near", "far", "least")
# What an encoding's own functions are called where others go around them: no reader takes them for another pair.
INNER = {"encode": "own_code", "decode": "own_value"}
# Whoever calls one of them with a setting calls the other with it.
PAIR = ("encode", "decode")
ONE = "1.0"


def reduced(
    program: Program,
    roots: Mapping[str, str],
    prefix: str,
    own: str,
    bound: Mapping[str, float] = MappingProxyType({}),
    pair: tuple[str, str] = PAIR,
) -> Program:
    """Return a program reduced to some of its functions and the parts that they need.

    Args:
        program: the whole program, which is changed.
        roots: the new names of these functions, by their present names.
        prefix: the prefix of every name.
        own: the prefix of an encoding's own functions, which `prefix` replaces.
        bound: the values of those settings of the encoder and the decoder that become constants.
        pair: the new names of functions that are called with the same settings.

    Raises:
        TranslationError: one of these functions could not be read.
    """
    keys = {plain_name(f): f.name for f in program.functions}
    if unread := next((name for name in roots if name not in keys), ""):
        raise TranslationError(f"function {unread} cannot be read")
    kept = _reached_names(program, [keys[name] for name in roots])
    functions = [f for f in program.functions if f.name in kept]
    _keep_changes_inside(functions)
    both = {keys[name] for name, called in roots.items() if called in pair}
    for setting, value in bound.items():
        for function in (candidate for candidate in functions if candidate.name in both):
            _bind(function, setting, value)
    for setting in SETTINGS:
        _leave_out(setting, functions, both)
    used = {node.name for f in functions for node in inside(f.body) if isinstance(node, Name)}
    constants = _used_constants(program.constants, used)
    _rename(functions, {keys[name]: f"{prefix}_{called}" for name, called in roots.items()}, prefix, own)
    tables = [table for table in program.tables if table.name in used]
    names = {table.name: table_name(table.name, prefix, own) for table in tables}
    _replace(functions, names)
    tables = [TexelTable(name) for name in names.values()]
    _rename_constants(constants, functions, prefix, own)
    return Program(constants, tables, functions, _named_structs(program, constants, functions, prefix, own))


def _named_structs(
    program: Program, constants: list[Declare], functions: list[Function], prefix: str, own: str
) -> list[Struct]:
    """Return the structures that constants and functions need, renamed everywhere to names with the prefix."""
    kinds = {node.kind.partition("[")[0] for node in inside([constants, functions]) if hasattr(node, "kind")}
    for struct in reversed(program.structs):
        kinds |= set(struct.kinds.values()) if struct.name in kinds else set()
    kept = [struct for struct in program.structs if struct.name in kinds]
    taken = [function.name for function in functions]
    _rename_structs(
        Program(constants, [], functions, kept),
        {struct.name: _free_name(f"{prefix}_{_without(own, struct.name).lower()}", taken) for struct in kept},
        {},
    )
    return kept


def _reached_names(program: Program, names: list[str]) -> set[str]:
    by_name = {f.name: f for f in program.functions}
    reached, left = set(names), list(names)
    while left:
        function = by_name[left.pop()]
        if function.unread:
            raise function.unread
        for node in inside(function.body):
            if isinstance(node, Call) and node.is_own and node.name not in reached:
                reached.add(node.name)
                left.append(node.name)
    return reached


def _keep_changes_inside(functions: list[Function]) -> None:
    """Make inout parameters plain if no caller uses their changed values.

    Translators from SPIR-V turn every parameter that is assigned to into an inout parameter, and pass a separate
    variable, which is assigned before each call and not read after it.
    """
    by_name = {f.name: f for f in functions}
    seen: set[tuple[str, int]] = set()
    for caller in functions:
        nodes = list(inside(caller.body))
        begun = Counter(n.name for n in nodes if isinstance(n, Declare) and n.value is not None)
        written = Counter(
            n.target.name for n in nodes if isinstance(n, Assign) and isinstance(n.target, Name) and n.operator == "="
        )
        begun += written
        named = Counter(n.name for n in nodes if isinstance(n, Name))
        calls = [n for n in nodes if isinstance(n, Call) and n.name in by_name]
        given = Counter(a.name for call in calls for a in call.arguments if isinstance(a, Name))
        for call in calls:
            for index, argument in enumerate(call.arguments):
                name = getattr(argument, "name", "")
                is_own = named[name] == given[name] + written[name] and begun[name] >= given[name] > 0
                if not is_own:
                    seen.add((call.name, index))
    for function in functions:
        for index, parameter in enumerate(function.parameters):
            parameter.is_changed = parameter.is_changed and (function.name, index) in seen


def _bind(function: Function, setting: str, value: float) -> None:
    """Replace a function's parameter, which is never assigned to, by a number; ignore a missing parameter."""
    if setting not in _parameter_names(function):
        return
    function.parameters = [parameter for parameter in function.parameters if parameter.name != setting]
    function.body = _with_number(function.body, setting, with_a_point(f"{value!r}"))


def _with_number(node: Any, name: str, text: str) -> Any:
    """Replace each use of a name in a part of a tree by a number, and return the part; x * 1 and x / 1 become x."""
    if isinstance(node, Name) and node.name == name:
        return Literal("float", text)
    if isinstance(node, list):
        return [_with_number(child, name, text) for child in node]
    if not is_dataclass(node):
        return node
    for field in fields(node):
        setattr(node, field.name, _with_number(getattr(node, field.name), name, text))
    match node:
        case Binary(_, "*" | "/", left, Literal(_, factor)) if factor == ONE:
            return left
    return node


def _leave_out(setting: str, functions: list[Function], pair: set[str]) -> None:
    """Remove a setting from functions that do not read it, and from their calls; from both of the pair or neither."""
    indices = {f.name: _parameter_names(f).index(setting) for f in functions if setting in _parameter_names(f)}
    unread: set[str] = set()
    for function in functions:
        if function.name in indices and not _reads(setting, function, indices, unread):
            unread.add(function.name)
    if not pair <= unread:
        unread -= pair
    for function in functions:
        for call in (node for node in inside(function.body) if isinstance(node, Call) and node.name in unread):
            del call.arguments[indices[call.name]]
        if function.name in unread:
            del function.parameters[indices[function.name]]


def _parameter_names(function: Function) -> list[str]:
    return [p.name for p in function.parameters]


def _reads(setting: str, function: Function, indices: Mapping[str, int], unread: set[str]) -> bool:
    """Whether a function uses a setting other than by passing it to functions that do not read it."""
    calls = (node for node in inside(function.body) if isinstance(node, Call) and node.name in unread)
    handed_on = {id(node) for call in calls for node in inside(call.arguments[indices[call.name]])}
    return any(isinstance(n, Name) and n.name == setting and id(n) not in handed_on for n in inside(function.body))


def _used_constants(constants: list[Declare], used: set[str]) -> list[Declare]:
    used_constants: list[Declare] = []
    for constant in reversed(constants):
        if constant.name in used:
            used_constants.insert(0, constant)
            used |= {node.name for node in inside(constant.value) if isinstance(node, Name)}
    return used_constants


def _rename(functions: list[Function], names: dict[str, str], prefix: str, own: str) -> None:
    plain = [plain_name(f) for f in functions if f.name not in names]
    for function in functions:
        if function.name not in names:
            short = plain_name(function)
            size = size_of(function.parameters[0].kind) if plain.count(short) > 1 else 0
            mine = _without(own, short)
            mine = INNER.get(mine, mine) if f"{prefix}_{mine}" in names.values() else mine
            names[function.name] = _free_name(f"{prefix}_{mine}{size or ''}", names.values())
    for function in functions:
        for call in (node for node in inside(function.body) if isinstance(node, Call) and node.is_own):
            call.name = names[call.name]
        function.name = names[function.name]


def table_name(name: str, prefix: str, own: str) -> str:
    """Return the new name of a lookup table: the prefix, and its name without the prefix `own`."""
    return f"{prefix}_{_without(own, name)}"


def _without(own: str, name: str) -> str:
    """Return a name without the prefix `own` of an encoding's functions, unless that leaves nothing."""
    return re.sub(f"^{own}_(?=.)", "", name)


def _free_name(name: str, taken: Collection[str]) -> str:
    """Return a name, with a number appended if it is taken."""
    ways = (name, *(f"{name}_{number}" for number in range(2, len(taken) + 3)))
    return next(way for way in ways if way not in taken)


def _shorter_name(own: str, name: str) -> str:
    """Return a constant's name without leading words that are the last words of the encoding's name `own`: COUNT for
    FIBONACCI_COUNT of spherical_fibonacci."""
    words = own.upper().split("_")
    for first in range(len(words)):
        begin = "_".join(words[first:]) + "_"
        if name.upper().startswith(begin) and len(name) > len(begin):
            return name[len(begin) :]
    return name


def _rename_constants(constants: list[Declare], functions: list[Function], prefix: str, own: str) -> None:
    short = {constant.name: _shorter_name(prefix, _shorter_name(own, constant.name)) for constant in constants}
    taken = list(short.values())
    names: dict[str, str] = {}
    others = {function.name for function in functions}
    for name, new in short.items():
        plain = f"{prefix.upper()}_{new if taken.count(new) == 1 else name}"
        names[name] = _free_name(plain, others | set(names.values()))
    _replace(functions, names)
    for constant in constants:
        _replace_in(constant.value, names)
        constant.name = names[constant.name]


def _replace(functions: list[Function], names: Mapping[str, str]) -> None:
    """Rename globals in functions, from old names to new ones, except where a variable has the old name."""
    for function in functions:
        own = {*_parameter_names(function), *(node.name for node in inside(function.body) if isinstance(node, Declare))}
        _replace_in(function.body, {old: new for old, new in names.items() if old not in own})


def _replace_in(nodes: object, names: Mapping[str, str]) -> None:
    # A node may stand in several places.
    for node in {id(node): node for node in inside(nodes) if isinstance(node, Name)}.values():
        node.name = names.get(node.name, node.name)


def numbered(program: Program, word: str) -> None:
    """Rename everything that has a name in a program, in place, to this word and a number."""
    numbers = count()
    _number_structs(program, word, numbers)
    outside = {definition.name: f"{word}_{next(numbers)}" for definition in [*program.constants, *program.functions]}
    for function in program.functions:
        for call in (node for node in inside(function.body) if isinstance(node, Call) and node.is_own):
            call.name = outside[call.name]
        function.name = outside[function.name]
    _replace(program.functions, outside)
    for constant in program.constants:
        _replace_in(constant.value, outside)
        constant.name = outside[constant.name]
    for function in program.functions:
        declared = [node for node in inside(function.body) if isinstance(node, Declare)]
        own = {
            name: f"{word}_{next(numbers)}" for name in [*_parameter_names(function), *(node.name for node in declared)]
        }
        _replace_in(function.body, own)
        for variable in (*function.parameters, *declared):
            variable.name = own[variable.name]


def _number_structs(program: Program, word: str, numbers: Iterator[int]) -> None:
    names = {struct.name: f"{word}_{next(numbers)}" for struct in program.structs}
    fields = {(struct.name, name): f"{word}_{next(numbers)}" for struct in program.structs for name in struct.kinds}
    _rename_structs(program, names, fields)


def _rename_structs(program: Program, names: Mapping[str, str], fields: Mapping[tuple[str, str], str]) -> None:
    """Rename structures and some of their fields throughout a program, in place.

    Args:
        names: the structures' new names, by old name.
        fields: the fields' new names, by the old names of the structure and the field."""

    def named(kind: str) -> str:
        plain, mark, length = kind.partition("[")
        return names.get(plain, plain) + mark + length

    # A node may stand in several places.
    nodes = {id(node): node for node in inside([program.constants, program.functions])}.values()
    for node in nodes:
        if isinstance(node, Member):
            node.field = fields.get((node.value.kind, node.field), node.field)
    for node in nodes:
        if hasattr(node, "kind"):
            node.kind = named(node.kind)
    for struct in program.structs:
        kinds = struct.kinds.items()
        struct.kinds = {fields.get((struct.name, name), name): named(kind) for name, kind in kinds}
        struct.name = names[struct.name]
