"""`pip install .`, archives and setup: all files are there, stated sizes are correct, and progress is shown."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from manual import NAMED, PAGES, README, ROOT
from test_install_slow import archived, copied

PYTHONS = ("3.11", "3.12", "3.13", "3.14")


ROW = ("quality", "--encoding", "octahedral", "--storage", "rg8", "--normals", "axes", "--backend", "jax")


def interpreter(version: str) -> str:
    """Return a Python of that version, from the path or from pyenv. Skip the test if none is found."""
    kept = sorted(Path("~/.pyenv/versions").expanduser().glob(f"{version}.*/bin/python{version}"))
    for path in (shutil.which(f"python{version}"), *map(str, kept)):
        if path and subprocess.run([path, "-c", "import venv"], capture_output=True).returncode == 0:
            return path
    pytest.skip(f"no Python {version}")


@pytest.mark.parametrize("version", PYTHONS)
def test_the_wheel_works_in_an_empty_environment(version, tmp_path):
    """In every available Python, the wheel measures the same rows as this checkout and takes less than 900 MB."""
    python = interpreter(version)
    built = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "--no-build-isolation", "-w", str(tmp_path)]
    subprocess.run([*built, str(copied(tmp_path / "checkout"))], check=True)
    subprocess.run([python, "-m", "venv", str(tmp_path / "empty")], check=True)
    own = tmp_path / "empty/bin/python"
    words = ("-m", "pip", "install", "-q", "--no-compile", "--constraint", str(ROOT / ".ci/constraints.txt"))
    done = subprocess.run([own, *words, *map(str, tmp_path.glob("*.whl"))], capture_output=True, text=True)
    if "Failed to establish a new connection" in done.stderr:
        pytest.skip("no package registry is reached")
    assert done.returncode == 0, done.stderr
    size = int(subprocess.run(["du", "-s", "-B1", own.parents[1]], capture_output=True, text=True).stdout.split()[0])
    here, there = (row_by([str(program), "-m", "normalbench"]) for program in (sys.executable, own))
    gate = gate_by(own, tmp_path / "project")
    shutil.rmtree(own.parents[1])
    assert there == here and size < 900e6
    assert gate.returncode == 0 and "1 passed" in gate.stdout, gate.stdout + gate.stderr


def gate_by(python: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run README's gate in an environment with the packages that README installs."""
    folder.mkdir()
    for name, text in NAMED.findall(PAGES[README]):
        (folder / name).write_text(text)
    (packages,) = re.findall(r"After `pip install (.+?)`", PAGES[README])
    subprocess.run([python, "-m", "pip", "install", "-q", *packages.split()], check=True)
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    command = [python, "-m", "pytest", "-p", "no:cacheprovider", "test_mine.py"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, env=clean)


def row_by(program):
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run([*program, *ROW, "--format", "json"], capture_output=True, text=True, env=clean)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_tests_pass_in_a_source_archive(tmp_path):
    """These tests read the manual, the scripts and other tests."""
    words = ("-q", "-p", "no:cacheprovider", "tests/test_ci_scripts.py", "tests/test_container.py")
    unpacked = archived(tmp_path)
    done = subprocess.run([sys.executable, "-m", "pytest", *words], cwd=unpacked, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
