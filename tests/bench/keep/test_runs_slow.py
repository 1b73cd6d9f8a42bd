"""Results folders: finished steps stay, stopped runs resume, and reading never writes."""

import json
import os
import shutil
import subprocess
from contextlib import contextmanager
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import pytest
import test_runs
from test_runs import THREE

from normalbench.bench.door import run as run_command
from normalbench.bench.door.run_options import RunOptions
from normalbench.bench.keep.runs import ROWS
from normalbench.bench.shaders.isa import isa, spirv
from normalbench.bench.tables.registry import TABLES

finished = test_runs.finished


@pytest.mark.usefixtures("gl")
def test_every_table_of_a_run_has_steps_with_unique_keys(tmp_path):
    asks = run_command.asked_of(RunOptions(count=4096), tmp_path)
    compilers = not isa.missing() and spirv.version(spirv.COMPILER)
    usual = {table.name for table in TABLES.values() if table.in_all}
    assert {ask.table.name for ask in asks} == usual - (set() if compilers else {"cost"})
    keys = [json.dumps([ask.table.name, step.key], sort_keys=True) for ask in asks for step in ask.steps]
    assert len(set(keys)) == len(keys) and all(ask.steps for ask in asks)


@contextmanager
def read_only(folder: Path):
    """Make a folder read-only, also for root, until the block ends."""
    tool, lock, unlock = ("chattr", "+i", "-i") if os.geteuid() == 0 else ("chmod", "a-w", "u+w")
    if (
        not shutil.which(tool)
        or subprocess.run([tool, "-R", lock, folder], capture_output=True, check=False).returncode
    ):
        pytest.skip("root writes everywhere, and this file system cannot forbid it")
    try:
        yield
    finally:
        subprocess.run([tool, "-R", unlock, folder], check=True)


def test_a_read_only_folder_is_a_one_line_error_and_keeps_its_rows(run, tmp_path, finished):
    folder = Path(shutil.copytree(finished, tmp_path / "parent" / "run"))
    command = (*THREE, "-o", str(folder))
    lines, facts = (folder / ROWS).read_bytes().splitlines(keepends=True), (folder / "run.json").read_text()
    (folder / ROWS).write_bytes(b"".join(lines[:2]))
    (folder / "run.json").write_text(facts.replace('"finished": true', '"finished": false'))
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    with read_only(folder.parent):
        for where in (folder, folder.with_name("other")):
            status, out, err = run(*command[:-1], str(where))
            assert (status, out, err.count("\n")) == (2, "", 1) and "cannot write" in err, err
    assert {path: path.read_bytes() for path in folder.parent.rglob("*") if path.is_file()} == before
    status, _, err = run(*command)
    assert status == 0 and f"2 of {len(lines)} steps are done" in err
    assert (folder / ROWS).read_bytes() == b"".join(lines)


def lost(text: str) -> str:
    return "".join(text.splitlines(keepends=True)[:-1])


def altered(text: str) -> str:
    return text.replace('"psnr_db": 4', '"psnr_db": 9')


def unsealed(text: str) -> str:
    return json.dumps({name: value for name, value in json.loads(text).items() if name not in ("lines", "digest")})


@pytest.mark.parametrize(
    "file, damage, said",
    [
        (ROWS, lost, "of the 3 lines"),
        (ROWS, altered, "was changed after the run finished"),
        ("run.json", unsealed, "does not say how many rows"),
    ],
)
def test_a_finished_run_with_altered_rows_is_reported(run, tmp_path, finished, file, damage, said):
    """Every command that reads the run reports the change; `check` fails, and nothing is added to the run."""
    folder, gates = Path(shutil.copytree(finished, tmp_path / "run")), tmp_path / "gates.toml"
    gates.write_text('[[gate]]\nencoding = "octahedral"\npsnr_db = "at least 1"\n')
    assert run("check", str(gates), "--run", str(folder))[0] == 0
    (folder / file).write_text(damage((folder / file).read_text()))
    for words, status in (
        (("check", str(gates), "--run", str(folder)), 2),
        (("report", str(folder), "--markdown"), 0),
        (("compare", str(folder), str(folder)), 0),
        ((*THREE, "-o", str(folder)), 2),
    ):
        exit_status, out, err = run(*words)
        assert exit_status == status and said in err.splitlines()[0], (words[0], err)
        assert words[-1] != "--markdown" or said in out, "the text says it too"


def test_one_table_that_fails_makes_the_run_fail(run, tmp_path, monkeypatch):
    """A table that succeeds later does not change the status."""
    words = ("--encoding", "octahedral", "--storage", "rg8", "--normals", "axes", "--backend", "jax", "--count", "64")
    quality = TABLES["quality"]
    failing = replace(quality.work, failures=lambda _: ["it is not as it should be"])
    monkeypatch.setattr(import_module(f"{quality.package}.work"), "WORK", failing)
    status, _, err = run("run", "--tables", "quality,mix", *words, "-o", str(tmp_path / "run"))
    assert status == 1 and "it is not as it should be" in err, err
