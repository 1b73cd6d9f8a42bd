"""Encodings with another axis or sign: the same encoding about other axes, in both languages."""

import pytest
import test_turned_slow
from test_turned_slow import EACH


@pytest.mark.parametrize("name, values", EACH, ids=str)
def test_both_languages_turn_every_encoding_alike(gl, name, values):
    test_turned_slow.test_both_languages_turn_encodings_alike(gl, name, values)
