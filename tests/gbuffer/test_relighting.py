"""The renderer's light, shadows and positions, compared with formulas in float64."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import relighting
from drawing import BLINN_PHONG, EXACT, FP32, SIZE, apart, covered_by_glass, draw, drawn, psnr, scene_of, towards
from relighting import relight, surfaces

from normalbench.encodings.catalogue import ENCODINGS, LIGHT_BUFFERS
from normalbench.gbuffer.defines.materials import CONSTANTS
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.frame.resources import SHADOW_SIZE
from normalbench.gbuffer.frame.scene_buffers import sun_matrix
from normalbench.gbuffer.layouts.layout import Layout
from normalbench.gbuffer.layouts.words import Target
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.mesh import box, plane, sphere
from normalbench.gbuffer.scenes.scene import KINDS, LIGHT_KINDS, Light, Material, Scene, ScenePart, View, placed


@cache
def lit(gl, scene: str):
    """Return a scene's surfaces, and the light on them computed with the formulas, with shadows."""
    frame = drawn(gl, "prepass", scene, True)
    seen = surfaces(scene_of(scene), frame.gbuffer)
    return seen, relight(scene_of(scene), seen, frame.shadow_map)


@pytest.mark.parametrize("which", ["diffuse", "specular"])
@pytest.mark.parametrize("name", BLINN_PHONG)
def test_the_light_buffer_matches_the_formulas(gl, name, which):
    """D in the first target and S in the second, all lights and shadows, over the pixels of each material kind: 80 dB
    below the light's own peak or 1, whichever is higher. Where float32 leaves a shadow undecided, either is right."""
    seen, sums = lit(gl, name)
    expected, slack = getattr(sums, which), getattr(sums, f"{which}_slack")
    light = drawn(gl, "prepass", name, True).light[which == "specular"]
    assert not light[~seen.covered].any(), "the background is lit"
    error = np.maximum(abs(light[seen.covered][:, :3] - expected) - slack, 0)
    for kind in np.unique(seen.kind):
        here = seen.kind == kind
        ratio = psnr(error[here], max(expected.max(), 1.0))
        assert ratio >= 80, f"{name}, {which} light on {KINDS[kind]}: {ratio:.1f} dB, largest {error[here].max():.2g}"


@pytest.mark.parametrize("name", BLINN_PHONG)
def test_the_deferred_colour_matches_the_formulas(gl, name):
    """Emitted and reflected light in the light buffer of deferred shading, as displayed: 80 dB."""
    scene, (seen, sums) = scene_of(name), lit(gl, name)
    frame = drawn(gl, "deferred", name, True)
    assert all(
        np.array_equal(a, b) for a, b in zip(frame.gbuffer, drawn(gl, "prepass", name, True).gbuffer, strict=True)
    )
    expected = relighting.emissive(scene, seen) + seen.albedo * sums.diffuse + seen.specular * sums.specular
    slack = seen.albedo * sums.diffuse_slack + seen.specular * sums.specular_slack
    got = frame.light[0][seen.covered][:, :3]
    decibels = apart(got, np.clip(got, expected - slack, expected + slack))
    assert decibels >= 80, f"{name}: {decibels:.1f} dB, largest {abs(got - expected).max():.2g}"


@pytest.mark.parametrize("pipeline", EXACT)
@pytest.mark.parametrize("name", ["playground", "objects", "gloss"])
def test_the_image_matches_the_formulas(gl, name, pipeline):
    """In the scenes without transparent surfaces, with ambient light and without shadows: 80 dB as displayed."""
    scene = scene_of(name)
    seen = lit(gl, name)[0]
    expected = relighting.image(scene, seen, unshadowed(gl, name))
    decibels = apart(drawn(gl, pipeline, name, False).image, expected)
    assert decibels >= 80, f"{pipeline} on {name}: {decibels:.1f} dB"


@cache
def unshadowed(gl, name: str):
    return relight(scene_of(name), lit(gl, name)[0], None)


def test_hardly_any_shadow_is_undecided(gl):
    """Of the pixels that the sun can light, fewer than one in a thousand are undecided in float32, and a notable
    share is in shadow. The playground's upper slab keeps out nearly all of the sun."""
    for name in BLINN_PHONG:
        (seen, _), scene = lit(gl, name), scene_of(name)
        low, high = relighting.sunlit(scene, seen.position, drawn(gl, "prepass", name, True).shadow_map)
        to_sun = -scene.view.matrix()[:3, :3] @ scene.sun.direction
        # Light reaches around skin, and any side of a hair.
        reached = (seen.direction @ to_sun > -CONSTANTS["SKIN_WRAP"]) | (seen.kind == KINDS.index("hair"))
        doubt = (low < high) & reached
        # A GPU's slopes of the shadow map are a little others.
        assert np.mean(doubt) < (1e-3 if gl.is_software else 2e-3), f"{name}: {np.sum(doubt)} of {low.size} in doubt"
        dark, half = np.mean(high == 0), np.mean((low > 0) & (high < 1))
        enough = dark > 0.01 and (half > 0.001 or name == "playground")
        assert enough, f"{name}: {dark:.1%} in shadow, {half:.1%} at its edges"


