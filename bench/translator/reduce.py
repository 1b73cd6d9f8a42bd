"""A program reduced to what some of its functions need, under names that collide with nothing."""

from __future__ import annotations

import re
from collections.abc import Mapping

from .tree import Call, Declare, Function, Name, Program, inside, size_of

# A parameter that functions have for others' sake.
VIEW = "view"


def reduced(program: Program, roots: Mapping[str, str], prefix: str, own: str) -> Program:
    """What the functions of some names need, and no more.

    Args:
        program: all of it; it is changed.
        roots: what functions are to be called, by the name that they have.
        prefix: what every name begins with.
        own: what the names of an encoding's own functions begin with, which the prefix stands for.
    """
    keys = {f.name.partition("(")[0]: f.name for f in program.functions}
    kept = _reached(program, [keys[name] for name in roots])
    functions = [f for f in program.functions if f.name in kept]
    _leave_out_views(functions)
    used = {node.name for f in functions for node in inside(f.body) if isinstance(node, Name)}
    constants = _used_constants(program.constants, used)
    _rename(functions, {keys[name]: f"{prefix}_{called}" for name, called in roots.items()}, prefix, own)
    tables = [table for table in program.tables if table.name in used]
    _rename_constants(constants, functions, prefix, own)
    return Program(constants, tables, functions)


def _reached(program: Program, names: list[str]) -> set[str]:
    by_name = {f.name: f for f in program.functions}
    found, left = set(names), list(names)
    while left:
        for node in inside(by_name[left.pop()].body):
            if isinstance(node, Call) and node.is_own and node.name not in found:
                found.add(node.name)
                left.append(node.name)
    return found


def _leave_out_views(functions: list[Function]) -> None:
    """Takes the view from functions that do not read it, those that are called first."""
    without: dict[str, list[int]] = {}
    for function in functions:
        for call in (node for node in inside(function.body) if isinstance(node, Call) and node.is_own):
            call.arguments = [a for at, a in enumerate(call.arguments) if at not in without.get(call.name, [])]
        read = {node.name for node in inside(function.body) if isinstance(node, Name)}
        unread = [at for at, p in enumerate(function.parameters) if p.name == VIEW and VIEW not in read]
        function.parameters = [p for at, p in enumerate(function.parameters) if at not in unread]
        without[function.name] = unread


def _used_constants(constants: list[Declare], used: set[str]) -> list[Declare]:
    found: list[Declare] = []
    for constant in reversed(constants):
        if constant.name in used:
            found.insert(0, constant)
            used |= {node.name for node in inside(constant.value) if isinstance(node, Name)}
    return found


def _rename(functions: list[Function], names: dict[str, str], prefix: str, own: str) -> None:
    plain = [f.name.partition("(")[0] for f in functions if f.name not in names]
    for function in functions:
        if function.name not in names:
            short = function.name.partition("(")[0]
            size = size_of(function.parameters[0].kind) if plain.count(short) > 1 else 0
            mine = re.sub(f"^{own}_(?=.)", "", short)
            mine = f"own_{mine}" if f"{prefix}_{mine}" in names.values() else mine
            names[function.name] = f"{prefix}_{mine}{size or ''}"
    for function in functions:
        for call in (node for node in inside(function.body) if isinstance(node, Call) and node.is_own):
            call.name = names[call.name]
        function.name = names[function.name]


def _without(own: str, name: str) -> str:
    """A constant's name without the words of its encoding's: COUNT for FIBONACCI_COUNT of spherical_fibonacci."""
    words = own.upper().split("_")
    for first in range(len(words)):
        begin = "_".join(words[first:]) + "_"
        if name.upper().startswith(begin) and len(name) > len(begin):
            return name[len(begin) :]
    return name


def _rename_constants(constants: list[Declare], functions: list[Function], prefix: str, own: str) -> None:
    short = {constant.name: _without(own, constant.name) for constant in constants}
    taken = list(short.values())
    names = {name: f"{prefix.upper()}_{new if taken.count(new) == 1 else name}" for name, new in short.items()}
    for function in functions:
        for node in inside(function.body):
            if isinstance(node, Name) and node.name in names:
                node.name = names[node.name]
    for constant in constants:
        for node in inside(constant.value):
            if isinstance(node, Name) and node.name in names:
                node.name = names[node.name]
        constant.name = names[constant.name]
