"""Text that a page holds packed."""

from __future__ import annotations

import base64
import gzip


def packed(text: str) -> str:
    """Text as base64 of gzip, the same each time."""
    return base64.b64encode(gzip.compress(text.encode(), mtime=0)).decode("ascii")
