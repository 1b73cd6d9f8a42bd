"""Ambient occlusion: the arcs of GTAO against integrals, and the results of all methods on simple bodies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drawing import FP32, scene_of
from occluded import (
    CLOSED,
    FROM_ABOVE,
    METHODS,
    ball,
    by_ball,
    drawn_effect,
    effect,
    floor,
    pillar,
    plan_of,
    scene_of_meshes,
    turned,
)

from normalbench.bench.ground.angles import angles_deg
from normalbench.bench.measures.metrics.visibility import RayCaster, triangles_of
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.effects.catalogue import EFFECTS
from normalbench.gbuffer.effects.effect import EffectError, chosen
from normalbench.gbuffer.effects.gtao import CONSTANTS as GTAO
from normalbench.gbuffer.effects.occlusion.passes import BENT_NORMAL, CONSTANTS, HALF_VISIBILITY, VISIBILITY, passes
from normalbench.gbuffer.effects.sao import turns
from normalbench.gbuffer.frame.contract import Pass, Pipeline, PipelineError
from normalbench.gbuffer.frame.resource import Resource
from normalbench.gbuffer.layouts.words import Target
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.mesh import box, rotation
from normalbench.gbuffer.scenes.scene import KINDS, View

SIZE = (96, 72)


BOTH = [f"{name}:size={size}" for name in METHODS for size in ("full", "half")]


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def slice_of(phi, n, v):
    """Return o, |m| and g of slices: angles of any shape (..., slices), normals and lines of sight (..., 3)."""
    right = unit(np.stack([v[..., 2], 0 * v[..., 2], -v[..., 0]], axis=-1))
    up, v, n, right = (a[..., None, :] for a in (np.cross(v, right), v, n, right))
    o = np.cos(phi)[..., None] * right + np.sin(phi)[..., None] * up
    across, along = np.sum(n * o, axis=-1), np.sum(n * v, axis=-1)
    return o, np.hypot(across, along), np.arctan2(across, along)


def arc(h, g):
    return (np.cos(g) + 2 * h * np.sin(g) - np.cos(2 * h - g)) / 4


def bent(h0, h1, g):
    t0 = 6 * np.sin(h0 - g) - np.sin(3 * h0 - g) + 6 * np.sin(h1 - g) - np.sin(3 * h1 - g) + 16 * np.sin(g)
    t1 = -np.cos(3 * h0 - g) - np.cos(3 * h1 - g) + 8 * np.cos(g) - 3 * (np.cos(h0 + g) + np.cos(h1 + g))
    return (t0 - 3 * (np.sin(h0 + g) + np.sin(h1 + g))) / 12, t1 / 12


def normals_and_sights(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return normals and lines of sight: sights up to 50 degrees off the axis, and normals that face them by more
    than 1 degree."""
    rng = np.random.default_rng(seed)
    sights = unit(np.stack([*rng.uniform(-0.84, 0.84, (2, count)), np.ones(count)], axis=1))
    normals = unit(rng.normal(size=(count, 3)))
    normals *= np.sign(np.sum(normals * sights, axis=1))[:, None]
    there = np.sum(normals * sights, axis=1) > np.sin(np.radians(1))
    return normals[there], sights[there]


def test_arcs_are_the_integrals_between_horizons():
    """The integrals of cos(t - g)|sin t|, and of that times sin t and cos t, agree to 1e-7, the error of 20,000
    midpoints."""
    rng = np.random.default_rng(2)
    g = rng.uniform(-1.5, 1.5, 50)
    h0, h1 = (np.clip(h, g - np.pi / 2, g + np.pi / 2) for h in (-rng.uniform(0, 3, 50), rng.uniform(0, 3, 50)))
    steps = (np.arange(20000) + 0.5) / 20000
    sums = np.zeros((3, 50))
    for h in (h0, h1):
        t = h[:, None] * steps
        weight = np.cos(t - g[:, None]) * np.abs(np.sin(t)) * np.abs(h[:, None]) / 20000
        sums += [np.sum(weight * f, axis=1) for f in (1 + 0 * t, np.sin(t), np.cos(t))]
    arcs = np.stack([arc(h0, g) + arc(h1, g), *bent(h0, h1, g)])
    assert np.abs(arcs - sums).max() < 1e-7, np.abs(arcs - sums).max(axis=1)


