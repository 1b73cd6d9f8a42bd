"""docs/ci.md: the steps of its workflows run, and end in the files that they promise."""

import json
import re

import pytest
import yaml
from manual import PAGES, README, ROOT

from normalbench.bench.shaders.languages.words import ENDINGS

PAGE = PAGES[ROOT / "docs/ci.md"]


FILES = dict(re.findall(r"^<!-- file (\S+) -->\n```(?:yaml|groovy|toml)\n(.*?)^```$", PAGE, re.S | re.M))


WORKFLOW, PIPELINE, JENKINSFILE = (".github/workflows/normals.yml", ".gitlab-ci.yml", "Jenkinsfile")


MINE = re.search(r"<!-- file mine.glsl -->\n```glsl\n(.*?)^```$", PAGES[README], re.S | re.M)


GATES = FILES["normals.toml"]


def test_actions_are_named_with_their_versions_and_install_what_the_manual_says():
    assert set(FILES) == {WORKFLOW, PIPELINE, JENKINSFILE, ".pre-commit-config.yaml", "normals.toml"}
    used = [step["uses"] for step in yaml.safe_load(FILES[WORKFLOW])["jobs"]["normals"]["steps"] if "uses" in step]
    assert used and all(re.fullmatch(r"actions/[\w-]+@v\d+", name) for name in used)
    installed = re.findall(r"--no-install-recommends (.*)$", PAGE, re.M)
    assert len(installed) == 2 and len(set(installed)) == 1
    assert all(name in PAGES[ROOT / "docs/commands.md"] for name in installed[0].split())


def test_no_text_that_a_stranger_writes_is_part_of_a_script():
    """Names of branches come as variables: in a script of GitHub's they would be run."""
    steps = yaml.safe_load(FILES[WORKFLOW])["jobs"]["normals"]["steps"]
    assert not any("${{" in step.get("run", "") for step in steps)


def hook() -> dict:
    (found,) = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
    return found


def test_the_hook_is_asked_for_every_file_that_a_gate_may_read():
    pattern = re.compile(hook()["files"])
    assert all(pattern.search(f"shaders/mine{ending}") for ending in (*ENDINGS, ".toml", ".json", ".py"))
    assert not pattern.search("README.md") and not pattern.search("mine.glsl.orig")
    (asked,) = (one for repo in yaml.safe_load(FILES[".pre-commit-config.yaml"])["repos"] for one in repo["hooks"])
    assert asked["id"] == hook()["id"]


@pytest.mark.usefixtures("gl")
def test_the_hook_holds_the_gates_that_read_a_changed_file(run, tmp_path, monkeypatch):
    """As pre-commit calls it: the words, the arguments, the names of the files."""
    monkeypatch.chdir(tmp_path)
    body = MINE[1].replace("mine_", "other_")
    (tmp_path / "mine.glsl").write_text('#include "shared.glsl"\n' + MINE[1])
    (tmp_path / "other.glsl").write_text(body)
    (tmp_path / "shared.glsl").write_text("\n")
    one, words = 'count = 4096\npsnr_db = "at least 51"\n', GATES.replace('psnr_db = "at least 51.5"\n', "")
    gates = words + one + words.replace("mine.glsl", "other.glsl") + one.replace("51", "99")
    (tmp_path / "gates.toml").write_text(gates)
    program, *words = hook()["entry"].split()
    assert program == "normalbench"
    for name, status, count in (("shared.glsl", 0, 1), ("mine.glsl", 0, 1), ("other.glsl", 1, 1), ("gates.toml", 1, 2)):
        found = run(*words, *hook()["args"], name, "--format", "json")
        assert found[0] == status and len(json.loads(found[1])) == count, found
    (tmp_path / "third.glsl").write_text(body)
    status, out, err = run(*words, *hook()["args"], "third.glsl")
    assert (status, out, err) == (0, "", "normalbench: no gate of gates.toml reads third.glsl\n")