def test_the_room_shows_every_kind_of_light_and_of_material(gl):
    """Each material covers at least 20 pixels; each kind of light gives at least 500 pixels a D above 0.01."""
    scene, (seen, _) = scene_of("room"), lit(gl, "room")
    assert all(np.sum(seen.kind == number) >= 20 for number in range(len(KINDS)))
    for kind in LIGHT_KINDS:
        chosen = replace(scene, lights=tuple(light for light in scene.lights if light.kind == kind))
        reached = np.sum(relight(chosen, seen, None).diffuse.max(axis=1) > 0.01)
        assert reached >= 500, f"{kind} light reaches {reached} pixels"


@cache
def line_up() -> Scene:
    """Return a row of balls of each material kind, strands upright, and white lamps in the order of LIGHT_KINDS."""
    upright = sphere(1.0, 96, 64).placed(np.array([(1.0, 0, 0), (0, 0, -1.0), (0, 1.0, 0)]), (0, 0, 0))
    places = [(-2.4, 0, 0), (-0.8, 0.3, -0.5), (0.8, -0.2, 0.3), (2.4, 0.1, 0)]
    materials = (
        Material("general", (0.5, 0.4, 0.3), (0.3, 0.3, 0.3), 20.0),
        Material("skin", (0.7, 0.5, 0.4), (0.2, 0.2, 0.2), 24.0),
        Material("hair", (0.3, 0.2, 0.1), (0.2, 0.15, 0.1), 40.0),
        Material("glossy", (0.5, 0.1, 0.1), (1.0, 1.0, 1.0), 30.0),
    )
    view = View((1.5, 1.2, 7.0), (0.0, 0.0, 0.0), 40.0, 1.0, 30.0)
    return Scene(
        parts=(ScenePart(upright, placed(places, 0.75), np.arange(4)),),
        materials=materials,
        lights=(
            Light("point", (9.0, 9.0, 9.0), (-0.5, 2.5, 2.5), 6.0),
            Light("spot", (20.0, 20.0, 20.0), (1.0, 3.0, 3.0), 9.0, towards(-1.0, -3.0, -3.0), 15.0, 40.0),
            Light("sun", (1.0, 1.0, 1.0), direction=towards(0.6, -0.5, -0.7)),
        ),
        ambient=(0.0, 0.0, 0.0),
        view=view,
        previous=view,
    )


@pytest.mark.parametrize("kind", LIGHT_KINDS)
def test_each_kind_of_light_matches_the_formulas_on_each_material(gl, kind):
    """With a single lamp, the errors of D and S on each ball are 80 dB below their peak; over 50 pixels are lit."""
    scene = replace(line_up(), lights=(line_up().lights[LIGHT_KINDS.index(kind)],))
    frame = draw(gl, "prepass", scene)
    seen = surfaces(scene, frame.gbuffer)
    sums = relight(scene, seen, None)
    for which, light, expected in zip("DS", frame.light, (sums.diffuse, sums.specular), strict=True):
        for number, material in enumerate(KINDS):
            here = seen.kind == number
            lit_pixels = np.sum(expected[here].max(axis=1) > 0.02)
            assert lit_pixels > 50, f"{kind} light on {material}: {which} on {lit_pixels} pixels"
            decibels = psnr(light[seen.covered][here][:, :3] - expected[here], expected[here].max())
            assert decibels >= 80, f"{kind} light on {material}: {which} {decibels:.1f} dB"


def test_strands_of_hair_run_along_v(gl):
    """On a ball with an upright axis strands follow the meridians, with the sign that faces the eye."""
    scene = line_up()
    seen = surfaces(scene, draw(gl, "prepass", scene).gbuffer)
    hair = seen.kind == KINDS.index("hair")
    outwards = (seen.position[hair] - scene.parts[0].models[2, :3, 3]) / 0.75
    around = np.cross([0.0, 1.0, 0.0], outwards)
    strand = seen.direction[hair]
    assert hair.sum() > 500
    assert abs(np.sum(strand * outwards, axis=1)).max() < 0.05
    assert abs(np.sum(strand * around, axis=1)).max() < 0.05
    forward = scene.view.matrix()[2, :3]
    assert (strand @ forward).min() >= -1e-6, "a strand points away from the eye"


