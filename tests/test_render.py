"""`normalbench render` and `normalbench sweep`: rows, pictures, plots, and what they say of bad input."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from normalbench.bench import image_metrics, rendering, sweep
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codec import Codec
from normalbench.encodings.storage import STORAGES
from normalbench.gbuffer.frame import Plan
from normalbench.gbuffer.layouts import LAYOUTS
from normalbench.gbuffer.light_buffers import LIGHT_BUFFERS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import WALL, displayed
from normalbench.gbuffer.render import rendering as render
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting

pytestmark = pytest.mark.usefixtures("gl")
SMALL = ["--size", "96x72", "--lights", "4", "--repeats", "1"]
QUICK = ["render", *SMALL, "--scene", "room", "--encoding", "octahedral,xy", "--format", "json"]
SWEEP = ["sweep", *SMALL, "--objects", "3,5", "--pipeline", "prepass,hybrid"]
CODECS = [Codec(e, s) for e in ENCODINGS.values() for s in STORAGES.values() if e.components <= s.channels]


def test_rows_say_what_was_rendered_and_how_far_it_is_off(run):
    status, out, _ = run(*QUICK, "--pipeline", "deferred,forward")
    rows = json.loads(out)
    assert status == 0 and all(tuple(row) == rendering.COLUMNS for row in rows)
    octahedral, xy, forward = rows
    assert (octahedral["pipeline"], octahedral["encoding"], octahedral["storage"]) == (
        "deferred",
        "octahedral",
        "rgba8",
    )
    assert octahedral["psnr_db"] > xy["psnr_db"] > 20 and xy["flip"] is None
    assert (octahedral["rank"], xy["rank"], octahedral["normal_rank"], xy["normal_rank"]) == (1, 2, 1, 2)
    assert octahedral["bytes_per_pixel"] == 64 + 4 + 5 + 16, "the normal's RGBA32F still holds the depth"
    assert forward["layout"] is None and forward["exact"] and forward["psnr_db"] is None
    assert octahedral["ms_frame"] > 0 and octahedral["ms_lights"] > 0 and octahedral["ms_forward"] is None
    assert octahedral["clock"] == WALL or "query" in octahedral["clock"]


def test_flip_is_measured_where_it_is_asked_for(run):
    pytest.importorskip("flip_evaluator")
    status, out, _ = run(*QUICK, "--pipeline", "deferred", "--flip")
    octahedral, xy = json.loads(out)
    assert status == 0 and 1 > xy["flip"] > octahedral["flip"] > 0


def test_flip_that_is_not_installed_is_one_line(run, monkeypatch):
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    status, out, err = run(*QUICK, "--flip")
    assert (status, out) == (3, "") and err.count("\n") == 1 and "pip install flip-evaluator" in err


def test_layouts_are_measured_as_they_are(run):
    status, out, _ = run(*QUICK[:-4], "--format", "json", "--pipeline", "hybrid", "--layout", "hybrid,kajiya")
    rows = json.loads(out)
    assert status == 0 and [(row["layout"], row["storage"]) for row in rows] == [
        ("hybrid", "rg16f"),
        ("kajiya", "rgba8 11:10:11"),
    ]
    assert [row["normal_bits"] for row in rows] == [32, 32] and all(row["psnr_db"] > 40 for row in rows)


def test_bytes_per_pixel_count_what_a_frame_keeps(run):
    """17 of the layout, 4 of the linear depth resolved from it, two light targets of 8; at two samples twice that."""
    arguments = ("--pipeline", "hybrid", "--layout", "hybrid,xy_depth_sign", "--light-buffer", "rgba16f")
    figures = [json.loads(run(*QUICK[:-4], *arguments, "--format", "json", "--samples", n)[1]) for n in ("1", "2")]
    assert [row["bytes_per_pixel"] for row in figures[0]] == [17 + 4 + 16, 21 + 16]
    assert [row["bytes_per_pixel"] for row in figures[1]] == [2 * 37, 2 * 37]


def test_codecs_are_ranked_among_their_like(run):
    """With and without shadows are two contests."""
    _, out, _ = run(*QUICK[:-2], "--format", "json", "--pipeline", "deferred,hybrid", "--shadow", "on,off")
    assert [row["rank"] for row in json.loads(out)].count(1) == 4


def test_what_does_not_suit_is_left_out_and_named(run):
    status, out, err = run(
        *QUICK[:-4], "--format", "json", "--pipeline", "deferred,prepass", "--layout", "normal_depth"
    )
    assert status == 0 and [row["pipeline"] for row in json.loads(out)] == ["prepass"]
    assert err.startswith("normalbench: left out: deferred needs albedo.b") and err.count("\n") == 1


def test_pictures_show_what_was_rendered(run, tmp_path):
    """Final, reference and difference; the difference of a coarse codec is not black, the final is no black picture."""
    status, *_ = run(*QUICK, "--pipeline", "hybrid", "--images", str(tmp_path))
    assert status == 0 and len(list(tmp_path.iterdir())) == 6
    pixels = {
        kind: np.asarray(Image.open(tmp_path / f"room-hybrid-fp32-xy-rgba8-rgba32fx2-{kind}.png")).astype(int)
        for kind in ("final", "reference", "difference")
    }
    assert all(image.shape == (72, 96, 3) for image in pixels.values())
    assert 60 < pixels["final"].mean() < 200 and (pixels["final"].max(axis=2) > 8).mean() > 0.99
    apart = abs(pixels["final"] - pixels["reference"])
    assert abs(np.minimum(apart * 16, 255) - pixels["difference"]).max() <= 16


def test_one_light_target_is_held_against_two(run):
    """One target rebuilds the highlights' colour: the row shows what that costs, and its reference does not do it."""
    status, out, _ = run(
        *("render", *SMALL, "--lights", "64", "--scene", "room", "--layout", "fp32", "--pipeline", "prepass,hybrid"),
        *("--light-targets", "1,2", "--format", "json"),
    )
    figures = {(row["pipeline"], row["light_targets"]): row for row in json.loads(out)}
    assert status == 0 and all(figures[p, 2]["exact"] for p in ("prepass", "hybrid"))
    # The hybrid pays for it on special materials alone.
    assert 30 < figures["prepass", 1]["psnr_db"] < figures["hybrid", 1]["psnr_db"] < 90


