"""Tangent frame encodings: limited errors, no lost hands, and frames that are stored again unchanged."""

import pytest
import test_frame_encodings
from test_frame_encodings_slow import MORE


@pytest.mark.parametrize("codec", MORE, ids=lambda c: c.name)
def test_no_frame_is_far_off_and_no_hand_is_lost_of_every_codec(gl, codec):
    test_frame_encodings.test_no_frame_is_far_off_and_no_hand_is_lost(gl, codec)


@pytest.mark.parametrize("codec", MORE, ids=lambda c: c.name)
def test_a_decoded_frame_is_stored_again_unchanged_in_every_codec(codec):
    test_frame_encodings.test_a_decoded_frame_is_stored_again_unchanged(codec)
