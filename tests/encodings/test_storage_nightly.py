"""Storage: the emulation and the OpenGL device store the same bits."""

import pytest
import test_storage_slow
from test_storage_slow import DRAWN, params


@pytest.mark.parametrize("storage, rounding", params(DRAWN))
def test_numbers_across_channels_in_any_storage_match_the_emulation(gl, storage, rounding):
    test_storage_slow.test_numbers_across_channels_match_the_emulation(gl, storage, rounding)
