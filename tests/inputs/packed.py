"""Packed texts in a page."""

import base64
import re
import zlib


def packed_text(page: str, key: str) -> str:
    """Return the text of an element of a page, by its id."""
    match = re.search(rf'id="{key}">([^<]*)</script>', page)
    assert match, key
    return zlib.decompress(base64.b64decode(match[1]), wbits=-zlib.MAX_WBITS).decode()
