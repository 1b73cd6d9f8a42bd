"""docs/ci.md: the steps of its workflows run and write the promised files."""

import re

import yaml
from manual import PAGES, ROOT

from normalbench.bench.ground.user_files import ENDINGS

PAGE = PAGES[ROOT / "docs/ci.md"]


FILES = dict(re.findall(r"^<!-- file (\S+) -->\n```(?:yaml|groovy|toml)\n(.*?)^```$", PAGE, re.S | re.M))


WORKFLOW, PIPELINE, JENKINSFILE = (".github/workflows/normals.yml", ".gitlab-ci.yml", "Jenkinsfile")
LEAST = ".github/workflows/gates.yml"
ACTION = (ROOT / "action.yml").read_text()


def test_actions_have_versions_and_install_packages_named_in_the_manual():
    assert set(FILES) == {LEAST, WORKFLOW, PIPELINE, JENKINSFILE, ".pre-commit-config.yaml", "normals.toml"}
    used = [step["uses"] for step in yaml.safe_load(FILES[WORKFLOW])["jobs"]["normals"]["steps"] if "uses" in step]
    assert used and all(re.fullmatch(r"actions/[\w-]+@v\d+", name) for name in used)
    installed = re.findall(r"--no-install-recommends (.*)$", PAGE + ACTION, re.M)
    assert len(installed) == 3 and len(set(installed)) == 1
    assert all(name in PAGES[ROOT / "docs/commands.md"] for name in installed[0].split())


def test_scripts_contain_no_untrusted_text():
    """Branch names are passed as variables, because GitHub would run a name that is inserted into a script."""
    steps = yaml.safe_load(FILES[WORKFLOW])["jobs"]["normals"]["steps"] + yaml.safe_load(ACTION)["runs"]["steps"]
    assert not any("${{" in step.get("run", "") for step in steps)


def test_the_smallest_workflow_has_at_most_ten_lines_and_uses_the_action():
    """The workflow's steps and `check` test everything that the action runs besides pip."""
    text = FILES[LEAST]
    (step,) = (step for step in yaml.safe_load(text)["jobs"]["gates"]["steps"] if "with" in step)
    assert len(text.splitlines()) <= 10 and set(step["with"]) <= set(yaml.safe_load(ACTION)["inputs"])
    (checked,) = (step["run"] for step in yaml.safe_load(ACTION)["runs"]["steps"] if "GATES" in step.get("env", {}))
    assert checked.startswith('normalbench check "$GATES" ')


def hook() -> dict:
    (entry,) = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
    return entry


def test_the_hook_matches_every_file_that_a_gate_may_read():
    pattern = re.compile(hook()["files"])
    assert all(pattern.search(f"shaders/mine{ending}") for ending in (*ENDINGS, ".toml", ".json", ".py"))
    assert not pattern.search("README.md") and not pattern.search("mine.glsl.orig")
    (asked,) = (entry for repo in yaml.safe_load(FILES[".pre-commit-config.yaml"])["repos"] for entry in repo["hooks"])
    assert asked["id"] == hook()["id"]
