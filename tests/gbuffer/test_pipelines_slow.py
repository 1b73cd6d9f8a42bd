"""The pipelines against each other, and the triangles that their passes draw."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from drawing import BLINN_PHONG, EXACT, FP32, SIZE, apart, covered_by_glass, draw, drawn, scene_of
from typed import effects_named, light_buffers_named

from normalbench.bench.subjects.names.effects import pipeline_with
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.scene import Light
from normalbench.gbuffer.scenes.setting import Setting


@pytest.mark.parametrize("shadows", [False, True], ids=["no shadows", "shadows"])
@pytest.mark.parametrize("name", BLINN_PHONG[:2])
def test_all_pipelines_give_one_image(gl, name, shadows):
    """In fp32 and at full size: 70 dB between any two, 55 with shadows, where a comparison of depths may go either way.
    Inferred lighting on what no transparent surface covers."""
    glass = covered_by_glass(gl, name)
    images = {pipeline: drawn(gl, pipeline, name, shadows).image for pipeline in EXACT}
    for one, other in combinations(EXACT, 2):
        counts = ~glass if "inferred" in (one, other) else np.ones_like(glass)
        found = apart(images[one][counts], images[other][counts])
        assert found >= (55 if shadows else 70), f"{one} and {other} on {name}: {found:.1f} dB"


def test_no_lamp_is_taken_for_the_sun(gl):
    """The sun has a number of its own in the stencil. Of many lamps the last shines, on what only the sun has lit:
    70 dB from that lamp by itself."""
    bright = Light("point", (9.0, 9.0, 9.0), (0.0, 0.0, -5.0), 30.0)
    dark = replace(bright, position=(0.0, 500.0, 0.0), radius=1.0)
    scene = SCENES["playground"].make(Setting(lights=0))
    alone = draw(gl, "forward", replace(scene, lights=(*scene.lights, bright))).image
    for place in (253, 254, 255):
        lights = (*scene.lights, *[dark] * (place - 1), bright)
        found = apart(draw(gl, "forward_multipass", replace(scene, lights=lights)).image, alone)
        assert found >= 70, f"lamp {place}: {found:.1f} dB"


@pytest.mark.parametrize("pipeline, effects", [("deferred", ""), ("hybrid", "lpv"), ("inferred", "")])
def test_light_across_channels_is_drawn_as_it_is(gl, pipeline, effects):
    """Floats of 20 bits, which are read, added to and written, show what floats of 32 bits show."""
    chosen = pipeline_with(PIPELINES[pipeline], effects_named(effects) if effects else [], [])
    shown = []
    for light in light_buffers_named("rgba32f,ufloat:6:14"):
        plan = Plan(SIZE, 1, FP32, light, min(2, max(chosen.light_targets)), True, 1.0)
        with rendering(gl, chosen, scene_of("room"), plan) as made:
            made.draw()
            shown.append(made.image())
    exact, found = shown
    assert exact.max() > 0.5 and abs(found - exact).max() < 2.0**-12 * exact.max()


@pytest.mark.parametrize("shadows", [False, True], ids=["no shadows", "shadows"])
@pytest.mark.parametrize("name", BLINN_PHONG[2:])
def test_all_pipelines_give_one_image_whichever_it_is(gl, name, shadows):
    test_all_pipelines_give_one_image(gl, name, shadows)


def test_more_lights_than_the_stencil_counts(gl):
    """270 lamps, where the stencil counts to 255, each lighting each pixel once, in passes and all at once: 120 dB."""
    scene = SCENES["playground"].make(Setting(lights=270))
    found = apart(draw(gl, "forward_multipass", scene).image, draw(gl, "forward", scene).image)
    assert found >= 120, f"{found:.1f} dB"
