"""Water: reflection and transmission of still water, waves against their formula, the grid, caustics and leaks."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
import water_twin as twin
from drawing import FP32, apart

from normalbench.bench.subjects.names.effects import lacking
from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.effects.catalogue import EFFECTS
from normalbench.gbuffer.effects.effect import EffectError, chosen
from normalbench.gbuffer.effects.water.grid import FIRST_GAP, STEP, Grid, centre_under, reach
from normalbench.gbuffer.effects.water.mirror import mirrored_view
from normalbench.gbuffer.effects.water.resources import CONSTANTS, WATER, Maps
from normalbench.gbuffer.effects.water.water_waves import waves_of
from normalbench.gbuffer.frame.contract import Pass, PipelineError
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.frame.resource import Resource
from normalbench.gbuffer.gl.device import read_pixels
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.built_in.lake import TREES
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.mesh import box, plane
from normalbench.gbuffer.scenes.scene import Light, Material, Scene, ScenePart, View, Water, placed
from normalbench.gbuffer.scenes.setting import Setting

SIZE = (96, 72)


LIGHT = {"texels": "128", "rings": "96", "spokes": "96"}


EFFECT = EFFECTS["water"]


BLACK = (0.0, 0.0, 0.0)


# Nothing is seen through it.
OPAQUE = (1e6, 1e6, 1e6)


@dataclass(frozen=True)
class Drawn:
    """A frame, row 0 at the top: the image, and the colour and alpha of the water."""

    image: np.ndarray
    water: np.ndarray

    @property
    def wet(self) -> np.ndarray:
        return self.water[..., 3] == 1


def plan_of(pipeline: str, samples: int = 1) -> Plan:
    targets = max(PIPELINES[pipeline].light_targets, default=1)
    return Plan(SIZE, samples, FP32, LIGHT_BUFFERS["rgba32f"], targets, True, 1.0)


def passes_of(**given) -> tuple[Pass, ...]:
    return chosen(EFFECT, {name: str(value) for name, value in {**LIGHT, **given}.items()}).passes()


def draw(gl, scene: Scene, pipeline="forward", **given) -> Drawn:
    with rendering(gl, PIPELINES[pipeline].with_effect(passes_of(**given)), scene, plan_of(pipeline)) as drawing:
        drawing.draw()
        return Drawn(drawing.image(), drawing.read(WATER)[0])


@cache
def lake(time: float = 0.0) -> Scene:
    return SCENES["lake"].make(Setting(lights=4, time=time))


def optics(gl, tmp_path, call: str, numbers: np.ndarray) -> np.ndarray:
    """Return a function of `water_optics.glsl` evaluated at each number."""
    path = tmp_path / "mine.frag"
    path.write_text(
        '#version 430\n#include "water_optics.glsl"\nuniform sampler2D numbers;\nout vec4 o;\n'
        f"void main() {{ float x = texelFetch(numbers, ivec2(gl_FragCoord.xy), 0).x; o = vec4({call}); }}\n"
    )
    with_tables = gl.fragment_pass(path, {"INDEX": CONSTANTS["INDEX"], "EXACT_FRESNEL": 1})
    target = gl.target((len(numbers), 1), STORAGES["rgba32f"])
    gl.render(with_tables, [target], numbers=gl.upload(numbers[None, :, None]))
    return read_pixels(target)[0].astype(np.float64)


ANGLES = np.radians(np.linspace(0, 89.99, 9000))


def test_fresnel_reflectance_is_accurate(gl, tmp_path):
    """The error is below 1e-4 at all angles; at 0°, 30° and 60° the values are 0.0204, 0.0214 and 0.0597."""
    fresnel = optics(gl, tmp_path, "exact_fresnel(x)", np.cos(ANGLES))[:, 0]
    error = np.abs(fresnel - twin.fresnel(ANGLES))
    assert error.max() < 1e-4, f"{error.max():.2g} at {np.degrees(ANGLES[error.argmax()]):.2f} degrees"
    known = optics(gl, tmp_path, "exact_fresnel(x)", np.cos(np.radians([0.0, 30.0, 60.0])))[:, 0]
    assert np.round(known, 4).tolist() == [0.0204, 0.0214, 0.0597], known


def test_schlick_approximation_has_its_known_error(gl, tmp_path):
    """The approximation is too high by at most 0.059, near 84°."""
    over = optics(gl, tmp_path, "schlick_fresnel(x)", np.cos(ANGLES))[:, 0] - twin.fresnel(ANGLES)
    worst, angle = np.abs(over).max(), np.degrees(ANGLES[np.abs(over).argmax()])
    assert round(over.max(), 3) == 0.059 and worst == over.max() and abs(angle - 84) < 0.5, (
        f"{worst:.4f} at {angle:.1f}"
    )


def test_two_layers_transmit_as_much_as_one_layer_of_twice_the_depth(gl, tmp_path):
    """The product of the two transmittances agrees to a relative 2e-6; each is exp(-k d)."""
    metres = np.linspace(0, 8, 400)
    single = optics(gl, tmp_path, "transmittance(vec3(0.6, 0.22, 0.17), x), 1.0", metres)[:, :3]
    two = optics(gl, tmp_path, "transmittance(vec3(0.6, 0.22, 0.17), 2.0 * x), 1.0", metres)[:, :3]
    error = np.abs(single * single / two - 1).max()
    assert error < 2e-6, f"{error:.2g}"
    error = np.abs(single / np.exp(-np.outer(metres.astype(np.float32), (0.6, 0.22, 0.17))) - 1).max()
    assert error < 2e-6, f"{error:.2g} from exp(-k d)"


def above_water() -> Scene:
    """Return the lake's sky and trees and a box over the water, under ambient light alone."""
    scene = lake()
    kept = [part for part in scene.parts if _shines(scene, part) or len(part.materials) == TREES]
    hovering = ScenePart(box(2.0, 1.0, 1.0), placed((0.5, 1.2, 6.0)), np.array([1]))
    return replace(scene, parts=(*kept, hovering), lights=())


