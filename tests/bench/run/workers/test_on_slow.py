"""Values that `--on` accepts or refuses, and clean-up when a command or worker ends."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest
from speed.scheduled import scheduled
from test_on import SMALL

from normalbench.bench.run import piped


def test_the_start_imports_neither_dask_nor_jax():
    done = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "normalbench", "quality", "--help"],
        capture_output=True,
        text=True,
    )
    loaded = {line.rpartition("|")[2].strip().partition(".")[0] for line in done.stderr.splitlines()}
    assert done.returncode == 0 and "--on" in done.stdout
    assert not loaded & {"dask", "distributed", "tornado", "jax", "moderngl"}


# EGL finds no driver under it.
NO_GL = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"}


def test_an_address_without_a_scheduler_is_refused_in_seconds(run):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
    began = time.monotonic()
    status, _, err = run(*SMALL, "--on", address)
    assert status == 2 and f"--on {address}: no scheduler responded; start one there with: dask scheduler" in err
    assert time.monotonic() - began < 20


@pytest.mark.drawn(3)
def test_local_workers_need_no_dask_or_certificates_and_leave_no_files(tmp_path):
    """The process cannot import dask, although its workers can; it measures twice, as a Python program may."""
    options = {"encoding": "xyz,octahedral", "storage": "rgba8", "normals": "axes", "backend": "jax", "on": "local:1"}
    code = "import sys\nsys.modules['dask'] = sys.modules['distributed'] = None\nimport normalbench as nb\n"
    code += f"for _ in range(2):\n    print(len(nb.quality(**{options})))"
    variables = os.environ | {"DASK_DISTRIBUTED__COMM__REQUIRE_ENCRYPTION": "True", "TMPDIR": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=variables, timeout=120)
    assert done.stdout.split() == ["2", "2"] and not done.stderr, done.stderr
    assert not [*tmp_path.iterdir()], "something is left"


def test_steps_that_no_worker_can_measure_are_measured_locally(gl, run, monkeypatch, tmp_path):  # noqa: ARG001
    """The workers have no OpenGL. GLSL rows are still written, and a message says which process measured them."""
    assert run(*SMALL, "-o", str(tmp_path / "one.json"))[0] == 0
    own = os.environ | NO_GL
    monkeypatch.setattr(piped, "environment", lambda: own)
    status, _, err = run(*SMALL, "-o", str(tmp_path / "two.json"), "--on", "local:1")
    assert status == 0 and "quality: 2 steps are measured by this process: no worker has the same GL device" in err
    assert json.loads((tmp_path / "one.json").read_text()) == json.loads((tmp_path / "two.json").read_text())


def children(pid: int) -> list[int]:
    """Return the ids of all descendants of a process."""
    pids = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True).stdout.split()
    return [int(child) for child in pids] + [other for child in pids for other in children(int(child))]


def is_there(pid: int) -> bool:
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False


# Rows by JAX and GLSL, a few to each task of a worker.
MANY = ("quality", "--storage", "rgba8", "--normals", "sphere", "--count", "65536", "--encoding")


MANY += (
    "octahedral,octahedral_precise,equal_area_octahedral,equal_area_octahedral_precise,hemi_octahedral,signed_octahedral,"
    "latitude_longitude,spherical,spheremap,spheremap_classic,cryengine3,stereographic,per_pixel_view,xy,xy_sign,"
    "xyz,xyz_largest,xyz_renormalised,cube,warped_cube,tetrahedral",
)


def begun(folder: Path, *words: str) -> subprocess.Popen[str]:
    """Start a command that keeps its temporary files in a subfolder."""
    (folder / "temporary").mkdir(exist_ok=True)
    command = [sys.executable, "-m", "normalbench", *MANY, *words, "-o", str(folder / "rows.json")]
    variables = os.environ | {"TMPDIR": str(folder / "temporary")}
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=variables)


def kept_in(folder: Path) -> int:
    """Return the number of lines in a command's journal: a header and a line for each step stored so far."""
    journal = folder / ".rows.json.rows"
    return len(journal.read_text().splitlines()) if journal.exists() else 0


