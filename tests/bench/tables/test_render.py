"""`normalbench render`: rows, pictures, and messages for bad input."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from written import as_document

from normalbench.bench.measures.metrics import images as image_metrics
from normalbench.bench.measures.metrics.flip import Flip
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.render.measure import SAME, RenderBench, ranked
from normalbench.bench.tables.render.table import RenderOptions
from normalbench.bench.tables.render.work import cases
from normalbench.bench.tables.shots import STAGES
from normalbench.encodings.catalogue import ENCODINGS, LIGHT_BUFFERS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.display import displayed
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import WALL
from normalbench.gbuffer.render import rendering as render
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.mesh import sphere
from normalbench.gbuffer.scenes.setting import Setting

pytestmark = pytest.mark.usefixtures("gl")


SMALL = ["--size", "96x72", "--lights", "4", "--repeats", "1"]


QUICK = ["render", *SMALL, "--scene", "room", "--encoding", "octahedral,xy", "--format", "json"]


def test_rows_describe_the_rendering_and_its_error(run):
    status, out, _ = run(*QUICK, "--pipeline", "deferred,forward")
    rows = json.loads(out)
    assert status == 0 and all(tuple(row) == tuple(TABLES["render"].empty(STAGES)) for row in rows)
    octahedral, xy, forward = rows
    assert (octahedral["pipeline"], octahedral["encoding"], octahedral["storage"]) == (
        "deferred",
        "octahedral",
        "rgba8",
    )
    assert octahedral["psnr_db"] > xy["psnr_db"] > 20 and xy["flip"] is None
    assert (octahedral["rank"], xy["rank"], octahedral["normal_rank"], xy["normal_rank"]) == (1, 2, 1, 2)
    assert octahedral["bytes_per_pixel"] is None, "nobody asked about the bytes of the exact rest"
    assert forward["layout"] is None and forward["exact"] and forward["psnr_db"] is None
    assert octahedral["ms_frame"] > 0 and octahedral["ms_lights"] > 0 and octahedral["ms_forward"] is None
    assert octahedral["clock"] == WALL or "query" in octahedral["clock"]


def test_ranking_returns_new_rows():
    """The stored rows stay as they were measured."""
    about = dict.fromkeys(SAME)
    rows = [about | {"psnr_db": db, "normal_psnr_db": db} for db in (40.0, 50.0)]
    assert [row["rank"] for row in ranked(rows)] == [2, 1] and not any("rank" in row for row in rows)


def test_rows_are_sorted_by_bits_and_then_best_first(run):
    _, out, _ = run("render", *SMALL, "--scene", "room", "--encoding", "xy,xyz,octahedral", "--format", "json")
    assert [row["encoding"] for row in json.loads(out)] == ["octahedral", "xy", "xyz"]


def test_a_scene_that_draws_nothing_is_refused_and_not_exact(run, tmp_path, monkeypatch):
    """The camera looks the other way, so the errors have no pixels. Every table that draws the scene refuses it."""
    monkeypatch.chdir(tmp_path)
    document = as_document([sphere(1.0, 16, 8)])
    document.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]
    document.node(camera=0, translation=[0, 0, -5])
    document.write(tmp_path / "away.glb")
    code = ["--encoding", "octahedral", "--storage", "rg8", "--scene", "away.glb", "--size", "64x48"]
    for words in (["render", "--repeats", "0"], ["render", "--repeats", "0", "--exposure", "auto"], ["pick"]):
        status, out, err = run(*words, *code)
        assert (status, out) == (2, "") and "away.glb: its camera sees nothing; move it" in err, words
        assert len(err.splitlines()) == 1, err


def test_a_scene_that_covers_little_of_its_image_is_reported(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    document = as_document([sphere(1.0, 16, 8)])
    document.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]
    document.node(camera=0, translation=[0, 0, 5])
    document.write(tmp_path / "far.glb")
    code = ["--encoding", "octahedral", "--storage", "rg8", "--scene", "far.glb", "--size", "64x48"]
    # A ball of radius 1 at 5: pi tan(asin(1/5))^2 of a picture of 4/3 (2 tan(0.5))^2 is 8.2 %.
    for words in (["render", "--repeats", "0"], ["pick"]):
        _, _, err = run(*words, *code)
        assert re.search(r"far.glb: surfaces cover only (7|8|9)% of the image; move the camera in the file", err), (
            words,
            err,
        )


def test_a_black_image_is_reported(run):
    _, out, err = run("render", *SMALL, "--encoding", "octahedral", "--exposure", "-20", "--format", "json")
    assert "100% of the covered pixels are black; errors there are not visible" in err
    assert all(row["black_percent"] == 100 for row in json.loads(out))


@pytest.mark.parametrize(
    "words, said",
    [
        (["--exposure", "bright"], "--exposure bright: not a number; use stops such as -1.5, or auto"),
        (["--exposure", "nan"], "--exposure nan: out of range; use -20 to 20 stops"),
        (["--exposure=-21"], "--exposure -21: out of range; use -20 to 20 stops"),
        (["--tone-mapping", "Filmic"], "unknown tone mapping 'Filmic'; known: none, reinhard, aces"),
    ],
)
def test_invalid_display_option_is_a_one_line_error(run, words, said):
    status, out, err = run("render", *SMALL, "--encoding", "octahedral", *words)
    assert (status, out) == (2, "") and err == f"normalbench: {said}\n"


def test_encodings_that_do_not_fit_are_reported_with_the_reason(run):
    """Precise rounding needs fixed point; three components need three channels."""
    codecs = ["--encoding", "octahedral_precise,xyz,octahedral", "--storage", "rg16f", "--pipeline", "deferred"]
    status, out, err = run("render", *SMALL, *codecs, "--format", "json")
    precise, xyz = err.splitlines()
    assert status == 0 and [row["encoding"] for row in json.loads(out)] == ["octahedral"]
    assert "octahedral_precise/rg16f: RG16F stores floats, but precise rounding is for fixed point" in precise
    assert "xyz/rg16f: 3 components, but RG16F has 2 channels" in xyz


def test_two_encoders_with_the_same_name_have_separate_rows(run, tmp_path):
    """Two lookup tables in files with the same name: the published table, and a table filled with 1/3."""
    published = ENCODINGS["best_fit"].tables()["best_fit_scale"]
    paths = [tmp_path / folder / "table.npy" for folder in ("one", "other")]
    for path, table in zip(paths, (published, np.full_like(published, 1 / 3)), strict=True):
        path.parent.mkdir()
        np.save(path, table)
    names = ["best_fit", *(f"best_fit:table={path}" for path in paths)]
    arguments = [*SMALL, "--scene", "room", "--pipeline", "deferred", "--encoding", ",".join(names)]
    status, out, _ = run("render", *arguments, "--format", "json")
    best_fit, same, other = json.loads(out)
    assert status == 0 and same["encoding"] == other["encoding"] == "best_fit:table=table.npy"
    assert same["normal_psnr_db"] == best_fit["normal_psnr_db"] > other["normal_psnr_db"] + 3, (same, other)


def test_layouts_with_encoders_of_the_same_name_are_measured_separately(gl):
    """Each row has the figures of its layout's encoder, whichever encoder was measured before."""
    encodings = [ENCODINGS["xyz"], ENCODINGS["octahedral"]]
    encodings += [replace(encoding, name="mine", functions=encoding.prefix) for encoding in encodings]
    (case,) = cases(RenderOptions(size="64x48", lights=4, scene="room", pipeline="deferred", encoding="xy"), gl)
    layouts = [LAYOUTS["fp32"].with_codec(Codec(encoding, STORAGES["rgba8"])) for encoding in encodings]
    bench = RenderBench(gl, 0, False)
    rows = [bench.measure(replace(case, plan=replace(case.plan, layout=layout)))[0] for layout in layouts]
    assert [row["encoding"] for row in rows] == ["xyz", "octahedral", "mine", "mine"]
    xyz, octahedral, *mine = (row["normal_psnr_db"] for row in rows)
    assert mine == [xyz, octahedral] and xyz != octahedral


