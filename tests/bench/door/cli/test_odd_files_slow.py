"""Files of odd kinds and names, and places that go away: a line each, soon, and nothing is lost."""

import json
import os
from pathlib import Path

import numpy as np
from test_odd_files import QUICK
from written import some_normals


def test_a_name_that_is_no_utf_8_is_measured_and_written(run, tmp_path, monkeypatch):
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
