"""Light propagation volumes over scenes: injected light, the positions of the volumes, and the light on surfaces."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import lpv_twin as twin
import numpy as np
import pytest
from drawing import FP32, apart, lamps, psnr, scene_of

from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.effects.catalogue import EFFECTS
from normalbench.gbuffer.effects.effect import EffectError, chosen
from normalbench.gbuffer.effects.lpv.cascades import box_of, cascades_of, finest_cell, spot_sight, sun_sight
from normalbench.gbuffer.effects.lpv.passes import lookup
from normalbench.gbuffer.effects.lpv.volumes import INDIRECT, Volumes
from normalbench.gbuffer.frame.contract import Pass
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.gl.device import FormatError
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.mesh import plane
from normalbench.gbuffer.scenes.scene import KINDS, Light, Material, Scene, ScenePart, View, placed

SIZE = (80, 60)


CELLS, TEXELS = 16, 64


SMALL = {"cells": CELLS, "texels": TEXELS}


LPV = EFFECTS["lpv"]


@dataclass(frozen=True)
class Lit:
    """A frame with light from volumes, read back: images with row 0 on top; the light of each cascade in the twin's
    form, and the blockers of the finest; the sum of all injected coefficients; the last reflective shadow map as
    flux, normal and position, (count, 4)."""

    image: np.ndarray
    indirect: np.ndarray
    gbuffer: list[np.ndarray]
    light: np.ndarray
    injected: np.ndarray
    blockers: np.ndarray
    last: tuple[np.ndarray, ...]


def plan_of(pipeline: str, layout=FP32) -> Plan:
    targets = max(PIPELINES[pipeline].light_targets)
    return Plan(SIZE, 1, layout, LIGHT_BUFFERS["rgba32f"], targets, True, 1.0)


def draw(gl, scene: Scene, pipeline="deferred", layout=FP32, **given) -> Lit:
    effect = chosen(LPV, {name: str(value) for name, value in {**SMALL, **given}.items()})
    values = dict(effect.values)
    volumes = Volumes(*(values[name] for name in ("cells", "cascades", "format", "sums", "texels")))
    piped = PIPELINES[pipeline].with_effect(effect.passes())
    with rendering(gl, piped, scene, plan_of(pipeline, layout)) as r:
        r.draw()
        light = [read(r, resource).reshape(-1, *(volumes.cells,) * 3, 4) for resource in volumes.light]
        injected = np.stack([read(r, resource).reshape(-1, 4).sum(axis=0) for resource in volumes.injected], axis=-1)
        side = volumes.corners
        blockers = read(r, volumes.blockers).reshape(-1, side, side, side, 4)[0].transpose(2, 0, 1, 3)
        last = tuple(read(r, resource).reshape(-1, 4) for resource in volumes.reflective)
        fields = np.stack(light, axis=-1).transpose(0, 3, 2, 1, 4, 5)
        return Lit(r.image(), r.read(INDIRECT)[0][..., :3], r.gbuffer(), fields, injected, blockers, last)


def read(rendered, resource) -> np.ndarray:
    """Return the numbers of a resource's only texture; for packed numbers, the bytes."""
    texture = rendered.frame.textures(resource)[0]
    return np.frombuffer(texture.read(), {"f4": np.float32, "f2": np.float16, "f1": np.uint8}[texture.dtype]).astype(
        float
    )


def only(scene: Scene, *lights: Light) -> Scene:
    return replace(scene, lights=lights)


ROOM = scene_of("room")


SENDERS = [light for light in ROOM.lights if light.kind in ("sun", "spot")]


# Near the floor and the teapot: four metres ahead lie well within the room, left, right and before.
VIEWED = replace(ROOM, view=View((0.0, 1.5, 0.2), (0.0, 1.5, -1.0), 70.0, 0.1, 40.0))


FLOOR_ALBEDO = (0.5, 0.25, 0.75)