def test_a_measured_exposure_does_not_depend_on_the_rows_before(gl):
    """A forward pipeline's covered pixels come from the G-buffer that is also the hybrid pipeline's reference."""
    options = {"size": "64x48", "lights": 4, "scene": "gloss", "encoding": "xy", "exposure": "auto"}
    exposures = []
    for names in ("forward,hybrid", "hybrid"):
        bench = RenderBench(gl, 0, False)
        rows = [bench.measure(case)[0] for case in cases(RenderOptions(**options, pipeline=names), gl)]
        exposures.append(rows[-1]["exposure"])
    assert exposures[0] == exposures[1] != 0


def test_flip_is_measured_on_request(run):
    status, out, _ = run(*QUICK, "--pipeline", "deferred", "--flip")
    octahedral, xy = json.loads(out)
    assert status == 0 and 1 > xy["flip"] > octahedral["flip"] > 0


def test_layouts_are_measured_unchanged(run):
    status, out, _ = run(*QUICK[:-4], "--format", "json", "--pipeline", "hybrid", "--layout", "hybrid,xegtao")
    rows = json.loads(out)
    assert status == 0 and [(row["layout"], row["storage"]) for row in rows] == [
        ("hybrid", "rg16f"),
        ("xegtao", "rgba8 11:11:10"),
    ]
    assert [row["normal_bits"] for row in rows] == [32, 32] and all(row["psnr_db"] > 40 for row in rows)