def _shines(scene: Scene, part: ScenePart) -> bool:
    return max(scene.materials[part.materials[0]].emissive) > 0


def test_still_water_shows_the_view_of_the_mirrored_camera(gl):
    """Pixels match the mirrored camera's pixels times the Fresnel reflectance in float64, to 1.5e-4 of the brightest;
    the water is opaque."""
    scene = above_water()
    scene = replace(scene, water=Water(deep=BLACK, extinction=OPAQUE))
    drawn = draw(gl, scene, waves=0)
    turned = replace(scene, view=mirrored_view(scene.view, 0.0), water=None)
    with rendering(gl, PIPELINES["forward"], turned, plan_of("forward")) as drawing:
        drawing.draw()
        mirrored = drawing.image()[:, ::-1]
    share = twin.fresnel(np.arccos(np.clip(-twin.still_rays(scene.view, SIZE)[..., 1], 0, 1)))[..., None]
    error = np.abs(drawn.water[..., :3] - share * mirrored).max(axis=-1)[drawn.wet] / mirrored.max()
    assert drawn.wet.mean() > 0.3, f"{drawn.wet.mean():.0%} of the image is water"
    assert error.max() < 1.5e-4, f"{error.max():.2g}, {np.mean(error > 1e-4):.2%} of the pixels"


def test_still_water_does_not_displace_the_image_below(gl):
    """A pixel equals the image without water, faded to the deep colour by exp(-k d), with no reflection: to 1e-4 of
    the brightest."""
    water = Water(deep=(0.2, 0.4, 0.6))
    view = View((0.0, 3.0, 4.0), (0.0, -1.0, 0.0), 50.0, 0.5, 40.0)
    floor = ScenePart(plane(30.0, 30.0), placed((0, -1.5, 0)), np.array([0]), casts=False)
    stones = ScenePart(box(1.0, 0.6, 1.0), placed([(0, -1.2, 0), (1.2, -0.9, 1.0)]), np.array([1, 1]))
    materials = (Material(albedo=(0.5, 0.4, 0.3)), Material(albedo=(0.8, 0.1, 0.1)))
    scene = Scene((floor, stones), materials, (), (1.0, 1.0, 1.0), view, view, water)
    drawn = draw(gl, scene, "deferred", waves=0)
    with rendering(gl, PIPELINES["deferred"], replace(scene, water=None), plan_of("deferred")) as drawing:
        drawing.draw()
        ground, position = drawing.image(), drawing.gbuffer()[0][..., :3].astype(float)
    ways = twin.still_rays(view, SIZE)
    column = np.linalg.norm(position, axis=-1) - 3.0 / -ways[..., 1]
    left = np.exp(-column[..., None] * np.array(water.extinction))
    share = twin.fresnel(np.arccos(-ways[..., 1]))[..., None]
    expected = (1 - share) * (left * ground + (1 - left) * np.array(water.deep))
    error = np.abs(drawn.water[..., :3] - expected).max(axis=-1)
    assert drawn.wet.all() and error.max() < 1e-4, (
        f"{error.max():.2g} at {np.unravel_index(error.argmax(), error.shape)}"
    )