def test_open_slices_have_a_mean_of_one_for_every_normal():
    """|m| (a(g - pi/2) + a(g + pi/2)) over 1024 slices is 1 to 1e-6. A single slice can be more than 10% off."""
    normals, sights = normals_and_sights(1000, 3)
    phi = np.broadcast_to(np.pi * (np.arange(1024) + 0.5) / 1024, (len(normals), 1024))
    _, share, g = slice_of(phi, normals, sights)
    each = share * (arc(g - np.pi / 2, g) + arc(g + np.pi / 2, g))
    off = np.abs(each.mean(axis=1) - 1)
    worst = int(off.argmax())
    assert off[worst] < 1e-6, f"{off[worst]:.2g} off for normal {normals[worst]}, sight {sights[worst]}"
    assert np.abs(each - 1).max() > 0.1


SLICES = """#version 430
#include "gtao.glsl"
layout(location = 0) out vec4 found;
layout(location = 1) out vec4 bent;
uniform sampler2D given_normal, given_sight, given_horizons;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec3 n = texelFetch(given_normal, texel, 0).xyz, v = texelFetch(given_sight, texel, 0).xyz;
    vec3 h = texelFetch(given_horizons, texel, 0).xyz;
    Slice s = slice_at(h.z, n, v);
    float sum = 0.0;
    for (int k = 0; k < 256; ++k) {
        Slice one = slice_at(PI * (float(k) + 0.5) / 256.0, n, v);
        sum += slice_visibility(one, open_horizons(one));
    }
    found = vec4(slice_visibility(s, cos(h.xy)), sum / 256.0, 0.0, 0.0);
    bent = vec4(slice_bent_normal(s, cos(h.xy), v), 0.0);
}
"""


@pytest.fixture(scope="module")
def slices(gl, tmp_path_factory):
    """Slices with given normals, lines of sight and horizons, and the results of GLSL for them."""
    normals, sights = (a[:512] for a in normals_and_sights(1000, 4))
    rng = np.random.default_rng(5)
    phi = rng.uniform(0, np.pi, len(normals))
    _, _, g = slice_of(phi[:, None], normals, sights)
    h0 = np.maximum(-rng.uniform(0, 1, len(g)) * np.pi, g[:, 0] - np.pi / 2)
    h1 = np.minimum(rng.uniform(0, 1, len(g)) * np.pi, g[:, 0] + np.pi / 2)
    given = {"given_normal": normals, "given_sight": sights, "given_horizons": np.stack([h0, h1, phi], axis=1)}
    shader = tmp_path_factory.mktemp("slices") / "slices.frag"
    shader.write_text(SLICES)
    arcs, directions = (Resource(name, "rgba32f", scale=(len(normals), 1)) for name in ("found", "directions"))

    def build(canvas):
        whole = {k: np.pad(a, [(0, 0), (0, 1)])[None].astype(np.float32) for k, a in given.items()}
        textures = {k: canvas.device.owned(canvas.frame.stack, canvas.device.upload(a)) for k, a in whole.items()}
        target, covers = canvas.target(arcs, directions), canvas.fullscreen(shader, **CONSTANTS, **GTAO)

        def run():
            target.use()
            canvas.device.state(None)
            canvas.prepare(covers.program, **textures)
            covers.render(vertices=3)

        return run

    pipeline = Pipeline("slices", "slices", "a test", (Pass("slices", (), (arcs, directions), build),))
    with rendering(gl, pipeline, scene_of("room"), plan_of(SIZE)) as drawing:
        drawing.draw()
        return given, drawing.read(arcs)[0][0], drawing.read(directions)[0][0]


def test_the_shader_computes_the_same_arcs(slices):
    """Visibility of a slice to 2e-6, bent normal to 5e-6: a few steps of float32 in sums of up to ten terms."""
    given, arcs, directions = slices
    n, v, (h0, h1, phi) = given["given_normal"], given["given_sight"], given["given_horizons"].T
    o, share, g = (a[:, 0] for a in slice_of(phi[:, None], n, v))
    exact = share * (arc(h0, g) + arc(h1, g))
    off = np.abs(arcs[:, 0] - exact)
    assert off.max() < 2e-6, f"{off.max():.2g} at normal {n[off.argmax()]}"
    t0, t1 = bent(h0, h1, g)
    off = np.abs(directions[:, :3] - (share * t0)[:, None] * o - (share * t1)[:, None] * v)
    assert off.max() < 5e-6, f"bent normal {off.max():.2g} off"


