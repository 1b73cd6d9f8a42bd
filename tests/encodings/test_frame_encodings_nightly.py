"""Tangent frame encodings: bounded errors, preserved handedness and decoded frames that are stored unchanged."""

import pytest
import test_frame_encodings
from test_frame_encodings_slow import MORE


@pytest.mark.parametrize("codec", MORE, ids=lambda c: c.name)
def test_frame_errors_are_bounded_and_handedness_is_kept_in_every_codec(gl, codec):
    test_frame_encodings.test_frame_errors_are_bounded_and_handedness_is_kept(gl, codec)


@pytest.mark.parametrize("codec", MORE, ids=lambda c: c.name)
def test_a_decoded_frame_is_stored_again_unchanged_in_every_codec(codec):
    test_frame_encodings.test_a_decoded_frame_is_stored_again_unchanged(codec)
