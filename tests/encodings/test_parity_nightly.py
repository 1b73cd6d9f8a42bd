"""Agreement of the two languages: to a few units in the last place before storage, code for code after storage."""

import pytest
import test_parity_slow
from test_parity import EVERY, codecs, swaps
from test_parity_slow import is_unseen


@pytest.mark.parametrize("kind, encoding", EVERY)
def test_every_swap_of_two_arguments_is_noticed(gl, monkeypatch, kind, encoding):
    several = swaps(kind, encoding)
    assert not [what for what, *swap in several if is_unseen(gl, monkeypatch, kind, encoding, *swap)]


@pytest.mark.parametrize("kind, codec", codecs("more_codecs"))
def test_all_codes_are_the_same_after_storage(gl, kind, codec):
    test_parity_slow.test_more_codes_are_the_same_after_storage(gl, kind, codec)
