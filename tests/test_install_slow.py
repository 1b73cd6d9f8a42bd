"""`pip install .`, archives and setup: all files are there, stated sizes are correct, and progress is shown."""

import shutil
import subprocess
import sys
from importlib.metadata import distributions

import install_page
import pytest
from manual import ROOT
from packaging.utils import canonicalize_name

from normalbench.bench.door.python import stub


def test_the_page_has_the_installed_sizes():
    """Sizes of pinned packages are within a tenth of the page's; extras that are not installed are not checked."""
    there = {canonicalize_name(package.metadata["Name"]): package for package in distributions()}
    shown, seen = install_page.shown(), set()
    assert set(shown) == {"", *install_page.EXTRAS} and set(install_page.EXTRAS) == set(install_page.PROJECT[OPTIONAL])
    for extra, (_, disk) in shown.items():
        try:
            names = install_page.added(extra, there)
        except KeyError:
            continue
        size = sum(size_of(there[name]) for name in names) / 1e6
        assert size == pytest.approx(disk, rel=0.1, abs=2), f"{extra or 'normalbench'}: python -m tests.install_page"
        seen.add(extra)
    assert {"", "maps", "dev"} <= seen
    assert shown[""][1] < 900


OPTIONAL = "optional-dependencies"


def size_of(package):
    """Return the size of a package on disk in bytes, without Python's byte code."""
    paths = (path.locate() for path in package.files or () if path.suffix != ".pyc")
    return sum(path.stat().st_size for path in paths if path.is_file())


ROOMS = ("bench", "encodings", "gbuffer", "reports")


BESIDE = ("pyproject.toml", "setup.py", "README.md", "LICENSE")


# What `import normalbench` gives lies elsewhere in a checkout.
API = "bench/door/api/"


# What type checkers and editors are told, which is made when the package is built.
STUB = "__init__.pyi"


def test_an_install_is_complete_and_leaves_nothing_in_the_checkout(tmp_path):
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
    """Copy the package's rooms, the files that pip reads and any other given paths to a folder; return the folder."""
    checkout.mkdir()
    for path in [ROOT / name for name in (*ROOMS, *BESIDE, *more)]:
        if path.is_dir():
            ignored = shutil.ignore_patterns("__pycache__", ".pytest_cache", STUB)
            shutil.copytree(path, checkout / path.name, ignore=ignored)
        else:
            shutil.copy(path, checkout)
    return checkout


def files_in(folder):
    """Return the paths of all files below a folder, relative to the folder."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


# What a source archive has beside the package.
FOR_TESTS = ("tests", "docs", ".ci", "Makefile", "Dockerfile", "MANIFEST.in", "CHANGELOG.md", "CITATION.cff")


OTHERS = ("CONTRIBUTING.md", ".dockerignore", ".gitignore", ".pre-commit-hooks.yaml")


def test_a_source_archive_has_everything_that_the_tests_need(tmp_path):
    """A nightly test runs tests in the archive."""
    archived(tmp_path)


def archived(folder):
    """Make and unpack a source archive, check that it has every file, and return its folder."""
    pytest.importorskip("setuptools", minversion="77", reason="pyproject.toml asks for it")
    checkout = copied(folder / "checkout", *FOR_TESTS, *OTHERS)
    before = files_in(checkout)
    subprocess.run([sys.executable, "setup.py", "-q", "sdist", "-d", str(folder)], cwd=checkout, check=True)
    shutil.unpack_archive(next(folder.glob("*.tar.gz")), folder / "unpacked")
    (unpacked,) = (folder / "unpacked").iterdir()
    assert before <= files_in(unpacked), sorted(before - files_in(unpacked))
    return unpacked
