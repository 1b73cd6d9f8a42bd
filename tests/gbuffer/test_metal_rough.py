"""Metallic-roughness surfaces, compared with their formulas in float64, in every pipeline and in several layouts."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from drawing import SIZE, apart, draw
from halves import WAYS, halves
from shading import dot

from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.vec import CONSTANTS as VEC
from normalbench.gbuffer.defines.materials import CONSTANTS
from normalbench.gbuffer.environment.dfg import dfg, dfg_table
from normalbench.gbuffer.environment.environment import Environment, directions
from normalbench.gbuffer.environment.sun import without_sun
from normalbench.gbuffer.frame.plan import LEAST_ROUGHNESS
from normalbench.gbuffer.gl.device import bind
from normalbench.gbuffer.layouts.layout import Layout
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.layouts.words import LayoutError, targets_of
from normalbench.gbuffer.scenes.files.read import file_scene, read_mesh_file
from normalbench.gbuffer.scenes.mesh import plane, sphere
from normalbench.gbuffer.scenes.metal_rough import Map, MetalRough
from normalbench.gbuffer.scenes.scene import Light, Scene, ScenePart, View, placed
from normalbench.gbuffer.scenes.setting import Setting

EYE = View((0.0, 0.0, 6.0), (0.0, 0.0, 0.0), 40.0, 1.0, 20.0)


# In view space, as the formulas have them.
LAMPS = (
    Light("point", (9.0, 6.0, 3.0), (1.5, 1.0, -3.0), 20.0),
    Light("point", (2.0, 5.0, 9.0), (-2.0, 0.5, -2.5), 20.0),
)


UPRIGHT = np.array([(1.0, 0, 0), (0, 0, 1.0), (0, -1.0, 0)])


def scene_of(*materials: MetalRough, ambient=(0.0, 0.0, 0.0), lamps=LAMPS, balls: int | None = None) -> Scene:
    """Return a scene with a ball of each material, or of the first `balls`, over a plane of the last material."""
    count = balls or len(materials)
    across = 2.4 * (np.arange(count) - (count - 1) / 2)
    balls = ScenePart(
        sphere(1.0, 64, 32), placed(np.stack([across, 0 * across, 0 * across], axis=1), 1.1), np.arange(count)
    )
    sheet = plane(8.0, 8.0).placed(UPRIGHT, (0.0, 0.0, -1.0))
    wall = ScenePart(sheet, placed((0, 0, 0)), np.array([len(materials) - 1]), casts=False)
    matrix = np.linalg.inv(EYE.matrix())
    lights = tuple(replace(lamp, position=tuple(matrix[:3, :3] @ lamp.position + matrix[:3, 3])) for lamp in lamps)
    return Scene((balls, wall), materials, lights, ambient, EYE, EYE)


def slanted() -> Map:
    """Return a normal map of a single normal: (0.3, -0.4) and the z that makes the length 1."""
    normal = np.array([0.3, -0.4, np.sqrt(0.75), 1.0])
    return Map(np.round((normal * 0.5 + 0.5) * 65535).astype(np.uint16)[None, None])


def test_a_normal_map_tilts_the_normal_in_the_tangent_frame(gl):
    """x along u, y against v, as in glTF: a plane whose u goes right and whose v goes up."""
    scene = scene_of(MetalRough(), MetalRough(normal_map=slanted()))
    normal = draw(gl, "hybrid", scene).gbuffer[1][4, 4, :3]
    assert normal == pytest.approx((0.3, 0.4, np.sqrt(0.75)), abs=2e-5)


def _answers(gl, light, eye, roughness, albedo, f0) -> tuple[np.ndarray, np.ndarray]:
    """Return the results of GLSL for single lights and for uniform light, (count,) each."""
    count = len(light)
    columns = [np.broadcast_to(np.asarray(x, float), (count,)) for x in (roughness, albedo, f0)]
    lights = np.concatenate([light, columns[0][:, None]], axis=1)
    eyes = np.concatenate([np.broadcast_to(eye, (count, 3)), np.zeros((count, 1))], axis=1)
    colours = np.stack([columns[1], columns[2], columns[0], columns[0]], axis=1)
    defines = {**CONSTANTS, **VEC, "LEAST_ROUGHNESS": LEAST_ROUGHNESS}
    shader = gl.compute_pass(Path(__file__).parents[1] / "inputs" / "answered.comp", defines)
    table = gl.upload(dfg_table())
    try:
        bind(shader, {"dfg": table})
        single, even = gl.computed(shader, [lights, eyes, colours], 2)
    finally:
        table.release()
        shader.release()
    return single[:, 0].astype(float), even[:, 0].astype(float)


@cache
def _halves(count: int = 96) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes in [0, 1] and [0, 2 pi) with their weights: Gauss-Legendre times the midpoint rule."""
    heights, of_heights = np.polynomial.legendre.leggauss(count)
    turns = (np.arange(2 * count) + 0.5) * np.pi / count
    u, p = np.meshgrid((heights + 1) / 2, turns, indexing="ij")
    return np.stack([u.ravel(), p.ravel()]), np.repeat(of_heights / 2, 2 * count) / (2 * count)