def test_lower_resolutions_of_inferred_are_reported(run):
    figures = []
    for scale in ("1", "0.5", "0.25"):
        arguments = ("--layout", "fp32", "--pipeline", "inferred", "--scale", scale, "--format", "json")
        _, out, _ = run("render", *SMALL, "--scene", "room", *arguments)
        figures += json.loads(out)
    assert figures[0]["exact"] and figures[1]["psnr_db"] > figures[2]["psnr_db"] > 15
    # At full size the image shares the G-buffer's depth and stencil.
    assert [row["bytes_per_pixel"] for row in figures] == [101, 101 / 4 + 5, 101 / 16 + 5]


def test_samples_beyond_the_device_are_asked_and_given(run, gl):
    status, out, _ = run(*QUICK, "--samples", "64", "--pipeline", "deferred,inferred")
    assert status == 0
    for row in json.loads(out):
        assert (row["samples_asked"], row["samples"]) == (64, gl.max_samples)
        assert row["psnr_db"] > 20


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_samples_smooth_edges(gl, pipeline):
    """At 4 samples the picture is nearer to one of 4 times the pixels than at 1 sample."""
    chosen, scene = PIPELINES[pipeline], SCENES["room"].make(Setting(lights=2))
    targets = max(chosen.light_targets, default=1)
    plan = Plan((120, 90), 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], targets, False, 1.0)

    def image(plan: Plan) -> np.ndarray:
        with render(gl, chosen, scene, plan) as made:
            made.draw()
            return made.image().astype(np.float64)

    fine = image(replace(plan, size=(480, 360))).reshape(90, 4, 120, 4, 3).mean(axis=(1, 3))
    one, four = (np.mean((displayed(image(replace(plan, samples=n))) - displayed(fine)) ** 2) for n in (1, 4))
    # Inferred lighting shades once a pixel and stipples glass at any number of samples: only outlines are smoothed.
    share = 0.9 if chosen.scaled else 0.5
    assert four < share * one, f"{four:.2e} at 4 samples, {one:.2e} at 1"


