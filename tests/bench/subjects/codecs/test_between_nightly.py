"""Findings that name the missing step between two functions, and no findings for encoders that round correctly."""

import pytest
import test_between_slow
from test_between_slow import ROUNDED

pytestmark = pytest.mark.usefixtures("gl")


@pytest.mark.parametrize("bits", [10, 16])
@pytest.mark.parametrize("rounds", ROUNDED)
def test_an_encoder_that_rounds_correctly_to_other_bits_has_no_findings(tmp_path, rounds, bits):
    test_between_slow.test_an_encoder_that_rounds_correctly_has_no_findings(tmp_path, rounds, bits)