def test_pipelines_that_do_not_suit_a_layout_are_left_out_and_reported(run):
    status, out, err = run(
        *QUICK[:-4], "--format", "json", "--pipeline", "deferred,prepass", "--layout", "normal_depth"
    )
    assert status == 0 and [row["pipeline"] for row in json.loads(out)] == ["prepass"]
    assert err.startswith("normalbench: left out: deferred needs base_color.b") and err.count("\n") == 1


def test_pictures_show_the_rendered_images(run, tmp_path):
    """Final, reference and difference images. A coarse codec's difference is not black, nor is its final image."""
    status, *_ = run(*QUICK, "--pipeline", "hybrid", "--images", str(tmp_path))
    assert status == 0 and len(list(tmp_path.iterdir())) == 5, "the reference is there once"
    pixels = {
        kind: np.asarray(Image.open(tmp_path / f"room-hybrid-{name}.png")).astype(int)
        for kind, name in (
            ("reference", "reference"),
            ("final", "fp32-xy-rgba8-rgba32fx2-final"),
            ("difference", "fp32-xy-rgba8-rgba32fx2-difference"),
        )
    }
    assert all(image.shape == (72, 96, 3) for image in pixels.values())
    assert 60 < pixels["final"].mean() < 200 and (pixels["final"].max(axis=2) > 8).mean() > 0.99
    apart = abs(pixels["final"] - pixels["reference"])
    assert abs(np.minimum(apart * 16, 255) - pixels["difference"]).max() <= 16


def test_lower_resolutions_of_inferred_lighting_are_reported(run):
    figures = []
    for scale in ("1", "0.5", "0.25"):
        arguments = ("--layout", "fp32", "--pipeline", "inferred", "--scale", scale, "--format", "json")
        _, out, _ = run("render", *SMALL, "--scene", "room", *arguments)
        figures += json.loads(out)
    assert figures[0]["exact"] and figures[1]["psnr_db"] > figures[2]["psnr_db"] > 15
    # At full size the image shares the G-buffer's depth and stencil.
    assert [row["bytes_per_pixel"] for row in figures] == [101, 101 / 4 + 5, 101 / 16 + 5]


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_samples_smooth_edges(gl, pipeline):
    """At 4 samples the image is closer to an image with 4 times the pixels than at 1 sample."""
    chosen, scene = PIPELINES[pipeline], SCENES["room"].make(Setting(lights=2))
    targets = max(chosen.light_targets, default=1)
    plan = Plan((120, 90), 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], targets, False, 1.0)

    def image(plan: Plan) -> np.ndarray:
        with render(gl, chosen, scene, plan) as drawing:
            drawing.draw()
            return drawing.image().astype(np.float64)

    fine = image(replace(plan, size=(480, 360))).reshape(90, 4, 120, 4, 3).mean(axis=(1, 3))
    single, four = (np.mean((displayed(image(replace(plan, samples=n))) - displayed(fine)) ** 2) for n in (1, 4))
    # Inferred lighting shades once a pixel and stipples glass at any number of samples: only outlines are smoothed.
    share = 0.9 if chosen.scaled else 0.5
    assert four < share * single, f"{four:.2e} at 4 samples, {single:.2e} at 1"


