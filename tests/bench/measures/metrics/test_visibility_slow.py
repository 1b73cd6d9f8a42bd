"""The reference rays for ambient occlusion, compared with closed forms."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from drawing import scene_of
from occluded import effect

from normalbench.bench.measures.metrics.occlusion_error import method_error


def test_more_slices_and_steps_come_closer_to_the_rays(gl):
    """In the room, each step from 1 x 2 to 3 x 3 to 16 x 16 improves the RMS by over four standard errors of both."""
    errors = [
        method_error(gl, effect(f"gtao:{given}"), scene_of("room"), (128, 96), pixels=2000, rays=256)
        for given in ("slices=1:steps=2", "slices=3:steps=3", "slices=16:steps=16")
    ]
    for coarse, fine in pairwise(errors):
        least = 4 * np.hypot(coarse.standard_error, fine.standard_error)
        assert coarse.rms - fine.rms > least, f"{coarse.rms:.4f}, then {fine.rms:.4f}; {least:.2g} apart is chance"
