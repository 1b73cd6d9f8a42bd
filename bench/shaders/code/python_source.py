"""The Python that functions of the catalogue need, as text for NumPy: themselves and what they call, and no more.

Text is edited in place, so that comments and formulas stay. What asks for the type of a number is decided here: it is
float32.
"""

from __future__ import annotations

import ast
import builtins
import inspect
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from types import FunctionType, ModuleType
from typing import Any, TypeVar

from ....encodings import vec

# Of jax.numpy and of jax.lax what NumPy has not: functions of the head that every file begins with.
STAND_INS: Mapping[str, str] = {"where": "_where", "fori_loop": "_fori_loop"}
ASARRAY = "asarray"
Edit = tuple[int, int, str]


@dataclass
class Gathered:
    """Definitions that are needed, by their names in the order in which they are needed.

    Attributes:
        written: functions that are written otherwise than in their module, by their names there.
    """

    written: dict[str, str] = field(default_factory=dict)
    constants: dict[str, str] = field(default_factory=dict)
    definitions: dict[str, str] = field(default_factory=dict)
    imports: set[str] = field(default_factory=set)
    _begun: set[str] = field(default_factory=set)

    def add(self, function: Callable[..., Any], without: tuple[str, ...] = (), named: str = "") -> str:
        """A function and what it needs; its private name.

        Args:
            without: arguments that are never None.
            named: its name, where that is another one.
        """
        name = named or private(function.__name__)
        if name not in self._begun:
            self._begun.add(name)
            module = sys.modules[function.__module__]
            text = _folded(_stripped(inspect.getsource(function)), without)
            text = self._rewritten(text, module, function.__name__, name)
            self.definitions[name] = text
        return name

    def text(self) -> str:
        """All of it, as a module has it: imports, constants, then what is needed before what needs it."""
        constants = [f"{name} = {value}" for name, value in self.constants.items()]
        return "\n\n\n".join(["\n".join(constants), *self.definitions.values()]).strip("\n")

    def _rewritten(self, text: str, module: ModuleType, own: str, named: str) -> str:
        edits = list(self._edits(text, ast.parse(text), module, own, named))
        return _edited(text, edits)

    def _edits(self, text: str, tree: ast.Module, module: ModuleType, own: str, named: str) -> Iterator[Edit]:
        head = tree.body[0]
        assert isinstance(head, ast.FunctionDef | ast.ClassDef)
        start = text.index(f"{own}", text.index("def " if isinstance(head, ast.FunctionDef) else "class "))
        yield start, start + len(own), named
        local = {arg.arg for arg in ast.walk(tree) if isinstance(arg, ast.arg)}
        local |= {name.id for name in ast.walk(tree) if isinstance(name, ast.Name) and isinstance(name.ctx, ast.Store)}
        local |= {node.name for node in ast.walk(head) if isinstance(node, ast.FunctionDef) and node is not head}
        for node in ast.walk(tree):
            yield from self._edit(text, node, module, local)

    def _edit(self, text: str, node: ast.AST, module: ModuleType, local: set[str]) -> Iterator[Edit]:
        if isinstance(node, ast.Call) and _of_jax(node.func) == ASARRAY and len(node.args) == 1:
            end = _span(text, node)[1]
            yield end - 1, end - 1, ", np.float32"
        if (called := _of_jax(node)) in STAND_INS:
            yield (*_span(text, node), STAND_INS[called or ""])
        elif isinstance(node, ast.Attribute) and called:
            yield (*_span(text, node.value), "np")
        elif isinstance(node, ast.Name) and node.id not in local and isinstance(node.ctx, ast.Load):
            found = self._named(node.id, module)
            if found != node.id:
                yield (*_span(text, node), found)

    def _named(self, name: str, module: ModuleType) -> str:
        """What a global name is called in the file; what it stands for is gathered."""
        if name in ("jnp", "np") or not hasattr(module, name):
            return STAND_INS.get(name, name)
        value = getattr(module, name)
        if name in self.written:
            self.definitions.setdefault(private(name), self.written[name])
            return private(name)
        if isinstance(value, ModuleType):
            self.imports.add(f"import {value.__name__}")
        elif isinstance(value, FunctionType) and value.__module__ == "collections":
            self.imports.add(f"from collections import {name}")
        elif isinstance(value, FunctionType | type) and not hasattr(builtins, name):
            return self.add(value)
        elif isinstance(value, int | float | tuple | str):
            self.constants.setdefault(name, _literal(module, name, value))
        return name


