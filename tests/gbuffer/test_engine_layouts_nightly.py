"""Engine layouts: their encodings have the errors measured for them elsewhere, and all layouts render."""

from itertools import product

import pytest
import test_engine_layouts_slow
from test_engine_layouts import ENGINES


@pytest.mark.parametrize("pipeline, name", [*product(["deferred", "hybrid"], ENGINES)])
def test_every_engines_layout_renders_with_either_pipeline(gl, pipeline, name):
    test_engine_layouts_slow.test_every_engines_layout_renders(gl, pipeline, name)
