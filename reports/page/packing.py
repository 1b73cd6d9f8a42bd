"""Text that a page holds packed."""

from __future__ import annotations

import base64
import zlib


def packed(text: str) -> str:
    """Return text as base64 of raw DEFLATE data; the same text always gives the same result."""
    packer = zlib.compressobj(level=9, wbits=-zlib.MAX_WBITS)
    return base64.b64encode(packer.compress(text.encode()) + packer.flush()).decode("ascii")