def private(name: str) -> str:
    """The name of a helper."""
    return name if name.startswith("_") else f"_{name}"


def _of_jax(node: ast.AST) -> str | None:
    """The name that an expression such as `jnp.where` takes of jax.numpy; that of a name of STAND_INS is itself."""
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "jnp":
        return node.attr
    return None


def _literal(module: ModuleType, name: str, value: Any) -> str:
    """A constant as its module writes it where that is one line of numbers alone, else its value."""
    nodes = [node for node in ast.parse(inspect.getsource(module)).body if isinstance(node, ast.Assign)]
    found = [node.value for node in nodes if [ast.unparse(target) for target in node.targets] == [name]]
    is_plain = len(found) == 1 and not any(isinstance(part, ast.Name | ast.Call) for part in ast.walk(found[0]))
    return ast.unparse(found[0]) if is_plain else repr(value)


def _stripped(text: str) -> str:
    """A definition without remarks to checkers, annotations of its attributes, and types that stand for several."""
    text = re.sub(r" *# (type:|noqa).*", "", text)
    types = "|".join(name for name, value in vars(vec).items() if isinstance(value, TypeVar))
    text = re.sub(rf"(: | -> )({types}|Any|tuple)\b(?=[,:)=])", "", text)
    text = re.sub(rf" -> ({types}|Any|Array|tuple)(?=:)", "", text)
    text = re.sub(r"(?m)^    \w+: Any\n", "", text)
    text = re.sub(r"(?m)^ +from jax\.lax import .*\n+", "", text)
    return re.sub(r'cast\("\w+", (\w+)\)', r"\1", text).rstrip("\n")


def _folded(text: str, without: tuple[str, ...]) -> str:
    """A definition for float32, with arguments that are not None: what can never happen is left out."""
    while True:
        edit = next(_folds(text, ast.parse(text), without), None)
        if edit is None:
            return text
        text = _edited(text, [edit])


def _folds(text: str, tree: ast.Module, without: tuple[str, ...]) -> Iterator[Edit]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and _decided(node.value, without):
            start, end = _span(text, node)
            yield text.rindex("\n", 0, start), end, ""
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and (said := _decided(node.test, without)):
            assert said == "False" and not node.orelse, "only what never happens is left out"
            start, end = _span(text, node)
            yield text.rindex("\n", 0, start), end, ""
        if isinstance(node, ast.IfExp) and (said := _decided(node.test, without)):
            chosen = node.body if said == "True" else node.orelse
            start, end = _span(text, node)
            yield start, end, text[slice(*_span(text, chosen))]


def _decided(test: ast.expr, without: tuple[str, ...]) -> str:
    """ "True" or "False" where that is known, else nothing."""
    said = ast.unparse(test)
    if re.fullmatch(r"[\w.]+\.dtype [!=]= jnp\.float32", said):
        return str("==" in said)
    if said in {f"{name} is None" for name in without}:
        return "False"
    return "True" if said == "is_short" else ""


def _span(text: str, node: ast.AST) -> tuple[int, int]:
    """Where a node begins and ends in a text of ASCII."""
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    place: Any = node
    return starts[place.lineno - 1] + place.col_offset, starts[place.end_lineno - 1] + place.end_col_offset


def _edited(text: str, edits: list[Edit]) -> str:
    for start, end, new in sorted(set(edits), reverse=True):
        text = text[:start] + new + text[end:]
    return text
