"""Screen-space reflections compared with Embree rays, their cost, and their use of encoded G-buffers."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from drawing import FP32
from occluded import effect, plan_of

from normalbench.encodings import vec
from normalbench.encodings.storages.storage import FORMATS
from normalbench.gbuffer.effects.ssr.passes import CONSTANTS, HITS, REFLECTED
from normalbench.gbuffer.environment.dfg import dfg
from normalbench.gbuffer.environment.environment import Environment
from normalbench.gbuffer.frame.resources import FINAL
from normalbench.gbuffer.gl.device import read_pixels
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.mesh import box, plane, sphere
from normalbench.gbuffer.scenes.metal_rough import MetalRough
from normalbench.gbuffer.scenes.scene import Light, Scene, ScenePart, View, placed

SIZE, SMALL = (160, 120), (96, 72)


VIEW = View((1.2, 2.0, 6.0), (-0.4, 0.9, 0.0), 45.0, 0.5, 40.0)


UPRIGHT = np.array([(1.0, 0, 0), (0, 0, 1.0), (0, 1.0, 0)])


@cache
def hall(roughness: float) -> Scene:
    """Return a scene of balls and boxes on a flat mirror in front of a wall."""
    balls = placed([(-1.3, 0.4, 0.6), (0.1, 0.5, -0.4), (1.2, 0.3, 1.1)], [0.4, 0.5, 0.3])
    boxes = placed([(-0.5, 0.25, 1.6), (1.0, 0.5, -0.6)], [0.5, 1.0], [0.5, 0.2])
    here = placed((0.0, 0.0, 0.0))
    colours = ((0.9, 0.1, 0.1), (0.1, 0.8, 0.2), (0.1, 0.2, 0.9), (0.9, 0.8, 0.1), (0.8, 0.2, 0.9))
    things = tuple(MetalRough(base=colour, roughness=1.0) for colour in colours)
    flat, rest = MetalRough((1.0, 1.0, 1.0), 1.0, roughness), MetalRough((0.5, 0.5, 0.5), roughness=1.0)
    parts = (
        ScenePart(sphere(1.0, 96, 64), balls, np.array([0, 1, 2])),
        ScenePart(box(1.0, 1.0, 1.0), boxes, np.array([3, 4])),
        ScenePart(plane(9.0, 9.0), here, np.array([5])),
        ScenePart(plane(7.0, 2.5).placed(UPRIGHT, (0.0, 1.25, -2.5)), here, np.array([6])),
    )
    lights = (Light("sun", (1.0, 0.9, 0.8), direction=(-0.48, -0.8, -0.36)),)
    return Scene(parts, (*things, flat, rest), lights, (0.4, 0.45, 0.5), VIEW, VIEW)


@dataclass(frozen=True)
class Traced:
    """A frame with the effect: the effect's two images, the image that rays sample, and the surfaces in world space.

    Attributes:
        reflected: (height, width, 4); row 0 is the top, as in all arrays here.
        places: the hits, (height, width, 2), in pixels from the upper left.
        hits: bool of shape (height, width).
        looks: how often the pixel's rays sample the screen.
        image: (height, width, 3).
        positions, normals: (height, width, 3); NaN where nothing is covered.
        mirror: which pixels show the mirror.
    """

    reflected: np.ndarray
    places: np.ndarray
    hits: np.ndarray
    looks: np.ndarray
    image: np.ndarray
    positions: np.ndarray
    normals: np.ndarray
    mirror: np.ndarray


def traced(gl, scene: Scene, settings: str = "", size=SIZE, layout=FP32, pipeline="deferred") -> Traced:
    ssr = effect("ssr" + settings)
    with rendering(gl, PIPELINES[pipeline].with_effect(ssr.passes()), scene, plan_of(size, layout)) as drawing:
        drawing.draw()
        position, direction, _, specular = drawing.gbuffer()
        reflected, hits = drawing.read(REFLECTED)[0], drawing.read(HITS)[0]
    with rendering(gl, PIPELINES[pipeline], scene, plan_of(size, layout)) as drawing:
        drawing.draw()
        image = drawing.read(FINAL)[0][..., :3]
    to_world = np.linalg.inv(scene.view.matrix())
    covered = (position[..., 2] != 0)[..., None]
    positions = np.where(covered, position[..., :3] @ to_world[:3, :3].T + to_world[:3, 3], np.nan)
    normals = np.where(covered, direction[..., :3] @ to_world[:3, :3].T, np.nan)
    places = np.stack([hits[..., 0], size[1] - hits[..., 1]], axis=-1)
    mirror = (specular[..., 0] > 0.9) & covered[..., 0]
    return Traced(reflected, places, hits[..., 3] > 0, hits[..., 2], image, positions, normals, mirror)


def final(gl, scene: Scene, settings: str, pipeline="deferred", size=SMALL) -> np.ndarray:
    """Return the image with the effect, (height, width, 3)."""
    ssr = effect("ssr" + settings)
    with rendering(gl, PIPELINES[pipeline].with_effect(ssr.passes()), scene, plan_of(size)) as drawing:
        drawing.draw()
        return drawing.image()


def reflected(ways: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Return directions to the eye, mirrored about the normals."""
    return 2 * np.sum(ways * normals, axis=-1, keepdims=True) * normals - ways


