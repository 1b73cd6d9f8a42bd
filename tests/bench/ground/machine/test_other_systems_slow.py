"""The command line on a Python without the parts that Windows or macOS lacks."""

import json

import pytest
from other_systems import ENCODER, SYSTEMS, on, write_examples

# Python takes seconds to begin, and JAX to be imported: once for all of them.
COMMANDS = (
    ("--version",),
    ("list",),
    ("doctor",),
    # An encoder runs in a process of its own, which limits itself and has a group or a job.
    ("quality", "--encoding", "mine.glsl", "--storage", "rg8", "--backend", "jax", "-o", "mine.json"),
    ("pick", "--encoding", "octahedral,spheremap", "--storage", "rg8", "--normals", "axes"),
    ("check", "gates.toml"),
    ("code", "octahedral", "--storage", "rg8", "--to", "hlsl", "-o", "code"),
    ("run", "--encoding", "xy", "--storage", "rg8", "--normals", "axes", "--tables", "quality,depth", "-o", "kept"),
)


def test_commands_succeed_and_a_users_encoder_is_measured(tmp_path, system="win32"):
    write_examples(tmp_path)
    done = on(system, tmp_path, *COMMANDS)
    ended = [line for line in done.stderr.splitlines() if " ended with " in line]
    assert ended == [f"{words[0]} ended with 0" for words in COMMANDS], done.stderr
    assert done.returncode == 0 and "Traceback" not in done.stderr, done.stderr
    assert [row["bits"] for row in json.loads((tmp_path / "mine.json").read_text())] == [16]


def test_shaders_run_as_wgsl_if_the_opengl_version_is_too_old(tmp_path):
    """The system's interface, Metal, is missing here. Functions may have any names, and their twin is measured."""
    write_examples(tmp_path)
    (tmp_path / "mine.glsl").write_text(ENCODER.replace("mine_", ""))
    done = on("darwin", tmp_path, ("quality", "--encoding", "mine.glsl", "--storage", "rg8", "--format", "json"))
    by_jax, by_wgsl = json.loads(done.stdout)
    assert (by_jax["backend"], by_wgsl["backend"]) == ("jax", "wgsl") and by_jax["psnr_db"]
    assert (
        "instead of GLSL, because this system supports OpenGL only up to 4.1" in done.stderr
        and "Metal" in by_wgsl["skipped"]
    ), by_wgsl


def test_several_pairs_in_a_file_are_listed_if_no_device_can_try_them(tmp_path):
    (tmp_path / "two.glsl").write_text(ENCODER.replace("mine_", "first_") + ENCODER.replace("mine_", "second_"))
    done = on("darwin", tmp_path, ("doctor", "two.glsl:language=glsl"))
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    assert "two.glsl:first_encode:first_decode" in done.stderr and "no OpenGL 4.3 device" in done.stderr, done.stderr


@pytest.mark.parametrize("system", SYSTEMS)
def test_a_users_encoder_that_does_not_end_is_stopped(system, tmp_path):
    """The encoder sleeps, so a limit of processor time, which Windows lacks, would not stop it."""
    write_examples(tmp_path)
    (tmp_path / "mine.py").write_text("import time\n\ntime.sleep(1000)\n")
    words = ("quality", "--encoding", "mine.glsl", "--storage", "rg8", "--backend", "jax")
    done = on(system, tmp_path, words, before=SOON)
    assert done.returncode == 2 and "Traceback" not in done.stderr, done.stderr
    assert "Python twin did not end within 15 s" in done.stderr, done.stderr


# A busy machine takes some seconds to come to the twin.
SOON = "from normalbench.bench.subjects.codecs import user_encodings; user_encodings.TIME_LIMIT = 15.0\n"
