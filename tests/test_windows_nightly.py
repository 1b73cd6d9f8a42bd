"""The program on Python for Windows, in Wine: its figures match Linux, with JAX, OpenGL and Vulkan."""

import json
import os
import subprocess
import sys

import pytest
import wine
from other_systems import START, write_examples
from screens import screen


@pytest.fixture(scope="module")
def windows(once):
    """Python for Windows, in Wine, with the program's packages."""
    if why := wine.why_not():
        pytest.skip(why)
    try:
        once("windows", wine.prepare)
    except subprocess.CalledProcessError as error:
        pytest.skip(f"no packages for Windows: {error}")
    with screen() as display:
        yield wine.Windows(display)


def well(done):
    assert done.returncode == 0 and "Traceback" not in done.stderr, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize("backend", ["jax", "glsl", "wgsl"])
def test_figures_match_linux(windows, tmp_path, backend):
    words = ["quality", "--encoding", "octahedral,xyz", "--storage", "rg8,rgb10a2,rg16f", "--backend", backend]
    words += ["--count", "65536", "--format", "json"]
    # As there, without a C compiler.
    here = subprocess.run(
        [sys.executable, "-c", START, *words],
        env={**os.environ, "PATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    there = well(windows.command(tmp_path, *words))
    figures = [
        [{name: value for name, value in row.items() if isinstance(value, int | float)} for row in json.loads(text)]
        for text in (here, there)
    ]
    assert figures[0] == [pytest.approx(row, rel=1e-6, abs=1e-12) for row in figures[1]]


def test_a_users_encoder_is_measured_and_an_endless_twin_is_stopped(windows, tmp_path):
    write_examples(tmp_path)
    words = [
        "quality",
        "--encoding",
        rf"Z:{tmp_path}\mine.glsl".replace("/", "\\"),
        "--storage",
        "rg8",
        "--format",
        "json",
    ]
    by = {row["backend"]: row["angle_mean_deg"] for row in json.loads(well(windows.command(tmp_path, *words)))}
    assert by["glsl"] == pytest.approx(by["jax"], rel=1e-3)
    (tmp_path / "mine.py").write_text("while True:\n    pass\n")
    done = windows.command(tmp_path, *words)
    figures = {row["backend"]: row["angle_mean_deg"] for row in json.loads(well(done))}
    assert figures["glsl"] is not None and figures["jax"] is None
    assert "its Python twin did not end" in done.stderr, done.stderr


def test_commands_succeed(windows, tmp_path):
    """The commands write the same files as on Linux."""
    write_examples(tmp_path)
    assert "apt-get" not in well(windows.command(tmp_path, "doctor"))
    assert "pass" in well(windows.command(tmp_path, "check", "gates.toml"))
    quality = ["quality", "--encoding", "xyz", "--storage", "rgb10a2", "--backend", "jax"]
    well(windows.command(tmp_path, *quality, "-o", "rows.csv", "--report", "page.html"))
    assert {path.name for path in tmp_path.iterdir()} >= {"rows.csv", "page.html"} and not [*tmp_path.glob(".*.rows")]
    well(windows.command(tmp_path, "code", "octahedral", "--storage", "rg8", "--to", "hlsl", "-o", "code"))
    assert (tmp_path / "code" / "octahedral_rg8.hlsl").is_file()
    answer = well(windows.command(tmp_path, "pick", "--bytes", "2", "--scene", "studio"))
    assert answer.startswith("2 bytes, on sphere: take octahedral in rg8.") and "recorded with Mesa" in answer


def test_a_run_is_complete_and_readable_on_another_system(windows, tmp_path):
    well(windows.command(tmp_path, "run", "--encoding", "octahedral,xy", "--storage", "rg8", "-o", "kept"))
    # It goes on where it was.
    well(windows.command(tmp_path, "run", "--encoding", "octahedral,xy", "--storage", "rg8", "-o", "kept"))
    ends = [path.name for path in (tmp_path / "kept").iterdir() if path.is_file() and b"\r\n" in path.read_bytes()]
    assert ends == []
    done = subprocess.run(
        [sys.executable, "-c", START, "report", "kept", "--markdown"], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.returncode == 0 and "take octahedral" in done.stdout, done.stderr


def test_the_pytest_plugin_measures_a_users_encoder(windows, tmp_path):
    write_examples(tmp_path)
    (tmp_path / "test_mine.py").write_text(
        "def test_it(normalbench):\n"
        "    row = normalbench.quality(encoding='mine.glsl', backend='jax', normals='hemisphere')\n"
        "    row.assert_that(psnr_db='at least 30')\n"
    )
    done = windows.python(tmp_path, "-m", "pytest", "-q", "test_mine.py")
    assert done.returncode == 0 and "1 passed" in done.stdout, done.stdout + done.stderr