def test_open_slices_of_the_shader_have_a_mean_of_one(slices):
    """The mean over 256 slices is 1 to within 1e-6 for every normal."""
    off = np.abs(slices[1][:, 1] - 1)
    assert off.max() < 1e-6, f"{off.max():.2g} at normal {slices[0]['given_normal'][off.argmax()]}"


def middle_of_floor(gl, meshes) -> float:
    """Return the visibility by GTAO from above, with a radius that fades nothing within 1.9 m. The mean is of
    25 pixels, 17 cm across: each has its own 24 slices, and a ball is in a few of these."""
    visibility, *_ = drawn_effect(gl, scene_of_meshes(*meshes), "gtao:slices=24:steps=80:radius=5", (141, 141))
    return float(visibility[68:73, 68:73].mean())


# The first, and the one that is farthest off; the others at night.
FORMS = ("ball on the floor", "deep pit")


@pytest.mark.parametrize("name", FORMS)
def test_gtao_matches_the_closed_form(gl, name):
    """The tolerance is 0.02: at the horizon each of 80 steps is 6 cm long, so the horizon may be found 6 cm late."""
    meshes, expected = CLOSED[name]
    visibility = middle_of_floor(gl, meshes)
    assert abs(visibility - expected) < 0.02, f"{name}: {visibility:.4f}, not {expected:.4f}"


@pytest.mark.parametrize("x", [1.0, 1.2])
def test_gtao_treats_everything_behind_a_surface_as_solid(gl, x):
    """A ball above the floor darkens the floor like a ray-traced ball on a pillar, to 0.01. The closed form of the
    ball alone is brighter by at least twice that."""
    y = 1.0
    meshes = (floor(), ball(0.5, x, y))
    exact = RayCaster(triangles_of(scene_of_meshes(*meshes, pillar(0.5, x, y)))).visible(
        np.array([[0.0, 1e-4, 0.0]]), np.array([[0.0, 1.0, 0.0]]), 200_000, lambda t: (t < 1e30).astype(float)
    )
    visibility = middle_of_floor(gl, meshes)
    assert abs(visibility - exact.visibility[0]) < 0.01, f"{visibility:.4f}, not {exact.visibility[0]:.4f}"
    assert by_ball(0.5, x, y) - visibility > 0.02


SLANTED = View((0.0, 2.0, 4.0), (0.0, 0.0, 0.0), 40.0, 0.5, 60.0, up=(0.3, 1.0, 0.0))


def open_to(gl) -> float:
    """Return the lowest visibility of open surfaces; a GPU's mean of ones may be two units in the last place low."""
    return 1.0 if gl.is_software else 1 - 2.0**-22


@pytest.mark.parametrize("text", BOTH)
def test_nothing_occludes_an_open_plane_or_a_convex_body(gl, text):
    """The visibility is 1 at every pixel of a level floor, seen at an angle, and of a box with nothing around it."""
    for name, mesh in (("floor", floor()), ("box", box(1.2, 1.0, 0.8))):
        visibility, position, _ = drawn_effect(gl, scene_of_meshes(mesh, view=SLANTED), text, SIZE)
        covered = position[..., 2] != 0
        assert covered.sum() > 500
        assert visibility[covered].min() >= open_to(gl), f"{name}: {visibility[covered].min():.9f}"
        assert not (visibility[~covered] != 1.0).any(), "the background"


def test_the_bent_normal_of_an_open_plane_is_its_normal(gl):
    """With 64 slices both agree to 0.1 degrees. On a floor next to a box, the bent normal leans away from the box."""
    text = "gtao:slices=64"
    bent_normal, _, direction = drawn_effect(gl, scene_of_meshes(floor(), view=SLANTED), text, SIZE, BENT_NORMAL)
    across = np.linalg.norm(np.cross(bent_normal[..., :3], direction[..., :3]), axis=-1)
    assert np.degrees(across.max()) < 0.1
    crate = box(1.0, 0.5, 1.0).placed(np.eye(3), (-0.5, 0.25, 0.0))
    beside, *_ = drawn_effect(gl, scene_of_meshes(floor(), crate), f"{text}:radius=3", (121, 121), BENT_NORMAL)
    # Seen from above x is to the right: the picture is 4.9 m wide.
    leaning = beside[60, 62:74, 0]
    assert (leaning > 0.02).all(), leaning


