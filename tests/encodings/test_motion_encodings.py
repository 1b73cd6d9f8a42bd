"""Motion encodings: rest is exact where it should be, and motion beyond the range is clipped or kept."""

import numpy as np
import pytest
from parity.comparison import planes, rows
from parity.motion import CODECS, MOVING, STILL, motions, through_gl, through_jax

from normalbench.encodings.catalogue import MOTION_ENCODINGS
from normalbench.encodings.codecs.motion_codec import MotionCodec
from normalbench.encodings.motion.log import OCTAVES, K
from normalbench.encodings.storages.storage import FORMATS, MOTION_STORAGES, STORAGES, Storage
from normalbench.encodings.vec import Vec2


def test_unreals_velocity_is_linear_in_centred_bits_with_a_larger_range():
    """0.2495 d + 32767 / 65535 of a difference d of clip space up to 2, in UNORM of 16 bits (Unreal Engine 4.27,
    Common.ush): the clear value 0 never occurs."""
    screens = np.random.default_rng(0).uniform(-1, 1, (2**16, 2)).astype(np.float32)
    theirs = 65535 * (0.2495 * 2 * screens.astype(np.float64)) + 32767
    codec = MotionCodec(MOTION_ENCODINGS["linear"], MOTION_STORAGES["rg16_centred"])
    stored = rows(codec.stored(planes(Vec2, screens), np.float32(32767 / (0.2495 * 2 * 65535))))
    ours = np.rint(stored.astype(np.float64) * 32767) + 32767
    # Half a step, and what float32 adds to 32767.
    assert abs(ours - theirs).max() <= 0.5 + 2.0**-7 and ours.min() > 0


def test_the_constant_of_the_logarithm_is_2047():
    """1 + k is 2^11: the two kinds of step meet at 1 / 2047 of the range."""
    assert K == 2047 and 2**OCTAVES == K + 1


@pytest.mark.parametrize("codec", CODECS[:17], ids=lambda c: c.name)
def test_rest_is_exact_except_in_unorm_that_is_not_centred(gl, codec):
    """UNORM has no code for 0: its two middle codes are half a step from it."""
    for decoded in (through_jax(codec)[STILL], through_gl(gl, codec)[STILL]):
        assert np.isfinite(decoded).all() and (decoded == decoded[0]).all()
        assert (decoded[0] != 0).all() == codec.storage.is_biased, decoded[0]


@pytest.mark.parametrize("storage", [s for s in MOTION_STORAGES.values() if s.is_centred], ids=lambda s: s.name)
def test_centred_stores_the_integers_of_snorm_in_a_unorm_target(storage: Storage):
    """The bias is 127 / 255, 511 / 1023 or 32767 / 65535, as engines write it; the top code is not used."""
    steps = 2 ** storage.bits[0] - 1
    assert storage.target.kind == "unorm" and storage.target.scale(0) == steps
    assert 2 * storage.scale(0) + 1 == steps and storage.count(0) == steps


def test_linear_in_32_bit_floats_is_exact_and_needs_no_range(gl):
    codec = MotionCodec(MOTION_ENCODINGS["linear"], MOTION_STORAGES["rgba32f"])
    assert not codec.needs_range and not codec.clips
    for decoded in (through_jax(codec), through_gl(gl, codec)):
        assert np.array_equal(decoded[MOVING], motions()[-MOVING.stop :])


@pytest.mark.parametrize(
    "storage, why",
    [(FORMATS["r16f"], "R16F has 1 channel"), (STORAGES["rgb8_8_8_1"], None)],
    ids=lambda s: str(s)[:12],
)
def test_a_storage_needs_two_channels(storage: Storage, why: str | None):
    reason = MotionCodec(MOTION_ENCODINGS["linear"], storage).misfit
    assert (why in reason) if why else reason is None, reason
