"""Suprema of the catalogue's codecs as the search found them before, each with a key of what it was computed from.

`python -m tests.recorded_suprema` writes suprema.json next to this file.
"""

from __future__ import annotations

import ast
import json
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from ....encodings.catalogue import is_in_catalogue
from ....encodings.codecs.codec import Codec
from ...ground.output.cache import key_of
from .search import Worst, worst_case

FILE = Path(__file__).with_name("suprema.json")
HERE, ENCODINGS = Path(__file__).parent, Path(__file__).parents[3] / "encodings"
# What every supremum depends on, besides the module of its encoding.
SHARED = (
    *(HERE / f"{name}.py" for name in ("search", "cells", "climb", "exact_codec")),
    *(ENCODINGS / f"{name}.py" for name in ("vec", "elementary", "rotation")),
    *(ENCODINGS / "codecs" / f"{name}.py" for name in ("codec", "encoding")),
    *(ENCODINGS / "storages" / f"{name}.py" for name in ("storage", "rounding", "rules")),
)


def supremum(codec: Codec, is_half: bool) -> Worst:
    """Return the largest error over the sphere, or over z >= 0: as it was recorded if it was computed from the same
    sources, else by `worst_case`."""
    known = _kept().get(name_of(codec, is_half))
    if known and is_in_catalogue(codec.encoding) and known["key"] == source_key(codec):
        return Worst(known["angle_deg"], tuple(known["normal"]), known["found_by"], known["moved_deg"])
    return worst_case(codec, is_half)


def name_of(codec: Codec, is_half: bool) -> str:
    """Return what a supremum is recorded by."""
    return f"{codec.name} {'hemisphere' if is_half else 'sphere'}"


def source_key(codec: Codec) -> str:
    """Return a key that differs if the code of anything that decides a supremum does; comments do not count."""
    module = sys.modules[codec.encoding.encode.__module__].__file__ or ""
    return key_of(_shared_code(), _code(Path(module)), codec.name)[:16]


@cache
def _shared_code() -> str:
    return "\n".join(map(_code, SHARED))


@cache
def _code(path: Path) -> str:
    """Return a module without comments and docstrings."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in _documented(tree):
        node.body = node.body[1:] or [ast.Pass()]
    return ast.dump(tree)


def _documented(tree: ast.Module) -> Iterator[Any]:
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef)
    return (node for node in ast.walk(tree) if isinstance(node, kinds) and ast.get_docstring(node, clean=False))


@cache
def _kept() -> dict[str, dict[str, Any]]:
    return json.loads(FILE.read_text(encoding="utf-8"))
