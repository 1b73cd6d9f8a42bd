"""What `--on` takes and refuses, and what is left behind."""

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

# EGL finds no driver under it.
NO_GL = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"}


def test_an_address_where_nobody_answers_is_refused_in_seconds(run):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
    began = time.monotonic()
    status, _, err = run(*SMALL, "--on", address)
    assert status == 2 and f"--on {address}: nobody answers; start a scheduler there: dask scheduler" in err
    assert time.monotonic() - began < 20


def test_workers_of_this_machine_need_no_dask():
    """In a process that cannot import it, twice, as a program may that uses the Python functions."""
    said = {"encoding": "xyz,octahedral", "storage": "rgba8", "normals": "axes", "backend": "jax", "on": "local:1"}
    code = "import sys\nsys.modules['dask'] = sys.modules['distributed'] = None\nimport normalbench as nb\n"
    code += f"for _ in range(2):\n    print(len(nb.quality(**{said})))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.stdout.split() == ["2", "2"], done.stderr


@pytest.mark.usefixtures("gl")
def test_steps_by_glsl_go_to_no_worker_without_gl(run, tmp_path):
    """One worker of two has no GL: rows by both back ends are those of one process, and none is measured here."""
    assert run(*SMALL, "-o", str(tmp_path / "one.json"))[0] == 0
    with scheduled({}, NO_GL) as there:
        status, _, err = run(*SMALL, "-o", str(tmp_path / "two.json"), "--on", there.address)
    assert status == 0 and not err
    assert json.loads((tmp_path / "one.json").read_text()) == json.loads((tmp_path / "two.json").read_text())


def test_what_no_worker_can_measure_is_measured_here(gl, run, monkeypatch, tmp_path):  # noqa: ARG001
    """Only workers without GL: rows by GLSL are there all the same, and a line says who measured them."""
    assert run(*SMALL, "-o", str(tmp_path / "one.json"))[0] == 0
    own = os.environ | NO_GL
    monkeypatch.setattr(piped, "environment", lambda: own)
    status, _, err = run(*SMALL, "-o", str(tmp_path / "two.json"), "--on", "local:1")
    assert status == 0 and "quality: 2 steps are measured by this process: no worker has this GL device" in err
    assert json.loads((tmp_path / "one.json").read_text()) == json.loads((tmp_path / "two.json").read_text())


def children(pid: int) -> list[int]:
    """The processes that a process started, and theirs."""
    found = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True).stdout.split()
    return [int(one) for one in found] + [other for one in found for other in children(int(one))]


def is_there(pid: int) -> bool:
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False


# Rows of 65536 normals by JAX and GLSL, a few to each task of a worker.
MANY = ("quality", "--encoding", "all", "--storage", "rgba8", "--normals", "sphere", "--count", "65536")


def begun(folder: Path, *words: str) -> subprocess.Popen[str]:
    """A command whose temporary files lie in a folder of their own."""
    (folder / "temporary").mkdir(exist_ok=True)
    command = [sys.executable, "-m", "normalbench", *MANY, *words, "-o", str(folder / "rows.json")]
    variables = os.environ | {"TMPDIR": str(folder / "temporary")}
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=variables)


def kept_in(folder: Path) -> int:
    """How many steps a command has kept so far, and one line that says of what."""
    journal = folder / ".rows.json.rows"
    return len(journal.read_text().splitlines()) if journal.exists() else 0


def wait_for(folder: Path, steps: int) -> None:
    until = time.monotonic() + 120
    while time.monotonic() < until and kept_in(folder) <= steps:
        time.sleep(0.05)


@pytest.fixture(scope="module")
def rows_alone(tmp_path_factory):
    """The file that one process writes, which nobody disturbs."""
    folder = tmp_path_factory.mktemp("alone")
    process = begun(folder)
    assert process.communicate()[1] == "" and process.returncode == 0
    return (folder / "rows.json").read_bytes()


def test_an_interruption_leaves_rows_and_no_process(tmp_path, rows_alone, number=signal.SIGKILL):
    """What is kept stays, the workers end, nothing of them is left, and the same command ends with the rows of one that
    nobody disturbed."""
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
    assert not [*(tmp_path / "temporary").iterdir()], "a folder is left"
    assert kept_in(tmp_path) > 3
    again = begun(tmp_path, "--on", "local:2")
    assert "steps were measured before" in again.communicate()[1] and again.returncode == 0
    assert (tmp_path / "rows.json").read_bytes() == rows_alone


def a_process_of(pid: int, module: str) -> int:
    """A process that runs a module, of those that a command started; it may be starting one anew."""
    until = time.monotonic() + 30
    while time.monotonic() < until:
        for child in children(pid):
            # Others end at any moment.
            with suppress(OSError, ValueError):
                if module in Path(f"/proc/{child}/cmdline").read_text():
                    return child
        time.sleep(0.05)
    raise AssertionError(f"no process of {pid} runs {module}")


def test_a_killed_worker_costs_no_row(tmp_path, rows_alone):
    """Another one is started, and the folder of the one that was killed goes."""
    process = begun(tmp_path, "--on", "local:2")
    for steps in (3, 8):
        wait_for(tmp_path, steps)
        assert process.poll() is None, "it ended before anything was killed"
        os.kill(a_process_of(process.pid, "bench.run.piped"), signal.SIGKILL)
    _, err = process.communicate(timeout=300)
    assert process.returncode == 0, err
    assert (tmp_path / "rows.json").read_bytes() == rows_alone
    assert not [*(tmp_path / "temporary").iterdir()], "a folder is left"


def test_a_killed_scheduler_and_its_killed_worker_cost_no_row(tmp_path, rows_alone):
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


def test_workers_that_do_not_stay_end_the_command(run, monkeypatch):
    """In a line, with the last that one of them said."""
    monkeypatch.setattr(piped, "python", lambda _: [sys.executable, "-c", "raise SystemExit('broken')"])
    status, out, err = run(*SMALL, "--on", "local:2")
    assert (status, out) == (2, "") and err.endswith("--on local:2: the workers do not stay: broken\n"), err
