"""Screen-space reflections compared with Embree rays, their cost, and their use of encoded G-buffers."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from drawing import FP32, psnr
from occluded import effect, plan_of
from test_ssr import SIZE, SMALL, Traced, final, hall, reflected, traced

from normalbench.bench.measures.metrics.visibility import RayCaster, triangles_of
from normalbench.gbuffer.effects.ssr.passes import HITS
from normalbench.gbuffer.layouts.words import Target
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.scene import Scene

# A material whose roughness has two bits.
MATERIAL = (
    Target("rgba32f", "albedo.r albedo.g albedo.b kind"),
    Target("rgba32f", "specular.r specular.g specular.b occlusion"),
    Target("rgba8", "roughness:2"),
)


# A ray starts over its own surface by this share of the distance to the eye.
OVER = 1e-4


# What Embree's and the rasteriser's float32 differ by, as a share of a distance.
ALIKE = 1e-3


NONE = 1e30


def places_of(scene: Scene, points: np.ndarray, size=SIZE) -> np.ndarray:
    """Return world points, (..., 3), in pixels from the upper left, (..., 2)."""
    clip = (
        np.concatenate([points, np.ones_like(points[..., :1])], -1)
        @ (scene.view.projection(size[0] / size[1]) @ scene.view.matrix()).T
    )
    flat = clip[..., :2] / clip[..., 3:]
    return (flat * (1, -1) * 0.5 + 0.5) * size


def seen_hits(scene: Scene, found: Traced, caster: RayCaster, origins: np.ndarray, ways: np.ndarray):
    """Return where rays, (rays, 3), hit surfaces on the screen: places, (rays, 2), and whether they do.

    A hit is on the screen if the pixel there shows the same surface: the hit is in the pixel's tangent plane.
    """
    size = found.hits.shape[::-1]
    far = caster.distances(origins, ways)
    met = far < NONE
    points = origins + np.where(met, far, 1.0)[:, None] * ways
    eye = np.array(scene.view.eye)
    met &= (points - eye) @ (np.array(scene.view.target) - eye) > 0
    places = places_of(scene, points, size)
    met &= np.all((places > 0) & (places < size), axis=1)
    x, y = np.where(met[:, None], places, 0.0).astype(int).T
    over = np.sum(found.normals[y, x] * (points - found.positions[y, x]), axis=1)
    return places, met & (np.abs(over) < ALIKE * np.linalg.norm(points - eye, axis=1))


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def starts_of(scene: Scene, found: Traced) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points just above the mirror's pixels, their normals and the directions to the eye; (pixels, 3)."""
    positions, normals = found.positions[found.mirror], found.normals[found.mirror]
    to_eye = np.array(scene.view.eye) - positions
    return positions + OVER * np.linalg.norm(to_eye, axis=1)[:, None] * normals, normals, unit(to_eye)


@pytest.fixture(scope="module")
def caster() -> RayCaster:
    pytest.importorskip("embreex")
    return RayCaster(triangles_of(hall(0.0)))


def near_share(scene: Scene, found: Traced, caster: RayCaster) -> tuple[float, int]:
    """Return the share of the mirror's rays that land within a pixel of Embree's hit, and the number of rays. Only
    rays that hit a surface on the screen count."""
    origins, normals, to_eye = starts_of(scene, found)
    places, there = seen_hits(scene, found, caster, origins, reflected(to_eye, normals))
    away = np.linalg.norm(found.places[found.mirror] - places, axis=1)
    return float(np.mean((found.hits[found.mirror] & (away <= 1))[there])), int(np.sum(there))


def test_mirror_rays_land_where_embree_rays_do(gl, caster):
    """At least 98% land within a pixel of Embree's hits on the screen; with three steps per ray, less than 95% do."""
    scene = hall(0.0)
    share, count = near_share(scene, traced(gl, scene, size=(320, 240)), caster)
    assert count > 10_000 and share >= 0.98, f"{share:.4f} of {count}"
    share, _ = near_share(scene, traced(gl, scene, ":steps=3"), caster)
    assert share < 0.95, share


