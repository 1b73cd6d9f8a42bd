"""Fingerprints that distinguish encodings with the same name: hashes of everything that determines their figures."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .files import MOST_TEXT, file_bytes

if TYPE_CHECKING:
    from jaxtyping import Shaped

DIGITS = 16
_INCLUDE = re.compile(rb'^\s*#include\s+"([^"]+)"', re.M)


def fingerprint(glsl: Path, values: object, tables: Mapping[str, Any], twin: Path | None = None) -> str:
    """Return a hash, in hex digits, of a GLSL file and its includes, its Python twin if it exists, values and tables.

    Args:
        twin: a Python file that may be missing; None for the file next to the GLSL file.

    Raises:
        OSError: a file cannot be read.
    """
    twin = twin or glsl.with_suffix(".py")
    files = (*_texts(glsl.resolve(), set()), *([file_bytes(twin, MOST_TEXT)] if twin.exists() else []))
    arrays = (
        part for name, table in sorted(tables.items()) for part in _array_parts(name, np.ascontiguousarray(table))
    )
    return _hash_digits((*files, repr(values).encode(), *arrays))


def _texts(path: Path, seen: set[Path]) -> Iterator[bytes]:
    """Yield the contents of a shader file and of every file that it includes, directly or not, each once; add their
    paths to `seen`, and skip included files that are already in it."""
    seen.add(path)
    yield (text := file_bytes(path, MOST_TEXT))
    for name in _INCLUDE.findall(text):
        if (target := (path.parent / name.decode()).resolve()) not in seen:
            yield from _texts(target, seen)


def _array_parts(name: str, array: Shaped[np.ndarray, "*shape"]) -> tuple[bytes, bytes]:
    return f"{name} {array.dtype} {array.shape}".encode(), array.tobytes()


def _hash_digits(parts: Iterable[bytes]) -> str:
    # Each part is hashed first, so that nothing can move from one to the next.
    return hashlib.sha256(b"".join(hashlib.sha256(part).digest() for part in parts)).hexdigest()[:DIGITS]