def test_a_nan_pixel_counts_as_a_full_error():
    image = np.full((4, 4, 3), 0.5)
    broken = image.copy()
    broken[1, 2, 0] = np.nan
    assert image_metrics.squared_error(broken, image) == (1 / 16, 1)
    assert Flip(image).of(broken).mean() > 0


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["--size", "0x10"], "WIDTHxHEIGHT"),
        (["--size", "640"], "WIDTHxHEIGHT"),
        (["--size", "99999999x10"], "each from 1 to"),
        (["--size", "16384x16384"], "2^25"),
        (["--frames", "1000"], "2^25"),
        (["--layout", ""], "no layout named"),
        (["--encoding", ""], "no encoding named"),
        (["--layout", "hybrid", "--rounding", "up"], "unknown rounding 'up'"),
        (["--layout", "hybrid,hybrid.toml"], "two layouts are named hybrid"),
        (["--samples", "0"], "--samples 0: out of range; use 1 to 64"),
        (["--scale", "0"], "use 0.05 to 1"),
        (["--scale", "nan"], "use 0.05 to 1"),
        (["--lights", "-1"], "--lights -1: out of range; use 0"),
        (["--objects", "0"], "--objects 0: out of range; use 1"),
        (["--frames", "-1"], "--frames -1"),
        (["--repeats", "-1"], "--repeats -1"),
        (["--seed", "-1"], "--seed -1"),
        (["--pipeline", "raytraced"], "unknown pipeline 'raytraced'; known: all, forward"),
        (["--layout", "mine"], "unknown layout 'mine'; known: all, fp32"),
        (["--layout", "missing.toml"], "missing.toml: there is no such file"),
        (["--layout", "clash.toml"], "normal.x is stored twice"),
        (["--layout", "hybrid", "--encoding", "xy_sign"], "has no depth"),
        (["--layout", "normal_depth", "--pipeline", "deferred"], "deferred needs base_color.b"),
        (["--light-buffer", "rgba8"], "unknown light buffer 'rgba8'"),
        (["--light-buffer", "r11g11b10f", "--light-targets", "1"], "one light target needs an alpha channel"),
        (["--light-targets", "3"], "unknown number of light targets '3'; known: all, 1, 2"),
        (["--scene", "sponza"], "unknown scene 'sponza'; known: all, playground"),
        (["--shadow", "yes"], "unknown shadow 'yes'; known: all, on, off"),
        (["--encoding", "cubemap"], "unknown encoding 'cubemap'"),
        (["--encoding", "xyz", "--storage", "rg8"], "3 components, but RG8 has 2 channels"),
        (["--images", "/proc/none"], "cannot write to /proc/none"),
        (["-o", "/proc/none/rows.csv"], "cannot write"),
    ],
)
def test_bad_input_is_a_one_line_error_and_nothing_is_written(run, tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    clash = "encoding = 'xy'\n[[targets]]\nformat = 'rgba8'\nholds = 'normal.x normal.y normal.x'\n"
    (tmp_path / "clash.toml").write_text(clash)
    (tmp_path / "hybrid.toml").write_text(clash.replace(" normal.x'", "'"))
    usual = [] if "--pipeline" in arguments else ["--pipeline", "hybrid"]
    status, out, err = run("render", *usual, *arguments)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1 and said in err, err
    assert {path.name for path in tmp_path.iterdir()} == {"clash.toml", "hybrid.toml"}


def test_a_rendered_frame_leaves_the_device_usable_for_other_passes(gl):
    """Values pass through a float target unchanged after a frame that blends and tests depth."""
    plan = Plan((48, 36), 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], 2, True, 1.0)
    with render(gl, PIPELINES["hybrid"], SCENES["room"].make(Setting(lights=2)), plan) as drawing:
        drawing.draw()
    values = np.random.default_rng(0).uniform(-1, 1, (36, 48, 4)).astype(np.float32)
    assert np.array_equal(gl.through(values, STORAGES["rgba32f"]), values)
    assert gl.context.error == "GL_NO_ERROR"
