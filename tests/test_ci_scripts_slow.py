"""A CI run reports how many commits ago the nightly tests passed, and fails above a limit."""

import os
import subprocess
from pathlib import Path

from manual import ROOT


def aged(folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([folder / ".ci/nightly-age"], capture_output=True, text=True)


def git(folder: Path, *words: str) -> None:
    settings = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
    clean = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    subprocess.run(["git", *settings, *words], cwd=folder, check=True, capture_output=True, env=clean)


def test_a_run_reports_the_nightly_age_and_fails_above_the_limit(tmp_path):
    """The age is the number of commits since the file was last written; without history the age is unknown."""
    there = tmp_path / "there"
    (there / ".ci").mkdir(parents=True)
    script = (ROOT / ".ci/nightly-age").read_text()
    (there / ".ci/nightly-age").write_text(script.replace("most=100", "most=2"))
    (there / ".ci/nightly-age").chmod(0o755)
    assert "most=100" in script
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
