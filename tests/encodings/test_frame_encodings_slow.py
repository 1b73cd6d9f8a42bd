"""Tangent frame encodings: bounded errors, preserved handedness and decoded frames that are stored unchanged."""

import numpy as np
import pytest
import test_frame_encodings
from parity.comparison import rows
from parity.frames import (
    CODECS,
    LEAST,
    as_frame,
    as_rows,
    hard_frames,
    of_quaternions,
)
from slowly import a_tenth

from normalbench.encodings.catalogue import FRAME_ENCODINGS
from normalbench.encodings.codecs.frame_codec import FrameCodec
from normalbench.encodings.storages.rules import by_rule


def test_handedness_is_kept_if_its_number_would_be_0():
    """If the third of three numbers is at its lower end, or if w is 0, a step is stored instead of 0."""
    third = of_quaternions(np.array([[1.0, 0.0, 0.0, 1e-6 - 1.0]]))
    half_turn = of_quaternions(np.array([[0.6, 0.0, 0.8, 0.0]]))
    for name, frames, number in (("smallest_three", third, 2), ("qtangent", half_turn, 3)):
        codes = rows(FRAME_ENCODINGS[name].encode(as_frame(frames), LEAST))
        assert codes[:, number] == pytest.approx([LEAST, -LEAST], rel=2e-3), name


@pytest.mark.parametrize("name", ["qtangent", "smallest_three"])
def test_handedness_is_kept_in_floats_of_any_form(name):
    """The smallest stored number is the smallest normal float of the form."""
    codec = FrameCodec(FRAME_ENCODINGS[name], by_rule("float", (4, 3)))
    frames = hard_frames()
    assert codec.least == 2.0**-6 and np.array_equal(as_rows(codec.round_trip(as_frame(frames)))[:, 3], frames[:, 3])


MORE = CODECS[6:]


@pytest.mark.parametrize("codec", a_tenth(MORE), ids=lambda c: c.name)
def test_frame_errors_are_bounded_and_handedness_is_kept_in_any_codec(gl, codec):
    test_frame_encodings.test_frame_errors_are_bounded_and_handedness_is_kept(gl, codec)


@pytest.mark.parametrize("codec", a_tenth(MORE), ids=lambda c: c.name)
def test_a_decoded_frame_is_stored_again_unchanged_in_any_codec(codec):
    test_frame_encodings.test_a_decoded_frame_is_stored_again_unchanged(codec)
