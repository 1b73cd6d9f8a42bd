"""What an encoder does with numbers between codes: rounding by itself is no mistake, in any bits."""

import pytest
import test_between
from test_between import ROUNDED

pytestmark = pytest.mark.usefixtures("gl")


@pytest.mark.parametrize("bits", [10, 16])
@pytest.mark.parametrize("rounds", ROUNDED)
def test_an_encoder_that_rounds_rightly_to_other_bits_raises_nothing(tmp_path, rounds, bits):
    test_between.test_an_encoder_that_rounds_rightly_raises_nothing(tmp_path, rounds, bits)