def visible_facets(ways: np.ndarray, a: float, rng: np.random.Generator, side: int) -> np.ndarray:
    """Return side * side normals of visible GGX facets for each direction to the eye, (pixels, 3) in tangent space,
    by warping a disc (Heitz, Sampling the GGX Distribution of Visible Normals, 2018)."""
    stretched = unit(ways * (a, a, 1))
    first = unit(np.stack([-stretched[:, 1], stretched[:, 0], 0 * stretched[:, 0]], axis=1))
    second = np.cross(stretched, first)
    cells = np.stack(np.meshgrid(*[np.arange(side)] * 2), axis=-1).reshape(-1, 2)
    u, v = np.moveaxis((cells + rng.uniform(size=(len(ways), len(cells), 2))) / side, -1, 0)
    x, y = np.sqrt(u) * np.cos(2 * np.pi * v), np.sqrt(u) * np.sin(2 * np.pi * v)
    half = 0.5 * (1 + stretched[:, 2:])
    y = (1 - half) * np.sqrt(1 - x * x) + half * y
    z = np.sqrt(np.maximum(1 - x * x - y * y, 0))
    parts = zip((x, y, z), (first, second, stretched), strict=True)
    return unit(sum(part[..., None] * axis[:, None] for part, axis in parts) * (a, a, 1))


def lambda_of(cosine: np.ndarray, a: float) -> np.ndarray:
    """Return Smith's lambda for GGX: G1 = 1 / (1 + lambda), and G2 = 1 / (1 + the sum of both lambdas)."""
    return (np.sqrt(1 + a * a * (1 - cosine**2) / cosine**2) - 1) / 2


@dataclass(frozen=True)
class Glossy:
    """Embree's result for the mirror's pixels: their light, (pixels, 3), and the share of rays that hit a surface in
    the image which another surface, or the edge of a pixel, hides from the eye."""

    light: np.ndarray
    hidden: np.ndarray


def glossy(scene: Scene, found: Traced, caster: RayCaster, roughness: float, side: int) -> Glossy:
    origins, normals, to_eye = starts_of(scene, found)
    across = unit(np.cross(normals, (0.3, 0.1, 1.0)))
    axes, a = np.stack([across, np.cross(normals, across), normals], axis=1), roughness**2
    v = np.einsum("pij,pj->pi", axes, to_eye)
    light_ways = reflected(v[:, None], visible_facets(v, a, np.random.default_rng(1), side))
    n_l, of_v = light_ways[..., 2], lambda_of(v[:, 2:], a)
    # G2 / G1; nothing from below the horizon.
    weights = np.where(n_l > 0, (1 + of_v) / (1 + of_v + lambda_of(np.where(n_l > 0, n_l, 1.0), a)), 0.0)
    weights /= weights.sum(axis=1, keepdims=True)
    ways = np.einsum("pij,pki->pkj", axes, light_ways).reshape(-1, 3)
    origins = np.repeat(origins, side * side, axis=0)
    places, there = seen_hits(scene, found, caster, origins, ways)
    x, y = np.where(there[:, None], places, 0.0).astype(int).T
    light = np.where(there[:, None], found.image[y, x], 0.0).reshape(*weights.shape, 3)
    inside = caster.distances(origins, ways) < NONE
    inside &= np.all((places > 0) & (places < found.hits.shape[::-1]), axis=1)
    hidden = (inside & ~there).reshape(weights.shape)
    return Glossy(np.sum(weights[..., None] * light, axis=1), np.sum(weights * hidden, axis=1))


def test_glossy_floor_matches_many_embree_rays(gl, caster):
    """At roughness 0.3: 35 dB against 256 rays that are drawn differently and take their colours from the same image.

    Pixels that get a quarter of their light from hidden surfaces, such as the undersides of balls, are left out: the
    effect sees the rims of the balls there. They are less than 2% of the covered pixels.
    """
    scene, roughness = hall(0.3), 0.3
    trace = traced(gl, scene, ":rays=48:misses=nothing", (128, 96))
    exact = glossy(scene, trace, caster, roughness, 16)
    apart, is_open = trace.reflected[trace.mirror][:, :3] - exact.light, exact.hidden < 0.25
    left_out = np.sum(~is_open) / np.sum(np.isfinite(trace.positions[..., 0]))
    assert left_out < 0.02, left_out
    assert psnr(apart[is_open]) > 35 > psnr(exact.light[is_open]) + 15, psnr(apart[is_open])


def looks_and_samples(gl, settings: str, size=SMALL) -> tuple[float, int]:
    """Return how often rays sample the screen, and how many samples the pass draws by the device's count."""
    ssr = effect("ssr" + settings)
    with rendering(gl, PIPELINES["deferred"].with_effect(ssr.passes()), hall(0.0), plan_of(size)) as drawing:
        drawing.draw()
        query = gl.context.query(samples=True)
        with query:
            drawing.passes["ssr"]()
        return float(drawing.read(HITS)[0][..., 2].sum()), query.samples