def test_the_normal_map_tilts_against_its_slopes(gl):
    """A level plane seen from above: its normal is N - strength (dh/du T + dh/dv B), T in the direction of u and B in
    that of v, to 0.02; the map is read back and magnified bilinearly."""
    view = View((0.3, 3.0, 0.2), (0.3, 0.0, 0.0), 40.0, 0.5, 20.0)
    bumpy = Material(bump=0.8, bump_repeat=1.0)
    scene = Scene((ScenePart(plane(6.0, 6.0), placed((0, 0, 0)), np.array([0])),), (bumpy,), (), (0.0,) * 3, view, view)
    plan = Plan(SIZE, 1, FP32, LIGHT_BUFFERS["rgba32f"], 2, False, 1.0)
    with rendering(gl, PIPELINES["prepass"], scene, plan) as r:
        r.draw()
        seen = surfaces(scene, r.gbuffer())
        texture = r.frame.scene_buffers.bumps
        slopes = np.frombuffer(texture.read(), np.float16).reshape(texture.height, texture.width, 2).astype(float)
    x, z = seen.position[:, 0], seen.position[:, 2]
    place = np.stack([x / 6 + 0.5, 0.5 - z / 6], axis=1) * texture.size - 0.5
    corner = np.floor(place).astype(int)
    slope = np.zeros((len(place), 2))
    for right, up in ((0, 0), (1, 0), (0, 1), (1, 1)):
        weight = np.prod(1 - abs(place - corner - (right, up)), axis=1, keepdims=True)
        slope += weight * slopes[(corner[:, 1] + up) % texture.height, (corner[:, 0] + right) % texture.width]
    tilted = np.stack([-0.8 * slope[:, 0], np.ones(len(x)), 0.8 * slope[:, 1]], axis=1)
    expected = tilted / np.linalg.norm(tilted, axis=1, keepdims=True)
    assert np.ptp(expected, axis=0).max() > 0.8
    error = abs(seen.direction - expected).max()
    assert error < 0.02, f"{error:.3f}"


@pytest.mark.parametrize("name", ["objects", "room"])
def test_one_target_holds_diffuse_light_and_specular_luminance(gl, name):
    """RGB is D, A the Rec. 709 luminance of S, 80 dB below the peak or 1. The material pass gives the highlight the
    colour of D: 80 dB as displayed."""
    scene, seen, sums = scene_of(name), lit(gl, name)[0], unshadowed(gl, name)
    frame = draw(gl, "prepass", scene, targets=1)
    luma = np.array([0.2126, 0.7152, 0.0722])
    expected = np.concatenate([sums.diffuse, (sums.specular @ luma)[:, None]], axis=1)
    decibels = psnr(frame.light[0][seen.covered] - expected, max(expected.max(), 1))
    assert decibels >= 80, f"{name}: light {decibels:.1f} dB"
    brightness = np.where(expected[:, :3].any(axis=1), sums.diffuse @ luma, 1.0)[:, None]
    coloured = replace(sums, specular=sums.diffuse / brightness * expected[:, 3:])
    opaque = ~covered_by_glass(gl, name)
    decibels = apart(frame.image[opaque], relighting.image(scene, seen, coloured)[opaque])
    assert decibels >= 80, f"{name}: image {decibels:.1f} dB"


def test_the_material_pass_restores_the_power_for_a_single_white_light(gl):
    """[S / sum(N.L att)]^(m/n) sum(N.L att) is exact for a single white light. On general materials the image agrees
    with forward shading to 60 dB, for highlights of power 4 to 1024 from a power of 32."""
    lamp = Light("point", (3.0, 3.0, 3.0), (2.0, 1.5, 5.0), 14.0)
    scene = replace(scene_of("gloss"), lights=(lamp,))
    bare = Layout("bare", "", (Target("rgba32f", "normal.x normal.y normal.z depth"),), ENCODINGS["xyz"], "")
    expected = draw(gl, "forward", scene).image
    for targets in (1, 2):
        decibels = apart(draw(gl, "prepass", scene, layout=bare, targets=targets).image, expected)
        assert decibels >= 60, f"{targets} targets: {decibels:.1f} dB"
    fixed = replace(scene, materials=tuple(replace(m, power=CONSTANTS["LIGHT_PASS_POWER"]) for m in scene.materials))
    assert apart(draw(gl, "forward", fixed).image, expected) < 40, "the powers make no difference"


