"""Pairs that return half of the sphere: one function loses the other half, or the pair is designed for one half."""

import pytest
import test_halves
import test_halves_slow
from test_halves import HALVES, OPEN
from test_halves_slow import TWO

pytestmark = pytest.mark.usefixtures("gl")
_here = test_halves._here


@pytest.mark.parametrize("half", [half for half in HALVES if half not in TWO])
@pytest.mark.parametrize("what", OPEN)
def test_encoding_finite_only_on_any_one_hemisphere_is_assumed_to_be_for_it(tmp_path, monkeypatch, what, half):
    test_halves_slow.test_encoding_finite_only_on_its_hemisphere_is_assumed_to_be_for_it(
        tmp_path, monkeypatch, what, half
    )
