"""Motion codes: no motion has an exact code where it should, and what is beyond the range is clipped or kept."""

import pytest
import test_motion_encodings
from parity.motion import CODECS
from slowly import a_tenth

MORE = CODECS[17:]


@pytest.mark.parametrize("codec", a_tenth(MORE), ids=lambda c: c.name)
def test_no_motion_is_exact_but_in_unorm_that_is_not_centred_of_any_codec(gl, codec):
    test_motion_encodings.test_no_motion_is_exact_but_in_unorm_that_is_not_centred(gl, codec)
