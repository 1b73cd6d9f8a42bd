"""Motion encodings: rest is exact where it should be, and motion beyond the range is clipped or kept."""

import pytest
import test_motion_encodings
from test_motion_encodings_slow import MORE


@pytest.mark.parametrize("codec", MORE, ids=lambda c: c.name)
def test_rest_is_exact_in_every_codec_except_in_unorm_that_is_not_centred(gl, codec):
    test_motion_encodings.test_rest_is_exact_except_in_unorm_that_is_not_centred(gl, codec)
