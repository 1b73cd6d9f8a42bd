"""The kinds of codes that `code` writes, by the type of their encodings."""

from __future__ import annotations

from typing import Any

from . import curve, depth, frame, light, motion, normal
from .code_kind import CodeKind

CODE_KINDS = tuple(one.KIND for one in (normal, motion, curve, light, depth, frame))


def kind_of(codec: Any) -> CodeKind:
    """What `code` knows of a codec's kind."""
    return next(one for one in CODE_KINDS if isinstance(codec.encoding, one.kind.encoding))
