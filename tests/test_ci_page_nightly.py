"""docs/ci.md: the steps of its workflows run and write the promised files."""

import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml
from test_ci_page import FILES, JENKINSFILE, PIPELINE, WORKFLOW
from test_ci_page_slow import GATES, MINE

# What talks to other machines, or changes this one, is only noted.
NOTED = ("sudo", "apt-get", "pip", "gh", "curl")


@dataclass(frozen=True)
class Step:
    """A shell script of a workflow, and when it runs."""

    script: str
    is_of_requests: bool
    is_of_pushes: bool
    runs_after_failure: bool = False


def github() -> list[Step]:
    steps = yaml.safe_load(FILES[WORKFLOW])["jobs"]["normals"]["steps"]
    when = [(step["run"], step.get("if", "")) for step in steps if "run" in step and step.get("name") != "Install"]
    return [Step(run, "'push'" not in rule, "'pull_request'" not in rule, "!cancelled()" in rule) for run, rule in when]


def gitlab() -> list[Step]:
    jobs = yaml.safe_load(FILES[PIPELINE])
    requests, pushes = jobs["normals"], jobs["normals-history"]
    after = jobs["normals"]["after_script"]
    return [
        Step("\n".join(requests["script"]), is_of_requests=True, is_of_pushes=False),
        Step("\n".join(after), is_of_requests=True, is_of_pushes=False, runs_after_failure=True),
        Step("\n".join(pushes["script"]), is_of_requests=False, is_of_pushes=True),
    ]


def jenkins() -> list[Step]:
    stages = re.findall(r"stage\('(\w+)'\) \{\n(.*?)^        \}\n", FILES[JENKINSFILE], re.S | re.M)
    scripts = [(name, text, re.search(r"sh ('''|')(.*?)\1", text, re.S)) for name, text in stages if name != "Install"]
    assert len(scripts) == 4 and all(script for *_, script in scripts)
    return [Step(script[2], "branch" not in text, "changeRequest" not in text) for _, text, script in scripts]


SYSTEMS = {"github": github, "gitlab": gitlab, "jenkins": jenkins}


PAGE_OF = {"github": WORKFLOW, "gitlab": PIPELINE, "jenkins": JENKINSFILE}


def environment(system: str) -> dict[str, str]:
    """Return the variables that the system and the workflow set."""
    measured = re.search(r"MEASURE(?:: | = ')(.*?)'?$", FILES[PAGE_OF[system]], re.M)
    on_github = {"MEASURE": measured[1], "TARGET": "main", "PULL_REQUEST": "7", "GITHUB_SHA": "0123abcd"}
    two = {"CI_MERGE_REQUEST_TARGET_BRANCH_NAME": "main", "CI_COMMIT_SHA": "0123abcd", "NORMALS_TOKEN": "secret"}
    three = {"CHANGE_TARGET": "main", "GIT_COMMIT": "0123abcd", "GITHUB_STEP_SUMMARY": "summary.md"}
    return on_github | two | three


def write_program(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)


def git(folder: Path, *words: str) -> None:
    who = ("-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false", "-c", "init.defaultBranch=main")
    subprocess.run(["git", *who, *words], cwd=folder, check=True, capture_output=True)


@pytest.fixture
def checkout(tmp_path):
    """A clone on a branch with a worse encoder than main, and the programs that a CI system would have."""
    origin, own = tmp_path / "origin", tmp_path / "own"
    origin.mkdir()
    (origin / "mine.glsl").write_text(MINE[1])
    (origin / "normals.toml").write_text(GATES)
    git(origin, "init", "-q")
    git(origin, "add", ".")
    git(origin, "commit", "-q", "-m", "Begin")
    git(tmp_path, "clone", "-q", str(origin), str(own))
    git(own, "checkout", "-q", "-b", "change")
    programs = tmp_path / "programs"
    for name in NOTED:
        write_program(programs / name, f'echo {name} "$@" >> {tmp_path}/noted')
    small = f'if [ "$1" = run ]; then set -- "$@" --count 4096; fi\nexec {sys.executable} -m normalbench "$@"'
    for path in (programs / "normalbench", own / ".venv/bin/normalbench"):
        write_program(path, small)
    return own


def run_all(steps: list[Step], folder: Path, system: str) -> int:
    """Run the steps as a CI system does; return the status of the first step that fails."""
    path = f"{folder.parent}/programs:{os.environ['PATH']}"
    failed = 0
    for step in steps:
        if failed and not step.runs_after_failure:
            continue
        command = ["bash", "-eo", "pipefail", "-c", step.script]
        more = environment(system) | {"PATH": path}
        done = subprocess.run(command, cwd=folder, env={**os.environ, **more}, capture_output=True, text=True)
        assert done.returncode in (0, 1), f"{step.script}\n{done.stderr}"
        failed = failed or done.returncode
    return failed


@pytest.mark.usefixtures("gl", "radv")
@pytest.mark.parametrize("system", SYSTEMS)
def test_a_workflow_rejects_a_change_that_makes_the_encoder_worse(system, checkout):
    """The comment on the pull or merge request states the difference."""
    steps = SYSTEMS[system]()
    (checkout / "mine.glsl").write_text(MINE[1].replace("normalize(", "normalize(vec3(0.02, 0.0, 0.0) + "))
    git(checkout, "commit", "-q", "-a", "-m", "Lean")
    assert run_all([step for step in steps if step.is_of_requests], checkout, system) == 1
    comment = (checkout / "comment.md").read_text()
    assert "mine: worse in " in comment and "| quality |" in comment and "<details>" in comment
    assert (checkout / "run/report.html").stat().st_size > 100_000
    if system != "jenkins":
        assert "FAIL" in comment
        assert "comment.md" in (checkout.parent / "noted").read_text()


@pytest.mark.usefixtures("gl", "radv")
@pytest.mark.parametrize("system", SYSTEMS)
def test_a_workflow_stores_the_run_of_a_pushed_commit(system, checkout):
    """The history lists the run, and its gates pass."""
    steps = SYSTEMS[system]()
    assert run_all([step for step in steps if step.is_of_pushes], checkout, system) == 0
    kept = {path.name for path in (checkout / "history/0123abcd").iterdir()}
    assert kept == {"run.json", "rows.jsonl"}
    assert (checkout / "history.md").read_text().startswith("1 run, from ")
    assert "pass" in (checkout / "gates.md").read_text()