FLOOR = ScenePart(plane(4.0, 6.0), placed((0, 0, 0)), np.array([0]), casts=False)


ABOVE = View((0.0, 8.0, 0.01), (0.0, 0.0, 0.0), 60.0, 0.5, 20.0)


def floor(light: Light) -> Scene:
    """Return a scene with a floor of 4 x 6 metres under one light."""
    materials = (Material(albedo=FLOOR_ALBEDO, specular=(0.0, 0.0, 0.0)),)
    return Scene((FLOOR,), materials, (light,), (0.0, 0.0, 0.0), ABOVE, ABOVE)


def test_the_sun_injects_the_light_that_the_floor_reflects(gl):
    """Flux = colour x albedo x area x cosine, in a volume that contains the floor: to 1% at 256 texels, because the
    map's pixels cover the floor in steps. The injected coefficients have the map's flux to 1e-5."""
    cosine = 0.8
    drawn = draw(gl, floor(Light("sun", (2.0, 1.0, 0.5), direction=(0.6, -cosine, 0.0))), cascades=1, texels=256)
    expected = np.array([2.0, 1.0, 0.5]) * FLOOR_ALBEDO * 24 * cosine
    check_flux(drawn, expected, 0.01)


def test_a_spot_injects_the_light_that_the_floor_reflects(gl):
    """The integral over the floor of colour x falloff x cone x cosine x albedo, to 1%; the injected coefficients have
    the map's flux to 1e-5. The map sees the rim at 40 degrees, where the cosine to the axis is 0.77."""
    spot = Light("spot", (3.0, 2.0, 1.0), (0.0, 1.8, 0.0), 9.0, (0.0, -1.0, 0.0), 30.0, 40.0)
    drawn = draw(gl, floor(spot), cascades=1, texels=256)
    r, ring = np.linspace(0, 1.8 * np.tan(np.radians(40)), 20001, retstep=True)
    distance2 = r**2 + 1.8**2
    cosine, window = 1.8 / np.sqrt(distance2), np.maximum(1 - (distance2 / 81) ** 2, 0) ** 2
    inner, outer = np.cos(np.radians([30, 40]))
    t = np.clip((cosine - outer) / (inner - outer), 0, 1)
    integral = np.sum(window / (distance2 + 1) * t * t * (3 - 2 * t) * cosine * 2 * np.pi * r) * ring
    check_flux(drawn, np.array(spot.colour) * FLOOR_ALBEDO * integral, 0.01)


def test_each_cascade_has_the_suns_light(gl):
    """Three volumes that contain the floor have its flux, each from its own map: to 2%, because pixels cover it in
    steps."""
    scene = floor(Light("sun", (2.0, 1.0, 0.5), direction=(0.6, -0.8, 0.0)))
    drawn = draw(gl, scene, cascades=3, extent=8.0, iterations=0, texels=256)
    expected = np.array([2.0, 1.0, 0.5]) * FLOOR_ALBEDO * 24 * 0.8
    ratios = [twin.flux(light) / expected for light in drawn.light]
    assert np.abs(np.array(ratios) - 1).max() < 0.02, ratios


def test_the_background_blocks_nothing(gl):
    """A cleared G-buffer decodes to some normal at the far plane, 20 metres below the eye. All surfels are at the
    floor's height."""
    lamp = Light("point", (1.0, 1.0, 1.0), (0.0, 2.0, 0.0), 3.0)
    drawn = draw(gl, floor(lamp), layout=LAYOUTS["hybrid"], cascades=1, extent=64.0, iterations=0)
    height = drawn.blockers[..., 0].sum(axis=(0, 2))
    assert np.count_nonzero(height) == 1, f"surfels in the layers {np.flatnonzero(height)}"


