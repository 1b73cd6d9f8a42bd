"""`normalbench compare`: no differences for the same work, exact figures, and time changes only beyond noise."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from contributing import a_copy_of_the_rooms

from normalbench.bench.keep.runs import read_run

HOWS = ("never", "worse", "change")


def in_a_copy(folder: Path, name: str) -> None:
    words = ["run", "--tables", "quality", "--encoding", "stereographic,octahedral,xyz", "--storage", "rg8,rgba8"]
    words += ["--normals", "hemisphere", "--count", "4096", "-o", name]
    done = subprocess.run([sys.executable, "-m", "normalbench", *words], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.usefixtures("gl")
def test_runs_of_a_commit_match_and_a_new_constant_changes_only_its_rows(run, tmp_path):
    """Another stereographic scale changes every row of that encoding and no other."""
    package = a_copy_of_the_rooms(tmp_path)
    in_a_copy(tmp_path, "one")
    in_a_copy(tmp_path, "two")
    status, out, err = run("compare", str(tmp_path / "one"), str(tmp_path / "two"), "--format", "json")
    assert (status, json.loads(out)) == (0, []) and "no change in" in err
    path = package / "encodings/normals/stereographic.py"
    path.write_text(path.read_text().replace("SCALE = 1.7777", "SCALE = 1.7"))
    in_a_copy(tmp_path, "altered")
    status, out, _ = run("compare", str(tmp_path / "one"), str(tmp_path / "altered"), "--format", "json")
    rows = json.loads(out)
    assert status == 0 and {row["row"].split()[0] for row in rows} == {"stereographic"}
    altered = {step["key"]["backend"] for step in read_run(tmp_path / "one").steps}
    # In each of its two storages.
    assert len({row["row"] for row in rows if row["column"] == "psnr_db"}) == 2 * len(altered)
    printed = run("compare", str(tmp_path / "one"), str(tmp_path / "altered"))[1]
    assert "stereographic" in printed and len(printed.splitlines()) <= 22
    status = [run("compare", str(tmp_path / "one"), str(tmp_path / "altered"), "--fail-on", how)[0] for how in HOWS]
    assert status == [0, int(any(row["verdict"] == "worse" for row in rows)), 1]
