"""Motion encodings: rest is exact where it should be, and motion beyond the range is clipped or kept."""

import numpy as np
import pytest
import test_motion_encodings
from parity.comparison import ULP, planes, rows
from parity.motion import BEYOND, CODECS, RANGE, through_gl, through_jax
from slowly import a_tenth

from normalbench.encodings.catalogue import MOTION_ENCODINGS
from normalbench.encodings.codecs.motion_codec import MotionCodec
from normalbench.encodings.storages.rules import by_rule
from normalbench.encodings.storages.storage import MOTION_STORAGES, STORAGES
from normalbench.encodings.vec import Vec2

EVERY = sorted(MOTION_ENCODINGS)


@pytest.mark.parametrize("name", EVERY)
def test_an_encoding_is_odd_and_rises_from_0_to_1_at_the_range(name):
    """Rest is 0, the range is 1, and opposite motions have opposite signs."""
    encoding, largest = MOTION_ENCODINGS[name], np.float32(RANGE)
    codes = rows(encoding.encode(planes(Vec2, np.float32([[0, -0.0], [RANGE, -RANGE]])), largest))
    assert codes == pytest.approx(np.float32([[0, 0], [1, -1]]), abs=4 * ULP)
    line = np.linspace(0, RANGE, 4097, dtype=np.float32)
    forward, other = rows(encoding.encode(planes(Vec2, np.stack([line, -line], axis=1)), largest)).T
    assert np.array_equal(forward, -other) and (np.diff(forward) > 0).all()


def test_a_bias_in_half_floats_loses_slow_motion():
    """Stored as 1/2 plus half of the motion, 0.05 pixels at a width of 1920 come back as 0."""
    slow = planes(Vec2, np.float32([[0.05 / 1920, -0.05 / 1920]]))
    biased = MotionCodec(MOTION_ENCODINGS["linear"], by_rule("ufloat", (5, 10)))
    assert np.array_equal(rows(biased.round_trip(slow, np.float32(1))), [[0, 0]])
    plain = MotionCodec(MOTION_ENCODINGS["linear"], STORAGES["rg16f"])
    assert rows(plain.round_trip(slow, np.float32(1))) == pytest.approx(rows(slow), rel=0.001)


@pytest.mark.parametrize("name", EVERY)
def test_fixed_point_clips_motion_beyond_the_range_and_floats_keep_it(gl, name):
    """Twice the range comes back as the range, and in half floats as itself."""
    for storage in MOTION_STORAGES.values():
        codec = MotionCodec(MOTION_ENCODINGS[name], storage)
        end = RANGE if codec.clips else 2 * RANGE
        for decoded in (through_jax(codec)[BEYOND], through_gl(gl, codec)[BEYOND]):
            assert decoded[0] == pytest.approx([end, -end], rel=0.005), codec.name


MORE = CODECS[17:]


@pytest.mark.parametrize("codec", a_tenth(MORE), ids=lambda c: c.name)
def test_rest_is_exact_in_any_codec_except_in_unorm_that_is_not_centred(gl, codec):
    test_motion_encodings.test_rest_is_exact_except_in_unorm_that_is_not_centred(gl, codec)