def test_cost_grows_with_steps_rays_and_pixels(gl):
    """A ray takes at most one step per pixel of its path, plus the bisection of hits."""
    looks, samples = looks_and_samples(gl, ":steps=8:rays=1")
    assert samples == SMALL[0] * SMALL[1]
    twice, _ = looks_and_samples(gl, ":steps=16:rays=1")
    all_steps, _ = looks_and_samples(gl, ":steps=4096:rays=1")
    assert 1.3 * looks < twice < 2 * looks and all_steps < 3 * twice, (looks, twice, all_steps)
    many, _ = looks_and_samples(gl, ":steps=8:rays=4")
    assert 2 * looks < many < 4 * looks, "a mirror has one ray"
    larger, four_times = looks_and_samples(gl, ":steps=8:rays=1", (2 * SMALL[0], 2 * SMALL[1]))
    assert four_times == 4 * samples and 3.5 * looks < larger < 4.5 * looks, (looks, larger)


def test_a_mirror_has_no_noise(gl):
    """Any seed and any number of rays give the same image, and a repeated frame is identical. On a GPU, two programs
    may differ by a unit in the last place."""
    first, other = (traced(gl, hall(0.0), f":{chosen}", SMALL) for chosen in ("rays=1", "rays=4:seed=7"))
    apart = np.abs(first.reflected - other.reflected)[first.mirror].max()
    assert apart <= (0 if gl.is_software else 2.0**-22), apart
    again = traced(gl, hall(0.0), ":rays=4:seed=7", SMALL)
    assert np.array_equal(again.reflected, other.reflected)
    assert not np.array_equal(first.reflected, other.reflected), "what is rough has noise"


def test_roughness_is_read_as_the_layout_stores_it(gl):
    """In two bits, 0.16 becomes 0: the hits are those of a mirror, to 0.01 of a pixel."""
    targets = (Target("rgba32f", "normal.x normal.y normal.z depth"), *MATERIAL)
    coarse = replace(FP32, targets=targets)
    exact, kept, mirror = (
        traced(gl, hall(roughness), ":rays=1", SMALL, layout)
        for roughness, layout in ((0.16, FP32), (0.16, coarse), (0.0, FP32))
    )
    both = mirror.hits & kept.hits & mirror.mirror
    assert np.array_equal(kept.hits[mirror.mirror], mirror.hits[mirror.mirror]) and np.sum(both) > 500
    assert np.abs(kept.places - mirror.places)[both].max() < 0.01
    assert np.mean(np.linalg.norm(exact.places - mirror.places, axis=-1)[both & exact.hits] > 1) > 0.3


@pytest.mark.parametrize("pipeline", ["deferred", "hybrid"])
def test_reflections_replace_the_ambient_light(gl, pipeline):
    """On a mirror with a base of 1, the image is the effect's result; pixels without hits are unchanged."""
    scene = hall(0.0)
    trace, image = traced(gl, scene, ":rays=1", SMALL, pipeline=pipeline), final(gl, scene, ":rays=1", pipeline)
    shown = trace.reflected[trace.mirror]
    assert np.abs(image[trace.mirror] - shown[:, :3]).max() < 1e-4
    missed = trace.reflected[..., 3] == 0
    assert np.array_equal(image[missed], trace.image[missed])
    assert np.abs(shown[shown[:, 3] == 0][:, :3] - scene.ambient).max() < 1e-6
    black = traced(gl, scene, ":rays=1:misses=nothing", SMALL, pipeline=pipeline).reflected[trace.mirror]
    assert not black[shown[:, 3] == 0].any() and np.array_equal(black[shown[:, 3] == 1], shown[shown[:, 3] == 1])


def test_reflections_use_the_first_sample_of_a_pixel(gl):
    """With four samples per pixel, a mirror's image matches that with one sample, except at edges."""
    scene, ssr = hall(0.0), effect("ssr:rays=1")
    with rendering(
        gl, PIPELINES["deferred"].with_effect(ssr.passes()), scene, replace(plan_of(SMALL), samples=4)
    ) as drawing:
        drawing.draw()
        image = drawing.image()
    trace = traced(gl, scene, ":rays=1", SMALL)
    apart = np.abs(image - final(gl, scene, ":rays=1"))[trace.mirror].max(axis=-1)
    assert np.median(apart) < 0.02 and np.isfinite(image).all(), np.median(apart)
