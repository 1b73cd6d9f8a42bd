"""Figures for the catalogue's codecs that ship with the package, each with a key for the code that computed it.

`python -m tests.recorded` recomputes them.
"""

from __future__ import annotations

import ast
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from threading import Lock
from typing import Any

from ...encodings.catalogue import is_in_catalogue
from ...encodings.codecs.codec import Codec
from ..ground.output.cache import key_of

ROOT = Path(__file__).parents[2]
# What a round trip depends on, besides the module of the encoding.
OF_CODECS = (
    *(f"encodings/{name}.py" for name in ("vec", "elementary", "rotation", "shared/view_frame")),
    *(f"encodings/codecs/{name}.py" for name in ("codec", "encoding")),
    *(f"encodings/storages/{name}.py" for name in ("storage", "rounding", "rules")),
)
# CPython 3.11 counts the depth of all threads' syntax trees together, and may then raise SystemError
# (python/cpython#106905).
_PARSING = Lock()


@dataclass(frozen=True)
class Recorded:
    """A file of recorded figures.

    Attributes:
        file: JSON: figures by name, each with its `key`.
        sources: files that the figures depend on, relative to the package's root, besides OF_CODECS and the
            encoding's module.
    """

    file: Path
    sources: Sequence[str]

    def find(self, name: str, codec: Codec) -> Mapping[str, Any] | None:
        """Return the figures recorded under a name; None if nothing is recorded, the encoding is not the catalogue's,
        or the code that computes the figures has changed since."""
        known = _figures(self.file).get(name)
        return known if known and is_in_catalogue(codec.encoding) and known["key"] == self.key(codec) else None

    def key(self, codec: Codec) -> str:
        """Return a short text that changes with any code that affects the figures; comments are ignored."""
        module = sys.modules[codec.encoding.encode.__module__].__file__ or ""
        shared = "\n".join(code_of(ROOT / path) for path in (*self.sources, *OF_CODECS))
        return key_of(shared, code_of(Path(module)), codec.name)[:16]


@cache
def code_of(path: Path) -> str:
    """Return the dump of a module's syntax tree, without comments and docstrings."""
    with _PARSING:
        tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in _documented(tree):
        node.body = node.body[1:] or [ast.Pass()]
    return ast.dump(tree)


def _documented(tree: ast.Module) -> Iterator[Any]:
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef)
    return (node for node in ast.walk(tree) if isinstance(node, kinds) and ast.get_docstring(node, clean=False))


@cache
def _figures(file: Path) -> Mapping[str, Mapping[str, Any]]:
    return json.loads(file.read_text(encoding="utf-8"))
