"""Limits on the size of a page: its elements after each view was opened once, scrolled to its end and left."""

import base64
import json
import zlib

from normalbench.reports.page import data


def test_tables_with_very_many_rows_keep_five_digits():
    """With all digits, such tables made up 3.4 of the 6.5 MB of a page with everything."""
    for count, kept in ((data.MANY_ROWS, 1.2345678901234567), (data.MANY_ROWS + 1, 1.2346)):
        text = data.block([{"x": 1.2345678901234567, "n": 2**40 + 1}] * count, ())
        unpacked = json.loads(zlib.decompress(base64.b64decode(text), -zlib.MAX_WBITS))
        numbers, whole = unpacked["columns"]
        assert set(numbers["values"]) == {kept} and set(whole["values"]) == {2**40 + 1}, count
        assert unpacked.get("digits") == (None if count == data.MANY_ROWS else data.DIGITS)
