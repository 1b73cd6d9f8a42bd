"""Odd kinds and names of files, and folders that disappear: errors are short and quick, and nothing is lost."""

import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from written import some_normals

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.ground.output.writing import whole_file
from normalbench.bench.keep.journal import journal

SHADER = """
vec2 mine_encode(vec3 n, vec3 view) { return n.xy; }
vec3 mine_decode(vec2 e, vec3 view) { return vec3(e, sqrt(max(1.0 - dot(e, e), 0.0))); }
"""


JAX = ("quality", "--storage", "rg8", "--backend", "jax")


GLSL = ("quality", "--storage", "rg8", "--backend", "glsl", "--normals", "axes")


QUICK = (*JAX, "--encoding", "octahedral")


PIPED = {
    "gates.toml": ("check", "gates.toml"),
    "layout.toml": ("render", "--layout", "layout.toml"),
    "mine.glsl": (*JAX, "--encoding", "mine.glsl"),
    "matrix.txt": (*QUICK, "--normals", "list.npy", "--space", "world", "--view-matrix", "matrix.txt"),
    "scales.npy": ("quality", "--backend", "jax", "--encoding", "best_fit:table=scales.npy", "--storage", "rgba8"),
    "frame.png": (*QUICK, "--normals", "frame.png"),
}


@pytest.mark.parametrize("name", PIPED)
def test_a_pipe_is_refused_without_waiting(run, tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    np.save("list.npy", some_normals())
    os.mkfifo(name)
    began = time.monotonic()
    status, out, err = run(*PIPED[name])
    assert (status, out, err.count("\n")) == (2, "", 1) and name in err and "plain file" in err, err
    assert time.monotonic() - began < 20


@pytest.mark.usefixtures("gl")
def test_a_file_name_may_contain_a_comma(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.save("a,b.npy", some_normals())
    Path("a,b.glsl").write_text(SHADER)
    for words in ((*QUICK, "--normals", "a,b.npy"), (*GLSL, "--encoding", "a,b.glsl")):
        status, out, err = run(*words)
        assert status == 0 and out, err


def test_far_too_many_channels_are_refused_at_once(run, tmp_path, monkeypatch):
    """The file is a row of 2^25 pixels that was saved without its last axis."""
    monkeypatch.chdir(tmp_path)
    np.save("row.npy", np.zeros((1, 2**25), np.uint8))
    began = time.process_time()
    status, _, err = run(*QUICK, "--normals", "row.npy")
    assert status == 2 and "33554432 channels; at most 1024 are supported" in err
    assert time.process_time() - began < 5


@pytest.mark.parametrize("name, option", [("page.html", "--report"), ("chart.PNG", "--plot")])
def test_rows_are_not_written_to_a_file_named_like_a_page_or_a_chart(run, tmp_path, name, option):
    path = tmp_path / name
    status, out, err = run(*QUICK, "-o", str(path))
    assert (status, out, path.exists()) == (2, "", False)
    assert err == f"normalbench: -o writes only rows; for {name} use {option} {path}, if the command has that option\n"


def test_a_folder_deleted_during_a_run_is_noticed_at_the_next_row(tmp_path):
    path = tmp_path / "run" / "rows.jsonl"
    with journal(path) as kept:
        kept.add({"a": 1})
        path.unlink()
        path.parent.rmdir()
        with pytest.raises(UsageError, match="the file was deleted meanwhile"):
            kept.add({"a": 2})


def test_partial_files_of_a_killed_process_are_deleted(tmp_path):
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    gone, others = tmp_path / f".rows.csv.{ended.pid}.partial", tmp_path / f".rows.csv.{os.getppid()}.partial"
    for path in (gone, others):
        path.write_text("half")
    with whole_file(tmp_path / "rows.csv") as partial:
        partial.write_text("whole")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([others.name, "rows.csv"])
