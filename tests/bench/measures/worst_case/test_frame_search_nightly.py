"""The largest rotations of tangent-frame codecs: a closed form, samples that stay below, and columns of the table."""

import pytest
import test_frame_search_slow
from test_frame_search_slow import CODECS, WAYS


@pytest.mark.parametrize("name", [name for name in CODECS if name not in WAYS])
def test_no_sample_of_other_codecs_is_above_the_supremum(name):
    test_frame_search_slow.test_no_sample_is_above_the_supremum(name)