SUN = towards(0.5, -0.8, -0.33)


BLOCK = np.array([(-0.8, 0.5, -0.5), (0.8, 1.6, 0.5)])


@cache
def block_over_floor() -> Scene:
    """Return a scene with a box over a wide floor under an oblique sun, white, with only diffuse light."""
    size = BLOCK[1] - BLOCK[0]
    white = Material(albedo=(1.0, 1.0, 1.0), specular=(0.0, 0.0, 0.0))
    view = View((3.0, 4.0, 6.0), (0.4, 0.3, -0.3), 50.0, 0.5, 50.0)
    return Scene(
        parts=(
            ScenePart(box(*size), placed(BLOCK.mean(axis=0)), np.array([0])),
            ScenePart(plane(30.0, 30.0), placed((0, 0, 0)), np.array([0]), casts=False),
        ),
        materials=(white,),
        lights=(Light("sun", (1.0, 1.0, 1.0), direction=SUN),),
        ambient=(0.0, 0.0, 0.0),
        view=view,
        previous=view,
    )


def meets_block(points: np.ndarray, grown: float) -> np.ndarray:
    """Whether a ray from each point to the sun meets the box, grown by `grown` on each side."""
    low, high = ((side - points) / -np.array(SUN) for side in (BLOCK[0] - grown, BLOCK[1] + grown))
    enters, leaves = np.minimum(low, high).max(axis=1), np.maximum(low, high).min(axis=1)
    return (leaves > enters) & (leaves > 0)


def within_block(points: np.ndarray) -> np.ndarray:
    """Return the distance of points on the box from the nearest edge of their face."""
    return np.sort(np.minimum(points - BLOCK[0], BLOCK[1] - points), axis=1)[:, 1]


@pytest.mark.parametrize("pipeline", ["forward", "deferred"])
def test_shadows_are_where_rays_to_the_sun_are_blocked(gl, pipeline):
    """Except within three texels of the shadow's edge, the floor is dark inside the shadow and N.L outside. The sides
    of the box that face the sun are fully lit up to three texels from their edges."""
    scene = block_over_floor()
    image = draw(gl, pipeline, scene, shadows=True).image[..., 0]
    seen = surfaces(scene, draw(gl, "deferred", scene, shadows=True).gbuffer)
    image = image[seen.covered]
    texel = 1 / np.linalg.norm(sun_matrix(scene)[:2, :3], axis=1).min() / SHADOW_SIZE
    floor = abs(seen.position[:, 1]) < 1e-4
    dark = floor & meets_block(seen.position, -3 * texel)
    bright = floor & ~meets_block(seen.position, 3 * texel)
    assert dark.sum() > 200 and bright.sum() > 5000
    assert not image[dark].any(), f"{np.count_nonzero(image[dark])} of {dark.sum()} pixels in shadow are lit"
    assert np.allclose(image[bright], -SUN[1], atol=1e-5), f"{np.sum(image[bright] < -SUN[1] - 1e-5)} wrongly dark"
    facing = seen.direction @ -np.array(SUN)
    side = ~floor & (facing > 0.01) & (within_block(seen.position) > 3 * texel)
    assert side.sum() > 300
    assert np.allclose(image[side], facing[side], atol=1e-5), f"{np.sum(image[side] < facing[side] - 1e-5)} with acne"


def test_a_coarse_ball_does_not_shadow_pixels_that_its_normals_light(gl):
    """Smooth normals on flat faces: some faces that look away from the sun are still lit. All pixels with an N.L of
    at least 0.05 are lit."""
    view = View((-3.0, 3.0, 5.0), (0.0, 0.0, 0.0), 30.0, 0.5, 50.0)
    ball = ScenePart(sphere(1.0, 18, 12), placed((0, 0, 0)), np.array([0]))
    white = Material(albedo=(1.0, 1.0, 1.0), specular=(0.0, 0.0, 0.0))
    scene = Scene((ball,), (white,), (Light("sun", (1.0,) * 3, direction=SUN),), (0.0, 0.0, 0.0), view, view)
    frame = draw(gl, "deferred", scene, shadows=True)
    seen = surfaces(scene, frame.gbuffer)
    facing = seen.direction @ -np.array(SUN)
    wrong = (frame.image[seen.covered][:, 0] < facing - 1e-4) & (facing > 0.05)
    assert np.sum(facing > 0.05) > 3000
    assert not wrong.any(), f"{wrong.sum()} pixels too dark, where N.L is up to {facing[wrong].max():.2f}"
