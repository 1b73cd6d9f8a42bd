"""`normalbench import` and the tables of devices: rows in a run, once each, all or none; and what its page shows."""

import json
import shutil

import devices as made
import test_import
from test_import import content_of

from normalbench.bench.keep.runs import read_run

folder = test_import.folder
made_once = test_import.made_once


def test_a_file_adds_to_a_run_once_and_a_newer_one_replaces_it(run, tmp_path, folder):
    """The run's own rows stay, the run stays finished, and the same file again changes no byte."""
    sources = json.loads((folder / "run.json").read_text())["sources"]
    first, command = made.write(tmp_path / "a.json", sources=sources), ("import", "-o", str(folder))
    status, out, err = run(*command, str(first))
    assert (status, err) == (0, "") and "SwiftShader, Chromium 156: added 35 codecs, 4 facts" in out
    assert f"normalbench report {folder}" in out
    done = read_run(folder)
    assert done.finished and not done.damage and len(done.tables["devices"]) == 39 and len(done.tables["quality"]) == 1
    assert len(json.loads((folder / "devices.json").read_text())) == 39
    before = content_of(folder)
    status, out, _ = run(*command, str(first))
    assert status == 0 and "nothing added; the run has the file of 2026-11-23T15:00:00Z already\n" in out
    assert content_of(folder) == before
    newer = made.write(tmp_path / "b.json", made="2026-11-24T15:00:00Z", truncated=("RG8",))
    assert "in place of those of 2026-11-23T15:00:00Z" in run(*command, str(newer))[1]
    rows = read_run(folder).tables["devices"]
    assert len(rows) == 39 and {row["made"] for row in rows} == {"2026-11-24T15:00:00Z"}
    before = content_of(folder)
    assert "the run has a newer file" in run(*command, str(first))[1] and content_of(folder) == before
    changed = made.write(tmp_path / "c.json", made="2026-11-24T15:00:00Z", vendor="another")
    assert "with other figures; the run's stay" in run(*command, str(changed))[1] and content_of(folder) == before


def test_a_run_goes_on_after_an_import(run, tmp_path, folder):
    """With another set: the devices stay, and the page of the run has them."""
    assert run("import", str(made.write(tmp_path / "a.json")), "-o", str(folder))[0] == 0
    words = ("--encoding", "xy", "--storage", "rg8", "--normals", "hemisphere", "--backend", "jax", "--count", "64")
    assert run("run", "--tables", "quality", *words, "-o", str(folder))[0] == 0
    done = read_run(folder)
    assert done.finished and set(done.tables) == {"quality", "devices"}
    assert '<section id="devices"' in (folder / "report.html").read_text()


def test_compare_names_what_a_device_does_otherwise(run, tmp_path, made_once):
    for name, truncated in (("before", ()), ("after", ("RG16F",))):
        path = made.write(tmp_path / f"{name}.json", truncated=truncated)
        folder = shutil.copytree(made_once, tmp_path / name)
        assert run("import", str(path), "-o", str(folder))[0] == 0
    status, out, _ = run("compare", str(tmp_path / "before"), str(tmp_path / "after"), "--format", "json")
    rows = json.loads(out)
    assert status == 0 and {row["column"] for row in rows} >= {"same_percent", "further", "mean_deg"}
    assert all("rg16f" in row["row"] for row in rows)
