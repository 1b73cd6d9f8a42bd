"""The layouts of engines: their codes have the errors that were measured for them outside, and all of them render."""

from functools import cache
from itertools import product

import numpy as np
import pytest
from slowly import a_tenth
from test_engine_layouts import ENGINES, GLOSS, STUDIO, plan

from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import check, rendering


@cache
def image_of(gl, pipeline: str, scene: str, layout: str) -> np.ndarray:
    one = plan(LAYOUTS[layout], light_targets=1 if pipeline == "deferred" else 2)
    scenes = {"gloss": GLOSS, "studio": STUDIO}
    check(gl, PIPELINES[pipeline], one, scenes[scene].is_metal_rough)
    with rendering(gl, PIPELINES[pipeline], scenes[scene], one) as made:
        made.draw()
        return made.image()


@pytest.mark.parametrize("pipeline, name", a_tenth(product(["deferred", "hybrid"], ENGINES)))
def test_every_engines_layout_renders(gl, pipeline, name):
    """The image is finite, lit, and near the one from 32-bit floats. Materials that are whole are of metal or not."""
    layout = LAYOUTS[name]
    if missing := PIPELINES[pipeline].needs - layout.metal_rough_components:
        pytest.skip(f"{pipeline} needs {', '.join(missing)}")
    images = [image_of(gl, pipeline, "studio" if layout.is_whole else "gloss", one) for one in (name, "fp32")]
    assert np.isfinite(images[0]).all() and images[1].max() > 0.1
    apart = np.sqrt(np.mean((np.clip(images[0], 0, 1) - np.clip(images[1], 0, 1)) ** 2))
    # The square of a roughness in 8 bits, FidelityFX's, is 0.037 off where surfaces are nearly mirrors.
    assert apart < (0.04 if layout.is_whole else 0.03), f"{apart:.4f} RMS"
