"""docs/ci.md: the steps of its workflows run and write the promised files."""

import json
import re

import pytest
from manual import PAGES, README
from test_ci_page import FILES, hook

MINE = re.search(r"<!-- file mine.glsl -->\n```glsl\n(.*?)^```$", PAGES[README], re.S | re.M)


GATES = FILES["normals.toml"]


@pytest.mark.usefixtures("gl")
def test_the_hook_checks_only_gates_that_read_a_changed_file(run, tmp_path, monkeypatch):
    """The hook is called as pre-commit calls it: with the command, the arguments and the file names."""
    monkeypatch.chdir(tmp_path)
    body = MINE[1].replace("mine_", "other_")
    (tmp_path / "mine.glsl").write_text('#include "shared.glsl"\n' + MINE[1])
    (tmp_path / "other.glsl").write_text(body)
    (tmp_path / "shared.glsl").write_text("\n")
    limits, words = 'count = 4096\npsnr_db = "at least 51"\n', GATES.replace('psnr_db = "at least 51.5"\n', "")
    gates = words + limits + words.replace("mine.glsl", "other.glsl") + limits.replace("51", "99")
    (tmp_path / "gates.toml").write_text(gates)
    program, *words = hook()["entry"].split()
    assert program == "normalbench"
    for name, status, count in (("shared.glsl", 0, 1), ("mine.glsl", 0, 1), ("other.glsl", 1, 1), ("gates.toml", 1, 2)):
        answer = run(*words, *hook()["args"], name, "--format", "json")
        assert answer[0] == status and len(json.loads(answer[1])) == count, answer
    (tmp_path / "third.glsl").write_text(body)
    status, out, err = run(*words, *hook()["args"], "third.glsl")
    assert (status, out, err) == (0, "", "normalbench: no gate in gates.toml uses third.glsl\n")
