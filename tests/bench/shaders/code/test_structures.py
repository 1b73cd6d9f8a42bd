"""Structures, and parameters that functions change, in the code of every language; tangent frames are such."""

import numpy as np
import pytest
from typed import codecs_of_kind

from normalbench.bench.shaders.code.kinds.table import kind_of
from normalbench.bench.shaders.code.reference import reference
from normalbench.bench.subjects.codecs.kinds.codecs import NAMED

pytestmark = pytest.mark.usefixtures("gl")


def frame_codec(name: str, storage: str, rounding: str = "nearest"):
    (codec,) = codecs_of_kind(NAMED["frame"], name, storage, [rounding], slice(1))
    assert not codec.misfit
    return codec


def test_a_hand_that_comes_back_as_the_other_is_an_error_of_half_a_turn():
    """What was given is in the order of what is decoded: a normal, the hand, a tangent."""
    codec = frame_codec("qtangent", "rgba16_snorm")
    found, errors = reference(codec), kind_of(codec).errors
    given = np.concatenate([found.n, found.view], axis=1)
    assert errors(given, found.decoded).max() < 0.01
    assert (errors(given, found.decoded * np.array([1, 1, 1, -1, 1, 1, 1])) == 180).all()
