"""On a system that the program does not run on yet it says so in one line."""

import pytest
from other_systems import on_windows

SAYS = (
    "Windows is not supported yet; install normalbench in WSL2 (`wsl --install` sets that up). "
    "The laboratory of a report.html runs in any browser on any system"
)
START = "from normalbench.bench.cli.start import program; program()"


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
        "    monkeypatch.setattr('normalbench.bench.machine.system.sys.platform', 'win32')\n"
        "def test_other(): pass\n"
        "def test_measures(normalbench): pass\n"
    )
    found = pytester.runpytest()
    found.assert_outcomes(passed=1, errors=1)
    found.stdout.fnmatch_lines([f"*{SAYS[:60]}*"])


def test_the_plugin_is_loaded_on_windows():
    done = on_windows("from normalbench.bench.pytest_plugin import plugin; print(plugin.MARKER[:11])")
    assert (done.stdout, done.stderr) == ("normalbench\n", "")
