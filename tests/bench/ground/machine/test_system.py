"""On a system that the program does not run on yet it says so in one line."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from other_systems import on_windows

SAYS = (
    "Windows is not supported yet; install normalbench in WSL2 (`wsl --install` sets that up). "
    "The laboratory of a report.html runs in any browser on any system"
)
START = "from normalbench.bench.door.cli.start import program; program()"


@pytest.mark.parametrize("words", [["--version"], ["--help"], ["quality", "--encoding", "xy"], ["pick"], []])
def test_a_command_on_windows_is_one_line(words):
    done = on_windows(f"sys.argv = ['normalbench', *{words}]\n{START}")
    assert (done.returncode, done.stdout, done.stderr) == (3, "", f"normalbench: {SAYS}\n")


@pytest.mark.parametrize("use", ["nb.quality()", "nb.encode('xy/rg8', [[0, 0, 1]])", "nb.Codec"])
def test_python_on_windows_raises_the_line(use):
    done = on_windows(f"import normalbench as nb\n{use}")
    assert done.returncode == 1 and done.stderr.splitlines()[-1].endswith(f"MissingError: {SAYS}")


def test_pytest_on_windows_runs_the_tests_that_measure_nothing(pytester):
    """The plugin is loaded wherever the package is installed: it must not stand in the way."""
    pytester.makepyfile(
        "import pytest\n"
        "@pytest.fixture(autouse=True)\n"
        "def elsewhere(monkeypatch):\n"
        "    monkeypatch.setattr('normalbench.bench.ground.machine.system.sys.platform', 'win32')\n"
        "def test_other(): pass\n"
        "def test_measures(normalbench): pass\n"
    )
    found = pytester.runpytest()
    found.assert_outcomes(passed=1, errors=1)
    found.stdout.fnmatch_lines([f"*{SAYS[:60]}*"])


NOBODY = """
import os, pwd, sys
os.environ.pop("HOME", None), os.environ.pop("XDG_CACHE_HOME", None)
def unknown(*_):
    raise KeyError("uid not found")
pwd.getpwuid = unknown
"""


def as_nobody(code: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """What a program does for a user whom the system does not know, with a folder for temporary files."""
    ours = {name: value for name, value in os.environ.items() if not name.startswith("JAX_")}
    variables = ours | {"TMPDIR": str(folder)}
    return subprocess.run([sys.executable, "-c", NOBODY + code], capture_output=True, text=True, env=variables)


@pytest.mark.parametrize(
    "words", [["doctor"], ["quality", "--encoding", "xy", "--normals", "axes", "--backend", "jax"]]
)
def test_a_user_without_a_home_is_served(tmp_path, words):
    """Nothing is said, and what is kept lies in a folder that is this user's alone."""
    done = as_nobody(f"sys.argv = ['normalbench', *{words}]\n{START}", tmp_path)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    (home,) = [path for path in tmp_path.iterdir() if "home" in path.name]
    assert home.stat().st_mode & 0o777 == 0o700 and (home / ".cache/normalbench").is_dir()


def test_a_home_that_somebody_else_made_is_not_used(tmp_path):
    planted = tmp_path / f"normalbench-home-{os.geteuid()}"
    planted.mkdir()
    planted.chmod(0o777)
    code = "from normalbench.bench.ground.machine.system import prepare; prepare(); print(os.environ['HOME'])"
    home = Path(as_nobody(code, tmp_path).stdout.strip())
    assert home.parent == tmp_path and home != planted and home.stat().st_mode & 0o777 == 0o700


def test_the_plugin_is_loaded_on_windows():
    done = on_windows("from normalbench.bench.door.pytest_plugin import plugin; print(plugin.MARKER[:11])")
    assert (done.stdout, done.stderr) == ("normalbench\n", "")