def probed(gl, tmp_path, **given) -> tuple[np.ndarray, np.ndarray]:
    """Return the points and normals that `water_map.glsl` gives at every texel's centre, [z, x, 3]."""
    texels = int(LIGHT["texels"])
    maps = Maps(given["octaves"], texels)
    points, normals = (Resource(name, "rgba32f", (texels, texels)) for name in ("probe_points", "probe_normals"))
    path = tmp_path / "probe.frag"
    path.write_text(
        '#version 430\n#include "water_map.glsl"\nlayout(location = 0) out vec4 p;\nlayout(location = 1) out vec4 n;\n'
        "void main() {\n    vec2 rest = gl_FragCoord.xy / float(TEXELS) * patch_size;\n"
        "    Wave w = wave_at(rest, 0.0);\n    p = vec4(wave_point(rest, w), 1.0);\n"
        "    n = vec4(wave_normal(w), 0.0);\n}\n"
    )

    def build(canvas):
        target, covers = canvas.target(points, normals), canvas.fullscreen(path, **maps.defines(given["chop"]))

        def run():
            target.use()
            canvas.device.state(None)
            for name, value in {"patch_size": Water.patch, "shortest": 1.0, "level": 0.0}.items():
                # A compiler drops what it finds that nothing reads.
                if name in covers.program:
                    covers.program[name] = value
            canvas.prepare(covers.program)
            covers.render(vertices=3)

        return run

    waves, *_ = passes_of(**given)
    probe = Pass("probe", waves.writes, (points, normals), build, after=("forward",))
    scene = replace(lake(), water=Water())
    with rendering(gl, PIPELINES["forward"].with_effect((waves, probe)), scene, plan_of("forward")) as drawing:
        drawing.draw()
        return tuple(drawing.read(resource)[0][::-1, :, :3].astype(np.float64) for resource in (points, normals))


@pytest.mark.parametrize("chop", [0.0, 0.3])
def test_waves_are_the_sum_of_cosines(gl, tmp_path, chop):
    """Points agree to 1e-5 m and normals to 1e-5 at every texel."""
    points, normals = probed(gl, tmp_path, octaves=5, chop=chop)
    expected, turned = _analytic(5, chop)
    error = np.abs(points - expected).max()
    assert error < 1e-5, f"points are {error:.2g} m off"
    assert np.abs(normals - turned).max() < 1e-5, f"normals are {np.abs(normals - turned).max():.2g} off"


def _analytic(octaves: int, chop: float) -> tuple[np.ndarray, np.ndarray]:
    place = (np.arange(int(LIGHT["texels"])) + 0.5) / int(LIGHT["texels"]) * Water.patch
    return twin.surface(waves_of(Water(), octaves, 0, 1.0), *np.meshgrid(place, place), chop)


@pytest.mark.parametrize("chop", [0.0, 0.3])
def test_grid_normals_converge_quadratically_to_the_gradients(gl, tmp_path, chop):
    """Normals are central differences over 1, 2 and 4 texels: each doubling multiplies the error by 3.8 to 4.1. The
    shortest wave is 21 texels long."""
    points, _ = probed(gl, tmp_path, octaves=2, chop=chop)
    exact, errors = _analytic(2, chop)[1], []
    for step in (1, 2, 4):
        inside = slice(step, -step)
        along_x = (np.roll(points, -step, axis=1) - np.roll(points, step, axis=1))[inside, inside]
        along_z = (np.roll(points, -step, axis=0) - np.roll(points, step, axis=0))[inside, inside]
        errors.append(np.sqrt(np.mean((twin.unit(np.cross(along_z, along_x)) - exact[inside, inside]) ** 2)))
    ratios = np.array(errors[1:]) / errors[:-1]
    assert np.all((ratios > 3.8) & (ratios < 4.1)), f"errors {errors}, ratios {ratios}"


