"""The bounds that lights are drawn with: they miss nothing, waste little, and add no light out of reach."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drawing import apart, draw, lamps, scene_of, towards
from test_light_bounds import in_world, shaded

from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.scene import Light
from normalbench.gbuffer.scenes.setting import Setting


def test_bounds_shade_little_more_than_lights_reach(gl):
    """With 64 point lights over the objects at 640 x 480, the bounds shade at least as many pixels as are within each
    radius, and in total at most 1.5 times as many."""
    scene = SCENES["objects"].make(Setting(lights=64))
    counted, seen = shaded(gl, scene, (640, 480))
    reached = np.array(
        [
            np.sum(np.linalg.norm(seen.position - np.array(light.position), axis=1) < light.radius * (1 - 1e-6))
            for light in lamps(scene)
        ]
    )
    assert len(counted) == 64 and np.all(counted >= reached), f"light {np.argmin(counted - reached)} misses pixels"
    assert reached.sum() > 50_000
    ratio = counted.sum() / reached.sum()
    assert ratio <= 1.5, f"{ratio:.3f} times"


# View space, y up, looking down -z; near 0.5.
IN_VIEW = {
    "eye in the middle": Light("point", (30.0,) * 3, (0.0, 0.0, 0.0), 14.0),
    "across the near plane": Light("point", (12.0,) * 3, (0.3, -0.2, -0.6), 10.0),
    "small, across the near plane": Light("point", (3.0,) * 3, (1.5, -2.4, -3.0), 4.2),
    "behind the eye": Light("point", (20.0,) * 3, (0.5, 0.3, 2.5), 12.0),
    "eye on the rim": Light("point", (10.0,) * 3, (-3.0, -1.0, -6.0), float(np.sqrt(46.0))),
    "all of it": Light("point", (4.0,) * 3, (0.0, 0.0, -5.0), 100.0),
    "spot from behind the eye": Light("spot", (40.0,) * 3, (0.2, 0.1, 1.5), 16.0, towards(0.0, -0.1, -1.0), 15.0, 30.0),
    "spot from the eye": Light("spot", (40.0,) * 3, (0.0, 0.0, 0.0), 16.0, towards(0.2, -0.2, -1.0), 10.0, 25.0),
    "spot to the eye": Light("spot", (8.0,) * 3, (0.0, 1.0, -12.0), 14.0, towards(0.0, -0.08, 1.0), 25.0, 40.0),
    "wide spot": Light("spot", (10.0,) * 3, (1.0, 2.5, -6.0), 9.0, towards(0.1, -1.0, 0.2), 50.0, 80.0),
    "spot wider than any cone": Light("spot", (10.0,) * 3, (0.0, 1.5, -6.0), 9.0, towards(0.1, -1.0, 0.2), 50.0, 120.0),
    "spot at the widest cone": Light("spot", (10.0,) * 3, (0.0, 1.5, -6.0), 9.0, towards(0.1, -1.0, 0.2), 50.0, 80.3),
    "spot past the eye": Light("spot", (10.0,) * 3, (-4.0, 0.0, -8.0), 12.0, towards(0.5, -0.1, 1.0), 20.0, 35.0),
}


@pytest.mark.parametrize("far", [40.0, 11.0])
@pytest.mark.parametrize("placed_at", IN_VIEW)
def test_bounds_around_the_eye_and_across_the_planes_miss_nothing(gl, placed_at, far):
    """In the room with one light, deferred and forward shading agree to 70 dB. The far plane is behind the room or in
    the room."""
    scene = scene_of("room")
    view = replace(scene.view, far=far)
    scene = replace(scene, view=view, lights=(in_world(IN_VIEW[placed_at], view),))
    forward = draw(gl, "forward", scene).image
    unlit = draw(gl, "forward", replace(scene, lights=())).image
    reached = np.mean(abs(forward - unlit).max(axis=2) > 0.002)
    assert reached > 0.02, f"the light reaches {reached:.1%} of the image"
    decibels = apart(draw(gl, "deferred", scene).image, forward)
    assert decibels >= 70, f"{decibels:.1f} dB"