@pytest.mark.parametrize("text", [*METHODS, "gtao:size=half"])
def test_turning_scene_and_camera_changes_nothing(gl, text):
    """Noise and taps are the same. Fewer than 1% of the pixels differ by more than 1e-3, because a tap falls on
    another pixel or crosses an edge."""
    room = replace(scene_of("room"), lights=())
    turn = rotation(0.7, 0.4, 1.1)
    before, after = (drawn_effect(gl, scene, text, SIZE)[0] for scene in (room, turned(room, turn)))
    differs = np.abs(before - after) > 1e-3
    assert differs.mean() < 0.01, f"{differs.mean():.2%} of the pixels, {np.abs(before - after).max():.2g} at most"
    assert abs(float(before.mean() - after.mean())) < 1e-4
    assert before.min() < 0.7


# Each pipeline and each size once; the other way round at night.
PIPED = [("deferred", "full"), ("prepass", "half"), ("hybrid", "full"), ("inferred", "half")]


@pytest.mark.parametrize("pipeline, size", PIPED)
def test_ambient_light_is_multiplied_by_the_visibility(gl, pipeline, size):
    """The room has only ambient light and no glass, and shows all other kinds of material."""
    room = scene_of("room")
    solid = tuple(part for part in room.parts if room.materials[part.materials[0]].alpha == 1)
    dark = replace(room, lights=(), parts=solid, ambient=(0.5, 0.25, 1.0))
    dark = replace(dark, materials=tuple(replace(m, emissive=(0.0, 0.0, 0.0)) for m in room.materials))
    plan = replace(plan_of(SIZE), light_targets=min(PIPELINES[pipeline].light_targets))
    chosen_effect = effect(f"gtao:size={size}")
    with rendering(gl, PIPELINES[pipeline], dark, plan) as drawing:
        drawing.draw()
        plain = drawing.image()
    with rendering(gl, PIPELINES[pipeline].with_effect(chosen_effect.passes()), dark, plan) as drawing:
        drawing.draw()
        image, visibility = drawing.image(), drawing.read(VISIBILITY)[0].reshape(SIZE[::-1])
    assert np.abs(image - plain * visibility[..., None]).max() < 1e-6
    assert visibility.min() < 0.7


STEPS = """#version 430
#include "taps.glsl"
layout(location = 0) out float half_visibility;
void main() {
    ivec2 pixel = surface_pixel(ivec2(gl_FragCoord.xy), target_size.xy);
    half_visibility = float(read_gbuffer(pixel).instance % 2);
}
"""


def test_upsampling_keeps_to_the_surface(gl, tmp_path):
    """A half-size buffer is 0 and 1 on alternate surfaces: each pixel gets the value of its own surface, except for
    at most 2% at silhouettes, whose surface is in none of their four texels."""
    (tmp_path / "steps.frag").write_text(STEPS)
    stages = list(passes("sao.frag", "half", False, SEED=0))
    stages[1] = replace(
        stages[1], build=lambda canvas: canvas.over(tmp_path / "steps.frag", HALF_VISIBILITY, **CONSTANTS)
    )
    pipeline = PIPELINES["deferred"].with_effect(stages)
    with rendering(gl, pipeline, scene_of("room"), plan_of((161, 121))) as drawing:
        drawing.draw()
        position, *_ = drawing.gbuffer()
        upsampled = drawing.read(VISIBILITY)[0].reshape(121, 161)
    expected = position[..., 3].astype(int) % 2
    wrong = np.mean(np.abs(upsampled - expected) > 1e-6)
    assert 0.3 < expected.mean() < 0.7
    assert wrong < 0.02, f"{wrong:.2%} of the pixels"


def test_hair_uses_the_normal_derived_from_its_depths(gl):
    """The room's ball of hair is convex, like its ball of skin: facets and seams darken its mean by at most 0.1."""
    room = scene_of("room")
    visibility, _, direction = drawn_effect(gl, room, "hbao", (160, 120))
    hair, skin = (visibility[direction[..., 3] == KINDS.index(kind)].mean() for kind in ("hair", "skin"))
    assert hair > skin - 0.1, f"hair {hair:.3f}, skin {skin:.3f}"