def test_waves_have_the_requested_slope_and_repeat():
    """The RMS slope is right to 1e-9. After a period every wave is where it was; after half a period it is not."""
    waves = waves_of(Water(slope=0.15), 5, 3, 2.0)
    assert np.sqrt(waves.slopes[0]) == pytest.approx(0.3, rel=1e-9)
    again, half = (waves_of(Water(slope=0.15, time=t), 5, 3, 2.0) for t in (20.0, 10.0))
    off = np.abs((again.phases - waves.phases + 0.5) % 1 - 0.5)
    assert off.max() < 1e-9, f"{off.max():.2g} turns"
    assert np.mean(np.abs((half.phases - waves.phases + 0.5) % 1 - 0.5) > 0.1) > 0.2
    assert np.array_equal(waves.numbers, np.round(waves.numbers)) and np.abs(waves.numbers).sum(axis=1).min() >= 1


def test_waves_move_with_the_scene(gl):
    """Two moments differ, and drawing them one after the other gives the same as drawing each alone."""
    alone = [draw(gl, lake(time)).water for time in (0.0, 0.2)]
    with rendering(gl, PIPELINES["forward"].with_effect(passes_of()), lake(0.0), plan_of("forward")) as drawing:
        for time, expected in zip((0.0, 0.2), alone, strict=True):
            drawing.draw(lake(time))
            assert np.array_equal(drawing.read(WATER)[0], expected), f"the moment {time} differs"
    assert np.mean(np.abs(alone[0] - alone[1]).max(axis=-1) > 0.01) > 0.1


GRID = Grid(256, 256)


def test_the_grid_has_no_crack():
    """Every edge belongs to two triangles, once in each direction; only edges of the last ring belong to one."""
    triangles = GRID.triangles
    edges = Counter((int(t[i]), int(t[(i + 1) % 3])) for t in triangles for i in range(3))
    assert max(edges.values()) == 1, "an edge is passed twice the same way"
    alone = [edge for edge in edges if edge[::-1] not in edges]
    outermost = len(GRID.vertices) - GRID.spokes
    assert len(alone) == GRID.spokes and min(min(edge) for edge in alone) >= outermost
    assert len(np.unique(GRID.vertices, axis=0)) == len(GRID.vertices), "two vertices lie in one place"


def test_the_first_rings_are_distinct_in_float32():
    """The gap is 10 cm, even 1 km from the origin and with a reach of 40 km; r = a0 + a1 i^4 gives 9 um there."""
    radii = GRID.radii(40000.0)
    assert radii[0] == pytest.approx(FIRST_GAP, rel=1e-3) and radii[-1] == pytest.approx(40000.0)
    assert np.diff(np.float32(1000.0) + radii.astype(np.float32)).min() > 0.099
    published = 40000.0 / 256**4
    assert published == pytest.approx(9.3e-6, rel=0.01)


def test_the_grid_does_not_swim():
    """Turning the camera moves no vertex, nor does a move of less than half a step; a whole step moves all vertices
    by a step."""
    view = View((3.5, 2.0, -7.0), (0.0, 1.0, 0.0), 60.0, 0.5, 100.0)
    centre = centre_under(view)
    assert centre == (3.5, -7.0)
    for moved in (replace(view, target=(9.0, 0.0, 3.0)), replace(view, eye=(3.5 + 0.49 * STEP, 5.0, -7.0))):
        assert centre_under(moved) == centre and reach(moved, 4 / 3) == reach(view, 4 / 3)
    assert centre_under(replace(view, eye=(3.5 + STEP, 2.0, -7.0 - 3 * STEP))) == (3.5 + STEP, -7.0 - 3 * STEP)


def open_water(view: View, **water) -> Scene:
    """Return a scene of deep water with nothing in it."""
    floor = ScenePart(plane(4000.0, 4000.0), placed((0, -50.0, 0)), np.array([0]), casts=False)
    sun = Light("sun", (1.0, 1.0, 1.0), direction=(0.48, -0.6, 0.64))
    return Scene((floor,), (Material(),), (sun,), (0.3, 0.3, 0.3), view, view, Water(**water))


