"""A run whose workers and scheduler are killed again and again has the files of one that nobody disturbed."""

import random
import subprocess
import sys
import time
from pathlib import Path

import pytest
from attack.kills import figures, images, names

# A part of the default run that takes a minute or two on two cores: JAX, GL and pictures.
PART = "quality,mix,frames,vectors"
WORKER_KILLS, SCHEDULER_KILLS = 20, 2
# Steps that are measured between two kills, not seconds, because machines differ in how long a step takes; and how many
# kills there must have been before the run was over: after each, some steps come at once.
PAUSES, FEWEST = (6, 12), 8
# The command, but that no step is given up: these workers are lost by chance, and the same step may be hit often.
COMMAND = """
import sys
from normalbench.bench.run.workers import pool
pool.MOST_LOST = 1000
from normalbench.bench.door.cli.start import program
program()
"""


def started(folder: Path, *on: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", COMMAND, "run", "--tables", PART, "-o", str(folder), *on]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def running(pid: int, module: str) -> list[int]:
    """A process's children that run a module."""
    # -ww: else `ps` cuts its lines where the environment says how wide a terminal is, and the module's name is lost.
    command = ["ps", "-ww", "-o", "pid=,args=", "--ppid", str(pid)]
    found = subprocess.run(command, capture_output=True, text=True).stdout
    return sorted(int(line.split()[0]) for line in found.splitlines() if f"bench.run.workers.{module}" in line)


def steps_done(folder: Path) -> int:
    path = folder / "rows.jsonl"
    return path.read_bytes().count(b"\n") if path.exists() else 0


def wait_for(steps: int, process: subprocess.Popen[str], folder: Path) -> None:
    """Until a run has measured so many steps, or is over."""
    while process.poll() is None and steps_done(folder) < steps:
        time.sleep(0.02)


def kill_one(process: subprocess.Popen[str], module: str, rng: random.Random) -> bool:
    """Kill one of its children that run a module; whether there was one."""
    there = running(process.pid, module)
    if there:
        subprocess.run(["kill", "-KILL", str(rng.choice(there))], check=False)
    return bool(there)


@pytest.mark.nightly("bench/run/workers/test_on.py::test_a_killed_worker_and_a_killed_scheduler_cost_no_row")
@pytest.mark.usefixtures("gl")
def test_kills_of_workers_and_of_the_scheduler_change_nothing(tmp_path):
    """At random moments, from the first rows on: the same figures to the digit, the same pictures, the same files."""
    alone = started(tmp_path / "alone")
    _, err = alone.communicate()
    assert alone.returncode == 0, err

    rng = random.Random(20260801)
    process = started(tmp_path / "killed", "--on", "local:4")
    began = time.monotonic()
    victims = ["worker"] * WORKER_KILLS
    for at in range(SCHEDULER_KILLS):
        victims.insert(3 + 4 * at, "scheduler")
    killed = []
    for victim in victims:
        wait_for(steps_done(tmp_path / "killed") + rng.randint(*PAUSES), process, tmp_path / "killed")
        if process.poll() is not None:
            break
        while not (is_hit := kill_one(process, victim, rng)) and process.poll() is None:
            time.sleep(0.1)
        killed += [victim] * is_hit
    _, err = process.communicate()
    took = time.monotonic() - began
    assert process.returncode == 0 and "Traceback" not in err, err
    assert len(killed) >= FEWEST, f"killed in {took:.0f} s: {killed}; it said: {err}"
    assert "scheduler" in killed, killed
    assert figures(tmp_path / "killed") == figures(tmp_path / "alone")
    assert images(tmp_path / "killed") == images(tmp_path / "alone")
    assert names(tmp_path / "killed") == names(tmp_path / "alone")
    print(f"{len(killed)} kills in {took:.0f} s")
