"""What the emulation stores is what the GL device stores, bit for bit."""

import pytest
import test_storage_slow
from test_storage_slow import DRAWN, params


@pytest.mark.parametrize("storage, rounding", params(DRAWN))
def test_numbers_across_channels_in_any_storage_come_back_as_the_emulation_says(gl, storage, rounding):
    test_storage_slow.test_numbers_across_channels_come_back_as_the_emulation_says(gl, storage, rounding)
