"""The pipelines against each other, and the triangles that their passes draw."""

from __future__ import annotations

import pytest
import test_pipelines
from drawing import BLINN_PHONG, apart, draw

from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting


@pytest.mark.parametrize("shadows", [False, True], ids=["no shadows", "shadows"])
@pytest.mark.parametrize("name", BLINN_PHONG[2:])
def test_all_pipelines_give_one_image_whichever_it_is(gl, name, shadows):
    test_pipelines.test_all_pipelines_give_one_image(gl, name, shadows)


def test_more_lights_than_the_stencil_counts(gl):
    """270 lamps, where the stencil counts to 255, each lighting each pixel once, in passes and all at once: 120 dB."""
    scene = SCENES["playground"].make(Setting(lights=270))
    found = apart(draw(gl, "forward_multipass", scene).image, draw(gl, "forward", scene).image)
    assert found >= 120, f"{found:.1f} dB"
