"""Values that `--on` accepts or refuses, and clean-up when a command or worker ends."""

import importlib.util

import pytest

from normalbench.bench.run.workers import words

SMALL = ("quality", "--encoding", "xyz,octahedral", "--storage", "rgba8", "--normals", "axes")


@pytest.mark.parametrize(
    ("word", "says"),
    [
        ("local:0", "--on local:0: use 1 to 256 worker processes, such as local:4"),
        ("local:1000", "--on local:1000: use 1 to 256 worker processes, such as local:4"),
        ("local:few", "--on local:few: use 1 to 256 worker processes, such as local:4"),
        ("here", "--on here: use local:N, such as local:4, or tcp://HOST:PORT"),
        ("tcp://host", "--on tcp://host: use local:N"),
        ("tcp://host:99999", "--on tcp://host:99999: use local:N"),
        ("http://host:80", "--on http://host:80: use local:N"),
    ],
)
@pytest.mark.parametrize("command", [SMALL, ("run",)], ids=["table", "run"])
def test_invalid_on_value_is_refused_at_once(run, tmp_path, monkeypatch, command, word, says):
    monkeypatch.chdir(tmp_path)
    status, out, err = run(*command, "--on", word)
    assert status == 2 and says in err and not out and len(err.splitlines()) == 1
    assert not list(tmp_path.iterdir()), "nothing is written"


def test_missing_dask_error_says_what_to_install(run, monkeypatch):
    monkeypatch.setattr(
        words, "find_spec", lambda name: None if name == "distributed" else importlib.util.find_spec(name)
    )
    for command in ((*SMALL, "--on"), ("worker",)):
        status, _, err = run(*command, "tcp://127.0.0.1:1")
        assert status == 3 and "pip install 'normalbench[workers]'" in err


def test_the_worker_command_refuses_a_bad_address(run):
    status, _, err = run("worker", "local:2")
    assert status == 2 and "worker local:2: use tcp://HOST:PORT" in err