@pytest.mark.parametrize("pipeline", ["deferred", "hybrid"])
def test_every_codec_gives_a_finite_image(gl, pipeline):
    """Every encoding in every storage it fits, one small frame each."""
    scene = SCENES["room"].make(Setting(lights=2))
    chosen = PIPELINES[pipeline]
    plan = Plan((48, 36), 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], max(chosen.light_targets), False, 1.0)
    worst = {}
    with render(gl, chosen, scene, plan) as made:
        made.draw()
        exact = displayed(made.image())
    for codec in CODECS:
        with render(gl, chosen, scene, replace(plan, layout=plan.layout.with_codec(codec))) as made:
            made.draw()
            error, broken = image_metrics.squared_error(displayed(made.image()), exact)
        assert broken == 0, f"{codec.name}: {broken} pixels are no number"
        worst[codec.name] = error
    assert max(worst.values()) < 0.02, max(worst, key=lambda name: worst[name])


def test_a_pixel_that_is_no_number_counts_in_full():
    image = np.full((4, 4, 3), 0.5)
    broken = image.copy()
    broken[1, 2, 0] = np.nan
    assert image_metrics.squared_error(broken, image) == (1 / 16, 1)
    pytest.importorskip("flip_evaluator")
    assert image_metrics.flip(broken, image) > 0


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
        (["--layout", "hybrid,hybrid.toml"], "two layouts are called hybrid"),
        (["--samples", "0"], "--samples 0: from 1 to 64"),
        (["--scale", "0"], "a scale is 0.05 to 1"),
        (["--scale", "nan"], "a scale is 0.05 to 1"),
        (["--lights", "-1"], "--lights -1: from 0"),
        (["--objects", "0"], "--objects 0: from 1"),
        (["--frames", "-1"], "--frames -1"),
        (["--repeats", "0"], "--repeats 0"),
        (["--seed", "-1"], "--seed -1"),
        (["--pipeline", "raytraced"], "unknown pipeline 'raytraced'; known: all, forward"),
        (["--layout", "mine"], "unknown layout 'mine'; known: all, fp32"),
        (["--layout", "missing.toml"], "cannot be read as a layout"),
        (["--layout", "clash.toml"], "normal.x lies in two places"),
        (["--layout", "hybrid", "--encoding", "xy_sign"], "keeps no depth"),
        (["--layout", "normal_depth", "--pipeline", "deferred"], "deferred needs albedo.b"),
        (["--light-buffer", "rgb9e5"], "unknown light buffer 'rgb9e5'"),
        (["--light-buffer", "r11g11b10f", "--light-targets", "1"], "one light target needs an alpha channel"),
        (["--light-targets", "3"], "unknown number of light targets '3'; known: all, 1, 2"),
        (["--scene", "sponza"], "unknown scene 'sponza'; known: all, playground"),
        (["--shadow", "yes"], "unknown shadow 'yes'; known: all, on, off"),
        (["--encoding", "cubemap"], "unknown encoding 'cubemap'"),
        (["--encoding", "xyz", "--storage", "rg8"], "more components"),
        (["--images", "/proc/none"], "cannot write to /proc/none"),
        (["-o", "/proc/none/rows.csv"], "cannot write"),
    ],
)
def test_bad_input_is_one_line_and_nothing_is_written(run, tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    clash = "encoding = 'xy'\n[[targets]]\nformat = 'rgba8'\nholds = 'normal.x normal.y normal.x'\n"
    (tmp_path / "clash.toml").write_text(clash)
    (tmp_path / "hybrid.toml").write_text(clash.replace(" normal.x'", "'"))
    status, out, err = run("render", "--pipeline", "hybrid", *arguments)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1 and said in err, err
    assert {path.name for path in tmp_path.iterdir()} == {"clash.toml", "hybrid.toml"}


def test_a_sweep_counts_what_each_pass_draws(run):
    """Light pre-pass draws everything twice, the hybrid its general surfaces once."""
    status, out, _ = run(*SWEEP, "--format", "json")
    rows = json.loads(out)
    assert status == 0 and all(tuple(row) == sweep.COLUMNS for row in rows)
    assert [(r["shadow"], r["objects"], r["pipeline"]) for r in rows] == [
        (shadow, objects, pipeline)
        for shadow in (True, False)
        for objects in (3, 5)
        for pipeline in ("prepass", "hybrid")
    ]
    for row in rows:
        scene = SCENES["objects"].make(Setting(row["objects"], 4))
        general, special = (
            sum(len(p.mesh.triangles) * np.sum([(scene.materials[m].kind != "general") == s for m in p.materials])
                for p in scene.parts)
            for s in (False, True)
        )  # fmt: skip
        assert row["triangles_geometry"] == general + special
        assert row["triangles_material"] == special + (general if row["pipeline"] == "prepass" else 0)
        assert (row["triangles_shadow_map"] > 0) == row["shadow"]


def test_a_sweep_writes_its_rows_and_its_plot(run, tmp_path):
    rows, plot = tmp_path / "rows.csv", tmp_path / "plot.png"
    status, out, _ = run(*SWEEP, "--format", "csv", "-o", str(rows), "--plot", str(plot))
    assert (status, out) == (0, "") and len(list(csv.DictReader(rows.read_text().splitlines()))) == 8
    pixels = np.asarray(Image.open(plot).convert("RGB"))
    assert pixels.shape[1] > 800 and len(np.unique(pixels.reshape(-1, 3), axis=0)) > 50
    assert sorted(path.name for path in tmp_path.iterdir()) == ["plot.png", "rows.csv"], "the journal is gone"


def test_a_stopped_sweep_goes_on_where_it_was(run, tmp_path, monkeypatch):
    """Rows that were measured before are kept to the last digit, a line that was cut off is measured again."""
    output = tmp_path / "rows.json"
    measure, measured = sweep.measure, []

    def stopping(device, point):
        if len(measured) == 3:
            raise KeyboardInterrupt
        measured.append(point)
        return measure(device, point)

    monkeypatch.setattr(sweep, "measure", stopping)
    status, out, err = run(*SWEEP, "--format", "json", "-o", str(output))
    assert (status, out) == (130, "") and "3 of 8 rows are kept; the same command goes on" in err
    journal = tmp_path / ".rows.json.rows"
    kept = [json.loads(line) for line in journal.read_text().splitlines()]
    with journal.open("a") as file:
        file.write('{"pipeline": "pre')
    monkeypatch.setattr(sweep, "measure", lambda device, point: measured.append(point) or measure(device, point))
    status, _, err = run(*SWEEP, "--format", "json", "-o", str(output))
    assert status == 0 and "3 of 8 rows were measured before" in err and len(measured) == 8
    rows = json.loads(output.read_text())
    assert rows[:3] == kept and len(rows) == 8 and not journal.exists()


def test_rows_of_another_sweep_are_not_taken_and_not_thrown_away(run, tmp_path, monkeypatch):
    """A layout that changed behind its name is another sweep."""
    monkeypatch.chdir(tmp_path)
    layout = "encoding = 'octahedral'\n[[targets]]\nformat = '{}'\nholds = 'normal.x normal.y'\n"
    measure, rows = sweep.measure, []

    def stopping(device, point):
        if rows:
            raise SystemExit(143)
        rows.append(measure(device, point))
        return rows[0]

    command = (
        "sweep",
        *SMALL,
        "--pipeline",
        "prepass",
        "--objects",
        "3,5",
        "--layout",
        "mine.toml",
        "-o",
        "new/rows.csv",
    )
    (tmp_path / "mine.toml").write_text(layout.format("rg8"))
    monkeypatch.setattr(sweep, "measure", stopping)
    with pytest.raises(SystemExit):
        run(*command)
    journal = tmp_path / "new" / ".rows.csv.rows"
    kept = journal.read_text()
    (tmp_path / "mine.toml").write_text(layout.format("rg16f"))
    status, _, err = run(*command)
    assert status == 2 and "keeps 1 rows of another sweep" in err and journal.read_text() == kept
    (tmp_path / "mine.toml").write_text(layout.format("rg8"))
    monkeypatch.setattr(sweep, "measure", measure)
    assert run(*command)[0] == 0 and not journal.exists()


def test_a_sweep_goes_through_a_pipe(run, tmp_path):
    """What is no file has no journal beside it."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = subprocess.Popen(["cat", str(pipe)], stdout=subprocess.PIPE, text=True)
    status, *_ = run(*SWEEP, "--format", "csv", "-o", str(pipe))
    assert status == 0 and reader.communicate(timeout=20)[0].count("\n") == 9
    assert [path.name for path in tmp_path.iterdir()] == ["pipe"]


def test_two_sweeps_do_not_share_an_output(run, tmp_path):
    with sweep.journal(tmp_path / "rows.csv"):
        status, _, err = run(*SWEEP, "-o", str(tmp_path / "rows.csv"))
    assert status == 2 and "another sweep is writing" in err and err.count("\n") == 1


def test_an_interrupted_process_leaves_its_journal(tmp_path):
    output = tmp_path / "rows.csv"
    command = [sys.executable, "-m", "normalbench.bench", "sweep", *SMALL, "--objects", "2000", "--repeats", "50"]
    command += ["--pipeline", "all", "-o", str(output)]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=os.environ | {"PYTHONUNBUFFERED": "1"})
    deadline = time.monotonic() + 60
    while not (tmp_path / ".rows.csv.rows").exists() and time.monotonic() < deadline:
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    # Python ends itself by the signal where that came in the middle of an import; to a shell that is 130 as well.
    assert process.returncode in (130, -signal.SIGINT) and "rows are kept" in err and "Traceback" not in err
    assert not output.exists()


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["--objects", "100,x"], "comma-separated"),
        (["--objects", "0"], "numbers from 1"),
        (["--objects", "9" * 5000], "numbers from 1"),
        (["--samples", "0"], "--samples 0: from 1 to 64"),
        (["--scale", "2"], "a scale is 0.05 to 1"),
        (["--layout", ""], "no layout named"),
        (["--objects", ""], "numbers from 1"),
        (["--size", "0x0"], "WIDTHxHEIGHT"),
        (["--plot", "plot.jpg"], "a plot's name ends in .png, .svg, .pdf"),
        (["--plot", "."], "is a folder"),
        (["--pipeline", "none"], "unknown pipeline 'none'"),
        (["-o", "."], "is a folder"),
        (["--layout", "normal_depth", "--pipeline", "hybrid"], "hybrid needs"),
    ],
)
def test_a_bad_sweep_is_one_line_and_nothing_is_written(run, tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    status, out, err = run("sweep", *arguments)
    assert (status, out) == (2, "") and err.count("\n") == 1 and said in err, err
    assert not list(tmp_path.iterdir())


def test_a_rendered_frame_leaves_the_device_as_other_passes_need_it(gl):
    """Values through a float target come back as they were, after a frame that blends and tests depth."""
    plan = Plan((48, 36), 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], 2, True, 1.0)
    with render(gl, PIPELINES["hybrid"], SCENES["room"].make(Setting(lights=2)), plan) as made:
        made.draw()
    values = np.random.default_rng(0).uniform(-1, 1, (36, 48, 4)).astype(np.float32)
    assert np.array_equal(gl.through(values, STORAGES["rgba32f"]), values)
    assert gl.context.error == "GL_NO_ERROR"


def test_ctrl_c_in_a_callback_that_swallows_it_still_ends_the_program(tmp_path):
    """As JAX's does in the garbage collector: no traceback, and the next step ends."""
    program = (
        "import gc, os, signal, sys\n"
        "from normalbench.bench import cli\n"
        "def callback(*_):\n"
        "    if 'normalbench.bench.sweep' in sys.modules and not sent:\n"
        "        sent.append(os.kill(os.getpid(), signal.SIGINT))\n"
        "sent = []\n"
        "gc.callbacks.append(callback)\n"
        "sys.exit(cli.main())\n"
    )
    command = [sys.executable, "-c", program, *SWEEP, "-o", str(tmp_path / "rows.csv")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode in (130, -signal.SIGINT), done.stderr
    assert "rows are kept" in done.stderr and "Traceback" not in done.stderr and "ignored" not in done.stderr
