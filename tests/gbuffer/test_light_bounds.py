"""The bounds that lights are drawn with: they miss nothing, waste little, and add no light out of reach."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import relighting
from drawing import FP32, SIZE, apart, covered_by_glass, draw, lamps, scene_of
from relighting import surfaces

from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.mesh import plane
from normalbench.gbuffer.scenes.scene import Light, Material, Scene, ScenePart, View


def shaded(gl, scene: Scene, size) -> tuple[np.ndarray, relighting.Surfaces]:
    """Return the number of pixels that each local light's bounds shade, and the surfaces."""
    plan = Plan(size, 1, FP32, LIGHT_BUFFERS["rgba32f"], 2, False, 1.0)
    with rendering(gl, PIPELINES["prepass"], scene, plan) as r:
        r.draw()
        lights = r.passes["lights"]
        lights.run.queries = []
        lights()
        return np.array([query.samples for query in lights.run.queries]), surfaces(scene, r.gbuffer())


def test_bounds_of_spot_lights_contain_their_cones(gl):
    """In the room the bounds shade at least as many pixels as are within a spot's radius and outer angle, and in
    total at most 1.5 times as many."""
    scene = scene_of("room")
    counted, seen = shaded(gl, scene, SIZE)
    spots = [index for index, light in enumerate(lamps(scene)) if light.kind == "spot"]
    reached = []
    for index in spots:
        light = lamps(scene)[index]
        way = seen.position - np.array(light.position)
        distance = np.linalg.norm(way, axis=1)
        cosine = way @ np.array(light.direction) / distance
        reached.append(np.sum((distance < light.radius) & (cosine > np.cos(np.radians(light.outer)) + 1e-6)))
    assert len(reached) == 3 and min(reached) > 100
    assert np.all(counted[spots] >= reached), f"{counted[spots]} shaded, {reached} in reach"
    assert counted[spots].sum() <= 1.5 * sum(reached), f"{counted[spots]} shaded, {reached} in reach"


def in_world(light: Light, view: View) -> Light:
    to_world = np.linalg.inv(view.matrix())
    position = to_world[:3, :3] @ np.array(light.position) + to_world[:3, 3]
    return replace(light, position=tuple(position), direction=tuple(to_world[:3, :3] @ np.array(light.direction)))


@pytest.mark.parametrize("index", [0, 5, 11])
def test_the_eye_can_be_inside_the_bounds_of_a_light(gl, index):
    """Among the objects, deferred shading agrees with forward shading to 70 dB."""
    scene = scene_of("objects")
    eye = np.array(lamps(scene)[index].position)
    view = replace(scene.view, eye=tuple(eye), target=tuple(eye + np.array([0.4, -0.15, -1.0])), near=0.2)
    moved = replace(scene, view=view)
    decibels = apart(draw(gl, "deferred", moved).image, draw(gl, "forward", moved).image)
    assert decibels >= 70, f"{decibels:.1f} dB"


@pytest.mark.parametrize("kind", ["point", "spot"])
def test_no_light_reaches_past_the_radius_or_outside_the_cone(gl, kind):
    """Outside, the light is exactly 0, in the light buffer and in forward shading; inside, most pixels are lit."""
    lamp = Light(kind, (9.0, 9.0, 9.0), (0.5, 3.5, 0.0), 4.0, tuple(np.array([0.6, -0.8, 0.0])), 20.0, 40.0)
    scene = scene_of("room")
    dull = tuple(replace(material, emissive=(0.0, 0.0, 0.0)) for material in scene.materials)
    scene = replace(scene, lights=(lamp,), ambient=(0.0, 0.0, 0.0), materials=dull)
    frame = draw(gl, "prepass", scene)
    seen = surfaces(scene, frame.gbuffer)
    way = seen.position - np.array(lamp.position)
    distance = np.linalg.norm(way, axis=1)
    outside = distance > lamp.radius * (1 + 1e-5)
    if kind == "spot":
        outside |= way @ np.array(lamp.direction) / distance < np.cos(np.radians(lamp.outer)) - 1e-5
    assert outside.sum() > 2000 and (~outside).sum() > 500
    opaque = ~covered_by_glass(gl, "room")[seen.covered]
    pictures = {"D": frame.light[0], "S": frame.light[1], "forward": draw(gl, "forward", scene).image}
    for name, picture in pictures.items():
        rows = picture[seen.covered]
        dark = outside if name != "forward" else outside & opaque
        wrong = rows[dark].max(axis=1) > 0
        assert not wrong.any(), f"{name}: {wrong.sum()} pixels, {rows[dark].max():.3g}"
    bright = frame.light[0][seen.covered][~outside].any(axis=1)
    assert bright.mean() > 0.5, f"{bright.mean():.0%} of what is in reach is lit"


# A wall six before the eye, or a floor two below it; lamps one from it, and the foot of each, view space.
WALL, FLOOR = "wall", "floor"


LAMPS = {
    "left": (WALL, (-1.5, 0.3, -5.0), (-1.5, 0.3, -6.0)),
    "right": (WALL, (1.5, 0.3, -5.0), (1.5, 0.3, -6.0)),
    "above": (WALL, (0.2, 1.3, -5.0), (0.2, 1.3, -6.0)),
    "below": (WALL, (0.2, -1.3, -5.0), (0.2, -1.3, -6.0)),
    "near": (FLOOR, (0.4, -1.0, -4.5), (0.4, -2.0, -4.5)),
    "far": (FLOOR, (0.4, -1.0, -9.0), (0.4, -2.0, -9.0)),
}


@pytest.mark.parametrize("pipeline", ["forward", "deferred"])
@pytest.mark.parametrize("side", LAMPS)
def test_a_surface_is_brightest_at_the_foot_of_its_lamp(gl, side, pipeline):
    """N.L over the squared distance has its peak where the lamp is closest: within two pixels, whichever way the
    camera looks. So no axis is swapped or reversed, and the distance does not count more than once."""
    ground, lamp, foot = LAMPS[side]
    view = View((3.0, -2.0, 5.0), (-4.0, 1.5, 9.0), 50.0, 0.5, 50.0)
    model = np.eye(4)
    if ground == WALL:
        model[:3, :3], model[:3, 3] = np.array([(1, 0, 0), (0, 0, -1), (0, 1, 0)]), (0, 0, -6.0)
    else:
        model[:3, 3] = (0, -2.0, -10.0)
    part = ScenePart(plane(40.0, 40.0), (np.linalg.inv(view.matrix()) @ model)[None], np.array([0]))
    white = Material(albedo=(1.0, 1.0, 1.0), specular=(0.0, 0.0, 0.0))
    light = in_world(Light("point", (1.0, 1.0, 1.0), lamp, 6.0), view)
    scene = Scene((part,), (white,), (light,), (0.0, 0.0, 0.0), view, view)
    image = draw(gl, pipeline, scene).image[..., 0]
    row, column = np.unravel_index(np.argmax(image), image.shape)
    up = np.tan(np.radians(view.fov / 2)) * -foot[2]
    expected = np.array([1 - foot[1] / up, 1 + foot[0] / up * SIZE[1] / SIZE[0]]) / 2 * SIZE[::-1] - 0.5
    off = abs(np.array([row, column]) - expected).max()
    assert off <= 2, f"brightest at row {row}, column {column}; the foot is at {expected.round(1)}"
    # (1 - (1/6)^4)^2 / 2, straight below.
    assert image.max() == pytest.approx((1 - 6.0**-4) ** 2 / 2, rel=0.01)
