"""The pipelines compared with each other, and the triangles that their passes draw."""

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
def test_all_pipelines_give_the_same_image(gl, name, shadows):
    """In fp32 and at full size, any two pipelines agree to 70 dB, or to 55 dB with shadows, where a depth comparison
    may go either way. Inferred lighting is compared where no transparent surface covers the others."""
    glass = covered_by_glass(gl, name)
    images = {pipeline: drawn(gl, pipeline, name, shadows).image for pipeline in EXACT}
    for first, other in combinations(EXACT, 2):
        counts = ~glass if "inferred" in (first, other) else np.ones_like(glass)
        decibels = apart(images[first][counts], images[other][counts])
        assert decibels >= (55 if shadows else 70), f"{first} and {other} on {name}: {decibels:.1f} dB"


def test_no_lamp_is_mistaken_for_the_sun(gl):
    """The sun has its own number in the stencil. After many dark lamps, one bright lamp lights surfaces that only the
    sun has lit: 70 dB from the image with only this lamp."""
    bright = Light("point", (9.0, 9.0, 9.0), (0.0, 0.0, -5.0), 30.0)
    dark = replace(bright, position=(0.0, 500.0, 0.0), radius=1.0)
    scene = SCENES["playground"].make(Setting(lights=0))
    alone = draw(gl, "forward", replace(scene, lights=(*scene.lights, bright))).image
    for place in (253, 254, 255):
        lights = (*scene.lights, *[dark] * (place - 1), bright)
        decibels = apart(draw(gl, "forward_multipass", replace(scene, lights=lights)).image, alone)
        assert decibels >= 70, f"lamp {place}: {decibels:.1f} dB"


@pytest.mark.parametrize("pipeline, effects", [("deferred", ""), ("hybrid", "lpv"), ("inferred", "")])
def test_light_across_channels_gives_the_same_image(gl, pipeline, effects):
    """20-bit floats, which are read, added to and written, give the image of 32-bit floats."""
    chosen = pipeline_with(PIPELINES[pipeline], effects_named(effects) if effects else [], [])
    shown = []
    for light in light_buffers_named("rgba32f,ufloat:6:14"):
        plan = Plan(SIZE, 1, FP32, light, min(2, max(chosen.light_targets)), True, 1.0)
        with rendering(gl, chosen, scene_of("room"), plan) as drawing:
            drawing.draw()
            shown.append(drawing.image())
    exact, packed = shown
    assert exact.max() > 0.5 and abs(packed - exact).max() < 2.0**-12 * exact.max()


@pytest.mark.parametrize("shadows", [False, True], ids=["no shadows", "shadows"])
@pytest.mark.parametrize("name", BLINN_PHONG[2:])
def test_all_pipelines_give_the_same_image_in_other_scenes(gl, name, shadows):
    test_all_pipelines_give_the_same_image(gl, name, shadows)


def test_more_lights_than_the_stencil_can_count_are_all_drawn_once(gl):
    """The stencil counts to 255. With 270 lamps, lighting in several passes agrees with forward shading to 120 dB."""
    scene = SCENES["playground"].make(Setting(lights=270))
    decibels = apart(draw(gl, "forward_multipass", scene).image, draw(gl, "forward", scene).image)
    assert decibels >= 120, f"{decibels:.1f} dB"
