"""The two languages agree: before storage to a few units in the last place, after it code for code."""

import pytest
from test_parity import EVERY, swaps
from test_parity_slow import is_unseen


@pytest.mark.parametrize("kind, encoding", EVERY)
def test_swapping_two_arguments_is_noticed_wherever_it_is(gl, monkeypatch, kind, encoding):
    several = swaps(kind, encoding)
    assert not [what for what, *swap in several if is_unseen(gl, monkeypatch, kind, encoding, *swap)]