def wait_for(folder: Path, steps: int) -> None:
    until = time.monotonic() + 120
    while time.monotonic() < until and kept_in(folder) <= steps:
        time.sleep(0.05)


@pytest.fixture(scope="module")
def rows_alone(tmp_path_factory):
    """The bytes of the file that one undisturbed process writes."""
    folder = tmp_path_factory.mktemp("alone")
    process = begun(folder)
    assert process.communicate()[1] == "" and process.returncode == 0
    return (folder / "rows.json").read_bytes()


def a_process_of(pid: int, module: str) -> int:
    """Return the id of a descendant process that runs a module; wait for it, because it may be restarting."""
    until = time.monotonic() + 30
    while time.monotonic() < until:
        for child in children(pid):
            # Others end at any moment.
            with suppress(OSError, ValueError):
                if module in Path(f"/proc/{child}/cmdline").read_text():
                    return child
        time.sleep(0.05)
    raise AssertionError(f"no process of {pid} runs {module}")


def test_interruption_and_killed_workers_lose_no_rows_and_leave_no_process(tmp_path, rows_alone, number=signal.SIGKILL):
    """Rows already measured are kept; the workers end and leave no files. The command runs again and loses two
    workers, which are replaced; its rows equal those of an undisturbed command."""
    process = begun(tmp_path, "--on", "local:2")
    wait_for(tmp_path, 3)
    workers = children(process.pid)
    assert len(workers) >= 2, "two workers"
    process.send_signal(number)
    _, err = process.communicate(timeout=30)
    assert process.returncode in ({130, 143} if number != signal.SIGKILL else {-9}) and "Traceback" not in err
    until = time.monotonic() + 10
    while any(map(is_there, workers)) and time.monotonic() < until:
        time.sleep(0.1)
    assert not [pid for pid in workers if is_there(pid)], "a process is left"
    # A worker that began a moment ago removes its folder a moment later.
    while any((tmp_path / "temporary").iterdir()) and time.monotonic() < until:
        time.sleep(0.1)
    assert not [*(tmp_path / "temporary").iterdir()], "a folder is left"
    kept = kept_in(tmp_path)
    assert kept > 3
    again = begun(tmp_path, "--on", "local:2")
    for steps in (kept, kept + 5):
        wait_for(tmp_path, steps)
        assert again.poll() is None, f"it ended before a worker was killed, with {kept_in(tmp_path)} lines kept"
        os.kill(a_process_of(again.pid, "bench.run.piped"), signal.SIGKILL)
    _, err = again.communicate(timeout=300)
    assert "steps are already measured" in err and again.returncode == 0, err
    assert (tmp_path / "rows.json").read_bytes() == rows_alone, "a killed worker costs a row"
    assert not [*(tmp_path / "temporary").iterdir()], "the folder of a killed worker is left"


@pytest.mark.drawn(3)
def test_killing_the_scheduler_and_a_worker_loses_no_rows(tmp_path, rows_alone):
    """The command and the workers wait for another scheduler at the same address."""
    with scheduled({}, {}) as there:
        process = begun(tmp_path, "--on", there.address)
        wait_for(tmp_path, 3)
        there.workers[0].kill()
        wait_for(tmp_path, 8)
        there.scheduler.kill()
        there.scheduler.communicate()
        there.start(there.address.rpartition(":")[2])
        assert process.poll() is None, "it ended before anything was killed"
        _, err = process.communicate(timeout=300)
    assert process.returncode == 0, err
    assert (tmp_path / "rows.json").read_bytes() == rows_alone


def test_workers_that_keep_exiting_end_the_command(run, monkeypatch):
    """The error ends with the last message from a worker."""
    monkeypatch.setattr(piped, "python", lambda _: [sys.executable, "-c", "raise SystemExit('broken')"])
    status, out, err = run(*SMALL, "--on", "local:2")
    assert (status, out) == (2, "") and err.endswith("--on local:2: the workers keep exiting: broken\n"), err
