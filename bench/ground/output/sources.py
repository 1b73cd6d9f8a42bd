"""The source files that compute rows: rows from different sources may differ."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

ROOMS = ("encodings", "gbuffer", "bench", "reports")


@cache
def sources() -> str:
    """Return a fingerprint of all source files in the package that compute rows: 16 hexadecimal digits."""
    root, digest = Path(__file__).parents[3], hashlib.sha256()
    for room in ROOMS:
        for path in sorted((root / room).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                digest.update(str(path.relative_to(root)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]
