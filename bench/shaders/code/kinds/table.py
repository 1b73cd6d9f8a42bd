"""The kinds of codes that `code` writes: each a module of its word next to this one."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .code_kind import CodeKind


def kind_of(codec: Any) -> CodeKind:
    """Return what `code` knows of a codec's kind."""
    return import_module(f".{codec.encoding.kind.word}", __package__).KIND
