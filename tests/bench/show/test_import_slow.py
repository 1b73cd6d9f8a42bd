"""`normalbench import` and the device tables: rows are added once, all or none, and appear on the page."""

import json
import os
import shutil
import sys
from collections import Counter
from pathlib import Path

import devices as made
import pytest

from normalbench.bench.door.cli import app as cli
from normalbench.bench.keep import runs
from normalbench.bench.keep.runs import read_run

OTHER = "ANGLE (NVIDIA Corporation, NVIDIA GeForce RTX 4090/PCIe/SSE2, OpenGL 4.5.0)"


@pytest.fixture(scope="module")
def made_once(tmp_path_factory):
    """A small run, copied for each test."""
    folder = tmp_path_factory.mktemp("small") / "run"
    words = ("--encoding", "xy", "--storage", "rg8", "--normals", "axes", "--backend", "jax")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["normalbench", "run", "--tables", "quality", *words, "-o", str(folder)])
        assert cli.main() == 0
    return folder


@pytest.fixture
def folder(made_once, tmp_path):
    return Path(shutil.copytree(made_once, tmp_path / "run"))


def content_of(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def test_device_measured_with_other_sources_is_reported_once(run, tmp_path, folder):
    path = made.write(tmp_path / "a.json", sources="another")
    for message in ("SwiftShader, Chromium 156: measured on a page of a different version", ""):
        status, _, err = run("import", str(path), "-o", str(folder))
        assert status == 0 and message in err and err.count("\n") == bool(message), err


def test_gpus_with_the_same_short_name_are_distinguished_in_any_order(run, tmp_path, folder):
    paths = [made.write(tmp_path / "a.json", renderer=made.GEFORCE), made.write(tmp_path / "b.json", renderer=OTHER)]
    for path in paths:
        assert run("import", str(path), "-o", str(folder))[0] == 0
    names = {row["renderer"]: row["device"] for row in read_run(folder).tables["devices"]}
    assert names == {made.GEFORCE: "GeForce RTX 4090 (Direct3D11)", OTHER: "GeForce RTX 4090 (OpenGL)"}
    out = run("devices", "--devices", ",".join(map(str, reversed(paths))), "--format", "json")[1]
    assert {row["renderer"]: row["device"] for row in json.loads(out)} == names


def test_one_bad_file_of_several_leaves_the_run_as_it_was(run, tmp_path, folder):
    good, bad = made.write(tmp_path / "a.json"), tmp_path / "bad.json"
    bad.write_text("{}")
    before = content_of(folder)
    status, out, err = run("import", str(good), str(bad), str(tmp_path / "none.json"), "-o", str(folder))
    assert (status, out, err.count("\n")) == (2, "", 2) and "bad.json: not a device file" in err
    assert "none.json: there is no such file" in err and content_of(folder) == before


def test_a_run_that_another_process_writes_or_that_was_changed_is_refused(run, tmp_path, folder):
    path = made.write(tmp_path / "a.json")
    with runs.amended(folder):
        status, _, err = run("import", str(path), "-o", str(folder))
    assert status == 2 and "another process is writing" in err, err
    with (folder / "rows.jsonl").open("a") as file:
        file.write((folder / "rows.jsonl").read_text())
    before = content_of(folder)
    status, _, err = run("import", str(path), "-o", str(folder))
    assert status == 2 and "nothing was added to the run" in err and content_of(folder) == before, err


def test_a_full_disk_leaves_the_run_as_it_was(run, tmp_path, folder, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    before = read_run(folder)
    monkeypatch.setattr(os, "fsync", full)
    status, _, err = run("import", str(made.write(tmp_path / "a.json")), "-o", str(folder))
    assert status == 2 and "No space left on device" in err, err
    after = read_run(folder)
    assert after.steps == before.steps and not after.damage and after.finished
    assert not list(folder.glob(".*partial"))


def test_a_named_device_makes_its_table_part_of_all(run, tmp_path):
    from normalbench.bench.door.run import chosen_tables

    assert "devices" in {table.name for table in chosen_tables(("all",), {"devices": ("a.json",)})}
    assert "devices" not in {table.name for table in chosen_tables(("all",), {"count": 3})}
    path, out = made.write(tmp_path / "a.json"), tmp_path / "out"
    assert run("run", "--tables", "devices", "--devices", str(path), "-o", str(out))[0] == 0
    assert Counter(row["row_of"] for row in read_run(out).tables["devices"]) == {"codec": 35, "fact": 4}


def test_a_stopped_run_accepts_devices_and_stays_unfinished(run, tmp_path, folder):
    facts = json.loads((folder / "run.json").read_text())
    (folder / "run.json").write_text(json.dumps(facts | {"finished": False}))
    assert run("import", str(made.write(tmp_path / "a.json")), "-o", str(folder))[0] == 0
    done = read_run(folder)
    assert not done.finished and len(done.tables["devices"]) == 39


def test_a_file_is_added_to_a_run_once_and_a_newer_file_replaces_it(run, tmp_path, folder):
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
    assert status == 0 and "nothing added; the run already has the file from 2026-11-23T15:00:00Z\n" in out
    assert content_of(folder) == before
    newer = made.write(tmp_path / "b.json", made="2026-11-24T15:00:00Z", truncated=("RG8",))
    assert "replacing those from 2026-11-23T15:00:00Z" in run(*command, str(newer))[1]
    rows = read_run(folder).tables["devices"]
    assert len(rows) == 39 and {row["made"] for row in rows} == {"2026-11-24T15:00:00Z"}
    before = content_of(folder)
    assert "the run has a newer file" in run(*command, str(first))[1] and content_of(folder) == before
    changed = made.write(tmp_path / "c.json", made="2026-11-24T15:00:00Z", vendor="another")
    assert "with different figures; the run keeps its own" in run(*command, str(changed))[1]
    assert content_of(folder) == before


def test_a_run_continues_after_an_import(run, tmp_path, folder):
    """A second set of normals is added; the devices stay and appear on the page."""
    assert run("import", str(made.write(tmp_path / "a.json")), "-o", str(folder))[0] == 0
    words = ("--encoding", "xy", "--storage", "rg8", "--normals", "hemisphere", "--backend", "jax", "--count", "64")
    assert run("run", "--tables", "quality", *words, "-o", str(folder))[0] == 0
    done = read_run(folder)
    assert done.finished and set(done.tables) == {"quality", "devices"}
    assert '<section id="devices"' in (folder / "report.html").read_text()


def test_compare_reports_the_differences_for_a_device(run, tmp_path, made_once):
    for name, truncated in (("before", ()), ("after", ("RG16F",))):
        path = made.write(tmp_path / f"{name}.json", truncated=truncated)
        folder = shutil.copytree(made_once, tmp_path / name)
        assert run("import", str(path), "-o", str(folder))[0] == 0
    status, out, _ = run("compare", str(tmp_path / "before"), str(tmp_path / "after"), "--format", "json")
    rows = json.loads(out)
    assert status == 0 and {row["column"] for row in rows} >= {"same_percent", "further", "mean_deg"}
    assert all("rg16f" in row["row"] for row in rows)
