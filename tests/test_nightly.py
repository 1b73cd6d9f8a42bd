"""What CI leaves to the nightly stands in the manual by name, each with the cheaper test that holds the same fact."""

import ast
import os
import re
import subprocess
from pathlib import Path

from manual import ROOT

TESTS = ROOT / "tests"
LISTED = re.compile(r"^\| `([\w/.]+::\w+)` +\| `([\w/.]+::\w+)` +\|$", re.M)


def marks(path: Path) -> dict[str, tuple[str, bool]]:
    """The tests of a file with a nightly mark: the cheaper test that it names, and whether all parameters have it."""
    tree = ast.parse(path.read_text())
    named = {node.targets[0].id: node.value for node in tree.body if isinstance(node, ast.Assign) and is_name(node)}
    found = {}
    for test in (node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")):
        for call in calls(test.decorator_list, named, set()):
            cheaper, *_ = call.args
            value = named[cheaper.id] if isinstance(cheaper, ast.Name) else cheaper
            assert isinstance(value, ast.Constant), f"{path.name}: {test.name} names no test"
            is_whole = call in test.decorator_list and not is_parametrised(call)
            found[f"{path.relative_to(TESTS)}::{test.name}"] = value.value, is_whole
    return found


def is_name(node: ast.Assign) -> bool:
    return len(node.targets) == 1 and isinstance(node.targets[0], ast.Name)


def is_parametrised(node: ast.AST) -> bool:
    """Whether it leaves some parameters to the nightly: one of two of `vendors.py`, or nine of ten of `slowly.py`."""
    is_called = isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
    return is_called and node.func.id in ("every_or_some", "a_tenth")


def calls(nodes, named, seen) -> list[ast.Call]:
    """The calls of `pytest.mark.nightly` in decorators, also by way of a list or function of the module."""
    found = []
    for node in (inner for outer in nodes for inner in ast.walk(outer)):
        is_marked = isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "nightly"
        if is_marked or is_parametrised(node):
            found.append(node)
        elif isinstance(node, ast.Name) and node.id in named and node.id not in seen:
            found += calls([named[node.id]], named, seen | {node.id})
    return found


def all_marks() -> dict[str, tuple[str, bool]]:
    return {name: mark for path in sorted(TESTS.rglob("test_*.py")) for name, mark in marks(path).items()}


def table() -> str:
    """The manual's table as the marks have it."""
    rows = [(f"`{name}`", f"`{cheaper}`") for name, (cheaper, _) in sorted(all_marks().items())]
    widths = [max(len(row[at]) for row in (*rows, ("nightly", "in every run"))) for at in (0, 1)]
    lines = [("nightly", "in every run"), ("-" * widths[0], "-" * widths[1]), *rows]
    return "\n".join(f"| {one:{widths[0]}} | {other:{widths[1]}} |" for one, other in lines)


def test_the_manual_lists_what_ci_leaves_out():
    (shown,) = re.findall(r"<!-- nightly -->\n(.*?)\n?<!-- end -->", (ROOT / "docs/house.md").read_text(), re.S)
    assert shown == table(), f"write into docs/house.md:\n{table()}"
    assert len(LISTED.findall(shown)) == len(all_marks()) > 5


def test_the_cheaper_test_is_there_and_runs_in_ci():
    left_out = all_marks()
    for name, (cheaper, _) in left_out.items():
        file, _, test = cheaper.partition("::")
        assert f"def {test}(" in (TESTS / file).read_text(), f"{name} names {cheaper}, which is not there"
        assert not left_out.get(cheaper, ("", False))[1], f"{name} names {cheaper}, which is left out too"


def aged(folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([folder / ".ci/nightly-age"], capture_output=True, text=True)


def git(folder: Path, *words: str) -> None:
    settings = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
    clean = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    subprocess.run(["git", *settings, *words], cwd=folder, check=True, capture_output=True, env=clean)


def test_a_run_says_how_old_the_nightly_is_and_fails_where_it_is_too_old(tmp_path):
    """By commits since the file was last written; a copy without history says that it cannot know."""
    there = tmp_path / "there"
    (there / ".ci").mkdir(parents=True)
    script = (ROOT / ".ci/nightly-age").read_text()
    (there / ".ci/nightly-age").write_text(script.replace("most=400", "most=2"))
    (there / ".ci/nightly-age").chmod(0o755)
    assert "most=400" in script
    assert aged(there).returncode == 0 and "cannot be known" in aged(there).stdout, "no repository at all"
    git(there, "init", "-q")
    git(there, "add", ".")
    git(there, "commit", "-qm", "first")
    assert aged(there).returncode == 0 and "have not passed in the 1 commits" in aged(there).stdout, "no script either"
    (there / ".ci/nightly").touch()
    (there / ".ci/nightly-passed").write_text("somewhen\n")
    git(there, "add", ".")
    git(there, "commit", "-qm", "added")
    for age in range(4):
        assert aged(there).returncode == int(age > 2) and f"in the {age} commits" in aged(there).stdout
        git(there, "commit", "-q", "--allow-empty", "-m", f"{age}")
    (there / ".ci/nightly-passed").write_text("2026-01-01, at commit abc\n")
    git(there, "add", ".")
    git(there, "commit", "-qm", "passed")
    for age in range(4):
        done = aged(there)
        assert f"passed {age} commits ago, on 2026-01-01, at commit abc" in done.stdout.splitlines()[0]
        assert done.returncode == int(age > 2), done.stdout
        git(there, "commit", "-q", "--allow-empty", "-m", f"{age}")
    git(tmp_path, "clone", "-q", "--depth", "1", f"file://{there}", "shallow")
    assert aged(tmp_path / "shallow").returncode == 0 and "cannot be known" in aged(tmp_path / "shallow").stdout


def test_run_says_the_age_first():
    lines = [line for line in (ROOT / ".ci/run").read_text().splitlines() if line and not line.startswith(("#", "cd"))]
    assert lines[:3] == ["set -euo pipefail", "export CI=true", ".ci/nightly-age"]
