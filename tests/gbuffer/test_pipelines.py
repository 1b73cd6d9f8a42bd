"""The pipelines compared with each other, and the triangles that their passes draw."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drawing import BLINN_PHONG, EXACT, FP32, SIZE, apart, covered_by_glass, draw, drawn, scene_of

from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.mesh import plane
from normalbench.gbuffer.scenes.scene import KINDS, Material, Scene, ScenePart, View, placed


@pytest.mark.parametrize("name", [name for name in EXACT if name != "inferred"])
@pytest.mark.parametrize("heights", [(0.0, 1.0), (1.0, 0.0)], ids=["far first", "near first"])
def test_near_glass_covers_far_glass(gl, name, heights):
    """Two panes, seen from above, in either order of the scene: half of the near pane over half of the far pane."""
    view = View((0.0, 4.0, 0.01), (0.0, 0.0, 0.0), 40.0, 0.5, 20.0)
    panes = ScenePart(plane(8.0, 8.0), placed([(0.0, height, 0.0) for height in heights]), np.arange(2))
    colours = [(0.0, 0.0, 1.0) if height else (1.0, 0.0, 0.0) for height in heights]
    glass = tuple(Material(albedo=colour, specular=(0.0, 0.0, 0.0), alpha=0.5) for colour in colours)
    image = draw(gl, name, Scene((panes,), glass, (), (1.0, 1.0, 1.0), view, view)).image
    assert image[SIZE[1] // 2, SIZE[0] // 2] == pytest.approx((0.25, 0.0, 0.5), abs=1e-6)


@pytest.mark.parametrize("name", ["objects", "room"])
def test_special_materials_look_the_same_in_forward_and_hybrid(gl, name):
    """The images agree to 60 dB over the pixels of each kind."""
    forward, hybrid = (drawn(gl, pipeline, name, False) for pipeline in ("forward", "hybrid"))
    kind = hybrid.gbuffer[1][..., 3]
    for number, special in enumerate(KINDS[1:], 1):
        here = kind == number
        assert here.sum() > 20
        decibels = apart(forward.image[here], hybrid.image[here])
        assert decibels >= 60, f"{special} in {name}: {decibels:.1f} dB"


def test_inferred_lighting_leaves_no_surface_dark(gl):
    """At a quarter of the size some pixels find their own surface in none of the four texels; they use the light of
    the nearest texel. The room has no background and no ambient light here. Fewer than one pixel in 200 stays dark,
    because its nearest texel is dark too."""
    scene = replace(scene_of("room"), ambient=(0.0, 0.0, 0.0))
    opaque = ~covered_by_glass(gl, "room")
    lit_pixels = opaque & (draw(gl, "forward", scene).image.max(axis=2) > 0.01)
    inferred = draw(gl, "inferred", scene, scale=0.25).image.max(axis=2)
    assert lit_pixels.sum() > 5000
    dark = np.sum(inferred[lit_pixels] == 0)
    assert dark < lit_pixels.sum() / 200, f"{dark} of {lit_pixels.sum()} pixels are dark"


def triangles_of(scene: Scene, wanted) -> int:
    """Return the number of triangles of all instances whose material is wanted."""
    counts = (
        len(part.mesh.triangles) * sum(wanted(scene.materials[index], part) for index in part.materials)
        for part in scene.parts
    )
    return sum(counts)


@pytest.mark.parametrize("name", BLINN_PHONG)
def test_each_pass_draws_only_its_own_triangles(gl, name):
    """The geometry pass draws all opaque triangles once. The second geometry pass draws all of them again in light
    pre-pass, and exactly the special triangles in hybrid. The shadow map has the triangles that cast shadows."""
    scene = scene_of(name)
    opaque = triangles_of(scene, lambda material, _: material.alpha == 1)
    special = triangles_of(scene, lambda material, _: material.alpha == 1 and material.kind != "general")
    expected = {
        "shadow_map": triangles_of(scene, lambda material, part: material.alpha == 1 and part.casts),
        "geometry": opaque,
        "transparent": triangles_of(scene, lambda material, _: material.alpha < 1),
    }
    for pipeline, again in (("prepass", opaque), ("hybrid", special)):
        plan = Plan(SIZE, 1, FP32, LIGHT_BUFFERS["rgba32f"], 2, True, 1.0)
        with rendering(gl, PIPELINES[pipeline], scene, plan) as r:
            counted = r.triangles()
        expected["material"] = again
        triangles = {stage: counted[stage] for stage in expected}
        assert triangles == expected, f"{pipeline} on {name}"
