"""Tangent frame codes: no frame is far off, no hand is lost, and what was stored is stored again as it is."""

import pytest
import test_frame_encodings
from test_frame_encodings_slow import MORE


@pytest.mark.parametrize("codec", MORE, ids=lambda c: c.name)
def test_no_frame_is_far_off_and_no_hand_is_lost_of_every_codec(gl, codec):
    test_frame_encodings.test_no_frame_is_far_off_and_no_hand_is_lost(gl, codec)


@pytest.mark.parametrize("codec", MORE, ids=lambda c: c.name)
def test_what_was_stored_is_stored_again_as_it_is_of_every_codec(codec):
    test_frame_encodings.test_what_was_stored_is_stored_again_as_it_is(codec)
