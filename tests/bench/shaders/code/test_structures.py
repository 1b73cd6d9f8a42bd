"""Structures and parameters that functions change, as in tangent frames, in the code of every language."""

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


def test_flipped_handedness_is_an_error_of_180_degrees():
    """Input and decoded values have the same order: normal, handedness, tangent."""
    codec = frame_codec("qtangent", "rgba16_snorm")
    expected, errors = reference(codec), kind_of(codec).errors
    given = np.concatenate([expected.n, expected.view], axis=1)
    assert errors(given, expected.decoded).max() < 0.01
    assert (errors(given, expected.decoded * np.array([1, 1, 1, -1, 1, 1, 1])) == 180).all()