def test_the_back_of_a_sheet_injects_no_light(gl):
    """A two-sided floor, lit from below, is in the map. But the renderer lights no backs: no light is reflected."""
    scene = floor(Light("sun", (1.0, 1.0, 1.0), direction=(0.0, 1.0, 0.0)))
    drawn = draw(gl, replace(scene, parts=(replace(FLOOR, two_sided=True),)), cascades=1)
    flux, _, position = drawn.last
    assert np.mean(position[:, 3]) > 0.3 and np.all(flux[:, :3] == 0), f"{flux[:, :3].sum(axis=0)}"


def test_hair_reflects_along_its_surface_and_not_its_strands(gl):
    """The G-buffer stores the strand of hair, but the map has the normal, (0, 1, 0) all over a floor of hair."""
    sun = Light("sun", (1.0, 1.0, 1.0), direction=(0.6, -0.8, 0.0))
    scene = floor(sun)
    scene = replace(scene, materials=tuple(replace(material, kind="hair") for material in scene.materials))
    drawn = draw(gl, scene, cascades=1)
    box = box_of(scene)
    cascade = cascades_of(scene.view, box, finest_cell(box, 0.0, CELLS, 1), CELLS, 1)[0]
    _, normals, there = points_of(drawn, sun_sight(sun, cascade, box, TEXELS).matrix())
    assert there.sum() > 500
    worst = np.abs(normals - [0, 1, 0]).max()
    assert worst < 1e-5, f"{worst:.3g}"


def test_a_floor_between_two_planes_of_the_lattice_is_on_one_side(gl):
    """Half a cell up, rounding could send each texel to either side. All light is in one layer of cells, and all
    blockers are at the corners below that layer."""
    cell = 8.0 / CELLS
    raised = replace(FLOOR, models=placed((0, cell / 2, 0)))
    scene = replace(floor(Light("sun", (1.0, 1.0, 1.0), direction=(0.6, -0.8, 0.0))), parts=(raised,))
    drawn = draw(gl, scene, cascades=1, extent=8.0, iterations=0)
    layers = np.flatnonzero(drawn.light[0][..., 0, 0].sum(axis=(0, 2)))
    corners = np.flatnonzero(drawn.blockers[..., 0].sum(axis=(0, 2)))
    assert len(layers) == 1 and np.array_equal(layers, corners), f"light in {layers}, blockers at {corners}"


def check_flux(found: Lit, expected: np.ndarray, share: float) -> None:
    flux = found.last[0][:, :3].sum(axis=0)
    assert flux == pytest.approx(expected, rel=share), f"{flux} in the map, not {expected}"
    injected = found.injected[0] * 2 * np.sqrt(np.pi)
    assert injected == pytest.approx(flux, rel=1e-5), f"{injected} injected, not {flux}"


def test_light_outside_the_volume_is_omitted(gl):
    """A volume of two metres in the room, without propagation, has the light that NumPy injects from the spot's map,
    to 1e-5 of the brightest coefficient. The map has more light."""
    scene, spot = only(VIEWED, SENDERS[1]), SENDERS[1]
    drawn = draw(gl, scene, extent=2.0, cascades=1, iterations=0)
    cell = 2.0 / CELLS
    cascade = cascades_of(scene.view, box_of(scene), cell, CELLS, 1)[0]
    world, normals, there = points_of(drawn, spot_sight(spot).matrix())
    fluxes = drawn.last[0][there, :3]
    expected = twin.injected(CELLS, world / cell - cascade.origin, normals, fluxes)
    worst = np.abs(drawn.light[0] - expected).max() / np.abs(expected).max()
    assert worst < 1e-5, f"{worst:.3g}"
    inside = twin.flux(expected)[0] / fluxes[:, 0].sum()
    assert 0.02 < inside < 0.5, f"{inside:.1%} of the light lies inside"


AMPLIFIER, STEPS = 1.0, 6


