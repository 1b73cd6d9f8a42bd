"""A half of the sphere that does not come back: lost by one of the two functions, or a design for the other half."""

import pytest
import test_halves
import test_halves_slow
from test_halves import HALVES, OPEN
from test_halves_slow import TWO

pytestmark = pytest.mark.usefixtures("gl")
_here = test_halves._here


@pytest.mark.parametrize("half", [half for half in HALVES if half not in TWO])
@pytest.mark.parametrize("what", OPEN)
def test_a_code_that_is_finite_on_any_half_alone_is_taken_for_it(tmp_path, monkeypatch, what, half):
    test_halves_slow.test_a_code_that_is_finite_on_its_half_alone_is_taken_for_it(tmp_path, monkeypatch, what, half)
