"""A run whose workers and scheduler are killed repeatedly has the files of an undisturbed run."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from attack.kills import figures, images, names
from speed.scheduled import Scheduled, scheduled

# A part of the default run that takes a minute or two on two cores: JAX, GL and pictures.
PART = "quality,mix,frames,vectors"


WORKER_KILLS, SCHEDULER_KILLS = 12, 2


# Steps that are measured between two kills, not seconds, because machines differ in how long a step takes; and how many
# kills there must have been before the run was over: after each, some steps come at once.
PAUSES, FEWEST = (6, 12), 8


# The command, but that no step is given up: these workers are lost by chance, and the same step may be hit often.
COMMAND = """
import sys
from normalbench.bench.run.workers import local
local.MOST_LOST = 1000
from normalbench.bench.door.cli.start import program
program()
"""


def started(folder: Path, *on: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", COMMAND, "run", "--tables", PART, "-o", str(folder), *on]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def children(pid: int) -> list[int]:
    """Return the worker processes of a command."""
    # -ww: else `ps` cuts its lines where the environment says how wide a terminal is, and the module's name is lost.
    command = ["ps", "-ww", "-o", "pid=,args=", "--ppid", str(pid)]
    output = subprocess.run(command, capture_output=True, text=True).stdout
    return sorted(int(line.split()[0]) for line in output.splitlines() if "bench.run.piped" in line)


def steps_done(folder: Path) -> int:
    path = folder / "rows.jsonl"
    return path.read_bytes().count(b"\n") if path.exists() else 0


def wait_for(steps: int, process: subprocess.Popen[str], folder: Path) -> None:
    """Wait until a run has measured this many steps, or has ended."""
    while process.poll() is None and steps_done(folder) < steps:
        time.sleep(0.02)


class Local:
    """Workers that the command starts and restarts."""

    on, victims = "local:4", ["worker"] * WORKER_KILLS

    def kill(self, process: subprocess.Popen[str], victim: str, rng: random.Random) -> None:  # noqa: ARG002
        while process.poll() is None:
            if there := children(process.pid):
                os.kill(rng.choice(there), signal.SIGKILL)
                return
            time.sleep(0.1)


class Joined:
    """Workers of a scheduler. A new worker replaces each killed worker."""

    def __init__(self, there: Scheduled):
        self.on, self._there = there.address, there
        self.victims = ["worker"] * (WORKER_KILLS - SCHEDULER_KILLS)
        for kill in range(SCHEDULER_KILLS):
            self.victims.insert(3 + 4 * kill, "scheduler")

    def kill(self, process: subprocess.Popen[str], victim: str, rng: random.Random) -> None:  # noqa: ARG002
        if victim == "worker":
            hit = self._there.workers.pop(rng.randrange(len(self._there.workers)))
            hit.kill()
            hit.wait()
            self._there.join()
        else:
            self._there.scheduler.kill()
            self._there.scheduler.communicate()
            self._there.start(self._there.address.rpartition(":")[2])


@pytest.fixture
def workers(request, monkeypatch):
    """The workers to kill: those of the command or those of a scheduler."""
    if request.param == "local":
        yield Local()
        return
    # Dask counts for itself.
    monkeypatch.setenv("DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES", "1000")
    with scheduled({}, {}, {}, {}) as there:
        yield Joined(there)


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The folder of an undisturbed run."""
    folder = tmp_path_factory.mktemp("alone") / "run"
    process = started(folder)
    _, err = process.communicate()
    assert process.returncode == 0, err
    return folder


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("workers", ["local", "scheduler"], indirect=True)
def test_killing_workers_and_the_scheduler_changes_nothing(tmp_path, alone, workers):
    """Kills come at random moments after the first rows; figures, pictures and file names match exactly."""
    rng, folder = random.Random(20260801), tmp_path / "killed"
    process = started(folder, "--on", workers.on)
    began, killed = time.monotonic(), []
    for victim in workers.victims:
        wait_for(steps_done(folder) + rng.randint(*PAUSES), process, folder)
        if process.poll() is not None:
            break
        workers.kill(process, victim, rng)
        killed.append(victim)
    _, err = process.communicate()
    took = time.monotonic() - began
    assert process.returncode == 0 and "Traceback" not in err, err
    assert len(killed) >= FEWEST, f"killed in {took:.0f} s: {killed}; it said: {err}"
    assert set(killed) == set(workers.victims), killed
    assert figures(folder) == figures(alone)
    assert images(folder) == images(alone)
    assert names(folder) == names(alone)
    print(f"{len(killed)} kills in {took:.0f} s")
