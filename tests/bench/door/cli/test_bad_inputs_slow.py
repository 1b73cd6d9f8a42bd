"""The list of bad inputs, each with the tests that try it, and tests that fit no other file."""

import json

import pytest
from test_bad_inputs import LOOPS, TOO_LONG

QUICK = ("--backend", "glsl", "--normals", "hemisphere", "--count", "4096", "--format", "json")


@pytest.mark.usefixtures("gl")
def test_an_endless_loop_does_not_affect_other_encodings(run, tmp_path):
    path = tmp_path / "mine.glsl"
    path.write_text(LOOPS % TOO_LONG["while"])
    status, out, err = run("quality", "--encoding", f"{path},xy", *QUICK)
    assert status == 0 and [row["encoding"] for row in json.loads(out)] == ["xy"]
    assert err.startswith(f"normalbench: left out: {path}: the loops of encode for [") and err.count("\n") == 1, err