def _reflected(gl, n_v: float, roughness: float, f0: float) -> float:
    """Return the integral of the light that a black surface reflects, over all directions, sampled by GGX normals."""
    (u, p), weight = _halves()
    a2 = roughness**4
    # D n.h dw is uniform in u where tan^2 of the angle is a^2 u / (1 - u).
    cosine = np.sqrt((1 - u) / (1 - u + a2 * u))
    sine = np.sqrt(1 - cosine**2)
    h, eye = np.stack([sine * np.cos(p), sine * np.sin(p), cosine], axis=1), np.array([np.sqrt(1 - n_v**2), 0, n_v])
    v_h = dot(h, eye)
    light = 2 * v_h * h - eye
    single, _ = _answers(gl, light, eye, roughness, 0.0, f0)
    density = a2 / (np.pi * (cosine**2 * (a2 - 1) + 1) ** 2) * cosine / np.maximum(4 * v_h[:, 0], 1e-12)
    counts = (light[:, 2] > 0) & (v_h[:, 0] > 0)
    # The answer is to an irradiance of pi.
    return float(np.sum(np.where(counts, single / np.pi / density, 0.0) * weight))


def _scattered(gl, n_v: float, roughness: float) -> float:
    """Return the cosine-weighted integral of the light that a white dielectric reflects beyond a black one."""
    (u, p), weight = _halves(48)
    eye = np.array([np.sqrt(1 - n_v**2), 0, n_v])
    light = np.stack([np.sqrt(u) * np.cos(p), np.sqrt(u) * np.sin(p), np.sqrt(1 - u)], axis=1)
    white, black = (_answers(gl, light, eye, roughness, albedo, 0.04)[0] for albedo in (1.0, 0.0))
    return float(np.sum((white - black) / np.maximum(light[:, 2], 1e-12) * weight))


@pytest.mark.parametrize("roughness", [0.045, 0.1, 0.3, 0.5, 0.7, 1.0])
def test_a_white_surface_reflects_all_light(gl, roughness):
    """A white furnace of single lights, metal and dielectric: within 1%, n.v from 0.05."""
    for n_v in (0.05, 0.2, 0.5, 0.8, 1.0):
        metal = _reflected(gl, n_v, roughness, 1.0)
        white = _reflected(gl, n_v, roughness, 0.04) + _scattered(gl, n_v, roughness)
        assert abs(metal - 1) < 0.01, f"metal at n.v {n_v}: {metal:.4f}"
        assert abs(white - 1) < 0.01, f"white dielectric at n.v {n_v}: {white:.4f}"


def test_white_surfaces_are_white_in_uniform_light(gl):
    """A furnace with light from all directions, metal and dielectric, every roughness: within 1%."""
    n_v, roughness = (x.ravel() for x in np.meshgrid(np.linspace(0.05, 1, 20), np.linspace(0, 1, 21)))
    eyes = np.stack([np.sqrt(1 - n_v**2), 0 * n_v, n_v], axis=1)
    for name, albedo, f0 in (("metal", 0.0, 1.0), ("dielectric", 1.0, 0.04)):
        _, even = _answers(gl, eyes, eyes, roughness, albedo, f0)
        assert np.abs(even - 1).max() < 0.01, f"{name}: {even.min():.4f} to {even.max():.4f}"


def test_the_lobe_without_multiple_scattering_is_the_split_sum(gl):
    """Divided by its gain, the lobe of a metal is scale + bias, within 0.002."""
    for roughness in (0.3, 0.7, 1.0):
        for n_v in (0.2, 0.5, 1.0):
            single = sum(float(x) for x in dfg(np.array(n_v), np.array(roughness)))
            lobe = _reflected(gl, n_v, roughness, 1.0) * single
            assert abs(lobe - single) < 0.002, f"roughness {roughness}, n.v {n_v}: {lobe:.4f}, not {single:.4f}"


