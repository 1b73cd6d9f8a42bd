"""The two languages agree: before storage to a few units in the last place, after it code for code."""

import pytest
import test_parity_slow
from test_parity import EVERY, codecs, swaps
from test_parity_slow import is_unseen


@pytest.mark.parametrize("kind, encoding", EVERY)
def test_swapping_two_arguments_is_noticed_wherever_it_is(gl, monkeypatch, kind, encoding):
    several = swaps(kind, encoding)
    assert not [what for what, *swap in several if is_unseen(gl, monkeypatch, kind, encoding, *swap)]


@pytest.mark.parametrize("kind, codec", codecs("more_codecs"))
def test_after_storage_all_codes_are_the_same(gl, kind, codec):
    test_parity_slow.test_after_storage_more_codes_are_the_same(gl, kind, codec)
