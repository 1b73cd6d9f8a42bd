"""`pip install .`: all files of the package are installed, and nothing is left in the checkout."""

import shutil
import subprocess
import sys

import pytest
from manual import ROOT

ROOMS = ("bench", "encodings", "gbuffer", "reports")
BESIDE = ("pyproject.toml", "setup.py", "README.md", "LICENSE")
# What `import normalbench` gives lies elsewhere in a checkout.
API = "bench/door/api/"


@pytest.mark.slow
def test_an_install_is_whole_and_leaves_nothing_in_the_checkout(tmp_path):
    pytest.importorskip("setuptools", minversion="77", reason="pyproject.toml asks for it")
    checkout, site = tmp_path / "checkout", tmp_path / "site"
    checkout.mkdir()
    for name in ROOMS:
        shutil.copytree(ROOT / name, checkout / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in BESIDE:
        shutil.copy(ROOT / name, checkout)
    before = files_in(checkout)
    words = ("install", "--quiet", "--no-deps", "--no-build-isolation", "--no-compile", "--target", str(site))
    done = subprocess.run([sys.executable, "-m", "pip", *words, str(checkout)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert files_in(checkout) == before and {path.name for path in checkout.iterdir()} == {*ROOMS, *BESIDE}
    packaged = {name.removeprefix(API) for name in before if name not in BESIDE}
    assert files_in(site / "normalbench") == packaged


def files_in(folder):
    """The files below a folder, by their paths."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
