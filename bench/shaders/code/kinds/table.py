"""The kinds of codes that `code` writes, each in a module next to this one that is named after the kind's word."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .code_kind import CodeKind


def kind_of(codec: Any) -> CodeKind:
    """Return the description of a codec's kind for `code`."""
    return import_module(f".{codec.encoding.kind.word}", __package__).KIND