LOBE = """#version 430
#include "ssr_lobe.glsl"
layout(location = 0) out vec4 found;

// Columns are n.v, rows the roughness.
void main() {
    vec2 share = gl_FragCoord.xy / vec2(8.0);
    vec3 v = vec3(sqrt(1.0 - share.x * share.x), 0.0, share.x), mean = vec3(0.0);
    float a = share.y * share.y, sum = 0.0;
    for (int i = 0; i < RAYS; ++i) {
        vec2 u = vec2((float(i) + 0.5) / float(RAYS), fract(float(i) * GOLDEN));
        vec3 facet = visible_facet(v, a, u);
        sum += unmasked(reflect(-v, facet).z, v.z, a);
        mean += facet;
    }
    found = vec4(mean, sum) / float(RAYS);
}
"""


def test_rays_of_the_lobe_add_up_to_its_albedo(gl, tmp_path):
    """The mean of G2 / G1 over visible facets is a white metal's albedo by quadrature, scale + bias, to 1e-3."""
    shader = tmp_path / "lobe.frag"
    shader.write_text(LOBE)
    with ExitStack() as stack:
        macros = {**CONSTANTS, **vec.CONSTANTS, "PI": np.pi, "RAYS": 4096}
        target = gl.owned(stack, gl.target((8, 8), FORMATS["rgba32f"]))
        gl.render(gl.owned(stack, gl.fragment_pass(shader, macros)), [target])
        pixels = read_pixels(target)
    centres = (np.arange(8) + 0.5) / 8
    off = np.abs(pixels[..., 3] - sum(dfg(centres, centres[:, None])))
    assert off.max() < 1e-3, f"{off.max():.2g} at roughness, n.v {np.unravel_index(off.argmax(), off.shape)}"
    assert np.abs(pixels[..., 1]).max() < 2e-3, "facets lean to neither side"


def test_rays_that_miss_see_the_environment(gl):
    """The surface mirrors the environment as without the effect, and the image there is unchanged, bit for bit."""
    light = np.random.default_rng(3).uniform(0, 1, (16, 32, 3)).astype(np.float32)
    scene = replace(hall(0.0), environment=Environment("random", light))
    trace, image = traced(gl, scene, ":rays=1", SMALL), final(gl, scene, ":rays=1")
    missed = trace.mirror & (trace.reflected[..., 3] == 0)
    assert np.ptp(trace.reflected[missed][:, 0]) > 0.1 and np.array_equal(image[missed], trace.image[missed])
    # A metal of base 1 mirrors all of it.
    assert np.abs(trace.reflected[missed][:, :3] - trace.image[missed]).max() < 1e-4


@pytest.mark.parametrize("roughness", [0.0, 1e-3, 0.05, 1.0])
def test_every_roughness_gives_finite_values(gl, roughness):
    """No reflection is brighter than the image or the ambient light."""
    trace = traced(gl, hall(roughness), ":rays=2", SMALL)
    assert np.isfinite(trace.reflected).all() and np.isfinite(trace.places).all()
    assert trace.reflected.min() >= 0 and trace.reflected[..., :3].max() <= max(trace.image.max(), 0.5) + 1e-6
    assert (trace.places >= 0).all() and (trace.places[trace.hits] <= SMALL).all()
