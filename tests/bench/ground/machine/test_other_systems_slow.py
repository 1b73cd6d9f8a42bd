"""What the command line does where Python lacks what it lacks on Windows and on macOS."""

import pytest
import test_other_systems
from other_systems import ENCODER, on

there = test_other_systems.there


def test_several_pairs_of_a_file_are_named_where_no_device_tries_them(tmp_path):
    (tmp_path / "two.glsl").write_text(ENCODER.replace("mine_", "first_") + ENCODER.replace("mine_", "second_"))
    done = on("darwin", tmp_path, ("doctor", "two.glsl:language=glsl"))
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    assert "two.glsl:first_encode:first_decode" in done.stderr and "no GL 4.3 device" in done.stderr, done.stderr


def test_a_users_encoder_that_does_not_end_is_ended(there, tmp_path):
    (tmp_path / "mine.py").write_text("while True:\n    pass\n")
    done = there("quality", "--encoding", "mine.glsl", "--storage", "rg8", "--backend", "jax")
    assert done.returncode == 2 and "Traceback" not in done.stderr and "Python twin" in done.stderr, done.stderr


@pytest.mark.parametrize(
    "words",
    [
        ("--version",),
        ("list",),
        ("doctor",),
        ("pick", "--bytes", "2", "--normals", "axes"),
        ("check", "gates.toml"),
        ("code", "octahedral", "--storage", "rg8", "--to", "hlsl", "-o", "code"),
        ("quality", "--encoding", "xy", "--storage", "rg8", "--report", "page.html"),
        ("run", "--encoding", "xy", "--storage", "rg8", "--tables", "quality,depth", "-o", "kept"),
    ],
    ids=lambda words: words[0].strip("-"),
)
def test_a_command_ends_well(there, words):
    done = there(*words)
    assert done.returncode == 0 and "Traceback" not in done.stderr, done.stderr
