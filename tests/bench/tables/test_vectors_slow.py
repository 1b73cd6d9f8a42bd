"""`normalbench vectors`: errors that theory predicts, lost motion, drift, output, and messages for bad input."""

import jax.numpy as jnp
import numpy as np
import pytest
from test_vectors import row

from normalbench.encodings.catalogue import MOTION_ENCODINGS
from normalbench.encodings.codecs.motion_codec import MotionCodec
from normalbench.encodings.storages.storage import MOTION_STORAGES
from normalbench.encodings.vec import Vec2


def test_truncated_half_float_motion_is_up_to_one_unit_too_short():
    """Truncation never lengthens a motion, so points lag. The mean error is twice that of rounding to nearest,
    because a rectangle's points are on average twice as far from its corner as from its middle."""
    motions = np.random.default_rng(5).uniform(-0.1, 0.1, (2, 2**14)).astype(np.float32)
    codec = MotionCodec(MOTION_ENCODINGS["linear"], MOTION_STORAGES["rg16f"], "truncate")
    decoded = np.array(codec.round_trip(Vec2(*map(jnp.asarray, motions)), np.float32(1)))
    unit = np.spacing(np.abs(motions).astype(np.float16)).astype(np.float32)
    short = np.abs(motions) - np.abs(decoded)
    assert (short >= 0).all() and (short < unit * 1.001).all()
    assert float((short / unit).mean()) == pytest.approx(0.5, abs=0.02)
    nearest, cut = (row("linear/rg16f", 16, rounding=rounding) for rounding in ("nearest", "truncate"))
    assert cut["error_mean_px"] == pytest.approx(2 * nearest["error_mean_px"], rel=0.01)
    assert cut["drift_px"] > 5 * nearest["drift_px"]
