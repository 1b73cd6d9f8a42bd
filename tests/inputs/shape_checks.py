"""A process of its own for tests, in which every call checks the shapes in annotations.

Modules import the names of these annotations only for type checkers; here the names are builtins.
"""

import ast
import builtins
from collections.abc import Callable, Iterator
from pathlib import Path

import jaxtyping
import numpy as np
import pytest
from beartype import beartype

ROOT = Path(__file__).parents[2]
FOLDERS = ("bench/measures/metrics", "encodings/codecs", "encodings/shared", "encodings/storages")
KINDS = ("Bool", "Float", "Int", "Num", "Shaped", "UInt")
NAMES = {name: getattr(jaxtyping, name) for name in (*KINDS, "Array", "ArrayLike")} | {"np": np}
CALLED: set[str] = set()


def checked(function: Callable) -> Callable:
    """Return a function whose calls beartype checks, but only for shapes: test doubles replace other types."""
    hints, name = function.__annotations__, f"{function.__module__}.{function.__qualname__}"
    shapes = {word: hint for word, hint in hints.items() if "jaxtyping." in repr(hint)}
    if not shapes:
        return function
    function.__annotations__ = shapes
    strict = beartype(function)

    def called(*arguments, **named):
        CALLED.add(name)
        return strict(*arguments, **named)

    return called


def with_shapes() -> Iterator[str]:
    """Yield the names of the functions with shapes in their annotations, from the sources."""
    for path in (path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py")):
        module = ".".join(("normalbench", *path.relative_to(ROOT).with_suffix("").parts))
        tree = ast.parse(path.read_text())
        owners = {module: tree} | {f"{module}.{cls.name}": cls for cls in tree.body if isinstance(cls, ast.ClassDef)}
        for owner, where in owners.items():
            functions = (node for node in where.body if isinstance(node, ast.FunctionDef))
            yield from (f"{owner}.{function.name}" for function in functions if says_shapes(function))


def says_shapes(function: ast.FunctionDef) -> bool:
    """Whether an annotation of a function contains a shape."""
    hints = [argument.annotation for argument in function.args.args] + [function.returns]
    names = (node.value for hint in hints if hint for node in ast.walk(hint) if isinstance(node, ast.Subscript))
    return any(isinstance(name, ast.Name) and name.id in KINDS for name in names)


def main(*arguments: str) -> int:
    """Return pytest's status, or 1 if it is 0 and some functions with shapes were never checked; print these."""
    vars(builtins).update(NAMES)
    modules = [f"normalbench.{folder.replace('/', '.')}" for folder in FOLDERS]
    with jaxtyping.install_import_hook(modules, "shape_checks.checked"):
        # jaxtyping is a plugin of pytest too, which was imported before pytest could look at its assertions.
        status = pytest.main([*arguments, "-W", "ignore::pytest.PytestAssertRewriteWarning"])
    unseen = [] if status else sorted({*with_shapes()} - CALLED)
    print(*(f"{name}: its shapes were not checked" for name in unseen), sep="\n")
    return status or len(unseen) > 0
