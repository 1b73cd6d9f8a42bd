"""`pip install .`, archives and the set-up: all files are there, the sizes are those said, and nothing is silent."""

import json
import os
import re
import shutil
import subprocess
import sys
from importlib.metadata import distributions
from pathlib import Path

import install_page
import pytest
from manual import NAMED, PAGES, README, ROOT
from packaging.utils import canonicalize_name

from normalbench.bench.door.python import stub

ROOMS = ("bench", "encodings", "gbuffer", "reports")
BESIDE = ("pyproject.toml", "setup.py", "README.md", "LICENSE")
# What `import normalbench` gives lies elsewhere in a checkout.
API = "bench/door/api/"
# What type checkers and editors are told, which is made when the package is built.
STUB = "__init__.pyi"


@pytest.mark.slow
def test_an_install_is_whole_and_leaves_nothing_in_the_checkout(tmp_path):
    pytest.importorskip("setuptools", minversion="77", reason="pyproject.toml asks for it")
    checkout, site = copied(tmp_path / "checkout"), tmp_path / "site"
    before = files_in(checkout)
    words = ("install", "--quiet", "--no-deps", "--no-build-isolation", "--no-compile", "--target", str(site))
    done = subprocess.run([sys.executable, "-m", "pip", *words, str(checkout)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert files_in(checkout) == before and {path.name for path in checkout.iterdir()} == {*ROOMS, *BESIDE}
    packaged = {name.removeprefix(API) for name in before if name not in BESIDE}
    assert files_in(site / "normalbench") == packaged | {STUB}
    assert (site / "normalbench" / STUB).read_text() == stub.stub()


def copied(checkout, *more):
    """The rooms of the package in a folder, and what pip reads; more files and folders of the checkout, where asked."""
    checkout.mkdir()
    for path in [ROOT / name for name in (*ROOMS, *BESIDE, *more)]:
        if path.is_dir():
            made = shutil.ignore_patterns("__pycache__", ".pytest_cache", STUB)
            shutil.copytree(path, checkout / path.name, ignore=made)
        else:
            shutil.copy(path, checkout)
    return checkout


def files_in(folder):
    """The files below a folder, by their paths."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


# What a source archive has beside the package.
FOR_TESTS = ("tests", "docs", ".ci", "Makefile", "Dockerfile", "MANIFEST.in", "CHANGELOG.md", "CITATION.cff")
OTHERS = ("CONTRIBUTING.md", ".dockerignore", ".gitignore", ".pre-commit-hooks.yaml")


@pytest.mark.slow
def test_a_source_archive_has_all_that_the_tests_need(tmp_path):
    """Every file; tests that read the manual, the scripts and other tests pass in it."""
    pytest.importorskip("setuptools", minversion="77", reason="pyproject.toml asks for it")
    checkout = copied(tmp_path / "checkout", *FOR_TESTS, *OTHERS)
    before = files_in(checkout)
    subprocess.run([sys.executable, "setup.py", "-q", "sdist", "-d", str(tmp_path)], cwd=checkout, check=True)
    shutil.unpack_archive(next(tmp_path.glob("*.tar.gz")), tmp_path / "unpacked")
    (unpacked,) = (tmp_path / "unpacked").iterdir()
    assert before <= files_in(unpacked), sorted(before - files_in(unpacked))
    words = ("-q", "-p", "no:cacheprovider", "tests/test_nightly.py", "tests/test_container.py")
    done = subprocess.run([sys.executable, "-m", "pytest", *words], cwd=unpacked, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


PYTHONS = ("3.11", "3.12", "3.13", "3.14")
ROW = ("quality", "--encoding", "octahedral", "--storage", "rg8", "--normals", "axes", "--backend", "jax")


def interpreter(version: str) -> str:
    """A Python of that version: on the path, or one of pyenv's. Skips the test where there is none."""
    kept = sorted(Path("~/.pyenv/versions").expanduser().glob(f"{version}.*/bin/python{version}"))
    for path in (shutil.which(f"python{version}"), *map(str, kept)):
        if path and subprocess.run([path, "-c", "import venv"], capture_output=True).returncode == 0:
            return path
    pytest.skip(f"no Python {version}")


@pytest.mark.nightly("test_install.py::test_an_install_is_whole_and_leaves_nothing_in_the_checkout")
@pytest.mark.parametrize("version", PYTHONS)
def test_the_wheel_works_in_an_empty_environment(version, tmp_path):
    """By its dependencies alone, in each Python that is there: the row of this one, and within 900 MB."""
    made = interpreter(version)
    built = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "--no-build-isolation", "-w", str(tmp_path)]
    subprocess.run([*built, str(copied(tmp_path / "checkout"))], check=True)
    subprocess.run([made, "-m", "venv", str(tmp_path / "empty")], check=True)
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
    """README's gate in an environment that has what README installs for it."""
    folder.mkdir()
    for name, text in NAMED.findall(PAGES[README]):
        (folder / name).write_text(text)
    (packages,) = re.findall(r"`pip install (.+?)`", PAGES[README])
    subprocess.run([python, "-m", "pip", "install", "-q", *packages.split()], check=True)
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    command = [python, "-m", "pytest", "-p", "no:cacheprovider", "test_mine.py"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, env=clean)


def row_by(program):
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run([*program, *ROW, "--format", "json"], capture_output=True, text=True, env=clean)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_the_page_has_the_sizes_of_what_is_installed():
    """Those of the pinned packages, to a tenth; of what is not installed here nothing is known."""
    there = {canonicalize_name(one.metadata["Name"]): one for one in distributions()}
    shown, seen = install_page.shown(), set()
    assert set(shown) == {"", *install_page.EXTRAS} and set(install_page.EXTRAS) == set(install_page.PROJECT[OPTIONAL])
    for extra, (_, disk) in shown.items():
        try:
            names = install_page.added(extra, there)
        except KeyError:
            continue
        found = sum(size_of(there[name]) for name in names) / 1e6
        assert found == pytest.approx(disk, rel=0.1, abs=2), f"{extra or 'normalbench'}: python -m tests.install_page"
        seen.add(extra)
    assert {"", "maps", "dev"} <= seen
    assert shown[""][1] < 900


OPTIONAL = "optional-dependencies"


def size_of(package):
    """What it has on disk, without what Python compiled."""
    paths = (path.locate() for path in package.files or () if path.suffix != ".pyc")
    return sum(path.stat().st_size for path in paths if path.is_file())


@pytest.fixture
def setting_up(tmp_path):
    """The set-up in a copy, with a Python that does as it is told: what it printed, and its status."""
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


def test_the_set_up_names_each_step_and_is_never_silent(setting_up):
    done = setting_up("echo Downloading jax; sleep 2.5; echo 'normalbench: no compiler' >&2")
    assert done.returncode == 0 and done.stderr == "normalbench: no compiler\n" * 2
    first, *lines, last = done.stdout.splitlines()
    assert re.fullmatch(r"normalbench: sets up .venv in 5 steps, .* MB to download, .* on disk", first), first
    assert [line[:8] for line in lines if " of " in line] == [f"  {at} of 5" for at in range(1, 6)]
    assert lines.count("    1 s  Downloading jax") == lines.count("    2 s  Downloading jax") == 2
    assert re.fullmatch(r"normalbench: set up in \d+ s; .venv takes \d+ MiB", last), last


def test_a_step_that_fails_ends_the_set_up_with_what_it_said(setting_up):
    """With its status; one that can be done without is left out."""
    done = setting_up("echo 'ERROR: no such package'; exit 3")
    assert done.returncode == 3 and "3 of 5" not in done.stdout
    assert done.stderr.splitlines()[0] == "ERROR: no such package"
    assert "normalbench: step 2 failed, with status 3" in done.stderr
    done = setting_up('case "$*" in *slangtorch*) exit 1; esac')
    assert done.returncode == 0 and done.stderr.count("left out") == 1 and "5 of 5" in done.stdout


def test_the_page_has_the_sizes_that_the_set_up_says():
    """Each step's, in the table of the same order."""
    said = re.findall(r'^  (?:needed|wished) "([^"]+)" "([^"]+)"', (ROOT / ".ci/setup").read_text(), re.M)
    rows = re.findall(r"^\| ([\w' ]+?) +\| +([\w ]*?) *\| +(\d+ MB) \|", install_page.PAGE.read_text(), re.M)
    shown = {name: (down, disk) for name, down, disk in rows}
    for name, size in said[:5]:
        found = re.search(r"(\d+ MB) to download", size), re.search(r"(\d+ MB) on disk", size)
        assert tuple(one[1] if one else "" for one in found) == shown[name], name


@pytest.mark.parametrize("target", ["say-bench", "say-test", "say-test ALL=1", "say-test ALL=nightly"])
def test_make_says_first_what_it_does_and_how_long(target):
    """Before anything is set up."""
    done = subprocess.run(["make", "-s", *target.split()], cwd=ROOT, capture_output=True, text=True)
    assert re.match(
        r"make (bench|test): sets up what is missing, then .* about (five|\d+) minutes|.*an hour", done.stdout
    )
    goal = target.split()[0].removeprefix("say-")
    assert re.search(rf"^{goal}: say-{goal} ", (ROOT / "Makefile").read_text(), re.M)
