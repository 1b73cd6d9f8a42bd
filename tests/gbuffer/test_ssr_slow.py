"""Screen-space reflections against rays by Embree, their cost, and what they do with codes of the G-buffer."""

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
    """World points, (..., 3), in pixels from the upper left, (..., 2)."""
    clip = (
        np.concatenate([points, np.ones_like(points[..., :1])], -1)
        @ (scene.view.projection(size[0] / size[1]) @ scene.view.matrix()).T
    )
    flat = clip[..., :2] / clip[..., 3:]
    return (flat * (1, -1) * 0.5 + 0.5) * size


def seen_hits(scene: Scene, found: Traced, caster: RayCaster, origins: np.ndarray, ways: np.ndarray):
    """Where rays, (rays, 3), meet what the screen shows: places, (rays, 2), and whether they do.

    What they meet is on the screen if the pixel there shows that surface: it lies in the tangent plane of the pixel's.
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
    """Of the mirror's pixels: points a little over the surface, normals, and the ways to the eye; (pixels, 3)."""
    positions, normals = found.positions[found.mirror], found.normals[found.mirror]
    to_eye = np.array(scene.view.eye) - positions
    return positions + OVER * np.linalg.norm(to_eye, axis=1)[:, None] * normals, normals, unit(to_eye)


@pytest.fixture(scope="module")
def caster() -> RayCaster:
    pytest.importorskip("embreex")
    return RayCaster(triangles_of(hall(0.0)))


def near_share(scene: Scene, found: Traced, caster: RayCaster) -> tuple[float, int]:
    """Of the mirror's rays that meet what is on the screen, by Embree: the share that lands within a pixel, and their
    number."""
    origins, normals, to_eye = starts_of(scene, found)
    places, there = seen_hits(scene, found, caster, origins, reflected(to_eye, normals))
    away = np.linalg.norm(found.places[found.mirror] - places, axis=1)
    return float(np.mean((found.hits[found.mirror] & (away <= 1))[there])), int(np.sum(there))


def test_a_mirrors_rays_land_where_embrees_do(gl, caster):
    """98 % within a pixel of what Embree meets and the screen shows. With three steps a ray it is less than 95 %."""
    scene = hall(0.0)
    share, count = near_share(scene, traced(gl, scene, size=(320, 240)), caster)
    assert count > 10_000 and share >= 0.98, f"{share:.4f} of {count}"
    share, _ = near_share(scene, traced(gl, scene, ":steps=3"), caster)
    assert share < 0.95, share


def visible_facets(ways: np.ndarray, a: float, rng: np.random.Generator, side: int) -> np.ndarray:
    """Normals of GGX's facets that ways to the eye see, (pixels, 3) in tangent space, side * side to each: by a disc
    that is bent to the facets' shape (Heitz, Sampling the GGX Distribution of Visible Normals, 2018)."""
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
    """Smith's, of GGX: G1 = 1 / (1 + lambda), G2 = 1 / (1 + both)."""
    return (np.sqrt(1 + a * a * (1 - cosine**2) / cosine**2) - 1) / 2


@dataclass(frozen=True)
class Glossy:
    """What Embree says of the mirror's pixels: their light, (pixels, 3), and the share of it that another surface hides
    from the eye, or the edge of a pixel."""

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


def test_a_glossy_floor_is_what_many_rays_by_embree_make_of_it(gl, caster):
    """Roughness 0.3: 35 dB from 256 rays that are drawn in another way and take their colours from the same image.

    Left out are pixels that get a quarter of their light from what is hidden, such as the undersides of balls: the
    effect takes their rims for these. They are less than 2 % of what is covered.
    """
    scene, roughness = hall(0.3), 0.3
    found = traced(gl, scene, ":rays=48:misses=nothing", (128, 96))
    exact = glossy(scene, found, caster, roughness, 16)
    apart, is_open = found.reflected[found.mirror][:, :3] - exact.light, exact.hidden < 0.25
    left_out = np.sum(~is_open) / np.sum(np.isfinite(found.positions[..., 0]))
    assert left_out < 0.02, left_out
    assert psnr(apart[is_open]) > 35 > psnr(exact.light[is_open]) + 15, psnr(apart[is_open])


def looks_and_samples(gl, settings: str, size=SMALL) -> tuple[float, int]:
    """How often rays look at the screen, and the samples that the pass draws, which the device counts."""
    one = effect("ssr" + settings)
    with rendering(gl, PIPELINES["deferred"].with_effect(one.passes()), hall(0.0), plan_of(size)) as made:
        made.draw()
        query = gl.context.query(samples=True)
        with query:
            made.passes["ssr"]()
        return float(made.read(HITS)[0][..., 2].sum()), query.samples


def test_cost_grows_with_steps_rays_and_pixels(gl):
    """A ray takes no more steps than its way has pixels; the halvings of hits come on top."""
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
    """Any seed and any number of rays give one image, and the same frame again. On a GPU two programs may be a unit in
    the last place apart."""
    first, other = (traced(gl, hall(0.0), f":{chosen}", SMALL) for chosen in ("rays=1", "rays=4:seed=7"))
    apart = np.abs(first.reflected - other.reflected)[first.mirror].max()
    assert apart <= (0 if gl.is_software else 2.0**-22), apart
    again = traced(gl, hall(0.0), ":rays=4:seed=7", SMALL)
    assert np.array_equal(again.reflected, other.reflected)
    assert not np.array_equal(first.reflected, other.reflected), "what is rough has noise"


def test_roughness_is_what_the_layout_keeps_of_it(gl):
    """In two bits 0.16 becomes 0: what rays of a mirror meet, to a hundredth of a pixel."""
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
def test_it_takes_the_place_of_what_lies_around(gl, pipeline):
    """Of a mirror with a base of 1: the image there is the effect's, and all else is as it was but for hits."""
    scene = hall(0.0)
    found, image = traced(gl, scene, ":rays=1", SMALL, pipeline=pipeline), final(gl, scene, ":rays=1", pipeline)
    shown = found.reflected[found.mirror]
    assert np.abs(image[found.mirror] - shown[:, :3]).max() < 1e-4
    missed = found.reflected[..., 3] == 0
    assert np.array_equal(image[missed], found.image[missed])
    assert np.abs(shown[shown[:, 3] == 0][:, :3] - scene.ambient).max() < 1e-6
    black = traced(gl, scene, ":rays=1:misses=nothing", SMALL, pipeline=pipeline).reflected[found.mirror]
    assert not black[shown[:, 3] == 0].any() and np.array_equal(black[shown[:, 3] == 1], shown[shown[:, 3] == 1])


def test_samples_of_a_pixel_are_drawn_by_its_first(gl):
    """With four samples a pixel: a mirror's image is that of one sample, but at edges."""
    scene, one = hall(0.0), effect("ssr:rays=1")
    with rendering(
        gl, PIPELINES["deferred"].with_effect(one.passes()), scene, replace(plan_of(SMALL), samples=4)
    ) as made:
        made.draw()
        image = made.image()
    found = traced(gl, scene, ":rays=1", SMALL)
    apart = np.abs(image - final(gl, scene, ":rays=1"))[found.mirror].max(axis=-1)
    assert np.median(apart) < 0.02 and np.isfinite(image).all(), np.median(apart)
