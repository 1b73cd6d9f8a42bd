"""Objects on a device that outlive frames."""

import numpy as np

from normalbench.bench.tables.budget.rates import EXACT, Stage
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting


def test_an_open_frame_is_lit_the_same_after_other_frames_are_drawn(gl, monkeypatch):
    """The device keeps nothing that is not in use."""
    for kept in (gl._programs, gl._textures):
        monkeypatch.setattr(kept, "_most", 0)
    stage = Stage(SCENES["studio"], Setting(), (64, 48))
    with rendering(gl, PIPELINES["deferred"], stage.scene, stage.plan(EXACT)) as drawing:
        seen = drawing.surfaces()
        first = drawing.lit(seen)
        for name in ("unreal4", "second_life"):
            with rendering(gl, PIPELINES["deferred"], stage.scene, stage.plan(LAYOUTS[name])) as other:
                other.draw()
        again = drawing.lit(seen)
    assert first.max() > 1 and np.array_equal(first, again), f"{np.abs(first - again).max():.3g} apart"