@pytest.mark.parametrize("eye", [(0.0, 1.0, 0.0), (123.4, 6.0, -77.7), (3000.3, 40.0, 2000.1)])
def test_open_water_covers_every_pixel(gl, eye):
    """Seen from straight above, with waves, every pixel is water and finite."""
    view = View(eye, (eye[0] + 0.01, 0.0, eye[2]), 80.0, 0.1, 200.0)
    drawn = draw(gl, open_water(view))
    assert drawn.wet.all(), f"{np.sum(~drawn.wet)} pixels are not"
    assert np.isfinite(drawn.water).all()


def test_water_shades_only_its_visible_pixels(gl):
    """Still water takes one sample per visible pixel, and none behind a wall."""
    view = View((0.0, 2.0, 6.0), (0.0, 1.9, 0.0), 60.0, 0.5, 100.0)
    scene = open_water(view)
    wall = ScenePart(box(40.0, 40.0, 0.2), placed((0, 0, 3.0)), np.array([0]))
    for parts in (scene.parts, (*scene.parts, wall)):
        pipeline = PIPELINES["forward"].with_effect(passes_of(waves=0))
        with rendering(gl, pipeline, replace(scene, parts=parts), plan_of("forward")) as drawing:
            drawing.draw()
            wet = int(np.sum(drawing.read(WATER)[0][..., 3] == 1))
            drawing.draw()
            counted = samples_of(gl, drawing)
        assert counted == wet, f"{counted} samples, {wet} pixels of water"
        assert wet == 0 if len(parts) > 1 else wet > 2000


def samples_of(gl, made) -> int:
    """Return how many samples the water's surface shades in one more frame."""
    query = gl.context.query(samples=True)
    for name, run in made.passes.items():
        if name == "water_surface":
            with query:
                run()
        else:
            run()
    return query.samples


def caustics(gl, scene: Scene, **given) -> np.ndarray:
    """Return the caustic maps, (slices, z, x)."""
    own = {**LIGHT, **given}
    resource = Maps(5, int(own["texels"])).caustics
    with rendering(gl, PIPELINES["forward"].with_effect(passes_of(**given)), scene, plan_of("forward")) as drawing:
        drawing.draw()
        texels = np.frombuffer(drawing.frame.textures(resource)[0].read(), np.float32)
    return texels.reshape(CONSTANTS["CAUSTIC_SLICES"], *(int(own["texels"]),) * 2)


def test_caustics_move_light_without_adding_any(gl):
    """The mean of each slice is 1, to 2%; at first, deeper slices vary more."""
    maps = caustics(gl, lake(), texels=256)
    means, spread = maps.mean(axis=(1, 2)), maps.std(axis=(1, 2))
    assert np.all(abs(means - 1) < 0.02), means
    assert spread[1] > 0.1 and spread[2] > spread[1], spread


def test_still_water_has_no_caustics(gl):
    """The maps are 1 everywhere, to 1e-4, or to 1/256 where a rasteriser snaps corners to 1/256 of a texel."""
    maps = caustics(gl, lake(), waves=0)
    most = 1e-4 if gl.is_software else 1 / 256
    assert np.abs(maps - 1).max() < most, f"{maps.min()} to {maps.max()}"


POSES = {
    "near": View((0.0, 1.0, 4.0), (0.0, 0.3, 0.0), 60.0, 0.3, 60.0),
    "low": View((1.0, 0.7, 7.0), (0.0, 0.5, 0.0), 45.0, 0.3, 60.0),
    "from above": View((0.5, 5.0, 4.0), (0.0, 0.0, 0.0), 50.0, 0.3, 60.0),
}


def leak(gl, view: View, refraction: str) -> float:
    """Return the most light from things above the water that is visible in it: clear water minus the reflection."""
    bars = placed([(-1.5, 1.2, 0.0), (0.0, 1.0, 1.0), (1.6, 0.9, -1.0)])
    parts = (
        ScenePart(plane(60.0, 60.0), placed((0, -3.0, 0)), np.array([0]), casts=False),
        ScenePart(box(0.5, 0.8, 0.5), bars, np.ones(3, int)),
    )
    materials = (Material(albedo=BLACK, specular=BLACK), Material(albedo=BLACK, specular=BLACK, emissive=(1.0, 0, 0)))
    scene = Scene(parts, materials, (), BLACK, view, view, Water(deep=BLACK, slope=0.15))
    clear, opaque = (replace(scene, water=replace(scene.water, extinction=k)) for k in (BLACK, OPAQUE))
    seen, mirrored = (draw(gl, wet_scene, refraction=refraction, blur=0).water for wet_scene in (clear, opaque))
    return float((seen - mirrored)[..., 0].max())


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("refraction", ["two_depth", "alpha"])
def test_things_above_the_water_do_not_leak_into_it(gl, pose, refraction):
    """Glowing bars over a black ground leak no light; without the guard, more than a tenth leaks."""
    leaked = leak(gl, POSES[pose], refraction)
    assert leaked == 0, f"{leaked:.2g} leaks"
    assert unguarded(gl, pose) > 0.1, f"unguarded, {unguarded(gl, pose):.2g} leaks"


