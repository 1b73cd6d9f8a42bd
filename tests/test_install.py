"""`pip install .`, archives and setup: all files are there, stated sizes are correct, and progress is shown."""

import os
import re
import shutil
import subprocess

import install_page
import pytest
from manual import ROOT


@pytest.fixture
def setting_up(tmp_path):
    """The setup in a copy, with a scripted Python: a function that returns its output and status."""
    (tmp_path / ".ci").mkdir()
    shutil.copy(ROOT / ".ci/setup", tmp_path / ".ci")
    for name in ("prepare-venv", "prepare-gl", "prepare-isa"):
        write_program(tmp_path / ".ci" / name, "exit 0")

    def run(pip: str):
        write_program(tmp_path / ".venv/bin/python", pip)
        command = [tmp_path / ".ci/setup", "bench", "python3"]
        return subprocess.run(
            command, capture_output=True, text=True, env={**os.environ, "SETUP_SPEAKS_EVERY": "1"}, timeout=60
        )

    return run


def write_program(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)


def test_the_setup_reports_each_step_and_is_never_silent(setting_up):
    done = setting_up("echo Downloading jax; sleep 2.5; echo 'normalbench: no compiler' >&2")
    assert done.returncode == 0 and done.stderr == "normalbench: no compiler\n" * 3
    first, *lines, last = done.stdout.splitlines()
    assert re.fullmatch(r"normalbench: sets up .venv in 6 steps, .* MB to download, .* on disk", first), first
    assert [line[:8] for line in lines if " of " in line] == [f"  {step} of 6" for step in range(1, 7)]
    assert lines.count("    1 s  Downloading jax") == lines.count("    2 s  Downloading jax") == 3
    assert re.fullmatch(r"normalbench: set up in \d+ s; .venv takes \d+ MiB", last), last


def test_a_failed_step_ends_the_setup_with_its_error(setting_up):
    """The setup ends with the step's status; an optional step that fails is left out."""
    done = setting_up("echo 'ERROR: no such package'; exit 3")
    assert done.returncode == 3 and "3 of 6" not in done.stdout
    assert done.stderr.splitlines()[0] == "ERROR: no such package"
    assert "normalbench: step 2 failed, with status 3" in done.stderr
    done = setting_up('case "$*" in *slangtorch*) exit 1; esac')
    assert done.returncode == 0 and done.stderr.count("left out") == 1 and "6 of 6" in done.stdout


def test_the_page_has_the_sizes_that_the_setup_prints():
    """The rows of the page's table are in the order of the steps."""
    sizes = re.findall(r'^  (?:needed|wished) "([^"]+)" "([^"]+)"', (ROOT / ".ci/setup").read_text(), re.M)
    rows = re.findall(r"^\| ([\w' ]+?) +\| +([\w ]*?) *\| +(\d+ MB) \|", install_page.PAGE.read_text(), re.M)
    shown = {name: (down, disk) for name, down, disk in rows}
    for name, size in sizes[:5]:
        matches = re.search(r"(\d+ MB) to download", size), re.search(r"(\d+ MB) on disk", size)
        assert tuple(match[1] if match else "" for match in matches) == shown[name], name


@pytest.mark.parametrize("target", ["say-bench", "say-test", "say-test ALL=1", "say-test ALL=nightly"])
def test_make_first_prints_its_task_and_the_expected_time(target):
    """The message comes before anything is set up."""
    done = subprocess.run(["make", "-s", *target.split()], cwd=ROOT, capture_output=True, text=True)
    assert re.match(
        r"make (bench|test): sets up what is missing, then .* about (five|\d+) minutes|.*an hour", done.stdout
    )
    goal = target.split()[0].removeprefix("say-")
    assert re.search(rf"^{goal}: say-{goal} ", (ROOT / "Makefile").read_text(), re.M)
