"""`normalbench render`: rows, pictures, and messages for bad input."""

import json
from dataclasses import replace

import numpy as np
import pytest
from test_render import QUICK, SMALL

from normalbench.bench.measures.metrics import images as image_metrics
from normalbench.encodings.catalogue import ENCODINGS, LIGHT_BUFFERS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.display import displayed
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering as render
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.mesh import box, sphere
from normalbench.gbuffer.scenes.models.teapot import teapot
from normalbench.gbuffer.scenes.setting import Setting

pytestmark = pytest.mark.usefixtures("gl")


# Every encoding in some channel formats, and numbers across channels with a few.
CODECS = [
    Codec(encoding, storage)
    for name, encoding in ENCODINGS.items()
    for storage in STORAGES.values()
    if (
        name in ("octahedral", "octahedral_precise", "tetrahedral", "xyz")
        if storage.is_packed
        else storage.channels > 2
    )
]


# Signed words are not rounded precisely by a layout.
CODECS = [c for c in CODECS if c.fits and c.storage.name != "rgb8_12_12_snorm"]


CODECS = [c for c in CODECS if not (c.encoding.is_precise and c.storage.is_packed and c.storage.kind == "snorm")]


def test_only_one_of_the_two_psnr_figures_includes_the_background(run):
    """The background is black in both images, so the mean over all pixels is the mean over covered pixels times their
    share."""
    words = ["--scene", "playground", "--encoding", "octahedral", "--storage", "rg8", "--format", "json"]
    for more in ([], ["--samples", "4"], ["--pipeline", "forward"]):
        _, out, _ = run("render", *SMALL, *words, *more)
        (row,) = json.loads(out)
        share = row["covered_percent"] / 100
        assert share == pytest.approx(0.98, abs=0.01), "the playground leaves 2 % of the picture black"
        if row["psnr_db"] is not None:
            expected = row["psnr_db"] + 10 * np.log10(share)
            # Of a pixel at an edge some samples are background.
            assert row["psnr_covered_db"] == pytest.approx(expected, abs=0.2 if more else 1e-6)


@pytest.mark.parametrize("name", ["ball", "slab", "pot"])
def test_a_users_own_mesh_clips_at_most_a_hundredth(run, tmp_path, name):
    """Size and shape do not matter: a sphere, a plate and a teapot, a thousand times as large and as small."""
    mesh = {"ball": sphere(1e-3, 12, 12), "slab": box(1e3, 10.0, 1e3), "pot": teapot(4)}[name]
    path = tmp_path / f"{name}.obj"
    corners = "".join(f"v {x} {y} {z}\n" for x, y, z in mesh.positions)
    path.write_text(corners + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in mesh.triangles))
    words = ["--scene", str(path), "--power", "16,1024", "--encoding", "octahedral", "--format", "json"]
    for more in ([], ["--tone-mapping", "aces"]):
        _, out, err = run("render", *SMALL, *words, *more)
        assert "clipped" not in err
        for row in json.loads(out):
            assert row["clipped_percent"] <= 1 and row["exposure"] != 0, row
    _, out, err = run("render", *SMALL, *words, "--exposure", "9")
    assert {row["exposure"] for row in json.loads(out)} == {9}
    assert f"{path.name} at power 16: " in err and "of the covered pixels are clipped" in err
    assert all(row["clipped_percent"] > 5 for row in json.loads(out))


def test_bytes_per_pixel_count_all_buffers_of_a_frame(run, gl):
    """17 bytes for the layout, 4 for the linear depth resolved from it, two light targets of 8; all per sample."""
    arguments = ("--pipeline", "hybrid", "--layout", "hybrid,xy_depth_sign", "--light-buffer", "rgba16f")
    figures = [json.loads(run(*QUICK[:-4], *arguments, "--format", "json", "--samples", n)[1]) for n in ("1", "2")]
    assert [row["bytes_per_pixel"] for row in figures[0]] == [17 + 4 + 16, 21 + 16]
    given = gl.given_samples(2)
    assert [row["bytes_per_pixel"] for row in figures[1]] == [given * 37, given * 37]
    read = json.loads(run(*QUICK[:-4], *arguments[:-1], "rgbm", "--format", "json")[1])
    assert read[0]["bytes_per_pixel"] == 17 + 4 + 2 * 2 * 4, "what is read while it is written has two copies"


def test_codecs_are_ranked_separately_for_each_pipeline_and_shadow(run):
    """Rows with shadows and rows without shadows have separate ranks."""
    _, out, _ = run(*QUICK[:-2], "--format", "json", "--pipeline", "deferred,hybrid", "--shadow", "on,off")
    assert [row["rank"] for row in json.loads(out)].count(1) == 4


def test_one_light_target_is_compared_with_two(run):
    """One target rebuilds the colour of highlights. The row includes this error, because its reference rebuilds
    nothing."""
    status, out, _ = run(
        *(
            "render",
            "--size",
            "96x72",
            "--repeats",
            "1",
            "--scene",
            "room",
            "--layout",
            "fp32",
            "--pipeline",
            "prepass,hybrid",
        ),
        *("--light-targets", "1,2", "--format", "json"),
    )
    figures = {(row["pipeline"], row["light_targets"]): row for row in json.loads(out)}
    assert status == 0 and all(figures[p, 2]["exact"] for p in ("prepass", "hybrid"))
    # The hybrid pays for it on special materials alone.
    assert 30 < figures["prepass", 1]["psnr_db"] < figures["hybrid", 1]["psnr_db"] < 90


def test_too_many_samples_are_reduced_to_the_devices_maximum(run, gl):
    status, out, _ = run(*QUICK, "--samples", "64", "--pipeline", "deferred,inferred")
    assert status == 0
    for row in json.loads(out):
        assert (row["samples_asked"], row["samples"]) == (64, gl.max_samples)
        assert row["psnr_db"] > 20


@pytest.mark.parametrize("pipeline", ["deferred", "hybrid"])
def test_every_codec_gives_a_finite_image(gl, pipeline):
    """Every encoding and every storage is drawn in one small frame; other tests check the parity of all pairs."""
    scene = SCENES["room"].make(Setting(lights=2))
    chosen = PIPELINES[pipeline]
    plan = Plan((48, 36), 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], max(chosen.light_targets), False, 1.0)
    worst = {}
    with render(gl, chosen, scene, plan) as drawing:
        drawing.draw()
        exact = displayed(drawing.image())
    # The last storage that an encoding fits, and the last encoding that a storage holds.
    several = {**{c.encoding.name: c for c in CODECS}, **{c.storage.name: c for c in CODECS}}
    assert ENCODINGS.keys() < several.keys()
    for codec in dict.fromkeys(several.values()):
        with render(gl, chosen, scene, replace(plan, layout=plan.layout.with_codec(codec))) as drawing:
            drawing.draw()
            error, broken = image_metrics.squared_error(displayed(drawing.image()), exact)
        assert broken == 0, f"{codec.name}: {broken} pixels are no number"
        worst[codec.name] = error
    assert max(worst.values()) < 0.02, max(worst, key=lambda name: worst[name])