VARIED = (
    MetalRough((0.9, 0.6, 0.3), 1.0, 0.15),
    MetalRough((0.1, 0.4, 0.7), 0.0, 0.4, emission=(0.2, 0.1, 0.3)),
    MetalRough((0.6, 0.6, 0.5), 0.5, 0.8, occlusion_strength=1.0, occlusion_map=Map(np.full((1, 1, 4), 140, np.uint8))),
)


LIT = scene_of(*VARIED, ambient=(0.5, 0.5, 0.55))


@pytest.mark.parametrize("name", ["prepass", "inferred"])
def test_light_prepass_refuses_metallic_roughness_surfaces(gl, name):
    with pytest.raises(LayoutError, match="use forward, forward_multipass, deferred or hybrid"):
        draw(gl, name, LIT)


NORMAL, BASE, EMISSION = (
    "normal.x normal.y",
    "base_color.r base_color.g base_color.b",
    "emissive.r emissive.g emissive.b",
)


# What lies in 32-bit floats, and what lies in a bit or two of eight.
KEPT = {
    "": (f"{BASE} metallic", "roughness f0 ao shading_model", EMISSION, ""),
    "roughness": (f"{BASE} metallic", "f0 ao shading_model", EMISSION, "roughness:2"),
    "metallic": (f"{BASE} roughness", "f0 ao shading_model", EMISSION, "metallic:1"),
    "ao": (f"{BASE} metallic", "roughness f0 shading_model", EMISSION, "ao:1"),
    "emissive": (
        f"{BASE} metallic",
        "roughness f0 ao shading_model",
        "",
        "emissive.r:1 emissive.g:1 emissive.b:1",
    ),
    "base colour": (
        "metallic",
        "roughness f0 ao shading_model",
        EMISSION,
        "base_color.r:1 base_color.g:1 base_color.b:1",
    ),
}


def kept(name: str) -> Layout:
    """Return a layout that stores one attribute coarsely, and all others in floats."""
    *exact, coarse = KEPT[name]
    targets = [f"rgba32f: {words}" for words in (NORMAL, *exact) if words] + ([f"rgba8: {coarse}"] if coarse else [])
    return Layout("kept", "kept", targets_of("; ".join(targets)), ENCODINGS["octahedral"], "test")


@pytest.mark.parametrize("pipeline", ["deferred", "hybrid"])
def test_a_layout_with_metallic_in_floats_gives_the_same_image(gl, pipeline):
    """Base colour and metallic, or the two colours that follow from these attributes: 80 dB."""
    decibels = apart(draw(gl, pipeline, LIT, kept("")).image, draw(gl, pipeline, LIT).image)
    assert decibels >= 80, f"{decibels:.1f} dB"


@pytest.mark.parametrize("pipeline", ["deferred", "hybrid"])
@pytest.mark.parametrize("name", list(KEPT)[1:])
def test_each_attribute_in_one_or_two_bits_changes_the_image(gl, pipeline, name):
    """The PSNR against the image in floats is between 5 and 45 dB."""
    decibels = apart(draw(gl, pipeline, LIT, kept(name)).image, draw(gl, pipeline, LIT).image)
    assert 5 < decibels < 45, f"{decibels:.1f} dB"


@pytest.mark.parametrize("layout", ["fp32", "metal_rough"])
def test_extreme_materials_give_finite_images(gl, layout):
    """A stored roughness of exactly 0, a metallic of 0 and 1 and a black base colour, under every kind of light."""
    extremes = [MetalRough((base,) * 3, metalness, 0.0) for base in (0.0, 1.0) for metalness in (0.0, 1.0)]
    scene = scene_of(*extremes, ambient=(1.0, 1.0, 1.0))
    spot = Light("spot", (5.0, 5.0, 5.0), (0.0, 0.0, 5.0), 20.0, (0.0, 0.0, -1.0), 20.0, 40.0)
    scene = replace(scene, lights=(*scene.lights, spot, Light("sun", (1.0, 1.0, 1.0), direction=(0.0, 0.0, -1.0))))
    for name in ("forward", "deferred", "hybrid"):
        image = draw(gl, name, scene, LAYOUTS[layout]).image
        assert np.isfinite(image).all() and image.max() > 0, f"{name}: {np.sum(~np.isfinite(image))} are not finite"