def test_a_pipeline_accepts_only_one_occlusion_method():
    gtao, other = effect("gtao"), effect("hbao")
    with pytest.raises(PipelineError) as refused:
        PIPELINES["deferred"].with_effect(gtao.passes()).with_effect(other.passes())
    assert str(refused.value) == "pipeline deferred: pass occluder_depth has the same name as another pass"


def test_a_forward_pipeline_has_no_gbuffer_to_read():
    with pytest.raises(PipelineError, match="pass occluder_depth must come after linear_depth; known: shadow_map"):
        PIPELINES["forward"].with_effect(effect("ssao").passes())


@pytest.mark.parametrize(
    "name, given, said",
    [
        ("gtao", {"radius": "0"}, "effect gtao: radius=0 is not a number from 0.01 to 100"),
        ("gtao", {"bias": "0.1"}, "effect gtao has no setting 'bias'; known: size, radius, slices, steps, power, seed"),
        ("sao", {"taps": "0"}, "effect sao: taps=0 is not a whole number from 1 to 1024"),
        ("hbao", {"size": "quarter"}, "effect hbao: size=quarter is not full or half"),
    ],
)
def test_settings_out_of_range_are_refused(name, given, said):
    with pytest.raises(EffectError) as refused:
        chosen(EFFECTS[name], given)
    assert str(refused.value) == said


@pytest.mark.parametrize("size", [(1, 1), (2, 1), (5, 3)])
@pytest.mark.parametrize("text", [f"{name}:size=half" for name in METHODS])
def test_half_of_the_smallest_image_is_one_pixel(gl, text, size):
    visibility, *_ = drawn_effect(gl, scene_of_meshes(floor(), view=FROM_ABOVE), text, size)
    assert (visibility >= open_to(gl)).all(), visibility.min()


def test_depth_can_be_in_the_layout_or_in_the_depth_buffer(gl):
    """Four taps per pixel see the same room whether depth is a float of the layout or the depth buffer's 24 bits."""
    room, bare = (
        scene_of("room"),
        replace(FP32, targets=(replace(FP32.targets[0], holds="normal.x normal.y normal.z"), *FP32.targets[1:])),
    )
    in_layout, other = (drawn_effect(gl, room, "hbao", SIZE, layout=layout)[0] for layout in (FP32, bare))
    assert np.mean(np.abs(in_layout - other) > 0.01) < 0.01


@pytest.mark.parametrize("text", METHODS)
def test_a_seed_changes_the_noise_and_nothing_else(gl, text):
    """The image is the same for the same seed, and different for another seed, with means at most 0.01 apart."""
    first, same, other = (drawn_effect(gl, scene_of("room"), f"{text}:seed={s}", SIZE)[0] for s in (1, 1, 2))
    assert np.array_equal(first, same)
    assert np.mean(first != other) > 0.05 and abs(float(first.mean() - other.mean())) < 0.01


def test_the_spirals_turns_share_no_factor_with_its_taps():
    assert [turns(taps) for taps in (1, 2, 3, 8, 9, 11, 64)] == [1, 1, 2, 5, 5, 7, 39]


@pytest.mark.parametrize("text", ["gtao", "hbao", "gtao:slices=16:steps=16"])
def test_the_change_in_occlusion_shrinks_with_the_error_of_the_normal(gl, text):
    """Octahedral codes of 10 bits against 6, in the room: the mean change per degree of error stays within a factor
    of 2. A threshold at open surfaces would make it grow without limit."""

    def coded(bits: int):
        words = Target("rgba8", f"normal.x:{bits} normal.y:{bits}")
        return replace(
            FP32, targets=(Target("r32f", "depth"), words, *FP32.targets[1:]), encoding=ENCODINGS["octahedral"]
        )

    exact, _, normal = drawn_effect(gl, scene_of("room"), text, SIZE)
    slopes = []
    for bits in (6, 10):
        coarse, _, decoded = drawn_effect(gl, scene_of("room"), text, SIZE, layout=coded(bits))
        here = normal[..., 3] != KINDS.index("hair")
        angle = angles_deg(normal[here][:, :3], decoded[here][:, :3])
        slopes.append(float(np.abs(coarse - exact)[here].mean() / angle.mean()))
    assert 0.5 < slopes[1] / slopes[0] < 2, f"{slopes[0]:.5f} a degree, then {slopes[1]:.5f}"
    assert 1e-4 < slopes[0] < 0.0079
