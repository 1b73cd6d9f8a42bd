"""The claims of README.md and every page of docs/ are true: commands run, examples pass."""

import shlex
import shutil
import subprocess
import sys
from dataclasses import fields

import pytest
import test_readme
from contributing import a_copy_of_the_rooms, normalbench_in
from test_readme import COMMANDS, FILES, LONG, PYTEST, write_files

from normalbench.bench.door.cli import app as cli
from normalbench.bench.tables.registry import TABLES

readers_folder = test_readme.readers_folder


BRIEF_COMMANDS = [command for command in COMMANDS if not LONG.match(command)]


# What is measured of less than the command says: how it is written is tried here, its figures are by others.
SMALL = {"count": "4096", "size": "160x90", "counts": "4", "repeats": "3"}


def in_small(words: list[str]) -> list[str]:
    """Return options that make a command measure as little as possible, except options that it already has."""
    table = TABLES.get(words[1])
    known = {field.name for field in fields(table.options)} if table else set()
    return [word for name in SMALL if name in known and f"--{name}" not in words for word in (f"--{name}", SMALL[name])]


@pytest.mark.parametrize("command", BRIEF_COMMANDS)
def test_every_command_runs_as_written(command, readers_folder, monkeypatch, capsys, request):
    words = shlex.split(command)
    if "nvidia" in words:
        request.getfixturevalue("nvidia")
    for name in {"before", "after"} & set(words) if words[1] != "run" else ():
        shutil.copytree(request.getfixturevalue("results")[0], readers_folder / name)
    if "--layouts" in words:
        shutil.rmtree(readers_folder / "layouts")
    if words[0] == "python":
        done = subprocess.run([sys.executable, *words[1:]], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return
    monkeypatch.setattr(sys, "argv", [*words, *in_small(words)])
    assert cli.main() == 0, capsys.readouterr().err
    for option in ("-o", "--images", "--plot"):
        if option in words:
            assert (readers_folder / words[words.index(option) + 1]).exists()


@pytest.mark.usefixtures("gl")
def test_tests_shown_in_the_manual_pass(pytester):
    """The tests use the manual's encoding and commands; the command that writes the baseline runs first."""
    write_files(pytester.path)
    tests = sum(text.count("def test_") for name, text in FILES.items() if name.startswith("test_"))
    assert len(PYTEST) == 2
    for command in sorted(PYTEST, key=len, reverse=True):
        words = ["." if word == "tests" else word for word in shlex.split(command)[1:]]
        result = pytester.runpytest_subprocess(*words, "-p", "no:cacheprovider", "-p", "no:hypothesispytest")
        result.assert_outcomes(passed=tests)


@pytest.mark.parametrize(
    "file, old, new, said",
    [
        ("normals/xy.py", "def encode(", "def encode((", ["xy.py", "SyntaxError"]),
        ("normals/xy.py", 'name="xy"', 'name="yx"', ["xy.py", "'yx'"]),
        ("catalogue.py", '    "xy",\n', '    "xy",\n    "missing",\n', ["missing.py", "No module named"]),
    ],
)
def test_an_encoding_that_fails_to_import_is_a_one_line_error_and_help_works(tmp_path, file, old, new, said):
    path = a_copy_of_the_rooms(tmp_path) / "encodings" / file
    path.write_text(path.read_text().replace(old, new))
    for arguments in (["list"], ["quality", "--encoding", "octahedral"]):
        done = normalbench_in(tmp_path, *arguments)
        assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
        assert all(part in done.stderr for part in said), done.stderr
    assert normalbench_in(tmp_path, "--help").returncode == 0
