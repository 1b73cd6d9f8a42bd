"""What the command line does where Python lacks what it lacks on Windows and on macOS."""

import json

import pytest
from other_systems import ENCODER, SYSTEMS, is_gone, lacking, on, write_examples


@pytest.mark.parametrize("system", SYSTEMS)
def test_the_list_of_what_a_system_lacks_is_the_type_checkers(system):
    assert "pidfd_open" in lacking("os", system) and "sched_getaffinity" in lacking("os", system)
    assert is_gone("fcntl", system) == ("flock" in lacking("fcntl", system)) == (system == "win32")
    assert ("SIGALRM" in lacking("signal", system)) == (system == "win32")
    assert not lacking("os", system) & {"getpid", "replace", "environ"}


@pytest.fixture(params=SYSTEMS)
def there(request, tmp_path):
    """What a command does on a system, in a folder with an encoder and a gate."""
    write_examples(tmp_path)
    return lambda *words: on(request.param, tmp_path, words)


def test_a_users_encoder_is_measured(there):
    """It runs in a process of its own, which limits itself and has a group or a job."""
    done = there("quality", "--encoding", "mine.glsl", "--storage", "rg8", "--backend", "jax", "--format", "json")
    assert done.returncode == 0 and "Traceback" not in done.stderr, done.stderr
    assert [row["bits"] for row in json.loads(done.stdout)] == [16]


def test_shaders_run_as_wgsl_where_opengl_ends_early(tmp_path):
    """By the interface of that system, which is not here; of functions of any names, and with their twin."""
    write_examples(tmp_path)
    (tmp_path / "mine.glsl").write_text(ENCODER.replace("mine_", ""))
    done = on("darwin", tmp_path, ("quality", "--encoding", "mine.glsl", "--storage", "rg8", "--format", "json"))
    by_jax, by_wgsl = json.loads(done.stdout)
    assert (by_jax["backend"], by_wgsl["backend"]) == ("jax", "wgsl") and by_jax["psnr_db"]
    assert "in place of GLSL: OpenGL ends at 4.1" in done.stderr and "Metal" in by_wgsl["skipped"], by_wgsl
