"""Subsurface scattering over scenes: how the blurs spread light, where they stop, and what is rejected."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from drawing import psnr, scene_of
from scipy.special import erf
from skins import SIZE, SUBSURFACE, WALL, facing, passes, plan_of, scattered

from normalbench.gbuffer.effects.effect import EffectError, chosen
from normalbench.gbuffer.effects.subsurface.passes import CONSTANTS
from normalbench.gbuffer.effects.subsurface.profile import (
    VARIANCES,
    WEIGHTS,
    burley_distances,
    separable_kernel,
)
from normalbench.gbuffer.frame.contract import PipelineError
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.layouts.words import LayoutError
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.mesh import box
from normalbench.gbuffer.scenes.scene import KINDS, Light, Scene, ScenePart, placed

METHODS = {
    "separable": {"method": "separable"},
    "gaussians": {"method": "gaussians", "samples": 25},
    "burley": {"method": "burley", "samples": 33},
}


WIDTH, HEIGHT = SIZE


CENTRE = (HEIGHT // 2, WIDTH // 2)


# Four pixels for each millimetre of skin on a wall at a distance of one metre, whose picture is one metre high.
WIDE = 3 * 4 / HEIGHT


def dark() -> np.ndarray:
    return np.zeros((HEIGHT, WIDTH, 3), np.float32)


def dot() -> np.ndarray:
    light = dark()
    light[CENTRE] = 1
    return light


def spread(kernel: np.ndarray, scale: float, at: np.ndarray) -> np.ndarray:
    """Return the light at these distances from a line of light, (pixels, 3); two pixels share a tap between them."""
    near = np.maximum(1 - np.abs(at[:, None] - kernel[:, 3] * scale), 0)
    return near @ kernel[:, :3]


# Further samples, pairs, pipelines and codes of light are asked at night.
@pytest.mark.parametrize("samples, along", [(11, "rows"), (25, "columns")])
def test_a_blurred_line_of_light_matches_the_kernel(gl, samples, along):
    """A one-pixel line on a wall that faces the eye, at 1 and 2 m, is blurred into the kernel, to 1e-6 of the line.
    The kernel is `width` metres wide, so it is half as wide in the image at twice the distance."""
    column = along == "rows"
    line = dark()
    line[(slice(None), CENTRE[1]) if column else CENTRE[0]] = 1
    offsets = np.arange(WIDTH if column else HEIGHT) - CENTRE[int(column)]
    kernel, moments = separable_kernel(samples), []
    for distance in (1.0, 2.0):
        blurred = scattered(gl, facing(WALL, distance=distance), line, samples=samples, width=WIDE)
        profile = (blurred[CENTRE[0]] if column else blurred[:, CENTRE[1]])[:, :3]
        expected = spread(kernel, 4 / distance, offsets)
        apart = np.abs(profile - expected).max()
        assert apart < 1e-6, f"at {distance} m: {apart:.2g}"
        moments.append(np.sum(profile * np.abs(offsets)[:, None], axis=0))
    # A kernel's taps keep their mean distance between pixels, but for those next to the middle.
    assert np.allclose(moments[0] / moments[1], 2, rtol=0.02), moments


def six(at: np.ndarray) -> np.ndarray:
    """Return the six Gaussians, centred and integrated over pixels of 0.25 mm, (height, width, 3)."""
    edges = [(np.arange(n + 1) - n / 2) / 4 for n in (HEIGHT, WIDTH)]
    total = np.zeros((HEIGHT, WIDTH, 3))
    for v, w in zip(VARIANCES.tolist(), WEIGHTS, strict=True):
        y, x = (np.diff(erf(edge / np.sqrt(2 * v))) / 2 for edge in edges)
        total += y[:, None, None] * x[None, :, None] * w
    return total[at]


@pytest.mark.parametrize("pairs", [3, 4, 5])
def test_reused_gaussians_sum_to_the_original_six(gl, pairs):
    """More than 2 pixels from a dot, at 4 pixels per mm and 25 samples, the RMS error is below 1e-3 of the peak."""
    blurred = scattered(gl, facing(WALL), dot(), method="gaussians", pairs=pairs, samples=25, width=WIDE)[..., :3]
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    far = np.hypot(y - CENTRE[0], x - CENTRE[1]) > 2
    whole = six(np.s_[:])
    for channel in range(3):
        rms = np.sqrt(np.mean((blurred[far] - whole[far])[:, channel] ** 2)) / whole[..., channel].max()
        assert rms < 1e-3, f"channel {channel}: {rms:.2g} of the peak"


@pytest.mark.parametrize("method", ["separable", "gaussians"])
def test_a_closed_patch_keeps_its_light(gl, method):
    """Skin under varied light, surrounded by brighter stone: the sum over the patch is unchanged, to 1e-4. A pixel
    keeps the light that it does not pass on, and no light comes from the stone."""
    rng = np.random.default_rng(1)
    scene = facing((0.5, 0.5, 0.0, 0.0, 0), (9.0, 9.0, 0.0, -0.001, 1))
    light = rng.uniform(0, 1, (HEIGHT, WIDTH, 3)).astype(np.float32) ** 4
    blurred = scattered(gl, scene, light, **METHODS[method], width=WIDE)
    skin = blurred[..., 3] > 0
    assert 0.1 < skin.mean() < 0.5
    lost = blurred[skin][:, :3].sum(axis=0, dtype=float) / light[skin].sum(axis=0, dtype=float) - 1
    assert np.abs(lost).max() < 1e-4, f"{lost}"
    assert np.abs(blurred[skin][:, :3] - light[skin]).max() > 0.1, "nothing is blurred"


@pytest.mark.parametrize("method", METHODS)
def test_uniform_light_is_unchanged(gl, method):
    """On skin amid dark stone, light of one brightness is unchanged to 1e-6, also at the border."""
    scene = facing((0.5, 0.5, 0.0, 0.0, 0), (9.0, 9.0, 0.0, -0.001, 1))
    blurred = scattered(gl, scene, np.full((HEIGHT, WIDTH, 3), 0.7, np.float32), **METHODS[method], width=WIDE)
    skin = blurred[..., 3] > 0
    apart = np.abs(blurred[skin][:, :3] - 0.7).max()
    assert apart < 1e-6, f"{apart:.2g}"
    assert not blurred[~skin].any(), "there is light where no skin is"


@pytest.mark.parametrize("method", METHODS)
def test_planes_ten_widths_apart_do_not_mix(gl, method):
    """Two walls of skin meet in the image: light on one wall changes nothing on the other, bit for bit. Without depth
    following, the light spreads to the other wall."""
    width = 0.02
    scene = facing((4.0, 9.0, -2.0, 0.0, 0), (9.0, 9.0, 0.0, -10 * width, 0))
    lights = np.stack([dark(), dark()])
    lights[:, :, : WIDTH // 2] = 0.25
    lights[1, :, WIDTH // 2 :] = 8
    for follow, mixes in ((0.5, False), (0.0, True)):
        dim, other = (scattered(gl, scene, light, **METHODS[method], width=width, follow=follow) for light in lights)
        near = dim[..., 3] < 1 + width
        assert 0.3 < near.mean() < 0.7
        apart = np.abs(dim - other)[near].max()
        assert (apart > 0.1) == mixes and (mixes or apart == 0), f"follow={follow}: {apart:.2g}"


SEEDS, PARTS = 16, 16


def diffused(channel: int) -> np.ndarray:
    """Return R(r) of a channel, centred and integrated over pixels of 0.25 mm, (height, width). Each pixel is sampled
    at 16 x 16 points, except for the 1 / r term in the middle pixel, whose integral over a square of side a is 4 a
    asinh(1)."""
    y, x = ((np.arange(n * PARTS) + 0.5) / PARTS - n / 2 for n in (HEIGHT, WIDTH))
    d, r = burley_distances()[channel], np.hypot(y[:, None], x) / 4
    scale, share = 1 / (8 * np.pi * d), 1 / (4 * PARTS) ** 2
    middle = np.kron(dot()[..., 0], np.ones((PARTS, PARTS)))
    smooth = (np.exp(-r / d) + np.exp(-r / (3 * d)) - 2 * middle) / r * scale * share
    return smooth.reshape(HEIGHT, PARTS, WIDTH, PARTS).sum(axis=(1, 3)) + dot()[..., 0] * 2 * scale * np.arcsinh(1)


def test_normalised_diffusion_spreads_a_dot_like_its_profile(gl):
    """With 97 taps at 4 pixels per mm, the mean light over 16 seeds in each of five rings is that of the profile. The
    tolerance is four standard errors of the mean, and at most 0.02 of all light."""
    scene = facing(WALL)
    lights = [scattered(gl, scene, dot(), method="burley", samples=97, seed=n, width=WIDE) for n in range(SEEDS)]
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    r, edges = np.hypot(y - CENTRE[0], x - CENTRE[1]) / 4, (0, 0.5, 1, 2, 3, 4)
    for channel in range(3):
        expected = diffused(channel)
        for near, far in pairwise(edges):
            ring = (r >= near) & (r < far)
            sums = np.array([light[ring, channel].sum() for light in lights])
            apart, error = sums.mean() - expected[ring].sum(), sums.std(ddof=1) / SEEDS**0.5
            assert abs(apart) < min(4 * error + 1e-4, 0.02), (
                f"channel {channel}, {near} to {far} mm: {apart:+.4f} of all light, {error:.4f} expected"
            )


def test_noise_depends_on_pixel_and_seed(gl):
    """The disc turns by pixel and seed and is the same in the next frame; other methods ignore the seed."""
    rng = np.random.default_rng(2)
    light = rng.uniform(0, 1, (HEIGHT, WIDTH, 3)).astype(np.float32)
    for method, differ in (("burley", True), ("separable", False)):
        a, b, other = (scattered(gl, facing(WALL), light, **METHODS[method], seed=seed) for seed in (3, 3, 4))
        assert np.array_equal(a, b)
        assert np.any(a != other) == differ, method


def test_shadow_edges_bleed_red(gl):
    """With every method, a millimetre into the dark behind a straight edge, more red arrives than green and more
    green than blue; on the bright side more red is lost."""
    light = dark()
    light[:, : CENTRE[1] + 1] = 1
    for method, given in METHODS.items():
        row = scattered(gl, facing(WALL), light, **given, width=WIDE)[..., :3].mean(axis=0)
        inside, outside = row[CENTRE[1] + 1 + 4], row[CENTRE[1] - 4]
        assert inside[0] > 2 * inside[1] > 2 * inside[2] >= 0, f"{method}: {inside}"
        assert 1 - outside[0] > 2 * (1 - outside[1]), f"{method}: {outside}"


THROUGH = (0.5, 1.0, 2.0, 4.0, 8.0)


@pytest.mark.parametrize("translucency", [0.0, 0.83])
def test_sunlight_comes_through_slabs(gl, translucency):
    """Five slabs lit straight from behind show colour x T(d) with d = 16.5 (1 - translucency) thickness / width, to
    2e-4 of the colour. The thickness is reduced by 0.21 widths, because points are moved inwards. Without a shadow
    map, or with transmittance off, no light comes through."""
    width, colour = 0.01, (2.0, 1.5, 1.0)
    sun = Light("sun", colour, direction=(0.0, 0.0, 1.0))
    scene = slabs(sun, width)
    plan = plan_of(shadows=True)
    given = {"width": width, "translucency": translucency}
    light = scattered(gl, scene, plan=plan, **given)
    for number, thickness in enumerate(THROUGH):
        x = round(WIDTH / 2 + (number - 2) * 0.2 * HEIGHT)
        d = 16.5 * (1 - translucency) * (thickness - CONSTANTS["SHRINK"])
        expected = np.array(colour) * (WEIGHTS.T @ np.exp(-(d**2) / VARIANCES))
        apart = np.abs(light[CENTRE[0], x, :3] - expected).max()
        assert apart < 2e-4 * max(colour), f"{thickness} widths: {light[CENTRE[0], x, :3]}, not {expected}"
    middles = [round(WIDTH / 2 + (number - 2) * 0.2 * HEIGHT) for number in range(len(THROUGH))]
    for other in ({"plan": plan_of()}, {"plan": plan, "transmittance": 0}):
        assert not scattered(gl, scene, **(given | other))[CENTRE[0], middles, :3].any()


def slabs(sun: Light, width: float) -> Scene:
    """Return a scene of adjacent slabs of skin, as many widths thick as THROUGH lists, with their faces at z = 0."""
    around = facing(lights=(sun,))
    parts = tuple(
        ScenePart(box(0.16, 0.8, t * width), placed([((number - 2) * 0.2, 0.0, -t * width / 2)]), np.array([0]))
        for number, t in enumerate(THROUGH)
    )
    return Scene(parts, around.materials, around.lights, around.ambient, around.view, around.previous)


@dataclass(frozen=True)
class Pair:
    """Images without the effect and with it, and the mask of skin pixels."""

    without: np.ndarray
    with_it: np.ndarray
    skin: np.ndarray


def pair(gl, pipeline: str, scene: Scene, plan, **given) -> Pair:
    images = []
    for extra in ((), passes(given)):
        with rendering(gl, PIPELINES[pipeline].with_effect(extra), scene, plan) as r:
            r.draw()
            images.append(r.image())
            kinds = r.gbuffer()[1][..., 3] if plan.samples == 1 else None
    skin = np.zeros(images[0].shape[:2], bool) if kinds is None else kinds == KINDS.index("skin")
    return Pair(*images, skin)


@pytest.mark.parametrize(
    "pipeline, method", [("hybrid", "separable"), ("prepass", "gaussians"), ("inferred", "burley")]
)
def test_only_skin_changes(gl, pipeline, method):
    """Pixels that are not skin match those without the effect, bit for bit; most skin pixels change."""
    images = pair(gl, pipeline, scene_of("head"), plan_of(shadows=True), **METHODS[method])
    differ = np.any(images.without != images.with_it, axis=-1)
    assert 0.05 < images.skin.mean() < 0.6
    assert not np.any(differ & ~images.skin), f"{np.sum(differ & ~images.skin)} pixels that are not skin differ"
    assert np.mean(differ[images.skin]) > 0.9, f"{np.mean(differ[images.skin]):.1%} of skin differs"


def test_pipelines_scatter_the_same_light(gl):
    """Hybrid, pre-pass and inferred light the skin alike: at least 100 dB against hybrid."""
    images = [
        scattered(gl, scene_of("head"), pipeline=p, plan=plan_of(shadows=True))
        for p in ("hybrid", "prepass", "inferred")
    ]
    for other in images[1:]:
        decibels = psnr((other - images[0])[..., :3], images[0][..., :3].max())
        assert decibels >= 100, f"{decibels:.1f} dB"


@pytest.mark.parametrize("pipeline, changed", [("hybrid", {"samples": 4}), ("inferred", {"scale": 0.5})])
def test_no_skin_goes_dark(gl, pipeline, changed):
    """With four samples per pixel, and with a G-buffer of half the size, in the room with its glass panes: every
    bright pixel keeps more than a quarter of the light that it has without the effect."""
    images = pair(gl, pipeline, scene_of("room"), plan_of(**changed), transmittance=0)
    bright = images.without.max(axis=-1) > 0.02
    least = np.min(images.with_it.max(axis=-1)[bright] / images.without.max(axis=-1)[bright])
    assert least > 0.25, f"{least:.2f} of the light is left"
    assert np.any(images.with_it != images.without)


@pytest.fixture(scope="module")
def exact_light(gl):
    """Light of the bust in 32-bit floats: blurred, and unblurred because its width is below a pixel."""
    return [scattered(gl, scene_of("head"), width=width)[..., :3] for width in BLURRED]


BLURRED = (0.01, 0.0001)


# Saturation in four steps is for what a surface gives off.
COARSE = {"hue_saturation": 24}


# The nearest to floats, the least exact of those in floats, a shared exponent, and colours in few steps.
LIGHTS = ("rgba16f", "r11g11b10f", "rgb9e5", "hue_saturation")


@pytest.mark.parametrize("light", LIGHTS)
def test_light_is_read_in_every_encoding(gl, light, exact_light):
    """Scattered light scores at most 0.1 dB below unscattered light in the same format, and at least 30 dB or the
    format's entry in `COARSE`. Measured: 33.7 dB in R11G11B10F, whose blending loses small lights, to 64.4 dB in
    RGB9E5."""
    plan, decibels = plan_of(light=light), []
    for width, exact in zip(BLURRED, exact_light, strict=True):
        decibels.append(psnr(scattered(gl, scene_of("head"), plan=plan, width=width)[..., :3] - exact, exact.max()))
    least = COARSE.get(light, 30)
    assert decibels[0] >= max(decibels[1] - 0.1, least), f"{decibels[0]:.1f} dB, and {decibels[1]:.1f} dB unscattered"


@pytest.mark.parametrize(
    "given, blurs", [({"method": "separable"}, 2), ({"method": "gaussians"}, 6), ({"method": "burley"}, 1)]
)
def test_blurs_run_only_on_skin(gl, given, blurs):
    """Each blur draws as many samples as there are skin pixels, and none without skin."""
    pipeline = PIPELINES["hybrid"].with_effect(passes(given))
    names = [stage.name for stage in passes(given)][2:]
    assert len(names) == blurs
    for side in (0.2, 0.4, 0.8, 0.0):
        scene = facing((side, side, 0.0, 0.0, 0), (9.0, 9.0, 0.0, -0.001, 1))
        with rendering(gl, pipeline, scene, plan_of()) as r:
            for name in names:
                r.passes[name].run.queries = []
            r.draw()
            counted = [query.samples for name in names for query in r.passes[name].run.queries]
            skin = int(np.sum(r.gbuffer()[1][..., 3] == KINDS.index("skin")))
        assert counted == [skin] * blurs, f"{counted}, of {skin} pixels of skin"
        assert (skin > 0) == (side > 0)


def test_the_next_frame_starts_fresh(gl):
    """Frames drawn one after the other are identical, bit for bit: no mark remains."""
    pipeline = PIPELINES["hybrid"].with_effect(passes({"method": "gaussians"}))
    with rendering(gl, pipeline, scene_of("head"), plan_of(shadows=True)) as r:
        images = []
        for _ in range(3):
            r.draw()
            images.append(r.image())
    assert np.array_equal(images[0], images[1]) and np.array_equal(images[0], images[2])


def test_scene_without_skin_is_reported():
    assert SUBSURFACE.lacks(scene_of("head")) is None
    assert SUBSURFACE.lacks(scene_of("room")) is None
    assert SUBSURFACE.lacks(scene_of("gloss")) == "it has no skin"


@pytest.mark.parametrize(
    "given, said",
    [
        ({"method": "texture"}, "method=texture is not separable or gaussians or burley"),
        ({"samples": "12"}, "samples=12 is not 17 or 11 or 25 or 33 or 65 or 97"),
        ({"width": "0"}, "width=0 is not a number from 0.0001 to 10"),
        ({"translucency": "1"}, "translucency=1 is not a number from 0 to 0.999"),
        ({"transmittance": "2"}, "transmittance=2 is not a whole number from 0 to 1"),
        ({"pairs": "2"}, "pairs=2 is not 3 or 4 or 5"),
        ({"follow": "-1"}, "follow=-1 is not a number from 0 to 100"),
    ],
)
def test_out_of_range_setting_is_a_one_line_error(given, said):
    with pytest.raises(EffectError) as refused:
        chosen(SUBSURFACE, given)
    assert str(refused.value) == f"effect subsurface: {said}"


@pytest.mark.parametrize(
    "pipeline, said",
    [
        ("deferred", "pass skin_light expects LIGHT_HOLDS 0 or 2, but has 1"),
        ("forward", "pass sun_entry must come after lights; known: shadow_map, forward, transparent"),
        ("forward_multipass", "pass skin_light "),
    ],
)
def test_pipeline_without_skin_light_is_a_one_line_error(pipeline, said):
    with pytest.raises(PipelineError) as refused:
        PIPELINES[pipeline].with_effect(passes({}))
    assert str(refused.value).startswith(f"pipeline {pipeline}: {said}") and "\n" not in str(refused.value), (
        refused.value
    )


def test_layout_without_a_shading_model_is_a_one_line_error(gl):
    pipeline = PIPELINES["prepass"].with_effect(passes({}))
    plan = plan_of(layout=LAYOUTS["normal_depth_material"])
    with (
        pytest.raises(
            LayoutError, match=r"^prepass needs shading_model, which layout normal_depth_material does not store$"
        ),
        rendering(gl, pipeline, scene_of("head"), plan),
    ):
        pass
