"""Odd kinds and names of files, and folders that disappear: errors are short and quick, and nothing is lost."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from test_odd_files import JAX, QUICK, SHADER
from written import some_normals

GATE = '[[gate]]\nencoding = "octahedral"\nnormals = "axes"\nbackend = "jax"\npsnr_db = "at least 1"\n'


def test_a_byte_order_mark_is_ignored(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("gates.toml").write_text(GATE, encoding="utf-8-sig")
    assert run("check", "gates.toml")[0] == 0
    Path("mine.glsl").write_text(SHADER, encoding="utf-8-sig")
    status, out, err = run(*JAX[:-2], "--backend", "glsl", "--encoding", "mine.glsl", "--format", "json")
    assert status == 0 and json.loads(out)[0]["psnr_db"] > 1, err


def test_a_terminal_without_a_degree_sign_gets_the_table(tmp_path):
    script = "from normalbench.bench.door.cli import app; app.main = lambda: print('0.9\u00b0') or 0; app.program()"
    known = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, env=known, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "0.9\\xb0\n", "")


def test_a_file_with_a_name_that_is_not_utf_8_can_be_measured(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    name = os.fsdecode(b"n\xff.npy")
    with Path(name).open("wb") as file:
        np.save(file, some_normals())
    for ending in ("table", "json", "csv", "markdown"):
        status, _, err = run(*QUICK, "--normals", name, "--format", ending, "-o", f"rows.{ending}")
        assert (status, err) == (0, "") and Path(f"rows.{ending}").read_text(encoding="utf-8"), ending
    assert json.loads(Path("rows.json").read_text())[0]["normals"] == "n\\udcff.npy"
    status, _, err = run("run", "--tables", "quality", *QUICK[1:], "--normals", name, "-o", "results")
    assert status == 0 and Path("results", "report.html").exists(), err
