"""`normalbench effects`: rows, their order, pictures, effects in other tables, and messages for bad input."""

import json
import sys
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from typed import codecs_named, effects_named

from normalbench.bench.ground.angles import angles_deg
from normalbench.bench.measures.metrics.totals import psnr_db
from normalbench.bench.run.measuring import Nothing, asked, measured
from normalbench.bench.tables.effects import work as effects_work
from normalbench.bench.tables.effects.measure import EffectsBench
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting

pytestmark = pytest.mark.usefixtures("gl")


EFFECT = "lpv:iterations=2:cascades=1:cells=8:texels=32"


SIZE = (96, 72)


JSON = ("--format", "json")


@pytest.fixture(scope="module")
def pictures(tmp_path_factory):
    return tmp_path_factory.mktemp("pictures")


@pytest.fixture(scope="module")
def rows(pictures):
    """Rows of two normal encodings, a depth encoding and an exact layout."""
    table = TABLES["effects"]
    options = {"effect": EFFECT, "size": "96x72", "lights": 2, "repeats": 1}
    options |= {"encoding": "octahedral", "storage": "rg8,rgb10a2", "depth": "linear/packed16", "layout": "fp32"}
    ask = asked(table, table.options(**options), table.outputs(images=pictures))
    return measured(ask, Nothing()).rows


def drawn(gl, layout):
    """Return the effect's own image, the normals and the mask of surfaces, drawn by the renderer alone."""
    effect = effects_named(EFFECT)[0]
    pipeline = PIPELINES["hybrid"].with_effect(effect.passes())
    plan = Plan(SIZE, 1, layout, LIGHT_BUFFERS["rgba32f"], 2, True, 1.0)
    with rendering(gl, pipeline, SCENES["room"].make(Setting(lights=2)), plan) as renderer:
        renderer.draw()
        position, direction, *_ = renderer.gbuffer()
        return renderer.read(effect.effect.result)[0][..., :3], direction[..., :3], position[..., 2] != 0


def test_figures_match_the_two_images(gl, rows):
    """PSNR, RMS, mean, maximum, slope and angles are recomputed from the renderer's buffers."""
    row = next(row for row in rows if row["storage"] == "rg8")
    own, normals, _ = drawn(gl, LAYOUTS["fp32"].with_codec(codecs_named("octahedral", "rg8", "nearest")[0]))
    exact, right, covered = drawn(gl, LAYOUTS["fp32"])
    apart = np.abs(own[covered].astype(np.float64) - exact[covered])
    angles = angles_deg(right[covered], normals[covered])
    expected = {
        "effect_rms": np.sqrt(np.mean(apart**2)),
        "effect_mean": apart.mean(),
        "effect_max": apart.max(),
        "effect_psnr_db": psnr_db(np.mean(apart**2)),
        "normal_mean_deg": angles.mean(),
        "normal_max_deg": angles.max(),
        "slope": apart.mean() / angles.mean(),
    }
    assert {name: row[name] for name in expected} == pytest.approx(expected, rel=1e-6)
    assert covered.all() and 0.1 < angles.mean() < 1


def test_an_exact_layout_loses_nothing_and_more_bits_lose_less(rows):
    by = {row["depth"] or row["storage"]: row for row in rows}
    exact = by["rgba32f"]
    assert (exact["effect_rms"], exact["normal_max_deg"], exact["exact"]) == (0, 0, True), exact
    assert exact["slope"] is None and exact["psnr_db"] == float("inf")
    apart = by["rg8"]["effect_rms"] / by["rgb10a2"]["effect_rms"]
    assert 3 < apart < 6, f"two more bits a number make an error {apart:.2f} times smaller; about 4 is expected"
    depth = by["linear/packed16"]
    assert depth["normal_max_deg"] == 0 and 0 < depth["effect_rms"] < by["rg8"]["effect_rms"]
    assert (depth["encoding"], depth["storage"], depth["normal_bits"]) == (None, None, None)


def test_reflections_report_how_many_hits_moved(run):
    """With two more bits per number, fewer than half as many hits move."""
    words = ("effects", "--effect", "ssr:rays=1,gtao", "--size", "96x72", "--lights", "2", "--rays", "0")
    status, out, _ = run(*words, "--encoding", "octahedral", "--storage", "rg8,rgb10a2", "--depth", "none", *JSON)
    coarse, fine, *other = json.loads(out)
    assert status == 0 and (coarse["scene"], coarse["storage"], fine["storage"]) == ("studio", "rg8", "rgb10a2")
    assert 2 < coarse["moved_percent"] < 50 and 0 < fine["moved_percent"] < coarse["moved_percent"] / 2
    assert fine["effect_rms"] < coarse["effect_rms"] and fine["psnr_db"] > coarse["psnr_db"] + 5
    assert {row["moved_percent"] for row in other} == {None} and len(other) == 2


