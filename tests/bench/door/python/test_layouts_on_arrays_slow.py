"""`nb.pack` and `nb.unpack` match the results of the renderer's own GLSL and of the formats."""

import numpy as np
from test_layouts_on_arrays import SURFACE

import normalbench as nb


def test_arrays_may_have_any_shape():
    surface = {name: np.broadcast_to(value, (2, 5, *np.shape(value))) for name, value in SURFACE.items()}
    targets = nb.pack("granite", surface)
    assert [held.shape for held in targets] == [(2, 5, 4)] * 3
    assert nb.unpack("granite", targets)["normal"].shape == (2, 5, 3)
    assert nb.pack("granite", SURFACE)[0].shape == (4,)
