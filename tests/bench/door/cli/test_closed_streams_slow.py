"""Standard input, output or error may be closed when the program starts: no other file takes its place."""

import numpy as np
import pytest
from test_closed_streams import CLOSED, started

ROW = ("quality", "--encoding", "octahedral", "--storage", "rg8", "--backend", "jax", "--count", "1000")


def test_messages_do_not_go_into_rows(run, tmp_path, monkeypatch):
    """The message says that --count has no effect on a file."""
    monkeypatch.chdir(tmp_path)
    np.save("f.npy", np.eye(3, dtype=np.float32))
    words = (*ROW, "--normals", "f.npy", "--format", "csv")
    _, rows, err = run(*words)
    assert "--count has no effect" in err
    done = started((2,), *words)
    assert (done.returncode, done.stdout) == (0, rows)


@pytest.mark.parametrize("closed", CLOSED)
def test_rows_in_a_file_are_complete_with_any_streams_closed(run, tmp_path, closed):
    """The rows are JSON, because CSV needs more imports."""
    done = started(closed, "list", "-o", "rows.json", cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (tmp_path / "rows.json").read_text() == run("list", "--format", "json")[1]


@pytest.mark.parametrize("closed", CLOSED)
def test_a_wrong_word_exits_with_status_2_with_any_streams_closed(closed):
    done = started(closed, "list", "nothing")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == (2 not in closed), done.stderr


def test_a_users_encoder_is_measured_without_streams(tmp_path):
    """The encoder is tried in a process of its own."""
    (tmp_path / "mine.glsl").write_text(
        "vec2 mine_encode(vec3 n, vec3 view) { return n.xy; }\n"
        "vec3 mine_decode(vec2 e, vec3 view) { return vec3(e, sqrt(max(1.0 - dot(e, e), 0.0))); }\n"
    )
    done = started((0, 1, 2), "doctor", "mine.glsl", "-o", "said.txt", cwd=tmp_path)
    assert done.returncode == 0 and (tmp_path / "said.txt").read_text().startswith("No problems found.\n")
