"""What a page holds packed."""

import base64
import re
import zlib


def packed_text(page: str, key: str) -> str:
    """The text of an element of a page, by its id."""
    found = re.search(rf'id="{key}">([^<]*)</script>', page)
    assert found, key
    return zlib.decompress(base64.b64decode(found[1]), wbits=-zlib.MAX_WBITS).decode()
