"""The command line: what it prints, what it writes, and what it says of bad input."""

import csv
import io
import json
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import test_cli
from PIL import Image
from test_cli import NO_GL, QUICK, in_a_process

from normalbench.bench.measures.metrics import published
from normalbench.bench.tables.quality.table import COMMON, TWO, WIDE
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.reports import tables


@pytest.mark.usefixtures("gl")
def test_the_pictures_show_the_scene(run, tmp_path):
    """Not black, not all alike: the decoded picture is the scene, the error picture of XY is blue where z was lost."""
    status, _, err = run("quality", "--encoding", "xy,xyz", "--images", str(tmp_path))
    assert status == 0, err
    names = {f"playground-{e}-rgba8-{k}.png" for e in ("xy", "xyz") for k in ("encoded", "decoded", "error", "power")}
    others = {"playground-normals.png", "playground-xy-rgba8.npz", "playground-xyz-rgba8.npz"}
    assert {p.name for p in tmp_path.iterdir()} == names | others, "and the set itself, and each pixel's code and angle"
    pictures = {name: np.asarray(pixels_of(tmp_path / name)).astype(int) for name in names}
    assert all(p.shape == (480, 640, 3) and p.std() > 3 for p in pictures.values())
    assert abs(pictures["playground-xyz-rgba8-decoded.png"] - pictures["playground-xyz-rgba8-encoded.png"]).max() <= 1
    error = pictures["playground-xy-rgba8-error.png"]
    lost = pictures["playground-xyz-rgba8-decoded.png"][..., 2] < 120
    lost &= pictures["playground-xyz-rgba8-decoded.png"].any(axis=-1)
    assert np.mean(error[lost][:, 2] > 200) > 0.95, "z is what XY loses"
    assert pictures["playground-xy-rgba8-encoded.png"][..., 2].max() == 0, "an unused channel is black"


def pixels_of(path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)


def test_run_prints_the_articles_figures_beside_its_own(results):
    _, out, err = results
    for name, figure in published.PSNR_DB.items():
        table = out[out.index("playground, rgba8") :]
        line = next(line for line in table.splitlines() if line.startswith(f"{name} "))
        assert f"{figure:.2f}" in line, line
    assert err == ""


@pytest.mark.usefixtures("gl")
def test_run_leaves_a_results_folder(tmp_path, run):
    folder = tmp_path / "results"
    arguments = ["run", "--tables", "quality", "--count", "65536", "-o", str(folder)]
    status, out, err = run(*arguments)
    assert status == 0 and str(folder) in out, err
    rows = json.loads((folder / "quality.json").read_text())
    two = [
        name for name in COMMON if ENCODINGS[name].components == 2 and Codec(ENCODINGS[name], STORAGES["rg16f"]).fits
    ]
    assert tuple(two) == TWO
    codecs = len(COMMON) + len(two) + 3 * len(WIDE) + 2
    assert len(rows) == codecs * 2 * 2, "in rgba8, rg16f, rgb10a2, rg16 and 12:12"
    assert {row["normals"] for row in rows} == {"playground", "hemisphere"}
    assert all(row["skipped"] is None and row["count"] for row in rows)
    assert len(list(csv.DictReader(io.StringIO((folder / "quality.csv").read_text())))) == len(rows)
    facts = json.loads((folder / "run.json").read_text())
    assert facts["machine"]["jax"] and facts["machine"]["GL"] and facts["finished"] and facts["sources"]
    assert facts["command"] == arguments
    assert len(list((folder / "images").iterdir())) == codecs * 5 + 1, "and the set itself"
    assert len(list((folder / "sphere").iterdir())) == codecs


def test_a_run_that_fails_in_the_end_keeps_its_rows_and_no_half_of_a_table(run, tmp_path, monkeypatch):
    """A full disk where the tables are written: one line; run again, nothing is measured a second time."""
    folder = tmp_path / "results"
    words = ("--encoding", "octahedral,xy", "--storage", "rg8", "--normals", "axes", "--backend", "jax")
    command = ("run", "--tables", "quality", *words, "-o", str(folder))

    def full(*_):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(tables, "to_csv", full)
        status, _, err = run(*command)
    assert status == 2 and "No space left on device" in err and err.count("\n") == 1
    assert {path.name for path in folder.iterdir()} == {"rows.jsonl", "run.json", "quality.json"}
    steps = (folder / "rows.jsonl").read_bytes().count(b"\n")
    status, _, err = run(*command)
    assert status == 0 and f"{steps} of {steps} steps are there" in err


@pytest.mark.parametrize("ended", [signal.SIGINT, signal.SIGTERM])
def test_an_ended_run_keeps_its_rows_and_says_how_to_go_on(tmp_path, ended):
    folder = tmp_path / "results"
    command = [sys.executable, "-m", "normalbench", "run", "--tables", "depth,quality", "-o", str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        deadline = time.monotonic() + 60
        while not (folder / "rows.jsonl").exists() or (folder / "rows.jsonl").read_bytes().count(b"\n") < 3:
            assert time.monotonic() < deadline, "it never began to write"
            time.sleep(0.05)
        process.send_signal(ended)
        _, err = process.communicate(timeout=60)
    assert process.returncode == (130 if ended == signal.SIGINT else 143)
    kept = (folder / "rows.jsonl").read_bytes().count(b"\n")
    said, *rest = err.splitlines()
    assert said.startswith(f"normalbench: {kept} of ") and said.endswith("steps are kept; the same command goes on"), (
        err
    )
    assert rest == (["normalbench: interrupted"] if ended == signal.SIGINT else [])
    assert {path.name for path in folder.iterdir()} == {"rows.jsonl", "run.json"}


@pytest.mark.usefixtures("gl")
def test_a_cache_folder_that_cannot_be_made_goes_without_saying(tmp_path, monkeypatch):
    """Mesa would print a line of its own."""
    for name in ("DIR", "DISABLE"):
        monkeypatch.delenv(f"MESA_SHADER_CACHE_{name}", raising=False)
    (tmp_path / "file").touch()
    done = in_a_process(*QUICK, "--backend", "glsl", XDG_CACHE_HOME=str(tmp_path / "file" / "cache"))
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize(
    "command",
    [(name,) for name in ("lights", "depth", "frames", "render", "sweep")],
    ids=lambda c: c[0],
)
def test_a_platform_jax_does_not_know_is_one_line_whatever_the_command(command):
    test_cli.test_a_platform_jax_does_not_know_is_one_line(command)


def test_without_a_gl_driver_jax_measures_all_the_same():
    done = in_a_process(*QUICK, "--format", "json", **NO_GL)
    rows = json.loads(done.stdout)
    assert done.returncode == 0
    assert all(row["psnr_db"] for row in rows if row["backend"] == "jax")
    skipped = [row["skipped"] for row in rows if row["backend"] == "glsl"]
    assert len(skipped) == 2 and all("no GL 4.3 device" in s and "apt-get install" in s for s in skipped)
    assert done.stderr.count("\n") == 1 and "apt-get install" in done.stderr