def test_a_mirror_in_uniform_light_has_the_colour_of_its_reflectance(gl):
    """In uniform light, a mirror of reflectance (0.9, 0.6, 0.3) has this colour."""
    image = draw(gl, "hybrid", scene_of(MetalRough((0.9, 0.6, 0.3), 1.0, 0.0), ambient=(1, 1, 1), lamps=())).image
    middle = image[SIZE[1] // 2, SIZE[0] // 2]
    assert middle == pytest.approx((0.9, 0.6, 0.3), rel=2e-3)


def test_a_pixel_that_covers_many_normals_is_rougher(gl):
    """Antialiasing makes the rim of a mirror ball rougher, but hardly a plane. Without it, both stay at 0."""
    scene = scene_of(MetalRough(metalness=1.0, roughness=0.0))
    widened, plain = (draw(gl, "hybrid", scene, antialiased=on).gbuffer[2][..., 3] for on in (True, False))
    assert plain.max() == 0
    assert widened[4, 4] < 0.01 < widened.max(), f"{widened[4, 4]} on the plane, at most {widened.max()}"


@pytest.mark.parametrize("authored", [False, True], ids=["made tangents", "the file's tangents"])
@pytest.mark.parametrize("way", range(len(WAYS)), ids=["as it is", "turned", "mirrored", "mirrored and turned"])
def test_a_normal_mapped_dome_is_lit_like_a_modelled_dome(gl, tmp_path, way, authored):
    """The light comes from the same side and is as bright: each half of the two domes has the same mean colour within
    3%. Both domes are rough, because the eye sees them from two sides."""
    material = {"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 1.0}}
    file = read_mesh_file(halves(WAYS[way], authored, **material).write(tmp_path / "halves.glb"))
    sun = Light("sun", (1.0, 1.0, 1.0), direction=(0.6, -0.48, -0.64))
    scene = replace(file_scene(file, Setting(lights=0)), lights=(sun,), environment=None, ambient=(0.0, 0.0, 0.0))
    drawn = draw(gl, "hybrid", scene, antialiased=False)
    right = drawn.gbuffer[0][..., 0]

    def mean(middle: float, low: float, high: float) -> tuple[float, ...]:
        """Return the mean colour from `low` to `high` right of `middle`; the rim is partly outside the image."""
        return tuple(map(float, drawn.image[(right > middle + low) & (right < middle + high)].mean(axis=0)))

    for low, high in ((-0.9, -0.1), (0.1, 0.9)):
        modelled, mapped = mean(-1.1, low, high), mean(1.1, low, high)
        assert mapped == pytest.approx(modelled, rel=0.03), f"{low} to {high}: {mapped}, not {modelled}"
    assert mean(1.1, -0.9, -0.1)[0] > 1.2 * mean(1.1, 0.1, 0.9)[0], "the light comes from the left"


def test_a_mirror_reflects_the_environment_behind_the_eye(gl):
    """The half of the directions behind the eye has its own colour, which a mirror ball shows in its middle."""
    towards = directions(64)
    light = np.where(towards[..., 2:] > 0, (0.1, 0.8, 0.2), (0.7, 0.1, 0.1)).astype(np.float32)
    scene = replace(scene_of(MetalRough((1.0, 1.0, 1.0), 1.0, 0.0), lamps=()), environment=Environment("two", light))
    image = draw(gl, "hybrid", scene, antialiased=False).image
    assert image[SIZE[1] // 2, SIZE[0] // 2] == pytest.approx((0.1, 0.8, 0.2), abs=2e-3)


def test_a_sun_in_an_environment_becomes_the_scenes_sun():
    """The irradiance is the same: a light of colour c gives pi c."""
    towards = directions(64)
    way = np.array((0.6, 0.64, 0.48))
    light = np.where((towards @ way)[..., None] > np.cos(np.radians(3)), 5000.0, 0.5) * np.ones(3)
    around = without_sun(Environment("sunny", light.astype(np.float32)))
    scene = scene_of(MetalRough()).under(around)
    assert around.sun is not None and scene.sun is not None
    assert np.dot(scene.sun.direction, -way) > np.cos(np.radians(1))
    assert np.multiply(scene.sun.colour, np.pi) == pytest.approx(around.sun[1])
    assert len(scene.lights) == 1 + len(LAMPS)


def test_a_bump_in_a_normal_map_is_a_hollow_from_behind(gl):
    """A sheet that is seen from its back has the normal of its front, reversed."""
    mapped = MetalRough(normal_map=slanted())
    away = plane(8.0, 8.0).placed(UPRIGHT @ np.diag([1.0, 1.0, -1.0]), (0.0, 0.0, -1.0))
    sheet = ScenePart(away, placed((0, 0, 0)), np.array([0]), casts=False, two_sided=True)
    normal = draw(gl, "hybrid", replace(scene_of(mapped), parts=(sheet,))).gbuffer[1][4, 4, :3]
    # The sheet is the one that faces the eye, seen in a mirror along z: (0.3, 0.4, -0.87), turned round.
    assert normal == pytest.approx((-0.3, -0.4, np.sqrt(0.75)), abs=2e-5)