@cache
def unguarded(gl, pose: str) -> float:
    return leak(gl, POSES[pose], "unguarded")


@pytest.fixture(scope="module")
def in_pipelines(gl) -> dict[str, Drawn]:
    return {name: draw(gl, lake(), name) for name in ("forward", "forward_multipass", "deferred", "prepass", "hybrid")}


def test_water_is_the_same_in_every_pipeline(in_pipelines):
    """With a G-buffer in 32-bit floats, 55 dB, because shadow tests may differ; the same pixels are water."""
    first, *others = in_pipelines
    for other in others:
        expected, two = in_pipelines[first], in_pipelines[other]
        assert np.array_equal(expected.wet, two.wet), f"{other}: {np.sum(expected.wet != two.wet)} pixels"
        decibels = apart(expected.water[..., :3], two.water[..., :3])
        assert decibels >= 55, f"{first} and {other}: {decibels:.1f} dB"


def test_water_replaces_only_the_pixels_that_it_covers(gl):
    """All other pixels are unchanged. The scene has no glass, which would cover both."""
    scene = replace(lake(), parts=tuple(part for part in lake().parts if _is_opaque(part)))
    drawn = draw(gl, scene, "deferred")
    with rendering(gl, PIPELINES["deferred"], scene, plan_of("deferred")) as drawing:
        drawing.draw()
        plain = drawing.image()
    assert 0.2 < drawn.wet.mean() < 0.8
    assert np.array_equal(drawn.image[drawn.wet], drawn.water[drawn.wet][:, :3])
    assert np.array_equal(drawn.image[~drawn.wet], plain[~drawn.wet])


def _is_opaque(part: ScenePart) -> bool:
    return all(lake().materials[index].alpha == 1 for index in part.materials)


def test_water_has_as_many_samples_as_the_image(gl):
    """With 4 samples per pixel, the image scores more than 20 dB against 1 sample; edges differ."""
    pipeline = PIPELINES["deferred"].with_effect(passes_of())
    with rendering(gl, pipeline, lake(), plan_of("deferred", 4)) as drawing:
        drawing.draw()
        decibels = apart(drawing.image(), draw(gl, lake(), "deferred").image)
    assert decibels > 20, f"{decibels:.1f} dB"


def test_scene_without_water_is_a_one_line_error():
    """A camera under water is rejected too."""
    water = chosen(EFFECT, {})
    room = SCENES["room"].make(Setting(lights=1))
    assert lacking([water], "room", room) == "water on room: it has no water"
    under = replace(lake(), view=replace(lake().view, eye=(0.0, -1.0, 0.0)))
    assert EFFECT.lacks(under) == "the camera is under water" and EFFECT.lacks(lake()) is None


@pytest.mark.parametrize(
    "given, said",
    [
        ({"waves": "5"}, "effect water: waves=5 is not a number from 0 to 4"),
        ({"octaves": "6"}, "effect water: octaves=6 is not a whole number from 1 to 5"),
        ({"texels": "100"}, "effect water: texels=100 is not 256 or 128 or 512"),
        ({"refraction": "none"}, "effect water: refraction=none is not two_depth or alpha or unguarded"),
    ],
)
def test_a_setting_out_of_range_is_refused(given, said):
    with pytest.raises(EffectError) as refused:
        chosen(EFFECT, given)
    assert str(refused.value) == said


def test_water_with_inferred_lighting_is_a_one_line_error():
    """After the G-buffer, inferred lighting stores depth in another resource."""
    with pytest.raises(PipelineError) as refused:
        PIPELINES["inferred"].with_effect(passes_of())
    assert str(refused.value).startswith("pipeline inferred: pass water_behind reads native_depth, which")