def test_a_scene_is_made_once_for_all_its_rows(gl):
    """Two encodings and their reference are three frames of one scene."""
    settings = []

    def room(setting):
        settings.append(setting)
        return SCENES["room"].make(setting)

    options = {"effect": EFFECT, "size": "96x72", "lights": 2, "storage": "rg8,rgb10a2", "depth": "none"}
    cases = effects_work.cases(TABLES["effects"].options(**options, encoding="octahedral"), gl)
    maker = replace(cases[0].maker, make=room)
    bench = EffectsBench(gl, repeats=0, rays=0, with_flip=False)
    rows = [bench.measure(replace(case, maker=maker))[0] for case in cases]
    assert [row["storage"] for row in rows] == ["rg8", "rgb10a2"] and settings == [Setting(lights=2)]


def test_an_effects_time_is_the_sum_of_its_passes(rows):
    names = [stage.name for stage in effects_named(EFFECT)[0].passes()]
    for row in rows:
        assert row["ms_effect"] == pytest.approx(sum(row[f"ms_{name}"] for name in names))
        assert min(row["ms_effect"], row["ms_frame"]) > 0 and row["clock"]


def test_pictures_show_the_effect_alone(pictures, rows):
    """The reference has bright and dark pixels, the exact layout matches it, and the page finds every image."""
    files = {path.name: np.asarray(Image.open(path)) for path in pictures.glob("*.png")}
    own = {name: pixels for name, pixels in files.items() if name.endswith("-effect.png")}
    assert len(own) == 5 and len(files) == 10, sorted(files)
    reference = next(pixels for name, pixels in own.items() if "reference" in name)
    assert reference.max() > 200 and reference.min() < 60 and reference.shape == (72, 96, 3)
    assert {name for name, pixels in own.items() if np.array_equal(pixels, reference)} >= {
        name for name in own if "rgba32f" in name
    }
    (subject,) = TABLES["effects"].work.subjects(pictures, rows)
    assert [codec.label for codec in subject.codecs][-1] == "depth linear/packed16" and len(subject.codecs) == 4
    assert np.array_equal(subject.original(), reference)
    assert all(codec.load().final.shape == (72, 96, 3) for codec in subject.codecs)


def test_an_effect_lights_the_image_of_other_tables(run):
    """`render` names the effect in its rows, and the image changes."""
    words = ("render", "--scene", "room", "--size", "96x72", "--lights", "2", "--repeats", "0", "--encoding", "xy")
    images = []
    for more in ((), ("--effects", EFFECT)):
        status, out, _ = run(*words, *more, "--format", "json")
        images.append(json.loads(out)[0])
        assert status == 0
    assert [row["effects"] for row in images] == [None, EFFECT]
    assert images[0]["psnr_db"] != images[1]["psnr_db"]


def test_a_method_is_judged_by_rays_if_a_ray_caster_is_installed(run, monkeypatch):
    """The figure is the same for every encoding. Without a ray caster a row has the other figures, and a line says
    what to install."""
    words = ("effects", "--effect", "gtao", "--size", "96x72", "--encoding", "octahedral,xy", "--depth", "none")
    status, out, err = run(*words, "--rays", "64", "--format", "json")
    first, second = json.loads(out)
    assert (status, err) == (0, "") and 0.02 < first["method_rms"] == second["method_rms"] < 0.2
    assert first["effect_rms"] < second["effect_rms"]
    for name in ("embreex", "embreex.mesh_construction"):
        monkeypatch.setitem(sys.modules, name, None)
    status, out, err = run(*words, "--format", "json")
    assert status == 0 and [row["method_rms"] for row in json.loads(out)] == [None, None]
    assert "method_rms is empty: rays need embreex" in err and err.count("\n") == 1, err


def test_an_effect_that_shows_nothing_is_an_error(run):
    """The only pixel of the head's scene shows no skin."""
    words = ("--effect", "subsurface", "--encoding", "octahedral", "--depth", "none", "--size", "1x1")
    status, out, err = run("effects", *words)
    assert (status, out, err) == (2, "", "normalbench: subsurface shows nothing in this image\n")


def test_a_denoiser_with_exact_normals_is_exact_and_xyz_gains_neighbours(run):
    """Decoded `xyz` is not of unit length: the power of a dot product above 1 grows."""
    words = ("--effect", "denoise:frames=3", "--size", "64x48", "--rays", "0", "--depth", "none", *JSON)
    status, out, err = run("effects", *words, "--layout", "fp32", "--encoding", "octahedral,xyz", "--storage", "rgba8")
    assert (status, err) == (0, "")
    octahedral, xyz, exact = json.loads(out)
    assert [row["encoding"] for row in (octahedral, xyz)] == ["octahedral", "xyz"]
    percents = ("lost_neighbours_percent", "gained_neighbours_percent", "lost_histories_percent")
    assert exact["exact"] and [exact[name] for name in percents] == [0, 0, 0]
    assert 0 < octahedral["gained_neighbours_percent"] < 1 < 20 < xyz["gained_neighbours_percent"]
    assert 0 < octahedral["lost_neighbours_percent"] < 1 < xyz["lost_neighbours_percent"]
    # With its own rays an encoding's error is that of the rays as well.
    words = ("--effect", "denoise:frames=3:rays=own", *words[2:])
    own = json.loads(run("effects", *words, "--encoding", "octahedral", "--storage", "rgba8")[1])[0]
    assert own["lost_neighbours_percent"] == octahedral["lost_neighbours_percent"]
    assert own["effect_rms"] > 1.2 * octahedral["effect_rms"]
