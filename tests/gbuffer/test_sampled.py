"""Sampled pixels of a frame, lit as in the whole frame."""

from contextlib import ExitStack

import numpy as np
import pytest

from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.sampled import SampledScene, _rectangles
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting

SIZE = (160, 120)


@pytest.mark.parametrize("scene", ["playground", "room", "studio"])
def test_sampled_pixels_match_the_frame(gl, scene):
    """The match is bit for bit for lamps, suns with shadows, special materials and environments, also with normals
    that are not the frame's own."""
    what = SCENES[scene].make(Setting(lights=8))
    plan = Plan(SIZE, 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], 1, True, 1.0)
    with ExitStack() as stack:
        drawing = stack.enter_context(rendering(gl, PIPELINES["deferred"], what, plan))
        drawing.draw()
        surfaces = drawing.surfaces()
        covered = drawing.covered(surfaces)
        tilted = (covered.normals + np.array([0.1, -0.2, 0.05])).astype(np.float32)
        frames = [drawing.lit(covered.with_normals(surfaces, n), upto="transparent") for n in (covered.normals, tilted)]
        chosen = np.sort(np.random.default_rng(0).choice(len(tilted), 500, replace=False))
        rows, columns = np.argwhere(covered.pixels)[chosen].T
        pixels = np.stack([SIZE[1] - 1 - rows, columns], axis=1)
        sampled = SampledScene(gl, stack, what, SIZE, pixels, covered.position[chosen], 3)
        own = [texels[pixels[:, 0], pixels[:, 1]] for texels in surfaces]
        lights = sampled.lit(what, own, np.stack([covered.normals[chosen], tilted[chosen]]))
    for row, frame in zip(lights, frames, strict=True):
        apart = np.abs(row - frame[pixels[:, 0], pixels[:, 1]])
        assert apart.max() == 0, f"{np.count_nonzero(apart)} numbers differ, by up to {apart.max():g}"


def test_rectangles_cover_each_column_once():
    columns = np.array([0, 1, 2, 40, 41, 99])
    corners = _rectangles(columns, 100)
    edges = np.round((corners[:, 0].reshape(-1, 6) + 1) * 50).astype(int)
    assert [(row.min(), row.max()) for row in edges] == [(0, 3), (40, 42), (99, 100)]
    assert set(corners[:, 1]) == {-1.0, 1.0}