def points_of(found: Lit, matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return world positions and normals of the surfaces in the last map, and which texels show a surface."""
    _, normal, position = found.last
    there, to_world = position[:, 3] > 0, np.linalg.inv(matrix)
    world = position[there, :3] @ to_world[:3, :3].T + to_world[:3, 3]
    return world, normal[there, :3] @ to_world[:3, :3].T, there


def surfel_areas(found: Lit, there: np.ndarray, sight, size) -> np.ndarray:
    """Return the area in square metres that each texel shows, and -1 for surfaces that face away: dx dy / cos, and
    for a perspective z^2 dx dy times z / |n.p|."""
    _, normal, position = (data[there, :3] for data in found.last)
    right, up, *_ = sight.rays(size)
    texel = 4 * right * up / TEXELS**2
    if sight.projection(1.0)[3, 3]:
        facing = normal[:, 2]
        return np.where(facing > 0, texel / np.maximum(facing, 1e-12), -1)
    facing = -np.sum(normal * position, axis=1)
    return np.where(facing > 0, texel * (-position[:, 2]) ** 3 / np.maximum(facing, 1e-12), -1)


@pytest.fixture(scope="module")
def chain(gl):
    """The room on the device, and NumPy's light at the same pixels from the maps of all its lights."""
    settings = {"cascades": 1, "iterations": STEPS, "amplifier": AMPLIFIER}
    whole = draw(gl, ROOM, **settings)
    box = box_of(ROOM)
    cell = finest_cell(box, 0.0, CELLS, 1)
    cascade = cascades_of(ROOM.view, box, cell, CELLS, 1)[0]
    field, potentials = np.zeros((*(CELLS,) * 3, 4, 3)), np.zeros((*(CELLS + 1,) * 3, 4))
    sights = [(sun_sight if light.kind == "sun" else lambda light, *_: spot_sight(light)) for light in SENDERS]
    sights = [make(light, cascade, box, TEXELS) for make, light in zip(sights, SENDERS, strict=True)]
    # The camera's map is left where no light has one of its own.
    views = [
        (ROOM.view, only(ROOM, lamps(ROOM)[-1])),
        *((s, only(ROOM, x)) for s, x in zip(sights, SENDERS, strict=True)),
    ]
    for sight, scene in views:
        drawn = draw(gl, scene, **settings)
        world, normals, there = points_of(drawn, sight.matrix())
        points = world / cell - cascade.origin
        if sight is not ROOM.view:
            field += twin.injected(CELLS, points, normals, drawn.last[0][there, :3])
        areas = surfel_areas(drawn, there, sight, SIZE) / cell**2
        potentials += twin.blocked(CELLS, points[areas > 0], normals[areas > 0], areas[areas > 0])
    total = twin.propagated(field, STEPS, potentials, AMPLIFIER)
    expected = seen(total, whole.gbuffer, ROOM, cascade)
    return whole, total, expected


def seen(total, gbuffer, scene: Scene, cascade) -> np.ndarray:
    """Return the light that arrives at the surfaces of a G-buffer, of shape (height, width, channels)."""
    position, normal = (data[..., :3].reshape(-1, 3) for data in gbuffer[:2])
    to_world = np.linalg.inv(scene.view.matrix())
    world, n = position @ to_world[:3, :3].T + to_world[:3, 3], normal @ to_world[:3, :3].T
    strand = gbuffer[1][..., 3].ravel() == KINDS.index("hair")
    n = np.where(strand[:, None], 0.0, n)
    light = twin.looked_up(total, world / cascade.cell - cascade.origin, n, cascade.cell)
    return light.reshape(*SIZE[::-1], -1)


def test_the_volumes_agree_with_numpy(chain):
    """The sun, three spots and the camera's surfels in the room, six steps: 80 dB over the brightest coefficient."""
    whole, total, _ = chain
    decibels = psnr(whole.light[0] - total, np.abs(total).max())
    assert decibels >= 80, f"{decibels:.1f} dB"


def test_the_light_of_each_pixel_agrees_with_numpy(chain):
    """60 dB over the brightest pixel. The room is not dark: a tenth of the pixels have at least a tenth of that."""
    whole, _, expected = chain
    decibels = psnr(whole.indirect - expected, expected.max())
    assert decibels >= 60, f"{decibels:.1f} dB"
    bright = np.mean(expected.max(axis=2) > expected.max() / 10)
    assert bright > 0.1, f"{bright:.0%} of the pixels are lit"


@pytest.mark.parametrize("given, least", [({"format": "rgba16f"}, 55), ({"sums": "rgba16f"}, 25)], ids=str)
def test_the_formats_of_volumes_and_sums_have_the_expected_accuracy(gl, given, least):
    """PSNR over the brightest pixel against 32-bit floats, at 128 texels. Volumes lose little: 63 dB, and 44 with a
    shared exponent. Adding VPLs in 16 bits is worse, 36 dB: in a large sum, small VPLs fall below the last bit, and a
    device that truncates loses light with each of them."""
    exact, coarse = (draw(gl, ROOM, texels=128, **more).indirect for more in ({}, given))
    share = coarse.mean() / exact.mean()
    quality = psnr(coarse - exact, exact.max())
    assert least <= quality < 100 and 0.9 < share < 1.01, f"{quality:.1f} dB, {share:.2%} of the light"


@pytest.mark.parametrize("pipeline", ["deferred", "prepass"])
def test_a_pipeline_adds_the_volumes_to_the_ambient_light(gl, pipeline):
    """The image is the image without volumes, plus albedo x `indirect`, in a scene without glass: 100 dB."""
    scene = replace(
        ROOM, parts=tuple(p for p in ROOM.parts if not any(ROOM.materials[i].alpha < 1 for i in p.materials))
    )
    with rendering(gl, PIPELINES[pipeline], scene, plan_of(pipeline)) as r:
        r.draw()
        without = r.image()
    drawn = draw(gl, scene, pipeline)
    albedo = draw(gl, scene, "deferred").gbuffer[2][..., :3]
    rest = psnr(drawn.image - without - albedo * drawn.indirect)
    assert rest >= 100, f"{rest:.1f} dB"
    assert apart(drawn.image, without) < 40, "it makes no difference"


@pytest.mark.parametrize("pipeline, samples, scale, most", [("deferred", 4, 1.0, 0.04), ("inferred", 1, 0.5, 0.02)])
def test_the_indirect_light_follows_the_g_buffer(gl, pipeline, samples, scale, most):
    """With four samples per pixel, and at half the size, the indirect light has the size of the G-buffer and the
    brightness of one sample at full size, to 2%, because silhouettes differ. The first of four samples is read as
    if it were in the middle of the pixel, up to half a pixel off: measured 2.1% here, 0.6 and 0.3 in images of two
    and four times the size."""
    plain = draw(gl, ROOM).indirect.mean()
    piped = PIPELINES[pipeline].with_effect(chosen(LPV, {name: str(value) for name, value in SMALL.items()}).passes())
    with rendering(gl, piped, ROOM, replace(plan_of(pipeline), samples=samples, scale=scale)) as r:
        r.draw()
        indirect = r.read(INDIRECT)[0][..., :3]
    assert indirect.shape[:2] == (SIZE[1] * scale, SIZE[0] * scale)
    assert indirect.mean() == pytest.approx(plain, rel=most), f"{indirect.mean():.4g}, not {plain:.4g}"


def moved(scene: Scene, by: tuple[float, float, float]) -> Scene:
    eye, target = (tuple(np.add(end, by).tolist()) for end in (scene.view.eye, scene.view.target))
    return replace(scene, view=replace(scene.view, eye=eye, target=target))


STILL = {"extent": 4.0, "cascades": 1, "amplifier": 0.0, "iterations": 4}


CELL = 4.0 / CELLS


def test_the_volumes_move_only_by_whole_cells(gl):
    """If the camera moves and its own surfels block nothing, the volumes stay the same, bit for bit, until they move
    by a whole cell: steps of a quarter of a cell move them once per cell."""
    box, origins, fields = box_of(VIEWED), [], []
    for quarter in range(5):
        scene = moved(VIEWED, (quarter * CELL / 4, 0.0, 0.0))
        origins.append(cascades_of(scene.view, box, CELL, CELLS, 1)[0].origin)
        fields.append(draw(gl, scene, **STILL).light)
    moves = [now[0] - before[0] for before, now in pairwise(origins)]
    assert sorted(moves) == [0, 0, 0, 1], origins
    for number, move in enumerate(moves):
        if not move:
            differ = np.mean(fields[number] != fields[number + 1])
            assert fields[number].max() > 0 and differ == 0, (
                f"{differ:.1%} of the numbers differ after quarter {number + 1}"
            )


@pytest.mark.parametrize("by", [(1, 0, 0), (-2, 0, 0), (1, 0, 1)], ids=str)
def test_moving_the_volumes_by_whole_cells_keeps_the_light(gl, by):
    """Cells in both volumes, farther from the moved ends than light travels, have the same light in the world: 100 dB
    over the brightest. Texels of the sun's map keep their positions, so no VPL changes its cell."""
    views = [moved(VIEWED, tuple(np.array(way) * CELL)) for way in ((0, 0, 0), by)]
    first, second = (draw(gl, scene, **STILL).light[0] for scene in views)
    ends = [STILL["iterations"] + abs(way) if way else 0 for way in by]
    inner = tuple(slice(end, CELLS - end) for end in ends)
    here, there = first[inner], np.roll(second, by, axis=(0, 1, 2))[inner]
    assert np.mean(here[..., 0, :] > 0) > 0.3, "hardly any light"
    decibels = psnr(here - there, np.abs(here).max())
    assert decibels >= 100, f"{decibels:.1f} dB; {np.mean(here != there):.1%} of the numbers differ"


def test_moving_a_volume_by_half_a_cell_hardly_changes_the_light(gl):
    """On surfaces that are in a volume before and after, with the camera's own surfels blocking light, the light
    changes by 0.2% of the brightest (RMS) and by 2% at most. The measured changes are 0.09% and 1.3%, mostly at the
    ends of the volume."""
    settings, to_world = STILL | {"amplifier": 1.0}, np.linalg.inv(VIEWED.view.matrix())
    box, lights = box_of(VIEWED), []
    first = draw(gl, VIEWED, **settings)
    points, normals = (data[..., :3].reshape(-1, 3) @ to_world[:3, :3].T for data in first.gbuffer[:2])
    points = points + to_world[:3, 3]
    inside = np.ones(len(points), bool)
    for by in (0.0, CELL / 2):
        scene = moved(VIEWED, (by, 0.0, 0.0))
        place = points / CELL - cascades_of(scene.view, box, CELL, CELLS, 1)[0].origin
        inside &= np.all((place > 1) & (place < CELLS - 1), axis=1)
        lights.append(twin.looked_up(draw(gl, scene, **settings).light[0], place, normals, CELL))
    assert inside.mean() > 0.2, f"{inside.mean():.0%} of the pixels lie inside"
    change = np.abs(lights[0] - lights[1])[inside] / lights[0][inside].max()
    rms, most = np.sqrt(np.mean(change**2)), change.max()
    assert 0 < rms < 0.002 and most < 0.02, f"{rms:.3%} RMS, {most:.2%} at most"


def test_a_scene_fits_into_the_coarsest_cascade():
    """Every corner of the room is inside, with about a cell to spare at each end, for any number of cascades."""
    box = box_of(ROOM)
    for count in (1, 2, 3):
        cell = finest_cell(box, 0.0, CELLS, count)
        last = cascades_of(ROOM.view, box, cell, CELLS, count)[-1]
        spare = np.concatenate([box[0] - last.box[0], last.box[1] - box[1]]) / last.cell
        assert spare.min() >= 0.75, f"{count} cascades: {spare.min():.2f} cells to spare"


@pytest.mark.parametrize("blend", [0.0, 0.2, 0.5])
def test_cascades_meet_without_a_seam_where_their_light_is_the_same(gl, blend):
    """Volumes of the same radiance everywhere, each in its own cells, of 8 and 16 metres in a room of 12, give all
    surfaces the same brightness, I = c_0 Y_00 and L = I / (s / 2)^2, to 1e-5, however wide they blend."""
    volumes = Volumes(CELLS, 2, "rgba32f", "rgba32f", TEXELS)
    pipeline = PIPELINES["deferred"].with_effect((uniform(volumes, (1.0, 4.0)), lookup(volumes, 8.0, blend)))
    scene = replace(VIEWED, materials=tuple(replace(m, kind="general") for m in VIEWED.materials))
    with rendering(gl, pipeline, scene, plan_of("deferred")) as r:
        r.draw()
        indirect, places = r.read(INDIRECT)[0][..., :3], r.gbuffer()[0][..., :3]
    covered = places[..., 2] < 0
    expected = twin.BAND0 / (8.0 / CELLS / 2) ** 2
    worst = np.abs(indirect[covered] / expected - 1).max()
    assert worst < 1e-5, f"{worst:.3g} of {expected:.4g}"
    near = cascades_of(scene.view, box_of(scene), 8.0 / CELLS, CELLS, 2)[0].box
    to_world = np.linalg.inv(scene.view.matrix())
    world = places[covered] @ to_world[:3, :3].T + to_world[:3, 3]
    both = np.mean(np.all((world > near[0]) & (world < near[1]), axis=1))
    assert 0.1 < both < 0.9, f"{both:.0%} of the pixels lie in the finer one"


def uniform(volumes: Volumes, brightness: tuple[float, ...]) -> Pass:
    """Return a pass that fills the volumes with directionless light of a different brightness in each cascade."""

    def build(canvas):
        def run():
            data = np.zeros((volumes.cascades, volumes.cells**3, 4), np.float32)
            data[..., 0] = np.array(brightness)[:, None]
            for resource in volumes.light:
                canvas.textures(resource)[0].write(data.tobytes())

        return run

    return Pass("uniform", (), volumes.light, build, after=("linear_depth",))


@pytest.mark.parametrize(
    "given, said",
    [
        ({"iterations": "9"}, "effect lpv: iterations=9 is not a whole number from 0 to 8"),
        ({"iterations": "-1"}, "effect lpv: iterations=-1 is not a whole number from 0 to 8"),
        ({"cascades": "4"}, "effect lpv: cascades=4 is not a whole number from 1 to 3"),
        ({"format": "rgb9e5"}, "effect lpv: format=rgb9e5 is not rgba32f or rgba16f or shared"),
    ],
)
def test_a_setting_out_of_range_is_a_one_line_error(given, said):
    with pytest.raises(EffectError) as refused:
        chosen(LPV, given)
    assert str(refused.value) == said


def test_a_volume_too_large_for_the_device_is_a_one_line_error(gl, monkeypatch):
    """The volume is refused before anything is drawn."""
    monkeypatch.setattr(gl, "max_volume", 40)
    effect = chosen(LPV, {"cells": "16", "cascades": "3"})
    pipeline = PIPELINES["deferred"].with_effect(effect.passes())
    with (
        pytest.raises(FormatError, match=r"supports at most 40 texels per side of a volume, not 16 x 16 x 48$"),
        rendering(gl, pipeline, ROOM, plan_of("deferred")),
    ):
        pass


def test_a_scene_without_injected_light_is_reported():
    assert LPV.lacks(ROOM) is None
    assert LPV.lacks(only(ROOM, *lamps(ROOM)[3:])) == "no sun or spot light lights the volume"
